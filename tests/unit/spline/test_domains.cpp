// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/predicates/turn.h"
#include "spline/dms_surface.h"
#include "spline/extend_triangulation.h"
#include "spline/knot_clouds.h"
#include "spline/plane/triangle_parts.h"
#include "spline/thin_plate.h"
#include "tests/unit/spline/grid_with_hole.h"

namespace watertight {
namespace {

using spline::DmsDomain;
using spline::ExtendedTriangulation;
using spline::Index;
using spline::Point;
using spline::Triangle;

/// A polygon of so many equal edges around a point; the points are rational, so the same
/// everywhere.
std::vector<Point> round_polygon(int edges, double radius, Point center = {}) {
  std::vector<Point> polygon;
  for (int i = 0; i < edges; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / edges;
    polygon.push_back(
        {center.x + radius * std::cos(angle), center.y + radius * std::sin(angle), 0});
  }
  return polygon;
}

double area_of(const ExtendedTriangulation& mesh) {
  double doubled = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    doubled += spline::twice_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  return doubled / 2;
}

/// Each edge inside has a triangle on either side, each edge of a polygon one.
void check_edges(const ExtendedTriangulation& mesh, std::span<const std::vector<Point>> polygons) {
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& t : mesh.triangles) {
    CHECK(geometry::turn(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) == 1);
    for (std::size_t j = 0; j < 3; ++j) CHECK(edges.emplace(t[j], t[(j + 1) % 3]).second);
  }
  std::set<std::pair<Index, Index>> borders;
  for (const auto& [a, b] : edges) {
    if (!edges.contains({b, a})) borders.insert(std::minmax(a, b));
  }
  std::set<std::pair<Index, Index>> expected;
  Index first = 0;
  for (const auto& polygon : polygons) {
    const auto size = static_cast<Index>(polygon.size());
    for (Index i = 0; i < size; ++i)
      expected.insert(std::minmax(first + i, first + (i + 1) % size));
    first += size;
  }
  CHECK(borders == expected);
}

double least_angle_cosine(const ExtendedTriangulation& mesh) {
  double largest = 0;  // of the cosines of least angles
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Point& a = mesh.vertices[t[j]];
      const Point& b = mesh.vertices[t[(j + 1) % 3]];
      const Point& c = mesh.vertices[t[(j + 2) % 3]];
      const double dot = (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y);
      largest = std::max(
          largest, dot / (std::hypot(b.x - a.x, b.y - a.y) * std::hypot(c.x - a.x, c.y - a.y)));
    }
  }
  return largest;
}

TEST_CASE("a region is filled with triangles as large as its edges") {
  const std::vector<std::vector<Point>> disc{round_polygon(60, 10)};
  const auto mesh = spline::extend_triangulation(disc);
  REQUIRE(mesh);
  check_edges(*mesh, disc);
  CHECK(std::abs(area_of(*mesh) - 60 / 2.0 * 100 * std::sin(2 * 3.14159265358979323846 / 60)) <
        1e-9);
  CHECK(mesh->vertices.size() > 150);
  CHECK(mesh->vertices.size() < 800);
  CHECK(least_angle_cosine(*mesh) < std::cos(12 * 3.14159265358979323846 / 180));
  const auto dense = spline::extend_triangulation(disc, {.density = 0.5});
  CHECK(dense->vertices.size() > 2 * mesh->vertices.size());
  const auto coarse = spline::extend_triangulation(disc, {.density = 1e9});
  CHECK(coarse->vertices.size() == 60);
  const auto smooth = spline::extend_triangulation(disc, {.smoothing_rounds = 5});
  check_edges(*smooth, disc);
  CHECK(smooth->triangles == mesh->triangles);
  CHECK(smooth->vertices != mesh->vertices);
  CHECK(least_angle_cosine(*smooth) <= least_angle_cosine(*mesh) + 0.05);
}

