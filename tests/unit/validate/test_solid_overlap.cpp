// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids whose relation is known by construction: space is cut into tetrahedra by the planes x = k,
// y = k, z = k and x - y = k, y - z = k, x - z = k (Freudenthal 1942). The cut with cubes of size 2
// or 3 is a coarsening of the cut with cubes of size 1. A solid is a set of tetrahedra of one size,
// connected over faces; the common part of two solids is counted in tetrahedra of size 1.
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <iterator>
#include <map>
#include <random>
#include <set>

#include "validate/overlap/solid_overlap.h"

namespace watertight {
namespace {

/// The length of a step of the grid: a metre along each axis.
constexpr validate::StepMetres kMetres{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

// The corner of a cube, and the number of one of its six tetrahedra.
using Cell = std::array<int, 4>;
using Corner = std::array<int, 3>;
constexpr std::array<std::array<int, 3>, 6> kWays{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

/// The corners of a tetrahedron: a way from the corner of the cube along the axes, in one of six
/// orders.
std::array<Corner, 4> corners_of(const Cell& cell, int size) {
  std::array<Corner, 4> corners{};
  corners[0] = {cell[0] * size, cell[1] * size, cell[2] * size};
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i + 1] = corners[i];
    const int axis = kWays[static_cast<std::size_t>(cell[3])][i];
    corners[i + 1][static_cast<std::size_t>(axis)] += size;
  }
  // The ways with odd permutations give mirrored tetrahedra.
  const bool is_odd = cell[3] == 1 || cell[3] == 2 || cell[3] == 5;
  if (is_odd) std::swap(corners[2], corners[3]);
  return corners;
}

/// The faces of a tetrahedron, turned outward.
std::array<std::array<Corner, 3>, 4> faces_of(const Cell& cell, int size) {
  const auto c = corners_of(cell, size);
  return {{{c[0], c[2], c[1]}, {c[0], c[1], c[3]}, {c[1], c[2], c[3]}, {c[2], c[0], c[3]}}};
}

std::set<Corner> face_key(const std::array<Corner, 3>& face) { return {face.begin(), face.end()}; }

struct Body {
  int size = 1;
  std::set<Cell> cells;
};

/// A body of about `count` tetrahedra within a cube of 4.
Body random_body(std::mt19937& random, int count) {
  std::uniform_int_distribution<int> pick(0, 1 << 20);
  Body body;
  body.size = 1 + pick(random) % 3;
  const int reach = body.size == 1 ? 4 : 2;
  const auto random_cell = [&] {
    return Cell{pick(random) % reach, pick(random) % reach, pick(random) % reach, pick(random) % 6};
  };
  std::map<std::set<Corner>, std::vector<Cell>> at_face;
  for (int x = 0; x < reach; ++x) {
    for (int y = 0; y < reach; ++y) {
      for (int z = 0; z < reach; ++z) {
        for (int way = 0; way < 6; ++way) {
          for (const auto& face : faces_of({x, y, z, way}, body.size)) {
            at_face[face_key(face)].push_back({x, y, z, way});
          }
        }
      }
    }
  }
  std::vector<Cell> border{random_cell()};
  while (!border.empty() && static_cast<int>(body.cells.size()) < count) {
    const auto at = static_cast<std::size_t>(pick(random)) % border.size();
    const Cell cell = border[at];
    border.erase(border.begin() + static_cast<std::ptrdiff_t>(at));
    if (!body.cells.insert(cell).second) continue;
    for (const auto& face : faces_of(cell, body.size)) {
      for (const Cell& next : at_face[face_key(face)]) {
        if (!body.cells.contains(next)) border.push_back(next);
      }
    }
  }
  return body;
}

/// The tetrahedra of size 1 in a body, each given by four times its centre.
std::set<Corner> fine_cells(const Body& body) {
  std::set<Corner> fine;
  for (const Cell& cell : body.cells) {
    const auto coarse = corners_of(cell, body.size);
    // A point is inside if its coordinates, along the axes in the order of the way, do not
    // increase.
    const auto& way = kWays[static_cast<std::size_t>(cell[3])];
    for (int x = 0; x < body.size; ++x) {
      for (int y = 0; y < body.size; ++y) {
        for (int z = 0; z < body.size; ++z) {
          for (int kind = 0; kind < 6; ++kind) {
            const Cell local{x, y, z, kind};
            Corner sum{};
            for (const Corner& corner : corners_of(local, 1)) {
              for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += corner[axis];
            }
            const auto along = [&](std::size_t i) { return sum[static_cast<std::size_t>(way[i])]; };
            if (along(0) < along(1) || along(1) < along(2)) continue;
            for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += 4 * coarse[0][axis];
            fine.insert(sum);
          }
        }
      }
    }
  }
  return fine;
}

/// The faces that belong to one tetrahedron only, cut into faces of size 1 for comparison: for each
/// face, twelve times its centre, and its turn.
std::vector<std::array<Corner, 3>> boundary_of(const Body& body) {
  std::map<std::set<Corner>, std::vector<std::array<Corner, 3>>> faces;
  for (const Cell& cell : body.cells) {
    for (const auto& face : faces_of(cell, body.size)) faces[face_key(face)].push_back(face);
  }
  std::vector<std::array<Corner, 3>> boundary;
  for (const auto& [key, users] : faces) {
    if (users.size() == 1) boundary.push_back(users[0]);
  }
  return boundary;
}

/// The faces of the tetrahedra of size 1 in a body that belong to one of them only.
std::set<std::set<Corner>> fine_boundary(const Body& body) {
  const std::set<Corner> inside = fine_cells(body);
  std::map<std::set<Corner>, int> uses;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      for (int z = 0; z < 6; ++z) {
        for (int way = 0; way < 6; ++way) {
          const Cell cell{x, y, z, way};
          Corner sum{};
          for (const Corner& corner : corners_of(cell, 1)) {
            for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += corner[axis];
          }
          if (!inside.contains(sum)) continue;
          for (const auto& face : faces_of(cell, 1)) ++uses[face_key(face)];
        }
      }
    }
  }
  std::set<std::set<Corner>> boundary;
  for (const auto& [face, count] : uses) {
    if (count == 1) boundary.insert(face);
  }
  return boundary;
}

