// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>

#include "spline/blossom.h"
#include "spline/energy/piece_energy.h"
#include "spline/thin_plate.h"
#include "tests/unit/spline/grid_with_hole.h"

namespace watertight {
namespace {

using spline::DmsDomain;
using spline::Index;
using spline::Point;

struct Filled {
  std::vector<Point> exact;
  spline::ThinPlate plate;
  double worst = 0;  // of the unknown coefficients
};

/// Fills the hole of a surface that is a polynomial outside of it.
Filled filled(const DmsDomain& domain, const samples::GridWithHole& grid,
              const spline::Polynomial& polynomial, double x = 0) {
  Filled result;
  for (const double c : spline::polynomial_coefficients(domain, polynomial))
    result.exact.push_back({x, 0, c});
  std::vector<Point> given = result.exact;
  for (std::size_t f = 6 * grid.old.size(); f < given.size(); ++f) given[f] = {7, 7, 7};
  auto plate = spline::least_thin_plate(domain, grid.hole, given);
  INFO((plate ? std::string() : to_string(plate.error())));
  REQUIRE(plate);
  result.plate = std::move(*plate);
  for (std::size_t f = 0; f < given.size(); ++f) {
    result.worst =
        std::max({result.worst, std::abs(result.plate.coefficients[f].z - result.exact[f].z),
                  std::abs(result.plate.coefficients[f].x - x)});
  }
  return result;
}

TEST_CASE("a hole in a plane, a bowl and any quadratic is filled with the same") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  REQUIRE(domain);
  spline::Polynomial plane;
  plane.c[0][0] = 1;
  plane.c[1][0] = 2;
  plane.c[0][1] = -3;
  const Filled flat = filled(*domain, grid, plane);
  CHECK(flat.plate.unknowns == 48);
  CHECK(flat.plate.old_functions > 48);
  CHECK(flat.worst <= 1e-10);
  CHECK(flat.plate.energy <= 1e-12);
  CHECK(filled(*domain, grid, plane, 1e6).worst <= 1e-9);  // far from the origin
  CHECK(flat.plate.condition > 1);
  CHECK(flat.plate.condition < 1e9);
  spline::Polynomial bowl;
  bowl.c[2][0] = 1;
  bowl.c[0][2] = 1;
  const Filled round = filled(*domain, grid, bowl);
  CHECK(round.worst <= 1e-10);
  CHECK(std::abs(round.plate.energy - 32) <= 1e-9);  // 2^2 + 2^2 over an area of 4
  samples::Numbers numbers(3);
  for (int i = 0; i < 10; ++i) CHECK(filled(*domain, grid, numbers.polynomial(2)).worst <= 1e-9);
}

/// A surface with random coefficients around a filled hole.
std::vector<Point> random_filled(const DmsDomain& domain, const samples::GridWithHole& grid,
                                 std::uint64_t seed) {
  auto plate = spline::least_thin_plate(
      domain, grid.hole, samples::Numbers(seed).points_in_space(domain.function_count()));
  REQUIRE(plate);
  return plate->coefficients;
}

TEST_CASE("no other coefficients bend a filled hole less") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  const std::vector<Point> least = random_filled(*domain, grid, 5);
  std::vector<std::vector<double>> products;
  for (const Index triangle : grid.hole)
    products.push_back(spline::energy_products(*domain, triangle));
  const auto energy_of = [&](const std::vector<Point>& coefficients) {
    double energy = 0;
    for (std::size_t t = 0; t < grid.hole.size(); ++t) {
      const auto functions = domain->functions_at(grid.hole[t]);
      for (std::size_t i = 0; i < functions.size(); ++i) {
        for (std::size_t j = 0; j < functions.size(); ++j) {
          energy += products[t][i * functions.size() + j] * coefficients[functions[i]].z *
                    coefficients[functions[j]].z;
        }
      }
    }
    return energy;
  };
  std::vector<Point> flat = least;
  for (Point& c : flat) c = {0, 0, c.z};
  const double energy = energy_of(least);
  CHECK(std::abs(energy - spline::thin_plate_energy(*domain, grid.hole, flat)) <= 1e-9 * energy);
  samples::Numbers numbers(7);
  for (int i = 0; i < 1000; ++i) {
    std::vector<Point> other = least;
    const double size = std::pow(10.0, -(i % 5));
    for (std::size_t f = 6 * grid.old.size(); f < other.size(); ++f)
      other[f].z += size * numbers.between(-1, 1);
    CHECK(energy_of(other) >= energy);
  }
}

TEST_CASE("value and slope go on across the border of a filled hole") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  const std::vector<Point> coefficients = random_filled(*domain, grid, 9);
  spline::BasisEvaluator evaluator(*domain);
  double worst = 0;
  double worst_slope = 0;
  int places = 0;
  for (const Index old : grid.old) {
    for (const Index inside : grid.hole) {
      std::vector<Point> shared;
      for (const Index v : grid.arrays.triangles[old]) {
        for (const Index w : grid.arrays.triangles[inside]) {
          if (v == w) shared.push_back(grid.arrays.vertices[v]);
        }
      }
      if (shared.size() != 2) continue;
      for (int i = 1; i < 16; ++i) {
        const double share = i / 16.0;
        const Point u{shared[0].x + share * (shared[1].x - shared[0].x),
                      shared[0].y + share * (shared[1].y - shared[0].y), 0};
        const auto limit = [&](Index triangle) {
          return spline::sum_of(evaluator.in_triangle(triangle, u, 1), coefficients);
        };
        const auto a = limit(old);
        const auto b = limit(inside);
        worst = std::max(worst, std::abs(a.value.z - b.value.z));
        worst_slope = std::max({worst_slope, std::abs(a.first[0].z - b.first[0].z),
                                std::abs(a.first[1].z - b.first[1].z)});
        ++places;
      }
    }
  }
  CHECK(places == 8 * 15);
  CHECK(worst <= 1e-9);
  CHECK(worst_slope <= 1e-9);
}

TEST_CASE("a hole that nothing holds is an error") {
  const samples::GridWithHole grid(2);
  const auto domain = DmsDomain::make(grid.arrays);
  std::vector<Index> all(grid.old);
  all.insert(all.end(), grid.hole.begin(), grid.hole.end());
  const std::vector<Point> coefficients(domain->function_count());
  CHECK(spline::least_thin_plate(*domain, all, coefficients).error().message ==
        "no surface reaches into the hole from its border");
  CHECK_FALSE(spline::least_thin_plate(*domain, {}, coefficients));
  CHECK_FALSE(spline::least_thin_plate(*domain, grid.hole, {}));
  const std::vector<Index> twice{grid.hole[0], grid.hole[0]};
  CHECK_FALSE(spline::least_thin_plate(*domain, twice, coefficients));
  const samples::GridWithHole cubic(3);
  const auto third = DmsDomain::make(cubic.arrays);
  CHECK(spline::least_thin_plate(*third, cubic.hole, std::vector<Point>(third->function_count()))
            .error()
            .code == ErrorCode::unsupported);
}

}  // namespace
}  // namespace watertight