TEST_CASE("a region may have islands and need not be convex") {
  const std::vector<std::vector<Point>> polygons{{{0, 0, 0},
                                                  {5, 0, 0},
                                                  {10, 0, 0},
                                                  {10, 5, 0},
                                                  {10, 10, 0},
                                                  {6, 10, 0},
                                                  {5, 6, 0},
                                                  {4, 10, 0},
                                                  {0, 10, 0},
                                                  {0, 5, 0}},
                                                 round_polygon(12, 1, {3, 3, 0}),
                                                 round_polygon(9, 1, {7, 3, 0})};
  const auto mesh = spline::extend_triangulation(polygons);
  REQUIRE(mesh);
  check_edges(*mesh, polygons);
  auto turned = polygons;
  for (auto& polygon : turned) std::ranges::reverse(polygon);
  const auto other = spline::extend_triangulation(turned);
  REQUIRE(other);
  check_edges(*other, turned);
  CHECK(std::abs(area_of(*mesh) - area_of(*other)) < 1e-9);
}

TEST_CASE("polygons that are not simple are refused with their number") {
  const auto message = [](const std::vector<std::vector<Point>>& polygons,
                          spline::ExtendOptions options = {}) {
    const auto mesh = spline::extend_triangulation(polygons, options);
    REQUIRE_FALSE(mesh);
    return mesh.error().message;
  };
  const auto square = std::vector<Point>{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  CHECK(message({{{0, 0, 0}, {1, 0, 0}}}) == "polygon 0 has fewer than three vertices");
  CHECK(
      message({square, {{1, 1, 0}, {2, std::numeric_limits<double>::quiet_NaN(), 0}, {1, 2, 0}}}) ==
      "polygon 1 has a vertex that is not finite");
  CHECK(message({square, {{1, 1, 0}, {2, 1, 0}, {4, 4, 0}}}) ==
        "polygon 1 has a vertex that is there already");
  CHECK(message({square, {{1, 1, 0}, {6, 1, 0}, {1, 2, 0}}}) ==
        "polygon 1 crosses another polygon or itself");
  CHECK(message({{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}}}) ==
        "polygon 0 crosses another polygon or itself");
  CHECK(message({square, {{1, 1, 0}, {4, 2, 0}, {1, 2, 0}}}) ==
        "polygon 0 touches a vertex of another polygon or of itself");
  CHECK(message({square}, {.density = 0}) == "density and regularity must be positive");
  CHECK(message({square}, {.density = 1e-4, .most_vertices = 1000}) ==
        "the region needs more than 1000 vertices");
}

TEST_CASE("each point of a triangle is in the part that is named") {
  samples::Numbers numbers(41);
  for (int i = 0; i < 2000; ++i) {
    std::array<Point, 3> corners{numbers.point(-1, 1), numbers.point(-1, 1), numbers.point(-1, 1)};
    if (geometry::turn(corners[0], corners[1], corners[2]) < 0) std::swap(corners[1], corners[2]);
    // Random points, and points on the lines between parts.
    double b = i % 2 == 0 ? numbers.between(0, 1) : std::floor(numbers.between(0, 5)) / 4;
    double c = i % 3 == 0 ? numbers.between(0, 1) : std::floor(numbers.between(0, 5)) / 4;
    if (b + c > 1) {
      b = 1 - b;
      c = 1 - c;
    }
    const auto at = [&](auto member) {
      return corners[0].*member + b * (corners[1].*member - corners[0].*member) +
             c * (corners[2].*member - corners[0].*member);
    };
    const Point u{at(&Point::x), at(&Point::y), 0};
    const std::size_t part = spline::part_of(corners, u);
    REQUIRE(part < spline::kParts);
    const auto own = spline::part_corners(corners, part);
    for (std::size_t j = 0; j < 3; ++j) CHECK(geometry::turn(own[j], own[(j + 1) % 3], u) > 0);
  }
}

