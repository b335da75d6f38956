// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "spline/blossom.h"
#include "spline/dms_surface.h"
#include "spline/extend_triangulation.h"
#include "spline/fit_surface.h"
#include "spline/knot_clouds.h"
#include "spline/spline_json.h"
#include "spline/thin_plate.h"
#include "tests/unit/spline/grid_with_hole.h"

namespace watertight {
namespace {

using spline::DmsDomain;
using spline::FitPoint;
using spline::Index;
using spline::Point;

/// Places in each triangle, on its border and inside, and what a surface has there.
template <class Surface>
std::vector<FitPoint> samples_in(const spline::DomainArrays& arrays, const Surface& surface,
                                 int steps = 6) {
  std::vector<FitPoint> points;
  for (Index triangle = 0; triangle < arrays.triangles.size(); ++triangle) {
    const auto& [a, b, c] = arrays.triangles[triangle];
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const double s = static_cast<double>(i) / steps;
        const double t = static_cast<double>(j) / steps;
        const Point& p = arrays.vertices[a];
        const Point& q = arrays.vertices[b];
        const Point& r = arrays.vertices[c];
        const Point u{p.x + s * (q.x - p.x) + t * (r.x - p.x),
                      p.y + s * (q.y - p.y) + t * (r.y - p.y), 0};
        points.push_back({triangle, u, surface(u)});
      }
    }
  }
  return points;
}

TEST_CASE("a surface through points of a quadratic is that quadratic") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  samples::Numbers numbers(3);
  const auto polynomial = numbers.polynomial(2);
  const auto points = samples_in(grid.arrays, [&](const Point& u) {
    return Point{u.x + 1e6, u.y, polynomial.value(u)};
  });
  const auto fitted = spline::fit_surface(*domain, points);
  REQUIRE(fitted);
  CHECK(fitted->largest_distance <= 1e-8);  // at 1e6 a double has steps of 1e-10
  const auto exact = spline::polynomial_coefficients(*domain, polynomial);
  for (std::size_t f = 0; f < exact.size(); ++f)
    CHECK(std::abs(fitted->coefficients[f].z - exact[f]) <= 1e-9);
  CHECK(fitted->condition > 1);
}

TEST_CASE("points that do not determine a surface are refused") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  CHECK(spline::fit_surface(*domain, {}).error().message == "there are no points to fit");
  const std::vector<FitPoint> outside{{99, {1, 1, 0}, {}}};
  CHECK(spline::fit_surface(*domain, outside).error().message ==
        "point 0 is in a triangle that is not there");
  auto points = samples_in(grid.arrays, [](const Point& u) { return u; });
  std::erase_if(points, [](const FitPoint& point) { return point.u.x < 1; });
  CHECK(spline::fit_surface(*domain, points).error().message ==
        "the points do not determine the surface: some functions have too few of them");
}

TEST_CASE("a truncated cone gets a rounded cap that goes on as the cone does") {
  const auto circle = [](int edges, double radius) {
    std::vector<Point> polygon;
    for (int i = 0; i < edges; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / edges;
      polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return polygon;
  };
  constexpr Index kOuter = 32;
  constexpr Index kInner = 16;
  const std::vector<std::vector<Point>> ring{circle(kOuter, 2), circle(kInner, 1)};
  auto mesh = spline::extend_triangulation(ring);
  REQUIRE(mesh);
  const auto clouds = spline::make_clouds(mesh->vertices, mesh->triangles);
  REQUIRE(clouds);
  const spline::DomainArrays old_arrays{2, mesh->vertices, *clouds, mesh->triangles};
  const auto old = DmsDomain::make(old_arrays);
  REQUIRE(old);
  const auto cone = [](const Point& u) {
    return Point{u.x, u.y, 2 - std::sqrt(u.x * u.x + u.y * u.y)};
  };
  const auto fitted = spline::fit_surface(*old, samples_in(old_arrays, cone));
  REQUIRE(fitted);
  CHECK(fitted->largest_distance < 0.01);

  // The cap: its border vertices are the last ones of the ring's polygons.
  const std::vector<std::vector<Point>> inner{circle(kInner, 1)};
  const auto cap = spline::extend_triangulation(inner);
  REQUIRE(cap);
  const auto ring_vertices = static_cast<Index>(mesh->vertices.size());
  std::vector<Index> hole;
  for (const auto& t : cap->triangles) {
    spline::Triangle& moved = mesh->triangles.emplace_back();
    for (std::size_t j = 0; j < 3; ++j)
      moved[j] = t[j] < kInner ? kOuter + t[j] : ring_vertices + t[j] - kInner;
    hole.push_back(static_cast<Index>(mesh->triangles.size() - 1));
  }
  mesh->vertices.insert(mesh->vertices.end(), cap->vertices.begin() + kInner, cap->vertices.end());
  const auto vertices = spline::move_off_lines(mesh->vertices, mesh->triangles, *clouds);
  REQUIRE(vertices);
  const auto all_clouds = spline::make_clouds(*vertices, mesh->triangles, *clouds);
  REQUIRE(all_clouds);
  const auto domain = DmsDomain::make({2, *vertices, *all_clouds, mesh->triangles});
  REQUIRE(domain);
  std::vector<Point> coefficients = fitted->coefficients;
  coefficients.resize(domain->function_count());
  const auto plate = spline::least_thin_plate(*domain, hole, coefficients);
  INFO((plate ? std::string() : to_string(plate.error())));
  REQUIRE(plate);
  const auto surface = spline::DmsSurface::make(*domain, plate->coefficients);
  REQUIRE(surface);
  const Point top = *surface->value({0, 0, 0});
  CHECK(top.z > 1.1);  // above the rim, below the tip of the cone
  CHECK(top.z < 1.9);
  std::vector<Point> places;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) places.push_back({0.1 * i, 0.1 * j, 0});
  }
  for (const auto& found : surface->values(places, 2))
    CHECK(spline::gaussian_curvature(*found) > 0.1);
  // On the old region the surface is what it was.
  const auto before = spline::DmsSurface::make(*old, fitted->coefficients);
  samples::Numbers numbers(5);
  for (int i = 0; i < 500; ++i) {
    const Point u = numbers.point(-1.4, 1.4);
    const auto was = before->value(u);
    if (was) CHECK(*was == *surface->value(u));
  }
}

