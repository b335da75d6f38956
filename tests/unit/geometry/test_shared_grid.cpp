// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "geometry/lattice/shared_grid.h"

namespace watertight::test {
namespace {

constexpr std::array kNoAxis{false, false, false};

Solid triangle_of(std::vector<Point> points, const Lattice& lattice = {}) {
  SolidArrays arrays;
  arrays.vertices = std::move(points);
  arrays.ring_vertices = {0, 1, 2};
  arrays.end_ring();
  arrays.end_facet();
  arrays.end_shell();
  auto solid = Solid::make(std::move(arrays), lattice, 0);
  REQUIRE(solid);
  return *std::move(solid);
}

Lattice decimal_lattice(int exponent, GridNumber origin = {}) {
  Lattice lattice;
  lattice.step.fill({1, exponent});
  lattice.origin.fill(origin);
  return lattice;
}

GridNumber decimal(const std::string& text) {
  const auto number = geometry::parse_decimal(text);
  REQUIRE(number);
  return *number;
}

}  // namespace

TEST_CASE("solids without placements are on the grid of their lattices") {
  const Solid coarse = triangle_of({{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, decimal_lattice(-2));
  const Solid fine = triangle_of({{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, decimal_lattice(-3, {1, 0}));
  const auto grid = geometry::SharedGrid::of_one_placement({{&coarse, nullptr}, {&fine, nullptr}});
  REQUIRE(grid);
  CHECK(grid->placement() == nullptr);
  CHECK(grid->lattice().step[0] == GridNumber{1, -3});
  CHECK(grid->vertices(0)->front() == Point{10, 20, 30});
  CHECK(grid->vertices(1)->front() == Point{1001, 1002, 1003});
  CHECK(grid->box(0).max == Point{70, 80, 100});
  CHECK(grid->rounded_axes(0) == kNoAxis);
}

TEST_CASE("solids of one placement are on the grid of their template") {
  const Solid solid = triangle_of({{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}, decimal_lattice(-1));
  geometry::Placement placement;
  placement.linear[0][0] = decimal("0.333333333333333333");
  placement.anchor = {{{3, 0}, {4, 0}, {5, 0}}};
  const geometry::Placement same = placement;
  const auto grid = geometry::SharedGrid::of_one_placement({{&solid, &placement}, {&solid, &same}});
  REQUIRE(grid);
  CHECK(grid->placement() == &placement);
  CHECK(grid->vertices(1)->front() == Point{1, 2, 3});
  CHECK(grid->world({0, 0, 0}) == std::array<double, 3>{3, 4, 5});
}

TEST_CASE("solids of different placements are put into the world exactly where a grid holds them") {
  const Solid solid = triangle_of({{0, 0, 0}, {10, 0, 0}, {0, 10, 25}}, decimal_lattice(-1));
  geometry::Placement turned;  // a rotation by the matrix (0.6 -0.8; 0.8 0.6)
  turned.linear[0] = {decimal("0.6"), decimal("-0.8"), {}};
  turned.linear[1] = {decimal("0.8"), decimal("0.6"), {}};
  turned.offset = {{decimal("0.125"), {}, {}}};
  turned.anchor = {{decimal("1000"), decimal("-2000.5"), {}}};
  const auto grid = geometry::SharedGrid::in_world({{&solid, nullptr}, {&solid, &turned}});
  REQUIRE(grid);
  CHECK(grid->placement() == nullptr);
  CHECK(grid->rounded_axes(0) == kNoAxis);
  CHECK(grid->rounded_axes(1) == kNoAxis);
  const auto own = grid->vertices(0);
  const auto placed = grid->vertices(1);
  REQUIRE(own);
  REQUIRE(placed);
  CHECK(grid->world((*own)[1]) == std::array<double, 3>{1, 0, 0});
  CHECK(grid->world((*placed)[0]) == std::array<double, 3>{1000.125, -2000.5, 0});
  CHECK(grid->world((*placed)[1]) == std::array<double, 3>{1000.725, -1999.7, 0});
  CHECK(grid->world((*placed)[2]) == std::array<double, 3>{999.325, -1999.9, 2.5});
  CHECK(grid->box(1).min == Point{(*placed)[2].x, (*placed)[0].y, (*placed)[0].z});
}

TEST_CASE("a grid too fine for doubles is coarsened, and says whose vertices are rounded") {
  const Solid solid = triangle_of({{0, 0, 0}, {7, 0, 0}, {0, 7, 3}});
  geometry::Placement long_digits;
  long_digits.linear[0][0] = decimal("0.707106781186547524");
  long_digits.linear[1][0] = decimal("0.70710678118654752");
  const auto grid = geometry::SharedGrid::in_world({{&solid, nullptr}, {&solid, &long_digits}});
  REQUIRE(grid);
  CHECK(grid->rounded_axes(0) == kNoAxis);
  CHECK(grid->rounded_axes(1) == std::array{true, true, false});
  const auto placed = grid->vertices(1);
  REQUIRE(placed);
  // The coordinate 4.949747468305832668 is rounded to steps of 1e-14.
  CHECK(grid->lattice().step[0] == GridNumber{1, -14});
  CHECK((*placed)[1].x == 494974746830583);
  CHECK(grid->world((*grid->vertices(0))[1]) == std::array<double, 3>{7, 0, 0});
}

TEST_CASE("doubles of a template count as the decimals that they are") {
  const Lattice doubles{LatticeKind::float64};
  const Solid solid = triangle_of({{0.1, 0, 0}, {1, 0, 0}, {0, 1e-300, 1}}, doubles);
  const Solid whole = triangle_of({{0, 0, 0}, {7, 0, 0}, {0, 7, 3}});
  const geometry::Placement here;
  const auto grid = geometry::SharedGrid::in_world({{&solid, &here}, {&whole, nullptr}});
  REQUIRE(grid);
  CHECK(grid->rounded_axes(0)[0]);
  CHECK(grid->rounded_axes(1) == kNoAxis);
  CHECK(grid->world((*grid->vertices(0))[0]) == std::array<double, 3>{0.1, 0, 0});
  CHECK(grid->world((*grid->vertices(0))[2]) == std::array<double, 3>{0, 0, 1});
}

TEST_CASE("positions beyond the range of doubles have no grid") {
  const Solid solid = triangle_of({{0, 0, 0}, {7, 0, 0}, {0, 7, 3}}, decimal_lattice(1000));
  geometry::Placement far;
  far.linear[0][0] = {1, 300};
  CHECK_FALSE(geometry::SharedGrid::in_world({{&solid, nullptr}, {&solid, &far}}));
}

}  // namespace watertight::test