TEST_CASE("pieces of a boundary are joined by edges like their own") {
  const std::vector<std::vector<Point>> pieces{{{0, 0, 0}, {1, 0, 0}}, {{1, 4, 0}, {0, 4, 0}}};
  const auto polygon = spline::complete_boundary(pieces);
  REQUIRE(polygon);
  REQUIRE(polygon->size() == 10);
  CHECK((*polygon)[2] == Point{1, 1, 0});
  CHECK((*polygon)[9] == Point{0, 1, 0});
  const std::vector<std::vector<Point>> near{{{0, 0, 0}, {1, 0, 0}}, {{1, 1, 0}, {0, 1, 0}}};
  CHECK(spline::complete_boundary(near)->size() == 4);
  const std::vector<std::vector<Point>> one{{{0, 0, 0}}};
  CHECK(spline::complete_boundary(one).error().message == "piece 0 has fewer than two points");
  const std::vector<std::vector<Point>> far{{{0, 0, 0}, {1e-9, 0, 0}},
                                            {{1, 4, 0}, {1, 4 + 1e-9, 0}}};
  CHECK_FALSE(spline::complete_boundary(far));
}

TEST_CASE("clouds keep all triangles and lie beyond the borders") {
  for (const int degree : {1, 2, 3}) {
    const std::vector<std::vector<Point>> disc{round_polygon(24, 5), round_polygon(7, 1)};
    const auto mesh = spline::extend_triangulation(disc);
    spline::CloudOptions options;
    options.degree = degree;
    const auto clouds = spline::make_clouds(mesh->vertices, mesh->triangles, {}, {}, options);
    REQUIRE(clouds);
    CHECK(*clouds == *spline::make_clouds(mesh->vertices, mesh->triangles, {}, {}, options));
    const auto domain = DmsDomain::make({degree, mesh->vertices, *clouds, mesh->triangles});
    INFO((domain ? std::string() : to_string(domain.error())));
    REQUIRE(domain);
    spline::BasisEvaluator evaluator(*domain);
    samples::Numbers numbers(5);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto functions = evaluator.at(numbers.point(-5, 5));
      if (!functions) continue;
      double sum = 0;
      for (const auto& function : *functions) sum += function.value;
      worst = std::max(worst, std::abs(sum - 1));
    }
    CHECK(worst <= 1e-13);
  }
}

TEST_CASE("knots that find no place are an error that names the vertex") {
  const std::vector<Point> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  // Two sides that have no point in common.
  const std::vector<spline::SideRule> rules{{1, {1, 0, 0}, {2, 0, 0}}, {1, {1, 0, 0}, {0, 0, 0}}};
  CHECK(spline::make_clouds(vertices, triangles, {}, rules).error().message ==
        "the knots of vertex 1 find no place");
  CHECK_FALSE(spline::make_clouds(vertices, triangles, std::vector<Point>(3)));
  CHECK_FALSE(spline::make_clouds(vertices, triangles, {}, {}, {.degree = 7}));
  const std::vector<Triangle> wrong{{0, 1, 9}};
  CHECK(spline::make_clouds(vertices, wrong).error().message ==
        "triangle 0 has a corner that is no vertex");
  CHECK(spline::move_off_lines(vertices, wrong, {}).error().message ==
        "triangle 0 has a corner that is no vertex");
  const std::vector<spline::SideRule> lost{{9, {}, {1, 0, 0}}};
  CHECK(spline::make_clouds(vertices, triangles, {}, lost).error().message ==
        "a rule is for a vertex that is not there");
}

TEST_CASE("a vertex on a line through two knots is moved off it") {
  const samples::GridWithHole grid(2);
  spline::DomainArrays arrays = grid.arrays;
  std::vector<Point> fixed(arrays.clouds.begin(), arrays.clouds.end() - 2);
  // The line through the two knots of the vertex (1, 1) and its middle neighbour.
  Index corner = 0;
  while (arrays.vertices[corner] != Point{1, 1, 0}) ++corner;
  fixed[2 * corner] = {1.05, 1.05, 0};
  fixed[2 * corner + 1] = {1.1, 1.1, 0};
  const auto moved = spline::move_off_lines(arrays.vertices, arrays.triangles, fixed);
  REQUIRE(moved);
  const Point center = moved->back();
  CHECK(center != Point{2, 2, 0});
  CHECK(std::hypot(center.x - 2, center.y - 2) <= 0.06);
  CHECK(std::equal(moved->begin(), moved->end() - 1, arrays.vertices.begin()));
}

}  // namespace
}  // namespace watertight
