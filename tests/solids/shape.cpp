// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solids/shape.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

namespace watertight::solids {
namespace {

using test::permutation;

void append_ring(SolidArrays& arrays, std::vector<Index> ring, Random& random) {
  if (!ring.empty()) {
    const auto start = static_cast<std::ptrdiff_t>(random.below(ring.size()));
    std::rotate(ring.begin(), ring.begin() + start, ring.end());
  }
  arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
  arrays.end_ring();
}

}  // namespace

Lattice millimetres() {
  Lattice lattice;
  lattice.step.fill(GridNumber{1, -3});
  return lattice;
}

Solid solid_of(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid) {
  auto solid = Solid::make(std::move(arrays), lattice, srid);
  if (!solid) {
    std::fprintf(stderr, "a generated solid is broken: %s\n", to_string(solid.error()).c_str());
    std::abort();
  }
  return std::move(solid).value();
}

Solid solid_of(const Shape& shape, const Lattice& lattice, std::uint32_t srid) {
  SolidArrays arrays;
  std::map<Point, Index> number;
  for (const Shell& shell : shape) {
    for (const Facet& facet : shell) {
      for (const Ring& ring : facet) {
        for (const Point& p : ring) {
          const auto [place, is_new] =
              number.emplace(p, static_cast<Index>(arrays.vertices.size()));
          if (is_new) arrays.vertices.push_back(p);
          arrays.ring_vertices.push_back(place->second);
        }
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  return solid_of(std::move(arrays), lattice, srid);
}

Shape shape_of(const Solid& solid) {
  Shape shape(solid.shell_count());
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    for (Index f = solid.facets_of(shell).begin; f < solid.facets_of(shell).end; ++f) {
      Facet& facet = shape[shell].emplace_back();
      for (Index r = solid.rings_of(f).begin; r < solid.rings_of(f).end; ++r) {
        Ring& ring = facet.emplace_back();
        for (const Index vertex : solid.ring(r)) ring.push_back(solid.vertices()[vertex]);
      }
    }
  }
  return shape;
}

Ring reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

Facet turned_over(Facet facet) {
  for (Ring& ring : facet) ring = reversed(std::move(ring));
  return facet;
}

Shell inside_out(Shell shell) {
  for (Facet& facet : shell) facet = turned_over(std::move(facet));
  return shell;
}

Shell join(Shell shell, const Shell& other) {
  shell.insert(shell.end(), other.begin(), other.end());
  return shell;
}

std::size_t facet_count(const Shape& shape) {
  std::size_t count = 0;
  for (const Shell& shell : shape) count += shell.size();
  return count;
}

std::size_t corner_count(const Shape& shape) {
  std::size_t count = 0;
  for (const Shell& shell : shape) {
    for (const Facet& facet : shell) {
      for (const Ring& ring : facet) count += ring.size();
    }
  }
  return count;
}

Rewritten rewritten(const Solid& solid, Random& random) {
  SolidArrays arrays;
  const std::vector<Index> vertices = permutation(solid.vertex_count(), random, 0);
  std::vector<Index> new_vertex(vertices.size());
  for (Index i = 0; i < vertices.size(); ++i) {
    arrays.vertices.push_back(solid.vertices()[vertices[i]]);
    new_vertex[vertices[i]] = i;
  }
  Rewritten result{solid, {}, permutation(solid.shell_count(), random, 1)};
  for (const Index shell : result.shell_of) {
    const IndexRange facets = solid.facets_of(shell);
    for (const Index offset : permutation(facets.size(), random, 0)) {
      const IndexRange rings = solid.rings_of(facets.begin + offset);
      result.facet_of.push_back(facets.begin + offset);
      for (const Index place : permutation(rings.size(), random, 1)) {
        std::vector<Index> ring;
        for (const Index vertex : solid.ring(rings.begin + place)) {
          ring.push_back(new_vertex[vertex]);
        }
        append_ring(arrays, std::move(ring), random);
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  result.solid = solid_of(std::move(arrays), solid.lattice(), solid.srid());
  return result;
}

std::int64_t AffineMap::determinant() const {
  const auto& m = matrix;
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

AffineMap unimodular_map(Random& random, std::int64_t size) {
  AffineMap map;
  // Each step is a shear: it adds a multiple of one row to another.
  for (int step = 0; step < 6; ++step) {
    const std::size_t to = random.below(3);
    const std::size_t from = (to + 1 + random.below(2)) % 3;
    const auto factor = static_cast<std::int64_t>(random.within(-2, 2));
    std::array<std::int64_t, 3> row = map.matrix[to];
    bool fits = true;
    for (std::size_t i = 0; i < 3; ++i) {
      row[i] += factor * map.matrix[from][i];
      fits = fits && std::abs(row[i]) <= size;
    }
    if (fits) map.matrix[to] = row;
  }
  for (std::int64_t& shift : map.shift) {
    shift = static_cast<std::int64_t>(random.within(-1'000'000'000, 1'000'000'000));
  }
  return map;
}

AffineMap general_map(Random& random, std::int64_t size) {
  AffineMap map = unimodular_map(random, size);
  do {
    for (auto& row : map.matrix) {
      for (std::int64_t& entry : row) {
        entry = static_cast<std::int64_t>(random.within(-size, size));
      }
    }
  } while (map.determinant() == 0);
  if (map.determinant() < 0) std::swap(map.matrix[0], map.matrix[1]);
  return map;
}

AffineMap axis_permutation(Random& random, bool is_even) {
  AffineMap map;
  const std::size_t turn = random.below(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t from = is_even ? (i + 1 + turn) % 3 : (2 * 3 - i - turn) % 3;
    map.matrix[i] = {};
    map.matrix[i][from] = 1;
  }
  return map;
}

double largest_coordinate(const Solid& solid, const AffineMap& map) {
  double largest = 0;
  for (const Point& p : solid.vertices()) {
    for (std::size_t row = 0; row < 3; ++row) {
      double sum = std::abs(static_cast<double>(map.shift[row]));
      for (int axis = 0; axis < 3; ++axis) {
        sum += std::abs(static_cast<double>(map.matrix[row][static_cast<std::size_t>(axis)]) *
                        p[axis]);
      }
      largest = std::max(largest, sum);
    }
  }
  return largest;
}

Solid mapped(const Solid& solid, const AffineMap& map) {
  SolidArrays arrays = solid.arrays();
  for (Point& p : arrays.vertices) {
    const Point source = p;
    for (int row = 0; row < 3; ++row) {
      const auto& factors = map.matrix[static_cast<std::size_t>(row)];
      std::int64_t sum = map.shift[static_cast<std::size_t>(row)];
      for (int axis = 0; axis < 3; ++axis) {
        sum += factors[static_cast<std::size_t>(axis)] * static_cast<std::int64_t>(source[axis]);
      }
      p[row] = static_cast<double>(sum);
    }
  }
  if (map.determinant() < 0) {
    for (std::size_t ring = 0; ring + 1 < arrays.ring_offsets.size(); ++ring) {
      std::reverse(arrays.ring_vertices.begin() + arrays.ring_offsets[ring],
                   arrays.ring_vertices.begin() + arrays.ring_offsets[ring + 1]);
    }
  }
  return solid_of(std::move(arrays), solid.lattice(), solid.srid());
}

std::set<int> codes_of(const Report& report, Severity severity) {
  std::set<int> codes;
  for (const Finding& finding : report.findings) {
    if (finding.severity == severity) codes.insert(finding.code);
  }
  return codes;
}

}  // namespace watertight::solids
