// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "geometry/predicates/predicates.h"
#include "tessellate/facets.h"
#include "tests/unit/tessellate/facet_solid.h"

using namespace watertight;

namespace {

using test::facet_solid;
using test::Ring;
using PointTriangle = std::array<Point, 3>;

std::vector<PointTriangle> point_triangles(const Solid& solid) {
  std::vector<PointTriangle> result;
  for (const Triangle& t : tessellate::triangulate_facets(solid).triangles) {
    result.push_back({solid.vertices()[t[0]], solid.vertices()[t[1]], solid.vertices()[t[2]]});
  }
  return result;
}

tessellate::FacetState state_of(const std::vector<Ring>& rings) {
  const tessellate::FacetTriangles result = tessellate::triangulate_facets(facet_solid(rings));
  if (result.state[0] != tessellate::FacetState::triangulated) REQUIRE(result.triangles.empty());
  return result.state[0];
}

/// Twice the area of a ring in the plane z = 0, in integers.
std::int64_t doubled_area(const Ring& ring) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point& a = ring[i];
    const Point& b = ring[(i + 1) % ring.size()];
    sum += static_cast<std::int64_t>(a.x * b.y - a.y * b.x);
  }
  return sum;
}

/// The incircle determinant of small integers: > 0 if d is inside the circle of a left-turning abc.
std::int64_t in_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto row = [&](const Point& p) {
    const auto x = static_cast<std::int64_t>(p.x - d.x);
    const auto y = static_cast<std::int64_t>(p.y - d.y);
    return std::array<std::int64_t, 3>{x, y, x * x + y * y};
  };
  const auto u = row(a);
  const auto v = row(b);
  const auto w = row(c);
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/// True if every edge that is no edge of a ring is Delaunay; in a tie the largest point counts as
/// outside.
bool is_canonical(const std::vector<PointTriangle>& triangles, const std::vector<Ring>& rings) {
  std::set<std::pair<Point, Point>> ring_edges;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      ring_edges.insert(std::minmax(ring[i], ring[(i + 1) % ring.size()]));
    }
  }
  std::map<std::pair<Point, Point>, std::vector<std::pair<PointTriangle, Point>>> edges;
  for (const PointTriangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::pair<Point, Point> key = std::minmax(t[i], t[(i + 1) % 3]);
      edges[key].push_back({t, t[(i + 2) % 3]});
    }
  }
  for (const auto& [edge, sides] : edges) {
    if (ring_edges.count(edge) != 0) {
      if (sides.size() != 1) return false;
      continue;
    }
    if (sides.size() != 2) return false;
    const PointTriangle& t = sides[0].first;
    const Point& apex = sides[1].second;
    const std::int64_t inside = in_circle(t[0], t[1], t[2], apex);
    if (inside > 0) return false;
    const Point largest = std::max({t[0], t[1], t[2], apex});
    const bool is_apex_largest = largest == sides[0].second || largest == apex;
    if (inside == 0 && !is_apex_largest) return false;
  }
  return true;
}

Ring random_star(std::mt19937& random, int count, int radius) {
  // Integer points around the origin, sorted by angle, form a simple, star-shaped ring.
  std::map<std::pair<double, double>, Point> by_angle;
  std::uniform_int_distribution<int> coordinate(-radius, radius);
  std::vector<Point> points;
  while (static_cast<int>(points.size()) < count) {
    const Point p{static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random)),
                  0};
    if (p.x == 0 && p.y == 0) continue;
    points.push_back(p);
  }
  const auto half = [](const Point& p) { return p.y < 0 || (p.y == 0 && p.x < 0); };
  std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) {
    if (half(a) != half(b)) return half(a) < half(b);
    return a.x * b.y - a.y * b.x > 0;
  });
  Ring ring;
  for (const Point& p : points) {
    if (!ring.empty() && ring.back().x * p.y - ring.back().y * p.x == 0 &&
        half(ring.back()) == half(p)) {
      continue;
    }
    ring.push_back(p);
  }
  return ring;
}

