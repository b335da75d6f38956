// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>

#include "spline/blossom.h"
#include "spline/dms_surface.h"
#include "tests/unit/spline/grid_with_hole.h"

namespace watertight {
namespace {

using spline::BasisEvaluator;
using spline::DmsDomain;
using spline::Index;
using spline::Point;

DmsDomain domain_of(const spline::DomainArrays& arrays) {
  auto domain = DmsDomain::make(arrays);
  INFO((domain ? std::string() : to_string(domain.error())));
  REQUIRE(domain);
  return std::move(*domain);
}

/// Points of all kinds: random ones, all vertices, and points on all edges.
std::vector<Point> points_in(const DmsDomain& domain, samples::Numbers& numbers, int count) {
  std::vector<Point> points = domain.arrays().vertices;
  for (const auto& triangle : domain.arrays().triangles) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Point& a = domain.arrays().vertices[triangle[j]];
      const Point& b = domain.arrays().vertices[triangle[(j + 1) % 3]];
      for (const double share : {0.25, 0.5, 0.75})
        points.push_back({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), 0});
    }
  }
  for (int i = 0; i < count; ++i) points.push_back(numbers.point(0, 4));
  return points;
}

TEST_CASE("the functions of a domain sum up to 1, on vertices and edges too") {
  for (const int degree : {1, 2, 3}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const samples::GridWithHole grid(degree, seed);
      const DmsDomain domain = domain_of(grid.arrays);
      CHECK(domain.function_count() == 32U * domain.functions_per_triangle());
      BasisEvaluator evaluator(domain);
      samples::Numbers numbers(7);
      double worst = 0;
      for (const Point& u : points_in(domain, numbers, 2000)) {
        const auto functions = evaluator.at(u);
        REQUIRE(functions);
        double sum = 0;
        for (const auto& function : *functions) {
          CHECK(function.value >= -1e-13);
          sum += function.value;
        }
        worst = std::max(worst, std::abs(sum - 1));
      }
      INFO("degree " << degree << ", seed " << seed);
      CHECK(worst <= 1e-14);
    }
  }
}

TEST_CASE("many functions at once are the definition, term by term") {
  for (const int degree : {1, 2, 3}) {
    const samples::GridWithHole grid(degree);
    const DmsDomain domain = domain_of(grid.arrays);
    BasisEvaluator evaluator(domain);
    samples::Numbers numbers(11);
    for (const Point& u : points_in(domain, numbers, 50)) {
      std::vector<double> values(domain.function_count());
      const auto functions = evaluator.at(u);
      for (const auto& function : *functions) values[function.function] = function.value;
      double worst = 0;
      for (Index f = 0; f < domain.function_count(); ++f) {
        const double plain = domain.scale_of(f) * spline::simplex_spline(u, domain.knots_of(f));
        worst = std::max(worst, std::abs(plain - values[f]));
      }
      CHECK(worst <= 1e-14);
    }
  }
}

TEST_CASE("a polynomial is reproduced, with its derivatives") {
  for (const int degree : {1, 2, 3}) {
    const samples::GridWithHole grid(degree);
    const DmsDomain domain = domain_of(grid.arrays);
    samples::Numbers numbers(13);
    for (int round = 0; round < 5; ++round) {
      const spline::Polynomial polynomial = numbers.polynomial(degree);
      std::vector<Point> coefficients;
      for (const double c : spline::polynomial_coefficients(domain, polynomial))
        coefficients.push_back({0, 0, c});
      const auto surface = spline::DmsSurface::make(domain, coefficients);
      REQUIRE(surface);
      double worst = 0;
      double worst_first = 0;
      double worst_second = 0;
      const auto points = points_in(domain, numbers, 300);
      const auto found = surface->values(points, 2);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& u = points[i];
        worst = std::max(worst, std::abs(found[i]->value.z - polynomial.value(u)));
        Point by_x;
        Point by_y;
        std::array<double, 3> second{};
        for (std::size_t a = 0; a < 4; ++a) {
          for (std::size_t b = 0; a + b < 4; ++b) {
            const auto power = [](double base, std::size_t exponent) {
              return exponent > 3 ? 0 : std::pow(base, exponent);
            };
            const double c = polynomial.c[a][b];
            const auto da = static_cast<double>(a);
            const auto db = static_cast<double>(b);
            by_x.z += c * da * power(u.x, a - 1) * power(u.y, b);
            by_y.z += c * db * power(u.x, a) * power(u.y, b - 1);
            second[0] += c * da * (da - 1) * power(u.x, a - 2) * power(u.y, b);
            second[1] += c * da * db * power(u.x, a - 1) * power(u.y, b - 1);
            second[2] += c * db * (db - 1) * power(u.x, a) * power(u.y, b - 2);
          }
        }
        worst_first = std::max({worst_first, std::abs(found[i]->first[0].z - by_x.z),
                                std::abs(found[i]->first[1].z - by_y.z)});
        for (std::size_t k = 0; k < 3; ++k)
          worst_second = std::max(worst_second, std::abs(found[i]->second[k].z - second[k]));
      }
      INFO("degree " << degree);
      CHECK(worst <= 1e-12);
      CHECK(worst_first <= 1e-11);
      CHECK(worst_second <= 1e-8);
    }
  }
}

