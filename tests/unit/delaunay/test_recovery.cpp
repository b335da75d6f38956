// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rung 1 of the ladder: boundaries whose triangles are not all Delaunay are recovered here, without
// an engine.
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <random>
#include <set>
#include <vector>

#include "delaunay/canonical/follow_delaunay.h"
#include "delaunay/canonical_delaunay.h"
#include "delaunay/ladder.h"
#include "delaunay/recovery/divided_edges.h"
#include "delaunay/recovery/fill_cavity.h"
#include "delaunay/recovery/flips.h"
#include "delaunay/recovery/point_between.h"
#include "delaunay/recovery/recover_faces.h"
#include "delaunay/recovery/signs.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/intersection/box_partition.h"
#include "geometry/predicates/predicates.h"
#include "geometry/solid.h"
#include "sample_solids.h"
#include "tessellate/facets.h"

namespace watertight {
namespace {

using samples::Shape;

/// A sphere of parallels and meridians in whole numbers: rounding dents about every second quad.
Shape rounded_sphere(int parallels, double radius) {
  Shape shape;
  samples::Shell& shell = shape.shells.emplace_back();
  const int meridians = 2 * parallels;
  const auto at = [&](int i, int j) {
    return static_cast<Index>(1 + (i - 1) * meridians + j % meridians);
  };
  shape.vertices.push_back({0, 0, radius});
  for (int i = 1; i < parallels; ++i) {
    for (int j = 0; j < meridians; ++j) {
      const double u = 3.14159265358979 * i / parallels;
      const double v = 2 * 3.14159265358979 * j / meridians;
      shape.vertices.push_back({std::round(radius * std::sin(u) * std::cos(v)),
                                std::round(radius * std::sin(u) * std::sin(v)),
                                std::round(radius * std::cos(u))});
    }
  }
  const auto south = static_cast<Index>(shape.vertices.size());
  shape.vertices.push_back({0, 0, -radius});
  for (int j = 0; j < meridians; ++j) {
    shell.push_back({{0, at(1, j), at(1, j + 1)}});
    shell.push_back({{south, at(parallels - 1, j + 1), at(parallels - 1, j)}});
    for (int i = 1; i + 1 < parallels; ++i) {
      shell.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      shell.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return shape;
}

delaunay::LadderResult climb_alone(const Shape& shape, delaunay::LadderOptions options = {}) {
  const Solid solid = samples::make_solid(shape);
  return delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), nullptr, options);
}

std::vector<Point> sorted_points(const delaunay::LadderResult& result) {
  REQUIRE(result.certificate.has_value());
  std::vector<Point> points = result.certificate->tetrahedralization.points;
  std::sort(points.begin(), points.end());
  return points;
}

TEST_CASE("a sphere that rounding has dented is proven without an engine") {
  for (const double radius : {900.0, 2000.0, 20000.0}) {
    const delaunay::LadderResult result = climb_alone(rounded_sphere(40, radius));
    INFO("radius " << radius);
    REQUIRE(result.attempts.size() == 2);
    CHECK(result.attempts[0].result == delaunay::RungOutcome::not_delaunay);
    INFO(result.attempts[1].outcome);
    REQUIRE(result.certificate.has_value());
    CHECK(result.certificate->rung == delaunay::Rung::recovered);
    CHECK(result.certificate->refilled_facets.empty());
  }
}

TEST_CASE("a solid of 249,000 triangles that rounding has dented is proven without an engine") {
  const Shape sphere = rounded_sphere(250, 100'000);
  REQUIRE(sphere.shells.front().size() == 249'000);
  const delaunay::LadderResult result = climb_alone(sphere);
  REQUIRE(result.certificate.has_value());
  CHECK(result.certificate->rung == delaunay::Rung::recovered);
}

/// An oblique prism over a star, whose lids are not flat: triangles of a lid between two of its
/// notches may cross the walls there.
Shape bent_star(std::size_t corners, std::mt19937& random) {
  Shape shape;
  for (const int lid : {0, 1}) {
    for (std::size_t i = 0; i < corners; ++i) {
      const double turn =
          2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(corners);
      const double radius = (i % 2 == 0 ? 9000 : 3000) + static_cast<double>(random() % 2000);
      const double lift = static_cast<double>(random() % 1500);
      shape.vertices.push_back({std::round(radius * std::cos(turn)) + 4000 * lid,
                                std::round(radius * std::sin(turn)) + 3000 * lid,
                                4000 * lid + lift});
    }
  }
  samples::Shell& shell = shape.shells.emplace_back();
  samples::Ring bottom;
  samples::Ring top;
  for (Index i = 0; i < corners; ++i) {
    const auto n = static_cast<Index>(corners);
    bottom.insert(bottom.begin(), i);
    top.push_back(n + i);
    shell.push_back({{i, (i + 1) % n, n + (i + 1) % n}});
    shell.push_back({{i, n + (i + 1) % n, n + i}});
  }
  shell.push_back({bottom});
  shell.push_back({top});
  return shape;
}

bool have_crossing(const Solid& solid, const std::vector<Triangle>& triangles) {
  return !geometry::intersecting_pairs(solid.vertices(), triangles)->empty();
}

TEST_CASE("facets keep their canonical triangles where others would cross") {
  std::mt19937 random(5);
  std::size_t crossing = 0;
  for (int round = 0; round < 800; ++round) {
    const Shape star = bent_star(12 + 2 * (random() % 8), random);
    const Solid solid = samples::make_solid(star);
    const auto canonical = tessellate::triangulate_facets(solid);
    if (have_crossing(solid, canonical.triangles)) continue;  // not valid
    const auto following = delaunay::follow_delaunay(
        solid, canonical, *delaunay::canonical_delaunay(solid.vertices(), 1000));
    if (!have_crossing(solid, following.triangles)) continue;
    ++crossing;
    INFO("round " << round);
    const delaunay::LadderResult result = climb_alone(star);
    REQUIRE(result.certificate.has_value());
    // Where triangles cross, edges are divided over and over: 150 Steiner vertices in the mean.
    CHECK(result.certificate->tetrahedralization.points.size() < solid.vertex_count() + 10);
  }
  CHECK(crossing > 10);
}

TEST_CASE("a solid whose axes have different units is proven as in metres") {
  const Solid in_metres = samples::make_solid(rounded_sphere(30, 2000));
  const auto facets = tessellate::triangulate_facets(in_metres);
  const auto expected = delaunay::climb_ladder(in_metres, facets, nullptr, {});
  REQUIRE(expected.certificate.has_value());
  // Heights in fine steps, beside metres and beside degrees (EPSG:4979) of 2^17 metres.
  for (const auto& [srid, exponent] : {std::pair<std::uint32_t, int>{0, 0}, {4979, -17}}) {
    INFO("EPSG:" << srid);
    SolidArrays arrays = in_metres.arrays();
    for (Point& p : arrays.vertices) p.z *= 1024;
    Lattice lattice;
    lattice.kind = LatticeKind::binary;
    lattice.step = {GridNumber{1, exponent}, GridNumber{1, exponent}, GridNumber{1, -10}};
    const Solid fine = Solid::make(std::move(arrays), lattice, srid).value();
    const auto found = delaunay::climb_ladder(fine, facets, nullptr, {});
    REQUIRE(found.certificate.has_value());
    CHECK(found.certificate->rung == expected.certificate->rung);
    CHECK(found.certificate->tetrahedralization.tetrahedra ==
          expected.certificate->tetrahedralization.tetrahedra);
  }
}

TEST_CASE("Schoenhardt's prism gets Steiner points without an engine") {
  const delaunay::LadderResult result = climb_alone(samples::schoenhardt());
  REQUIRE(result.certificate.has_value());
  CHECK(result.certificate->rung == delaunay::Rung::recovered);
  CHECK(result.certificate->tetrahedralization.points.size() > 6);
  // Steiner points on edges lie on them exactly; the deviation is the rounding of its measurement.
  CHECK(result.certificate->largest_deviation < 1e-12);
}

TEST_CASE("recovery does not depend on the numbering of the solid") {
  for (const Shape& shape : {samples::schoenhardt(), rounded_sphere(24, 700)}) {
    const std::vector<Point> expected = sorted_points(climb_alone(shape));
    for (unsigned seed = 0; seed < 4; ++seed) {
      CHECK(sorted_points(climb_alone(samples::shuffled(shape, seed))) == expected);
    }
  }
}

/// The shape seen in a mirror.
Shape mirrored(Shape shape) {
  for (Point& p : shape.vertices) p.x = -p.x + 0.0;
  for (samples::Shell& shell : shape.shells) {
    for (auto& facet : shell) {
      for (auto& ring : facet) std::reverse(ring.begin(), ring.end());
    }
  }
  return shape;
}

TEST_CASE("a solid in a mirror is recovered too") {
  for (const Shape& shape : {samples::schoenhardt(), rounded_sphere(40, 900)}) {
    const delaunay::LadderResult result = climb_alone(mirrored(shape));
    REQUIRE(result.certificate.has_value());
    CHECK(result.certificate->rung == delaunay::Rung::recovered);
  }
}

TEST_CASE("recovery ends within 50 ms of processor time after the wish to cancel") {
  const Shape sphere = rounded_sphere(60, 900);
  for (const int polls : {5, 50, 100}) {
    delaunay::LadderOptions options;
    options.first_rung = delaunay::Rung::recovered;
    int asked = 0;
    std::clock_t wished = 0;
    options.cancel = [&] {
      if (++asked < polls) return false;
      if (wished == 0) wished = std::clock();
      return true;
    };
    const delaunay::LadderResult result = climb_alone(sphere, options);
    REQUIRE(wished != 0);
    CHECK(result.attempts.back().result == delaunay::RungOutcome::cancelled);
    CHECK(static_cast<double>(std::clock() - wished) < 0.05 * CLOCKS_PER_SEC);
  }
}

TEST_CASE("signs for one box agree with the exact signs") {
  // Small whole numbers, of which many are coplanar, fractions, and sizes that leave doubles.
  for (const double unit : {1.0, 0.1, 0x1p50, 1e-160, 1e150}) {
    std::mt19937 random(7);
    std::vector<Point> points;
    for (int i = 0; i < 64; ++i) {
      const auto coordinate = [&] { return unit * static_cast<double>(random() % 8); };
      points.push_back({coordinate(), coordinate(), coordinate()});
    }
    const delaunay::Signs signs(geometry::box_of(points));
    for (int i = 0; i < 2000; ++i) {
      const auto any = [&]() -> const Point& { return points[random() % points.size()]; };
      const Point& a = any();
      const Point& b = any();
      const Point& c = any();
      const Point& d = any();
      CHECK(signs.orient3d(a, b, c, d) == geometry::orient3d(a, b, c, d));
    }
  }
}

TEST_CASE("recovery that is cancelled reports the cancellation") {
  delaunay::LadderOptions options;
  options.first_rung = delaunay::Rung::recovered;
  int asked = 0;
  options.cancel = [&] { return ++asked > 20; };
  const delaunay::LadderResult result = climb_alone(rounded_sphere(40, 900), options);
  CHECK_FALSE(result.certificate.has_value());
  REQUIRE_FALSE(result.attempts.empty());
  CHECK(result.attempts.back().result == delaunay::RungOutcome::cancelled);
}

TEST_CASE("a cavity that no tetrahedra fill names the triangles that block it") {
  // Schoenhardt's prism itself: no tetrahedron on its vertices lies inside.
  const Solid solid = samples::make_solid(samples::schoenhardt());
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  delaunay::Cavity cavity;
  for (const Triangle& t : facets.triangles) cavity.front.push_back({t[0], t[2], t[1]});
  std::size_t steps = 1000;
  const delaunay::Filling filling = delaunay::fill_cavity(solid.vertices(), cavity, steps);
  CHECK(filling.tetrahedra.empty());
  CHECK_FALSE(filling.blocked.empty());
  CHECK(steps > 0);
}

TEST_CASE("the search for a filling ends with its steps") {
  const Solid solid = samples::make_solid(samples::box({0, 0, 0}, {5, 6, 7}));
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  delaunay::Cavity cavity;
  for (const Triangle& t : facets.triangles) cavity.front.push_back({t[0], t[2], t[1]});
  std::size_t steps = 2;
  CHECK(delaunay::fill_cavity(solid.vertices(), cavity, steps).tetrahedra.empty());
  CHECK(steps == 0);
  steps = 1000;
  CHECK(delaunay::fill_cavity(solid.vertices(), cavity, steps).tetrahedra.size() >= 5);
}

TEST_CASE("no tetrahedron of a filling is on both sides of the hull") {
  // A pyramid over a square of the hull, and a cone below it. The edge from the outer vertex to the
  // top would make four tetrahedra around it.
  const std::vector<Point> points{{2, 2, 3}, {0, 0, 0}, {4, 0, 0},
                                  {4, 4, 0}, {0, 4, 0}, {2, 2, -5}};
  const Index top = 0;
  const Index outer = 5;
  delaunay::Cavity cavity;
  for (Index i = 1; i <= 4; ++i) {
    const Index next = i % 4 + 1;
    cavity.front.push_back({next, i, top});
    cavity.front.push_back({i, next, outer});
  }
  cavity.outer_vertex = outer;
  cavity.base = {1, 2, 3};
  std::size_t steps = 1000;
  const delaunay::Filling filling = delaunay::fill_cavity(points, cavity, steps);
  CHECK(filling.tetrahedra.size() == 4);
  for (const geometry::Tetrahedron& t : filling.tetrahedra) {
    const bool is_outside = std::find(t.begin(), t.end(), outer) != t.end();
    const bool is_inside = std::find(t.begin(), t.end(), top) != t.end();
    CHECK(is_outside != is_inside);
  }
}

/// A mesh with flips that keep nothing, or the faces and edges that a test names.
struct FlipMesh {
  FlipMesh(std::vector<Point> own_points, const std::vector<geometry::Tetrahedron>& tetrahedra)
      : points(std::move(own_points)), mesh(tetrahedra, points.size()) {}

  std::size_t tetrahedra() { return mesh.take().size(); }

  std::vector<Point> points;
  delaunay::TetrahedronMesh mesh;
  delaunay::KeptParts kept{0};
  CancelPoll never;
  delaunay::Flips flips{points, mesh, kept, 100'000, never};
};

// Two tetrahedra with the face (0, 1, 2), and three around the edge (3, 4).
const std::vector<Point> kBipyramid{{3, 0, 0}, {-2, 3, 0}, {-2, -3, 0}, {0, 0, 4}, {0, 0, -4}};
const std::vector<geometry::Tetrahedron> kTwo{{0, 1, 2, 3}, {0, 2, 1, 4}};
const std::vector<geometry::Tetrahedron> kThree{{4, 3, 0, 1}, {4, 3, 1, 2}, {4, 3, 2, 0}};

TEST_CASE("a flip makes an edge that passes through a face") {
  FlipMesh flips(kBipyramid, kTwo);
  CHECK(flips.flips.recover_edge(3, 4));
  CHECK_FALSE(flips.flips.is_face({0, 1, 2}));
  CHECK(flips.tetrahedra() == 3);
}

TEST_CASE("flips leave a face that is kept") {
  FlipMesh flips(kBipyramid, kTwo);
  flips.kept.add(Triangle{0, 1, 2});
  CHECK_FALSE(flips.flips.recover_edge(3, 4));
  CHECK(flips.flips.is_face({0, 1, 2}));
  CHECK(flips.tetrahedra() == 2);
}

TEST_CASE("a flip makes a face through which an edge passes") {
  FlipMesh flips(kBipyramid, kThree);
  CHECK(flips.flips.recover_face({0, 1, 2}));
  CHECK(flips.flips.tetrahedron_at(3, 4) == kNone);
  CHECK(flips.tetrahedra() == 2);
}

TEST_CASE("an edge is divided at the place with the fewest bits that is exact") {
  const auto at = [](const Point& q, double least, double most) {
    return delaunay::point_between({0, 0, 0}, q, {least, most});
  };
  CHECK(at({8, 16, 24}, 0, 1) == delaunay::PlacedPoint{{4, 8, 12}, 0.5});
  CHECK(at({8, 16, 24}, 0, 0.4) == delaunay::PlacedPoint{{2, 4, 6}, 0.25});
  CHECK(at({8, 16, 24}, 0.5, 1) == delaunay::PlacedPoint{{6, 12, 18}, 0.75});
  CHECK(at({8, 16, 24}, 0.55, 0.72) == delaunay::PlacedPoint{{5, 10, 15}, 0.625});
  // Places of up to 40 bits do not part these two.
  CHECK_FALSE(at({8, 16, 24}, 0.1, 0.1 + 0x1p-50).has_value());
  // Doubles hold the middle, but no quarter and no other middle.
  const Point p{0x1p52, 0, 0};
  CHECK_FALSE(delaunay::point_between(p, {0x1p52 + 2, 2, 6}, {0, 0.3}).has_value());
  CHECK(delaunay::point_at(p, {0x1p52 + 2, 2, 6}, 0.5) ==
        delaunay::PlacedPoint{{0x1p52 + 1, 1, 3}, 0.5});
  CHECK_FALSE(delaunay::point_at({0x1p52, 0, 1}, {0x1p52 + 1, 2, 2}, 0.5).has_value());
}

TEST_CASE("the parts of an edge are divided at places on the whole edge") {
  delaunay::DividedEdges edges;
  std::vector<Point> points{{0, 0, 0}, {0x1p52, 3 * 0x1p52, 0}};
  const auto divide = [&](const delaunay::VertexPair& edge, double least, double most) {
    const auto placed = edges.place_on(points, edge, {least, most});
    REQUIRE(placed.has_value());
    edges.divide(edge, static_cast<Index>(points.size()), placed->place);
    points.push_back(placed->point);
    return placed->place;
  };
  CHECK(divide({0, 1}, 0.3, 0.4) == 0.375);
  CHECK(divide({1, 2}, 0, 1) == 0.5);        // the whole edge's middle, not the part's
  CHECK(divide({1, 3}, 0.9, 1) == 0.53125);  // from vertex 1 towards vertex 3
  CHECK(points[4] == Point{0.53125 * 0x1p52, 3 * 0.53125 * 0x1p52, 0});
}

/// Six times the volume of tetrahedra on integers, all of which are positive.
std::int64_t volume_of(const std::vector<geometry::Tetrahedron>& tetrahedra,
                       const std::vector<Point>& points) {
  std::int64_t sum = 0;
  for (const geometry::Tetrahedron& t : tetrahedra) {
    std::array<std::array<std::int64_t, 3>, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        side[i][static_cast<std::size_t>(axis)] =
            static_cast<std::int64_t>(points[t[i + 1]][axis] - points[t[0]][axis]);
      }
    }
    const auto& [u, v, w] = side;
    const std::int64_t volume = w[0] * (u[1] * v[2] - u[2] * v[1]) +
                                w[1] * (u[2] * v[0] - u[0] * v[2]) +
                                w[2] * (u[0] * v[1] - u[1] * v[0]);
    REQUIRE(volume > 0);
    sum += volume;
  }
  return sum;
}

TEST_CASE("flips leave the hull filled, and the edges that they made before") {
  std::size_t made = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::set<Point> distinct;
    while (distinct.size() < 40) {
      const auto coordinate = [&] { return static_cast<double>(random() % 32); };
      distinct.insert({coordinate(), coordinate(), coordinate()});
    }
    const std::vector<Point> points(distinct.begin(), distinct.end());
    const auto delaunay = delaunay::canonical_delaunay(points);
    REQUIRE(delaunay.has_value());
    FlipMesh flips(points, delaunay->tetrahedra);
    std::vector<delaunay::VertexPair> edges;
    for (int i = 0; i < 40; ++i) {
      const auto a = static_cast<Index>(random() % 40);
      const auto b = static_cast<Index>(random() % 40);
      if (a == b || flips.flips.tetrahedron_at(a, b) != kNone) continue;
      if (!flips.flips.recover_edge(a, b)) continue;
      edges.push_back(delaunay::pair_of(a, b));
      flips.kept.add(edges.back());
    }
    for (const auto& [a, b] : edges) CHECK(flips.flips.tetrahedron_at(a, b) != kNone);
    made += edges.size();
    CHECK(volume_of(flips.mesh.take(), points) == volume_of(delaunay->tetrahedra, points));
  }
  // Without shorter rings there are fewer.
  CHECK(made == 300);
}

TEST_CASE("flips leave an edge that is kept") {
  FlipMesh flips(kBipyramid, kThree);
  flips.kept.add(delaunay::VertexPair{3, 4});
  CHECK_FALSE(flips.flips.recover_face({0, 1, 2}));
  CHECK(flips.tetrahedra() == 3);
}

TEST_CASE("an edge takes the place of one that it crosses") {
  // An octahedron of four tetrahedra around its axis.
  FlipMesh flips({{2, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, -2, 0}, {0, 0, 3}, {0, 0, -3}},
                 {{5, 4, 0, 1}, {5, 4, 1, 2}, {5, 4, 2, 3}, {5, 4, 3, 0}});
  CHECK(flips.flips.recover_edge(1, 3));
  CHECK(flips.flips.tetrahedron_at(4, 5) == kNone);
  CHECK(flips.tetrahedra() == 4);
}

TEST_CASE("an edge of the hull takes the place of the other diagonal of a flat quad") {
  // A pyramid over a square.
  FlipMesh flips({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 3}},
                 {{0, 1, 2, 4}, {0, 2, 3, 4}});
  CHECK(flips.flips.recover_edge(1, 3));
  CHECK(flips.flips.is_face({0, 1, 3}));
  CHECK(flips.tetrahedra() == 2);
}

TEST_CASE("an edge inside leaves the edge of a hull that is not flat") {
  FlipMesh flips({{0, 0, -1}, {4, 0, 0}, {4, 4, -1}, {0, 4, 0}, {2, 2, 3}},
                 {{0, 1, 2, 4}, {0, 2, 3, 4}});
  CHECK(flips.flips.recover_edge(1, 3));
  CHECK(flips.flips.tetrahedron_at(0, 2) != kNone);
  CHECK(flips.tetrahedra() == 3);
}

}  // namespace
}  // namespace watertight