TEST_CASE("a surface as JSON has the same numbers") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  samples::Numbers numbers(7);
  const auto coefficients = numbers.points_in_space(domain->function_count());
  const auto surface = spline::DmsSurface::make(*domain, coefficients);
  const auto json = nlohmann::json::parse(spline::to_json(*surface));
  CHECK(json["type"] == "watertight_spline");
  CHECK(json["schema"] == 1);
  CHECK(json["degree"] == 2);
  REQUIRE(json["vertices"].size() == 25);
  REQUIRE(json["clouds"].size() == 25);
  REQUIRE(json["triangles"].size() == 32);
  REQUIRE(json["coefficients"].size() == 32);
  for (std::size_t v = 0; v < 25; ++v) {
    CHECK(json["vertices"][v] ==
          nlohmann::json{grid.arrays.vertices[v].x, grid.arrays.vertices[v].y});
    for (std::size_t l = 0; l < 2; ++l) {
      const Point& knot = grid.arrays.clouds[2 * v + l];
      CHECK(json["clouds"][v][l] == nlohmann::json{knot.x, knot.y});
    }
  }
  for (std::size_t t = 0; t < 32; ++t) {
    CHECK(json["triangles"][t] == nlohmann::json(grid.arrays.triangles[t]));
    REQUIRE(json["coefficients"][t].size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
      const Point& c = coefficients[6 * t + i];
      CHECK(json["coefficients"][t][i] == nlohmann::json{c.x, c.y, c.z});
    }
  }
}

/// WATERTIGHT_SPLINE_ROUNDS asks for more.
std::uint64_t rounds() {
  const char* text = std::getenv("WATERTIGHT_SPLINE_ROUNDS");
  return text == nullptr ? 3000 : std::strtoull(text, nullptr, 10);
}

TEST_CASE("random domains are made or refused with a reason, and have no NaN") {
  int made = 0;
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= rounds(); ++seed) {
    test::Random random(seed);
    samples::Numbers numbers(seed);
    spline::DomainArrays arrays;
    arrays.degree = 1 + static_cast<int>(random.below(3));
    const std::size_t size = 3 + random.below(4);
    // A fan around the first vertex, in half of the cases with knots anywhere near.
    for (std::size_t v = 0; v < size; ++v) {
      const double angle = static_cast<double>(v);
      arrays.vertices.push_back(v == 0 ? Point{} : Point{std::cos(angle), std::sin(angle), 0});
      if (v >= 2) arrays.triangles.push_back({0, static_cast<Index>(v - 1), static_cast<Index>(v)});
    }
    if (random.below(4) == 0) arrays.vertices[random.below(size)] = numbers.point(-1, 1);
    if (random.below(16) == 0)
      arrays.vertices[random.below(size)].x = std::numeric_limits<double>::quiet_NaN();
    const double reach = random.below(2) == 0 ? 0.05 : 0.5;
    for (std::size_t v = 0; v < size; ++v) {
      for (int l = 1; l <= arrays.degree; ++l) {
        const Point way = numbers.point(-reach, reach);
        arrays.clouds.push_back({arrays.vertices[v].x + way.x, arrays.vertices[v].y + way.y, 0});
      }
    }
    const auto domain = DmsDomain::make(arrays);
    if (!domain) {
      ++refused;
      CHECK_FALSE(domain.error().message.empty());
      continue;
    }
    ++made;
    spline::BasisEvaluator evaluator(*domain);
    for (int i = 0; i < 20; ++i) {
      const auto functions =
          evaluator.at(i < static_cast<int>(size) ? arrays.vertices[static_cast<std::size_t>(i)]
                                                  : numbers.point(-1, 1),
                       2);
      if (!functions) continue;
      for (const auto& function : *functions) {
        CHECK(std::isfinite(function.value));
        for (const double value : function.first) CHECK(std::isfinite(value));
        for (const double value : function.second) CHECK(std::isfinite(value));
      }
    }
  }
  CHECK(made > 300);
  CHECK(refused > 300);
}

}  // namespace
}  // namespace watertight