Ring rectangle(double x0, double y0, double x1, double y1, bool is_clockwise = false) {
  Ring ring{{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
  if (is_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// The ring from a random start.
Ring rotated(Ring ring, std::mt19937& random) {
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(random() % ring.size()),
              ring.end());
  return ring;
}

}  // namespace

TEST_CASE("the triangles of a facet do not depend on the numbering of its vertices") {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    // A rectangle with every grid point of its border, and holes: many points are cocircular.
    const int n = 3 + round % 7;
    Ring outer;
    for (int i = 0; i < n; ++i) outer.push_back({double(i), 0, 0});
    for (int i = 0; i < n; ++i) outer.push_back({double(n), double(i), 0});
    for (int i = n; i > 0; --i) outer.push_back({double(i), double(n), 0});
    for (int i = n; i > 0; --i) outer.push_back({0, double(i), 0});
    std::vector<Ring> rings{outer};
    if (n >= 4) rings.push_back(rectangle(1, 1, n - 2, n - 2, true));
    if (n >= 6) rings.push_back(rectangle(n - 2, n - 2, n - 1, n - 1, true));
    const auto expected = point_triangles(facet_solid(rings));
    REQUIRE(!expected.empty());
    CHECK(is_canonical(expected, rings));
    std::vector<Ring> shuffled;
    for (const Ring& ring : rings) shuffled.push_back(rotated(ring, random));
    if (shuffled.size() > 2) std::swap(shuffled[1], shuffled[2]);
    CHECK(point_triangles(facet_solid(shuffled, &random)) == expected);
  }
}

TEST_CASE("random star-shaped facets are covered and canonical") {
  std::mt19937 random(11);
  for (int round = 0; round < 500; ++round) {
    const Ring ring = random_star(random, 4 + round % 40, 3 + round % 5);
    if (ring.size() < 3) continue;
    const Solid solid = facet_solid({ring}, &random);
    const tessellate::FacetTriangles result = tessellate::triangulate_facets(solid);
    if (result.state[0] != tessellate::FacetState::triangulated)
      continue;  // the origin can lie outside of the ring
    const auto triangles = point_triangles(solid);
    CHECK(triangles.size() == ring.size() - 2);
    std::int64_t area = 0;
    for (const PointTriangle& t : triangles) {
      const std::int64_t part = doubled_area({t[0], t[1], t[2]});
      CHECK((part > 0) == (doubled_area(ring) > 0));
      area += part;
    }
    CHECK(area == doubled_area(ring));
    if (doubled_area(ring) > 0) CHECK(is_canonical(triangles, {ring}));
    CHECK(point_triangles(facet_solid({rotated(ring, random)}, &random)) == triangles);
  }
}

TEST_CASE("a reversed facet has the same triangles, turned over") {
  const std::vector<Ring> rings{rectangle(0, 0, 4, 4)};
  std::vector<Ring> reversed = rings;
  std::reverse(reversed[0].begin(), reversed[0].end());
  auto a = point_triangles(facet_solid(rings));
  auto b = point_triangles(facet_solid(reversed));
  for (PointTriangle& t : b) std::swap(t[1], t[2]);
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  CHECK(a == b);
}

TEST_CASE("a facet is projected along the largest component of its world area, ties x, y, z") {
  const Ring tilted{{0, 0, 0}, {4, 0, 4}, {0, 4, 0}};  // normal (-16, 0, 16)
  CHECK(tessellate::facet_projection(facet_solid({tilted}), 0).axis == 0);
  CHECK(tessellate::facet_projection(facet_solid({tilted}), 0).is_mirrored);
  const Ring flat = rectangle(0, 0, 3, 3);
  CHECK(tessellate::facet_projection(facet_solid({flat}), 0).axis == 2);
  CHECK_FALSE(tessellate::facet_projection(facet_solid({flat}), 0).is_mirrored);

  // A coarser step along x makes the triangle with the same lattice points steeper in x.
  Solid solid = facet_solid({Ring{{0, 0, 0}, {1, 0, 5}, {0, 1, 0}}});
  CHECK(tessellate::facet_projection(solid, 0).axis == 0);
  Lattice lattice;
  lattice.step = {GridNumber{1, 1}, GridNumber{1, 0}, GridNumber{1, 0}};
  auto coarse = Solid::make(solid.arrays(), lattice, 0);
  REQUIRE(coarse);
  CHECK(tessellate::facet_projection(*coarse, 0).axis == 2);

  const Solid line = facet_solid({Ring{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}});
  CHECK(tessellate::facet_projection(line, 0).is_degenerate);
}

TEST_CASE("in a geographic system a degree counts 2^17 metres of height") {
  const auto axis = [](const Ring& ring, std::uint32_t srid, Lattice lattice = {}) {
    auto solid = Solid::make(facet_solid({ring}).arrays(), lattice, srid);
    REQUIRE(solid);
    return tessellate::facet_projection(*solid, 0).axis;
  };
  // The facet is ten units wide with one side three units up; the second facet has x and y
  // exchanged.
  const Ring along_x{{0, 0, 0}, {1, 0, 30}, {1, 1, 30}, {0, 1, 0}};
  const Ring along_y{{0, 0, 0}, {1, 0, 0}, {1, 1, 30}, {0, 1, 30}};
  for (const std::uint32_t srid : {0U, 7415U, 2263U, 4978U}) {
    INFO(srid);
    CHECK(axis(along_x, srid) == 0);
    CHECK(axis(along_y, srid) == 1);
  }
  for (const std::uint32_t srid : {4326U, 4979U, 6697U, 4807U}) {
    INFO(srid);
    CHECK(axis(along_x, srid) == 2);
    CHECK(axis(along_y, srid) == 2);
  }
  // The axis changes exactly where the constant states it: in a tie x precedes z.
  const auto slope = [](double height) {
    return Ring{{0, 0, 0}, {1, 0, height}, {1, 1, height}, {0, 1, 0}};
  };
  CHECK(axis(slope(131071), 4326) == 2);
  CHECK(axis(slope(131072), 4326) == 0);
  // The steps count too: with 10^-7 degrees beside 10^-3 m, 0.0131072 m are as long as a step along
  // x.
  Lattice lattice;
  lattice.step = {GridNumber{1, -7}, GridNumber{1, -7}, GridNumber{1, -3}};
  CHECK(axis(slope(13), 6697, lattice) == 2);
  CHECK(axis(slope(14), 6697, lattice) == 0);
  CHECK(axis(slope(14), 7415, lattice) == 0);
  // A wall that leans a little stays a wall.
  CHECK(axis({{0, 0, 0}, {0, 1, 0}, {0, 1, 1000000}, {1, 0, 1000000}}, 4326) == 0);
}

TEST_CASE("coordinates that cannot be angles count as metres in a geographic system") {
  const Ring ring{{400, 0, 0}, {401, 0, 30}, {401, 1, 30}, {400, 1, 0}};
  Ring near = ring;
  for (Point& p : near) p.x -= 41;  // moves the greatest x to 360
  const auto axis = [](const Ring& r) {
    auto solid = Solid::make(facet_solid({r}).arrays(), Lattice{}, 4326);
    REQUIRE(solid);
    return tessellate::facet_projection(*solid, 0).axis;
  };
  CHECK(axis(ring) == 0);
  CHECK(axis(near) == 2);
}

TEST_CASE("the projection of large and of fractional coordinates is exact") {
  const double large = 4503599627370496.0;  // 2^52
  // The two largest components differ by one part in 2^104.
  const Ring ring{{0, 0, 0}, {large, 0, large - 1}, {0, large, 0}};
  const tessellate::Projection projection = tessellate::facet_projection(facet_solid({ring}), 0);
  CHECK(projection.axis == 2);
  const Ring fraction{{0.1, 0, 0}, {0.1, 0.3, 0}, {0.1, 0, 0.7}};
  CHECK(tessellate::facet_projection(facet_solid({fraction}), 0).axis == 0);
}

/// The axis of the largest component of a triangle's area vector, in fractions.
int largest_axis(const Ring& t, const std::array<mpq_class, 3>& weight) {
  std::array<mpq_class, 3> size;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const auto side = [&](std::size_t end, int w) {
      return mpq_class(mpq_class(t[end][w]) - mpq_class(t[0][w]));
    };
    const mpq_class doubled = side(1, u) * side(2, v) - side(1, v) * side(2, u);
    size[static_cast<std::size_t>(axis)] = abs(doubled) * weight[static_cast<std::size_t>(axis)];
  }
  return static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
}

