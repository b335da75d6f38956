// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/generated/generated_solids.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "geometry/canonical_form.h"

namespace watertight::generated {
namespace {

using test::permutation;

[[noreturn]] void give_up(const Error& error) {
  std::fprintf(stderr, "a generated solid is broken: %s\n", to_string(error).c_str());
  std::abort();
}

Index add_corner(SolidArrays& arrays, double x, double y, double z) {
  arrays.vertices.push_back({x, y, z});
  return static_cast<Index>(arrays.vertices.size() - 1);
}

void add_ring(SolidArrays& arrays, const std::vector<Index>& ring) {
  arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
  arrays.end_ring();
}

std::vector<Index> reversed(std::vector<Index> ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

/// The eight vertices of a box; bits 0, 1 and 2 of the index choose the greater x, y and z.
std::array<Index, 8> add_corners(SolidArrays& arrays, Point min, Point max) {
  std::array<Index, 8> corner{};
  for (std::size_t i = 0; i < 8; ++i) {
    corner[i] = add_corner(arrays, (i & 1U) != 0 ? max.x : min.x, (i & 2U) != 0 ? max.y : min.y,
                           (i & 4U) != 0 ? max.z : min.z);
  }
  return corner;
}

void add_box_facets(SolidArrays& arrays, const std::array<Index, 8>& c, Turn turn) {
  const std::array<std::array<std::size_t, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}};
  for (const auto& side : sides) {
    std::vector<Index> ring;
    for (const std::size_t i : side) ring.push_back(c[i]);
    if (turn == Turn::inward) ring = reversed(ring);
    add_facet(arrays, {ring});
  }
}

/// Appends the walls, four vertices each, between a lower and an upper ring of equal size; the
/// rings turn counter-clockwise seen from above. Walls turned inward belong to a hole.
void add_walls(SolidArrays& arrays, const std::vector<Index>& low, const std::vector<Index>& high,
               Turn turn) {
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    std::vector<Index> ring{low[i], low[j], high[j], high[i]};
    if (turn == Turn::inward) ring = reversed(ring);
    add_facet(arrays, {ring});
  }
}

std::vector<Index> add_square(SolidArrays& arrays, double x, double y, double size, double z) {
  return {add_corner(arrays, x, y, z), add_corner(arrays, x + size, y, z),
          add_corner(arrays, x + size, y + size, z), add_corner(arrays, x, y + size, z)};
}