TEST_CASE("derivatives are what differences approach") {
  const samples::GridWithHole grid(2);
  const DmsDomain domain = domain_of(grid.arrays);
  samples::Numbers numbers(17);
  const auto surface =
      spline::DmsSurface::make(domain, numbers.points_in_space(domain.function_count()));
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const Point u = numbers.point(0.1, 3.9);
    const Point d{numbers.between(-1, 1), numbers.between(-1, 1), 0};
    constexpr double kStep = 1e-4;
    const std::array<Point, 2> ends{Point{u.x + kStep * d.x, u.y + kStep * d.y, 0},
                                    Point{u.x - kStep * d.x, u.y - kStep * d.y, 0}};
    const auto found = surface->values(ends, 2);
    // Where the second derivatives jump between the ends, a difference is less exact.
    if (std::abs(found[0]->second[0].z - found[1]->second[0].z) > 1e-9) continue;
    ++compared;
    const Point derivative = *surface->derivative(u, d);
    CHECK(std::abs(derivative.z - (found[0]->value.z - found[1]->value.z) / (2 * kStep)) <= 1e-8);
    const Point second = *surface->second_derivative(u, d, {1, 0, 0});
    CHECK(std::abs(second.z - (found[0]->first[0].z - found[1]->first[0].z) / (2 * kStep)) <= 1e-8);
  }
  CHECK(compared > 100);
}

TEST_CASE("functions of a filled hole are 0 in the old region") {
  for (const int degree : {1, 2, 3}) {
    const samples::GridWithHole grid(degree);
    const DmsDomain domain = domain_of(grid.arrays);
    BasisEvaluator evaluator(domain);
    samples::Numbers numbers(19);
    int old_points = 0;
    for (const Point& u : points_in(domain, numbers, 2000)) {
      const Index triangle = domain.place_of(u)->triangle;
      if (triangle >= grid.old.size()) continue;
      ++old_points;
      const auto functions = evaluator.at(u);
      for (const auto& function : *functions) {
        if (domain.triangle_of(function.function) >= grid.old.size()) CHECK(function.value == 0);
      }
    }
    CHECK(old_points > 1000);
  }
}

TEST_CASE("points of a triangulation lie in one half-open triangle each") {
  const samples::GridWithHole grid(1);
  const DmsDomain domain = domain_of(grid.arrays);
  samples::Numbers numbers(23);
  for (const Point& u : points_in(domain, numbers, 500)) {
    if (u.x >= 4 || u.y >= 4) continue;  // right and upper border
    int count = 0;
    for (const auto& [a, b, c] : grid.arrays.triangles) {
      const auto& v = grid.arrays.vertices;
      if (spline::is_in_triangle(v[a], v[b], v[c], u)) ++count;
    }
    CHECK(count == 1);
  }
  CHECK(domain.place_of({4, 4, 0}));
  CHECK_FALSE(domain.place_of({4.0000001, 4, 0}));
  CHECK_FALSE(domain.place_of({-1, 2, 0}));
}

TEST_CASE("surfaces follow affine maps, and stay in the hull of their coefficients") {
  const samples::GridWithHole grid(2);
  const DmsDomain domain = domain_of(grid.arrays);
  samples::Numbers numbers(29);
  const std::vector<Point> coefficients = numbers.points_in_space(domain.function_count());
  const auto affine = [](const Point& p) {
    return Point{2 * p.x - p.y + 3, 0.5 * p.y + p.z, p.x - p.z - 1};
  };
  const auto planar = [](const Point& p) {
    return Point{1.5 * p.x - 0.25 * p.y + 7, 0.5 * p.x + 2 * p.y - 3, 0};
  };
  std::vector<Point> mapped;
  for (const Point& c : coefficients) mapped.push_back(affine(c));
  spline::DomainArrays arrays = grid.arrays;
  for (Point& p : arrays.vertices) p = planar(p);
  for (Point& p : arrays.clouds) p = planar(p);
  const DmsDomain other = domain_of(arrays);
  const auto surface = spline::DmsSurface::make(domain, coefficients);
  const auto mapped_surface = spline::DmsSurface::make(domain, mapped);
  const auto moved_surface = spline::DmsSurface::make(other, coefficients);
  double worst = 0;
  double worst_moved = 0;
  for (int i = 0; i < 1000; ++i) {
    const Point u = numbers.point(0, 4);
    const Point value = *surface->value(u);
    const Point expected = affine(value);
    const Point found = *mapped_surface->value(u);
    const Point moved = *moved_surface->value(planar(u));
    worst = std::max({worst, std::abs(found.x - expected.x), std::abs(found.y - expected.y),
                      std::abs(found.z - expected.z)});
    worst_moved = std::max({worst_moved, std::abs(moved.x - value.x), std::abs(moved.y - value.y),
                            std::abs(moved.z - value.z)});
    CHECK(std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)}) <= 1);
  }
  CHECK(worst <= 1e-12);
  CHECK(worst_moved <= 1e-12);
}