/// The boundary of a body. For `is_oblique`, an affine map of integers with determinant 1 makes all
/// planes oblique. With `scale` the coordinates are no short integers, so that rationals decide.
validate::RegionSurface surface_of(const Body& body, bool is_oblique, double scale) {
  std::map<Corner, Index> number;
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  std::vector<Index> facets;
  const auto index_of = [&](const Corner& corner) {
    const auto [at, is_new] = number.try_emplace(corner, static_cast<Index>(points.size()));
    if (is_new) {
      const double x = scale * corner[0];
      const double y = scale * corner[1];
      const double z = scale * corner[2];
      points.push_back(is_oblique ? Point{x + 2 * y - z, y + 3 * z, x + 2 * y} : Point{x, y, z});
    }
    return at->second;
  };
  for (const auto& face : boundary_of(body)) {
    facets.push_back(static_cast<Index>(triangles.size()));
    triangles.push_back({index_of(face[0]), index_of(face[1]), index_of(face[2])});
  }
  return {std::move(points), std::move(triangles), std::move(facets)};
}

struct Counts {
  int overlapping = 0;
  int equal = 0;
  int sharing = 0;
  int apart = 0;
};

void check_pair(const Body& a, const Body& b, bool is_oblique, double scale, Counts& counts) {
  const std::set<Corner> cells_a = fine_cells(a);
  const std::set<Corner> cells_b = fine_cells(b);
  std::vector<Corner> common;
  std::set_intersection(cells_a.begin(), cells_a.end(), cells_b.begin(), cells_b.end(),
                        std::back_inserter(common));
  const bool do_overlap = !common.empty();
  const bool are_equal = cells_a == cells_b;
  bool share_area = false;
  if (!do_overlap) {
    const auto boundary = fine_boundary(a);
    for (const auto& face : fine_boundary(b)) share_area = share_area || boundary.contains(face);
  }
  const validate::RegionSurface first = surface_of(a, is_oblique, scale);
  const validate::RegionSurface second = surface_of(b, is_oblique, scale);
  const validate::RegionRelation relation =
      validate::relate_regions(first, second, {true, true}, {});
  REQUIRE(relation.do_overlap == do_overlap);
  const auto is_within = [](const std::set<Corner>& inner, const std::set<Corner>& outer) {
    return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
  };
  REQUIRE(relation.is_first_inside == is_within(cells_a, cells_b));
  REQUIRE(relation.is_second_inside == is_within(cells_b, cells_a));
  if (!do_overlap) REQUIRE(relation.touch_back_to_back == share_area);
  REQUIRE_FALSE(relation.is_cancelled);
  const validate::RegionRelation turned = validate::relate_regions(second, first, {true, true}, {});
  REQUIRE(turned.do_overlap == do_overlap);
  REQUIRE(turned.is_first_inside == relation.is_second_inside);
  REQUIRE(turned.is_second_inside == relation.is_first_inside);
  if (do_overlap && scale == 1) {
    const validate::OverlapExtent extent = validate::measure_overlap(first, second, kMetres);
    REQUIRE(extent.depth > 0);
    if (extent.witness) {
      REQUIRE(first.locate(*extent.witness) == validate::Location::inside);
      REQUIRE(second.locate(*extent.witness) == validate::Location::inside);
    }
  }
  counts.overlapping += do_overlap ? 1 : 0;
  counts.equal += are_equal ? 1 : 0;
  counts.sharing += share_area ? 1 : 0;
  counts.apart += !do_overlap && !share_area ? 1 : 0;
}