TEST_CASE("projections agree with fractions, also where components are nearly equal") {
  std::mt19937 random(11);
  Lattice uneven;
  uneven.step = {GridNumber{3, -7}, GridNumber{1, -5}, GridNumber{7, -3}};
  const std::array<mpq_class, 3> even_weight{1, 1, 1};
  const std::array<mpq_class, 3> uneven_weight{mpq_class(10000, 3), 100, mpq_class(1, 7)};
  for (int round = 0; round < 4000; ++round) {
    const bool is_uneven = round % 2 == 0;
    const auto& weight = is_uneven ? uneven_weight : even_weight;
    // The normal (1, 1, 1) in world scale, but for some units in the last place.
    Ring ring{{0.1, 0.2, 0.3}, {1, -1, 0}, {0, 1, -1}};
    for (std::size_t i = 1; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        double& x = ring[i][axis];
        x = ring[0][axis] + x * weight[static_cast<std::size_t>(axis)].get_d();
        for (auto steps = random() % 4; steps > 0; --steps) x = std::nextafter(x, 1e9);
      }
    }
    INFO(round);
    const auto solid =
        Solid::make(facet_solid({ring}).arrays(), is_uneven ? uneven : Lattice{}, 0).value();
    CHECK(tessellate::facet_projection(solid, 0).axis == largest_axis(ring, weight));
  }
}

