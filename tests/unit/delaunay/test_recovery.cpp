// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rung 1 of the ladder: boundaries whose triangles are not all Delaunay are recovered here, without
// an engine.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <vector>

#include "delaunay/ladder.h"
#include "delaunay/recovery/fill_cavity.h"
#include "delaunay/recovery/recover_faces.h"
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
  options.recovered_from = 0;
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

TEST_CASE("Schoenhardt's prism gets Steiner points without an engine") {
  const delaunay::LadderResult result = climb_alone(samples::schoenhardt());
  REQUIRE(result.certificate.has_value());
  CHECK(result.certificate->rung == delaunay::Rung::recovered);
  CHECK(result.certificate->tetrahedralization.points.size() > 6);
  CHECK(result.certificate->largest_deviation == 0);  // no Steiner point on a facet
}

TEST_CASE("recovery does not depend on the numbering of the solid") {
  for (const Shape& shape : {samples::schoenhardt(), rounded_sphere(24, 700)}) {
    const std::vector<Point> expected = sorted_points(climb_alone(shape));
    for (unsigned seed = 0; seed < 4; ++seed) {
      CHECK(sorted_points(climb_alone(samples::shuffled(shape, seed))) == expected);
    }
  }
}

TEST_CASE("engines are asked first for a small solid") {
  const Solid solid = samples::make_solid(rounded_sphere(12, 300));
  const delaunay::LadderResult result =
      delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), nullptr, {});
  REQUIRE(result.attempts.size() >= 2);
  CHECK(result.attempts[1].rung == delaunay::Rung::patch);
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

}  // namespace
}  // namespace watertight