TEST_CASE("solids of tetrahedra overlap, share areas and are equal as their tetrahedra do") {
  std::mt19937 random(20261121);
  Counts counts;
  for (int i = 0; i < 500; ++i) {
    const Body a = random_body(random, 1 + i % 40);
    const Body b = random_body(random, 1 + i % 23);
    check_pair(a, b, i % 2 == 1, 1, counts);
  }
  CHECK(counts.overlapping > 100);
  CHECK(counts.sharing > 20);
  CHECK(counts.apart > 10);
}

TEST_CASE("a solid and what is left of a block around it share areas and never overlap") {
  std::mt19937 random(3);
  Counts counts;
  for (int i = 0; i < 120; ++i) {
    const Body a = random_body(random, 1 + i % 60);
    // The largest part of the rest that is connected over faces.
    Body rest = a;
    rest.cells.clear();
    const int reach = a.size == 1 ? 4 : 2;
    std::map<std::set<Corner>, std::vector<Cell>> at_face;
    std::vector<Cell> start;
    for (int x = 0; x < reach; ++x) {
      for (int y = 0; y < reach; ++y) {
        for (int z = 0; z < reach; ++z) {
          for (int way = 0; way < 6; ++way) {
            const Cell cell{x, y, z, way};
            if (a.cells.contains(cell)) continue;
            start = {cell};
            for (const auto& face : faces_of(cell, a.size)) at_face[face_key(face)].push_back(cell);
          }
        }
      }
    }
    while (!start.empty()) {
      const Cell cell = start.back();
      start.pop_back();
      if (!rest.cells.insert(cell).second) continue;
      for (const auto& face : faces_of(cell, a.size)) {
        for (const Cell& next : at_face[face_key(face)]) start.push_back(next);
      }
    }
    if (rest.cells.empty()) continue;
    check_pair(a, rest, i % 2 == 1, 1, counts);
  }
  CHECK(counts.overlapping == 0);
  CHECK(counts.sharing > 80);
}

TEST_CASE(
    "equal solids with coarse and fine triangles are equal, less a tetrahedron they are not") {
  std::mt19937 random(5);
  Counts counts;
  for (int i = 0; i < 60; ++i) {
    Body coarse = random_body(random, 1 + i % 12);
    if (coarse.size == 1) coarse.size = 2;
    Body fine;
    const std::set<Corner> centres = fine_cells(coarse);
    for (int x = 0; x < 12; ++x) {
      for (int y = 0; y < 12; ++y) {
        for (int z = 0; z < 12; ++z) {
          for (int way = 0; way < 6; ++way) {
            Corner sum{};
            for (const Corner& corner : corners_of({x, y, z, way}, 1)) {
              for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += corner[axis];
            }
            if (centres.contains(sum)) fine.cells.insert({x, y, z, way});
          }
        }
      }
    }
    REQUIRE(fine.cells.size() == centres.size());
    check_pair(coarse, fine, i % 2 == 1, 1, counts);
    // Removing a corner cell may leave two parts; the second solid of a pair may have them.
    Body less = fine;
    less.cells.erase(less.cells.begin());
    const validate::RegionRelation relation = validate::relate_regions(
        surface_of(coarse, false, 1), surface_of(less, false, 1), {true, true}, {});
    REQUIRE(relation.do_overlap);
    REQUIRE_FALSE(relation.is_first_inside);
    REQUIRE(relation.is_second_inside);
  }
  CHECK(counts.equal == 60);
}

TEST_CASE("coordinates that no lattice of integers holds are compared in rationals") {
  std::mt19937 random(17);
  Counts counts;
  for (int i = 0; i < 150; ++i) {
    const Body a = random_body(random, 1 + i % 10);
    const Body b = random_body(random, 1 + i % 7);
    // The factor is 1 + 2^-30: its sums and products with small numbers are exact.
    check_pair(a, b, true, 1.0 + 1.0 / 1073741824.0, counts);
  }
  CHECK(counts.overlapping > 30);
  CHECK(counts.sharing > 5);
}

}  // namespace
}  // namespace watertight