TEST_CASE("a coefficient changes a surface in the hull of its knots only") {
  const samples::GridWithHole grid(2);
  const DmsDomain domain = domain_of(grid.arrays);
  BasisEvaluator evaluator(domain);
  samples::Numbers numbers(31);
  for (int i = 0; i < 1000; ++i) {
    const Point u = numbers.point(0, 4);
    const auto functions = evaluator.at(u, 2);
    for (const auto& function : *functions) {
      double left = 9;
      double right = -9;
      for (const Point& knot : domain.knots_of(function.function)) {
        left = std::min(left, knot.x);
        right = std::max(right, knot.x);
      }
      CHECK((left <= u.x && u.x <= right));
    }
  }
}

TEST_CASE("a domain that is not proper is refused with its place") {
  const samples::GridWithHole grid(2);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto message = [&](auto change) {
    spline::DomainArrays arrays = grid.arrays;
    change(arrays);
    const auto domain = DmsDomain::make(arrays);
    REQUIRE_FALSE(domain);
    return domain.error().message;
  };
  using Arrays = spline::DomainArrays;
  CHECK(message([](Arrays& a) { a.degree = 4; }) == "the degree is not 1 to 3");
  CHECK(message([](Arrays& a) { a.degree = 1; }) ==
        "the number of knots is not vertices times degree");
  CHECK(message([&](Arrays& a) { a.vertices[3].x = nan; }) == "vertex 3 is not finite");
  CHECK(message([&](Arrays& a) { a.clouds[5].y = 1 / 0.0; }) == "knot 5 is not finite");
  CHECK(message([](Arrays& a) { a.triangles[4][1] = 99; }) ==
        "triangle 4 has a corner that is no vertex");
  CHECK(message([](Arrays& a) { std::swap(a.triangles[4][1], a.triangles[4][2]); }) ==
        "triangle 4 does not turn left");
  CHECK(message([](Arrays& a) { a.triangles.push_back(a.triangles[2]); }) ==
        "triangle 32 and triangle 2 meet in more than an edge or a vertex");
  CHECK(message([](Arrays& a) {
          a.clouds[0] = {3, 3, 0};
        }).starts_with("triangle 0 does not turn left with knots"));
  CHECK(message([](Arrays& a) {
          a.clouds[1] = {2 * a.clouds[0].x, 2 * a.clouds[0].y, 0};
        }) == "three knots of function 200 of triangle 0 lie on a line");
  // An edge of one triangle ends in the middle of another one's.
  Arrays improper;
  improper.degree = 1;
  improper.vertices = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {1, -1, 0}};
  improper.clouds = {{-0.1, 0.01, 0}, {2.1, 0.02, 0}, {1, 1.1, 0}, {1.01, 0.01, 0}, {1, -1.1, 0}};
  improper.triangles = {{0, 1, 2}, {3, 0, 4}};
  const auto domain = DmsDomain::make(improper);
  REQUIRE_FALSE(domain);
  CHECK(domain.error().message ==
        "triangle 1 and triangle 0 meet in more than an edge or a vertex");
}

TEST_CASE("a surface needs a finite coefficient for each function") {
  const samples::GridWithHole grid(2);
  const DmsDomain domain = domain_of(grid.arrays);
  CHECK(spline::DmsSurface::make(domain, {}).error().message == "0 coefficients for 192 functions");
  std::vector<Point> coefficients(192);
  coefficients[7].z = std::numeric_limits<double>::infinity();
  CHECK(spline::DmsSurface::make(domain, coefficients).error().message ==
        "coefficient 7 is not finite");
}

TEST_CASE("a blossom is symmetric, affine and its polynomial where all points are equal") {
  samples::Numbers numbers(37);
  for (int i = 0; i < 100; ++i) {
    const auto polynomial = numbers.polynomial(3);
    const Point a = numbers.point(-2, 2);
    const Point b = numbers.point(-2, 2);
    const Point c = numbers.point(-2, 2);
    const Point middle{(a.x + b.x) / 2, (a.y + b.y) / 2, 0};
    const auto at = [&](const Point& p, const Point& q, const Point& r) {
      return spline::blossom(polynomial, std::array{p, q, r});
    };
    CHECK(std::abs(at(a, a, a) - polynomial.value(a)) <= 1e-12);
    CHECK(std::abs(at(a, b, c) - at(c, a, b)) <= 1e-12);
    CHECK(std::abs(at(middle, b, c) - (at(a, b, c) + at(b, b, c)) / 2) <= 1e-12);
  }
}

}  // namespace
}  // namespace watertight