/// A closed surface over a grid of heights: triangles above, one polygon below, walls around.
SolidArrays terrain(Random& random, Index size, double scale) {
  SolidArrays arrays;
  const double z_range = 400;
  for (Index i = 0; i <= size; ++i) {
    for (Index j = 0; j <= size; ++j) {
      const auto height = static_cast<double>(random.below(static_cast<std::uint64_t>(z_range)));
      const auto dx = static_cast<double>(random.below(60));
      const bool is_rim = i == 0 || j == 0 || i == size || j == size;
      add_corner(arrays, (i * 100 + (is_rim ? 0 : dx)) * scale, j * 100 * scale,
                 (500 + height) * scale);
    }
  }
  const auto at = [&](Index i, Index j) { return i * (size + 1) + j; };
  for (Index i = 0; i < size; ++i) {
    for (Index j = 0; j < size; ++j) {
      add_facet(arrays, {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      add_facet(arrays, {{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  std::vector<Index> rim;
  for (Index i = 0; i < size; ++i) rim.push_back(at(i, 0));
  for (Index j = 0; j < size; ++j) rim.push_back(at(size, j));
  for (Index i = size; i > 0; --i) rim.push_back(at(i, size));
  for (Index j = size; j > 0; --j) rim.push_back(at(0, j));
  std::vector<Index> foot;
  for (const Index vertex : rim) {
    const Point p = arrays.vertices[vertex];
    foot.push_back(add_corner(arrays, p.x, p.y, 0));
  }
  add_walls(arrays, foot, rim, Turn::outward);
  add_facet(arrays, {reversed(foot)});
  arrays.end_shell();
  return arrays;
}

}  // namespace

void add_facet(SolidArrays& arrays, const std::vector<std::vector<Index>>& rings) {
  for (const auto& ring : rings) add_ring(arrays, ring);
  arrays.end_facet();
}

void add_box(SolidArrays& arrays, Point min, Point max, Turn turn) {
  add_box_facets(arrays, add_corners(arrays, min, max), turn);
  arrays.end_shell();
}

OrientedBoundary boundary_of(SolidArrays arrays) {
  Lattice lattice;
  for (GridNumber& step : lattice.step) step = {1, -3};
  lattice.origin = {GridNumber{84616468, -3}, GridNumber{447422, 0}, GridNumber{-25, -1}};
  return boundary_of(std::move(arrays), lattice, 7415);
}

OrientedBoundary boundary_of(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid) {
  auto solid = Solid::make(std::move(arrays), lattice, srid);
  if (!solid) give_up(solid.error());
  auto boundary = OrientedBoundary::make(std::move(solid).value());
  if (!boundary) give_up(boundary.error());
  return std::move(boundary).value();
}

OrientedBoundary box() {
  SolidArrays arrays;
  add_box(arrays, {0, 0, 0}, {12000, 8500, 6230});
  return boundary_of(std::move(arrays));
}

OrientedBoundary pierced_block(Index holes) {
  SolidArrays arrays;
  const double size = 2000.0 * holes + 1000;
  const auto low = add_square(arrays, 0, 0, size, 0);
  const auto high = add_square(arrays, 0, 0, size, 700);
  add_walls(arrays, low, high, Turn::outward);
  std::vector<std::vector<Index>> bottom{reversed(low)};
  std::vector<std::vector<Index>> top{high};
  for (Index i = 0; i < holes; ++i) {
    for (Index j = 0; j < holes; ++j) {
      const double x = 1000 + 2000.0 * i;
      const double y = 1000 + 2000.0 * j;
      const auto hole_low = add_square(arrays, x, y, 1000, 0);
      const auto hole_high = add_square(arrays, x, y, 1000, 700);
      add_walls(arrays, hole_low, hole_high, Turn::inward);
      bottom.push_back(hole_low);
      top.push_back(reversed(hole_high));
    }
  }
  add_facet(arrays, bottom);
  add_facet(arrays, top);
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

OrientedBoundary box_with_cavities(Index count) {
  SolidArrays arrays;
  add_box(arrays, {0, 0, 0}, {3000.0 * count + 1000, 4000, 3500});
  for (Index i = 0; i < count; ++i) {
    const double x = 1000 + 3000.0 * i;
    add_box(arrays, {x, 1000, 1000}, {x + 2000, 3000, 2500}, Turn::inward);
  }
  return boundary_of(std::move(arrays));
}

OrientedBoundary boxes_touching_at_edge() {
  SolidArrays arrays;
  add_box(arrays, {0, 0, 0}, {1000, 1000, 1000});
  add_box(arrays, {1000, 1000, 0}, {2000, 2000, 1000});
  auto solid = Solid::make(std::move(arrays), Lattice{}, 0);
  if (!solid) give_up(solid.error());
  auto boundary = OrientedBoundary::make(geometry::merge_equal_vertices(*solid).solid);
  if (!boundary) give_up(boundary.error());
  return std::move(boundary).value();
}

OrientedBoundary boxes_touching_at_vertex() {
  SolidArrays arrays;
  add_box(arrays, {0, 0, 0}, {1000, 1000, 1000});
  add_box(arrays, {1000, 1000, 1000}, {2000, 2500, 2000});
  auto solid = Solid::make(std::move(arrays), Lattice{}, 0);
  if (!solid) give_up(solid.error());
  auto boundary = OrientedBoundary::make(geometry::merge_equal_vertices(*solid).solid);
  if (!boundary) give_up(boundary.error());
  return std::move(boundary).value();
}

OrientedBoundary block_with_touching_hole() {
  SolidArrays arrays;
  const auto low = add_square(arrays, 0, 0, 1000, 0);
  const auto high = add_square(arrays, 0, 0, 1000, 500);
  add_walls(arrays, low, high, Turn::outward);
  // The hole is a triangle with one corner at a corner of the block.
  const std::vector<Index> hole_low{low[0], add_corner(arrays, 600, 300, 0),
                                    add_corner(arrays, 300, 600, 0)};
  const std::vector<Index> hole_high{high[0], add_corner(arrays, 600, 300, 500),
                                     add_corner(arrays, 300, 600, 500)};
  add_walls(arrays, hole_low, hole_high, Turn::inward);
  add_facet(arrays, {reversed(low), hole_low});
  add_facet(arrays, {high, reversed(hole_high)});
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

OrientedBoundary torus(Index n, Index m) {
  // A table of a regular 16-gon of radius 1000 keeps the coordinates integers and the circles
  // convex.
  constexpr std::array<std::array<int, 2>, 16> circle{{{1000, 0},
                                                       {924, 383},
                                                       {707, 707},
                                                       {383, 924},
                                                       {0, 1000},
                                                       {-383, 924},
                                                       {-707, 707},
                                                       {-924, 383},
                                                       {-1000, 0},
                                                       {-924, -383},
                                                       {-707, -707},
                                                       {-383, -924},
                                                       {0, -1000},
                                                       {383, -924},
                                                       {707, -707},
                                                       {924, -383}}};
  const Index step_n = static_cast<Index>(circle.size()) / n;
  const Index step_m = static_cast<Index>(circle.size()) / m;
  SolidArrays arrays;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < m; ++j) {
      const auto& around = circle[i * step_n];
      const auto& across = circle[j * step_m];
      const double radius = 4000.0 + across[0];
      // The division of integers rounds down to the grid, so every machine gets the same integers.
      const auto x = static_cast<double>(static_cast<std::int64_t>(radius) * around[0] / 1000);
      const auto y = static_cast<double>(static_cast<std::int64_t>(radius) * around[1] / 1000);
      add_corner(arrays, x + 5000, y + 5000, across[1] + 1000.0);
    }
  }
  const auto at = [&](Index i, Index j) { return (i % n) * m + j % m; };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < m; ++j) {
      add_facet(arrays, {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      add_facet(arrays, {{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

OrientedBoundary grid_cube(Index n) {
  SolidArrays arrays;
  std::vector<Index> number((n + 1) * (n + 1) * (n + 1), kNone);
  const auto at = [&](Index x, Index y, Index z) {
    Index& vertex = number[(x * (n + 1) + y) * (n + 1) + z];
    if (vertex == kNone) vertex = add_corner(arrays, x, y, z);
    return vertex;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (Index u = 0; u < n; ++u) {
      for (Index v = 0; v < n; ++v) {
        const auto place = [&](Index a, Index b, Index c) {
          return axis == 0 ? at(c, a, b) : axis == 1 ? at(b, c, a) : at(a, b, c);
        };
        add_facet(arrays, {{place(u, v, 0), place(u, v + 1, 0), place(u + 1, v + 1, 0),
                            place(u + 1, v, 0)}});
        add_facet(arrays, {{place(u, v, n), place(u + 1, v, n), place(u + 1, v + 1, n),
                            place(u, v + 1, n)}});
      }
    }
  }
  arrays.end_shell();
  return boundary_of(std::move(arrays), Lattice{}, 0);
}

OrientedBoundary schoenhardt() {
  // A triangular prism whose upper triangle is turned by 30 degrees; its walls fold inward along
  // the long diagonals.
  SolidArrays arrays;
  arrays.vertices = {{20000, 10000, 0},    {5000, 18660, 0},    {5000, 1340, 0},
                     {18660, 15000, 9000}, {1340, 15000, 9000}, {10000, 0, 9000}};
  const std::vector<std::vector<Index>> triangles{{2, 1, 0}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                                                  {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  for (const auto& triangle : triangles) add_facet(arrays, {triangle});
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

delaunay::Certificate schoenhardt_certificate() {
  const OrientedBoundary boundary = schoenhardt();
  const Solid& solid = boundary.solid();
  delaunay::Certificate certificate;
  certificate.rung = delaunay::Rung::tetgen;
  delaunay::Tetrahedralization& mesh = certificate.tetrahedralization;
  mesh.points.assign(solid.vertices().begin(), solid.vertices().end());
  mesh.input_count = solid.vertex_count();
  mesh.points.push_back({10000.5, 10000.125, 4500});
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const auto ring = solid.ring(facet);
    mesh.constrained.push_back({{ring[0], ring[1], ring[2]}, facet});
    mesh.tetrahedra.push_back({ring[0], ring[2], ring[1], mesh.input_count});
    certificate.is_interior.push_back(true);
  }
  return certificate;
}

OrientedBoundary random_prism(Random& random, Index sides) {
  SolidArrays arrays;
  // A zigzag polygon: x rises along the lower side and falls along the upper one, which is longer,
  // so that the edges at both ends cross no others.
  std::vector<Point> outline;
  std::uint64_t x = 0;
  for (Index i = 0; i < sides; ++i) {
    outline.push_back({static_cast<double>(x + 500), static_cast<double>(random.below(3000)), 0});
    x += 200 + random.below(2500);
  }
  for (Index i = 0; i < sides; ++i) {
    const std::uint64_t from_end = (x + 1000) * i / (sides - 1);
    outline.push_back({static_cast<double>(x + 1000 - from_end),
                       4000 + static_cast<double>(random.below(5000)), 0});
  }
  const double height = 2500 + static_cast<double>(random.below(9000));
  std::vector<Index> low;
  std::vector<Index> high;
  for (const Point& p : outline) low.push_back(add_corner(arrays, p.x, p.y, 0));
  for (const Point& p : outline) high.push_back(add_corner(arrays, p.x, p.y, height));
  add_walls(arrays, low, high, Turn::outward);
  add_facet(arrays, {reversed(low)});
  add_facet(arrays, {high});
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

OrientedBoundary random_terrain(Random& random, Index size) {
  return boundary_of(terrain(random, size, 1));
}

OrientedBoundary random_doubles(Random& random, Index size) {
  Lattice lattice;
  lattice.kind = LatticeKind::float64;
  return boundary_of(terrain(random, size, 0.1), lattice, 4326);
}

OrientedBoundary saw(Index teeth, Back back) {
  const bool is_left = back == Back::left;
  SolidArrays arrays;
  std::vector<Index> base;
  double z = 0;
  for (Index k = 0; k <= 2 * teeth; ++k) {
    z += 20 + k * k % 7;
    if (!is_left && (k == 0 || k == 2 * teeth)) continue;
    base.push_back(add_corner(arrays, k % 2 == 0 ? 0 : 400, 0, z));
  }
  base.push_back(add_corner(arrays, is_left ? -300 : 700, 0, 0));
  const Index apex = is_left ? add_corner(arrays, -500, 300, 0) : add_corner(arrays, 200, -90, 50);
  for (std::size_t i = 0; i < base.size(); ++i) {
    add_facet(arrays, {{base[(i + 1) % base.size()], base[i], apex}});
  }
  add_facet(arrays, {base});
  arrays.end_shell();
  return geometry::canonical_form(boundary_of(std::move(arrays))).boundary;
}

OrientedBoundary shuffled(const OrientedBoundary& boundary, Random& random) {
  const Solid& solid = boundary.solid();
  SolidArrays arrays;
  const auto vertices = permutation(solid.vertex_count(), random, 0);
  arrays.vertices.resize(vertices.size());
  for (Index i = 0; i < vertices.size(); ++i) arrays.vertices[vertices[i]] = solid.vertices()[i];
  for (const Index shell : permutation(solid.shell_count(), random, 1)) {
    const IndexRange facets = solid.facets_of(shell);
    for (const Index facet : permutation(facets.size(), random, 0)) {
      const IndexRange rings = solid.rings_of(facets.begin + facet);
      for (const Index place : permutation(rings.size(), random, 1)) {
        const auto ring = solid.ring(rings.begin + place);
        const std::size_t start = random.below(ring.size());
        for (std::size_t i = 0; i < ring.size(); ++i) {
          arrays.ring_vertices.push_back(vertices[ring[(start + i) % ring.size()]]);
        }
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  return boundary_of(std::move(arrays), solid.lattice(), solid.srid());
}

std::vector<NamedBoundary> all(std::uint64_t seed) {
  Random random(seed);
  std::vector<NamedBoundary> solids{{"box", box()},
                                    {"pierced-block-1", pierced_block(1)},
                                    {"pierced-block-3", pierced_block(3)},
                                    {"cavity-1", box_with_cavities(1)},
                                    {"cavity-4", box_with_cavities(4)},
                                    {"touching-edge", boxes_touching_at_edge()},
                                    {"touching-vertex", boxes_touching_at_vertex()},
                                    {"touching-hole", block_with_touching_hole()},
                                    {"torus-8-4", torus(8, 4)},
                                    {"torus-16-16", torus(16, 16)},
                                    {"grid-cube-1", grid_cube(1)},
                                    {"grid-cube-4", grid_cube(4)},
                                    {"schoenhardt", schoenhardt()}};
  for (Index i = 0; i < 12; ++i) {
    const std::string number = std::to_string(i);
    solids.push_back({"prism-" + number, random_prism(random, 3 + i)});
    solids.push_back({"terrain-" + number, random_terrain(random, 1 + i)});
    solids.push_back({"doubles-" + number, random_doubles(random, 1 + i / 2)});
  }
  const std::size_t plain = solids.size();
  for (std::size_t i = 0; i < plain; ++i) {
    solids.push_back({solids[i].name + "-shuffled", shuffled(solids[i].boundary, random)});
  }
  return solids;
}

}  // namespace watertight::generated