TEST_CASE("holes may touch the exterior ring and each other in vertices") {
  const Ring outer{{0, 0, 0}, {5, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  const Ring hole{{5, 0, 0}, {4, 2, 0}, {6, 2, 0}};
  CHECK(state_of({outer, hole}) == tessellate::FacetState::triangulated);
  const Ring other{{6, 2, 0}, {6, 4, 0}, {8, 3, 0}};
  CHECK(state_of({outer, hole, other}) == tessellate::FacetState::triangulated);
  // Two holes that touch twice enclose a pocket, which still belongs to the facet.
  const Ring left{{2, 5, 0}, {5, 3, 0}, {4, 5, 0}, {5, 7, 0}};
  const Ring right{{8, 5, 0}, {5, 7, 0}, {6, 5, 0}, {5, 3, 0}};
  const Solid solid = facet_solid({rectangle(0, 0, 10, 10), left, right});
  std::int64_t area = 0;
  for (const PointTriangle& t : point_triangles(solid)) area += doubled_area({t[0], t[1], t[2]});
  CHECK(area == 200 - std::abs(doubled_area(left)) - std::abs(doubled_area(right)));
}

TEST_CASE("a vertex of a ring inside an edge of another ring splits that edge") {
  const Ring outer = rectangle(0, 0, 10, 10);
  const Ring at_edge{{0, 5, 0}, {3, 4, 0}, {3, 6, 0}};
  const Ring at_hole{{3, 5, 0}, {6, 4, 0}, {6, 6, 0}};
  const Ring at_notch{{4, 2, 0}, {6, 2, 0}, {5, 4, 0}};
  const Ring notched{{0, 0, 0},  {4, 0, 0},   {5, 2, 0}, {6, 0, 0},
                     {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  for (const std::vector<Ring>& rings : {std::vector<Ring>{outer, at_edge},
                                         {outer, at_edge, at_hole},
                                         {notched, at_notch},
                                         {notched, at_edge, at_notch}}) {
    const Solid solid = facet_solid(rings);
    const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
    CHECK(facets.state[0] == tessellate::FacetState::triangulated);
    CHECK(facets.divided);
    // The triangles must be those of the rings that list the vertex.
    const tessellate::FacetTriangles listed =
        tessellate::triangulate_facets(facets.divided_solid(solid));
    CHECK_FALSE(listed.divided);
    CHECK(listed.triangles == facets.triangles);
    std::int64_t area = 0;
    for (const PointTriangle& t : point_triangles(solid)) area += doubled_area({t[0], t[1], t[2]});
    std::int64_t expected = doubled_area(rings[0]);
    for (std::size_t i = 1; i < rings.size(); ++i) expected -= std::abs(doubled_area(rings[i]));
    CHECK(area == expected);
  }
  CHECK_FALSE(tessellate::triangulate_facets(facet_solid({outer, rectangle(2, 2, 4, 4)})).divided);
}

TEST_CASE("only facets that bound a region once their edges are split are divided") {
  const Ring outer = rectangle(0, 0, 10, 10);
  const Ring at_edge{{0, 5, 0}, {3, 4, 0}, {3, 6, 0}};
  const Ring along_edge{{0, 4, 0}, {3, 5, 0}, {0, 6, 0}};
  for (const std::vector<Ring>& rings :
       {std::vector<Ring>{outer, along_edge}, {outer, at_edge, rectangle(1, 1, 5, 5)}}) {
    const tessellate::FacetTriangles facets = tessellate::triangulate_facets(facet_solid(rings));
    CHECK(facets.state[0] == tessellate::FacetState::not_simple);
    CHECK_FALSE(facets.divided);
  }
  // The vertex is on the edge in the plane of projection, but beside it in space.
  const Ring beside{{0, 5, 1}, {3, 4, 0}, {3, 6, 0}};
  CHECK(state_of({outer, beside}) == tessellate::FacetState::not_simple);
  // A vertex of a ring splits no edge of the same ring.
  CHECK(state_of({{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {4, 0, 0}, {0, 8, 0}},
                  rectangle(6, 1, 7, 2)}) == tessellate::FacetState::not_simple);
}

TEST_CASE("rings that are not simple or nest wrongly give no triangles") {
  const Ring outer = rectangle(0, 0, 10, 10);
  CHECK(state_of({{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 6, 0}}}) ==
        tessellate::FacetState::not_simple);
  CHECK(state_of({outer, rectangle(5, 5, 12, 8)}) ==
        tessellate::FacetState::not_simple);  // the hole crosses the exterior ring
  CHECK(state_of({outer, rectangle(20, 5, 22, 8)}) ==
        tessellate::FacetState::not_simple);  // the hole is outside
  CHECK(state_of({outer, rectangle(1, 1, 9, 9), rectangle(2, 2, 3, 3)}) ==
        tessellate::FacetState::not_simple);  // one hole is inside another
  // The hole equals the exterior ring.
  CHECK(state_of({outer, outer}) == tessellate::FacetState::not_simple);
  CHECK(state_of({outer, {{0, 0, 0}, {0, 10, 0}, {3, 6, 0}}}) ==
        tessellate::FacetState::not_simple);  // the rings share an edge
  CHECK(state_of({rectangle(2, 2, 3, 3), outer}) ==
        tessellate::FacetState::not_simple);  // the hole is around the exterior ring
  CHECK(state_of({outer, {{1, 1, 0}, {2, 2, 0}}}) == tessellate::FacetState::not_simple);
  CHECK(state_of({{{0, 0, 0}, {4, 0, 0}, {2, 2, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 0}}}) ==
        tessellate::FacetState::not_simple);  // the ring passes a vertex twice
  CHECK(state_of({{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 3, 0}}}) ==
        tessellate::FacetState::not_simple);  // the ring has a spike
}

TEST_CASE("facets without area are degenerate") {
  CHECK(state_of({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}}) == tessellate::FacetState::degenerate);
  CHECK(state_of({{{0, 0, 0}, {1, 1, 1}}}) == tessellate::FacetState::degenerate);
  CHECK(state_of({{{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 3, 0}}}) ==
        tessellate::FacetState::degenerate);
}

TEST_CASE("different vertices with the same projection cause no crash") {
  const Ring ring{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {5, 5, 0}, {0, 10, 0}, {5, 5, 3}};
  CHECK(state_of({ring}) == tessellate::FacetState::not_simple);
}

TEST_CASE("a facet that is not planar is triangulated in projection") {
  const Ring ring{{0, 0, 0}, {10, 0, 1}, {10, 10, 0}, {0, 10, 1}};
  CHECK(state_of({ring}) == tessellate::FacetState::triangulated);
}

TEST_CASE("a rectangle with a corner off its plane has the diagonal of its mirror image") {
  for (std::size_t lifted = 0; lifted < 4; ++lifted) {
    Ring ring{{0, 0, 5}, {30, 0, 5}, {30, 20, 5}, {0, 20, 5}};
    ring[lifted].z += 1;
    for (int mirror = 0; mirror < 8; ++mirror) {
      Ring image = ring;
      for (Point& p : image) {
        for (int axis = 0; axis < 3; ++axis) {
          if ((mirror >> axis & 1) != 0) p[axis] = 40 - p[axis];
        }
      }
      std::size_t touching = 0;  // the number of triangles with the lifted corner
      for (const PointTriangle& t : point_triangles(facet_solid({image}))) {
        touching += std::count(t.begin(), t.end(), image[lifted]) > 0 ? 1 : 0;
      }
      // The diagonal between the corners beside the lifted one is the shorter one.
      CHECK(touching == 1);
    }
  }
}

TEST_CASE("triangles are grouped by facet and facets without triangles are kept") {
  SolidArrays arrays;
  arrays.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const std::vector<Index>& ring :
       std::vector<std::vector<Index>>{{0, 1, 2}, {0, 1}, {1, 2, 3}}) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
    arrays.end_ring();
    arrays.end_facet();
  }
  arrays.end_facet();  // adds a facet without rings
  arrays.end_shell();
  auto solid = Solid::make(std::move(arrays), Lattice{}, 0);
  REQUIRE(solid);
  const tessellate::FacetTriangles result = tessellate::triangulate_facets(*solid);
  CHECK(result.first == std::vector<Index>{0, 1, 1, 2, 2});
  CHECK(result.facet_of == std::vector<Index>{0, 2});
  CHECK(result.state[3] == tessellate::FacetState::degenerate);
  CHECK(result.triangles[1] == Triangle{3, 1, 2});
}

TEST_CASE("every quadrilateral on a small grid is triangulated canonically or not simple") {
  std::vector<Point> grid;
  for (int i = 0; i < 16; ++i) grid.push_back({double(i % 4), double(i / 4), 0});
  std::size_t wrong = 0;
  std::size_t triangulated = 0;
  for (std::size_t a = 0; a < 16; ++a) {
    for (std::size_t b = 0; b < 16; ++b) {
      for (std::size_t c = 0; c < 16; ++c) {
        for (std::size_t d = 0; d < 16; ++d) {
          if (std::set<std::size_t>{a, b, c, d}.size() != 4) continue;
          const Ring ring{grid[a], grid[b], grid[c], grid[d]};
          if (doubled_area(ring) <= 0) continue;
          const auto triangles = point_triangles(facet_solid({ring}));
          if (triangles.empty()) continue;
          ++triangulated;
          if (!is_canonical(triangles, {ring})) ++wrong;
        }
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(triangulated > 5000);
}
