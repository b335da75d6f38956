// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "spline/fit_surface.h"
#include "spline/plane/conformal_map.h"
#include "tests/unit/spline/grid_with_hole.h"

namespace watertight {
namespace {

using spline::Index;
using spline::Point;
using spline::Triangle;

double distance(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// Squares with diagonals.
std::vector<Triangle> grid_triangles(Index size) {
  std::vector<Triangle> triangles;
  for (Index y = 0; y + 1 < size; ++y) {
    for (Index x = 0; x + 1 < size; ++x) {
      const Index at = y * size + x;
      triangles.push_back({at, at + 1, at + size + 1});
      triangles.push_back({at, at + size + 1, at + size});
    }
  }
  return triangles;
}

TEST_CASE("triangles that lie in a plane keep their lengths") {
  std::vector<Point> places;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x)
      places.push_back({1e6 + 3.0 * x, 2.0 * x - y, 7 + 0.5 * x + 4.0 * y});
  }
  const auto triangles = grid_triangles(5);
  const auto map = spline::conformal_map(places, triangles);
  REQUIRE(map);
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(distance((*map)[t[i]], (*map)[t[(i + 1) % 3]]) -
                     distance(places[t[i]], places[t[(i + 1) % 3]])) < 1e-8);
    }
    CHECK(spline::twice_area((*map)[t[0]], (*map)[t[1]], (*map)[t[2]]) > 0);
  }
}

TEST_CASE("a rolled sheet is unrolled") {
  std::vector<Point> places;
  constexpr double kStep = 0.1;  // an angle; the edges are chords
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x)
      places.push_back({std::cos(kStep * x), std::sin(kStep * x), 2 * std::sin(kStep / 2) * y});
  }
  const auto map = spline::conformal_map(places, grid_triangles(20));
  REQUIRE(map);
  const double wanted = 19 * 2 * std::sin(kStep / 2);
  CHECK(std::abs(distance((*map)[0], (*map)[19]) - wanted) < 1e-6);
  CHECK(std::abs(distance((*map)[0], (*map)[380]) - wanted) < 1e-6);
}

TEST_CASE("triangles that have no map are refused with the reason") {
  const std::vector<Triangle> one{{0, 1, 2}};
  const auto error_of = [&](std::vector<Point> places, std::vector<Triangle> triangles) {
    const auto map = spline::conformal_map(places, triangles);
    REQUIRE(!map);
    return map.error().message;
  };
  CHECK(error_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, one) == "the triangles have no area");
  CHECK(error_of({{0, 0, 0}, {1, 0, 0}}, one) == "triangle 0 has a corner that is no vertex");
  CHECK(error_of({{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}}, one) ==
        "a vertex is not finite");
  CHECK(error_of({}, {}) == "the triangles have no area");
  // A vertex that no triangle holds.
  CHECK(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, one) ==
        "the triangles do not hold all vertices in the plane");
}

TEST_CASE("values spread from the border as means of neighbours") {
  // A hexagon around a vertex.
  std::vector<Point> values;
  std::vector<Triangle> triangles;
  for (Index i = 0; i < 6; ++i) {
    values.push_back({static_cast<double>(i), 1, -2.0 * i});
    triangles.push_back({i, (i + 1) % 6, 6});
  }
  const auto spread = spline::spread_inward(values, 7, triangles);
  REQUIRE(spread);
  CHECK(std::abs((*spread)[6].x - 2.5) < 1e-14);
  CHECK(std::abs((*spread)[6].y - 1) < 1e-14);
  CHECK(std::abs((*spread)[6].z + 5) < 1e-14);
  CHECK(spline::spread_inward(values, 6, triangles).error().message ==
        "triangle 0 has a corner that is no vertex");
  CHECK(spline::spread_inward(values, 8, triangles).error().message ==
        "a vertex is connected to none with a value");
  CHECK(*spline::spread_inward(values, 6, {}) == values);
}

TEST_CASE("with a stiffness three points determine a surface: their plane") {
  const samples::GridWithHole grid(2);
  const auto domain = spline::DmsDomain::make(grid.arrays);
  const auto plane = [](const Point& u) { return Point{u.x, u.y, 3 + 2 * u.x - u.y}; };
  std::vector<spline::FitPoint> points;
  for (const Index triangle : {Index{0}, Index{9}, Index{20}}) {
    const Point u = grid.arrays.vertices[grid.arrays.triangles[triangle][0]];
    points.push_back({triangle, u, plane(u)});
  }
  CHECK_FALSE(spline::fit_surface(*domain, points));
  const auto fitted = spline::fit_surface(*domain, points, 0.01);
  REQUIRE(fitted);
  CHECK(fitted->largest_distance < 1e-9);
  const auto surface = spline::DmsSurface::make(*domain, fitted->coefficients);
  samples::Numbers numbers(11);
  for (int i = 0; i < 100; ++i) {
    const Point u = numbers.point(0.1, 3.9);
    CHECK(distance(*surface->value(u), plane(u)) < 1e-6);
  }
  const samples::GridWithHole linear(1);
  const auto other = spline::DmsDomain::make(linear.arrays);
  CHECK(spline::fit_surface(*other, points, 0.01).error().code == ErrorCode::unsupported);
}

}  // namespace
}  // namespace watertight
