// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "geometry/placement.h"
#include "tests/unit/geometry/solids.h"

namespace watertight::test {
namespace {

geometry::Placement placement_of(const std::array<std::string, 9>& numbers) {
  geometry::Placement placement;
  for (std::size_t i = 0; i < 9; ++i) {
    const auto number = geometry::parse_decimal(numbers[i]);
    REQUIRE(number);
    placement.linear[i / 3][i % 3] = *number;
  }
  return placement;
}

}  // namespace

TEST_CASE("the sign of a determinant is exact") {
  CHECK(geometry::determinant_sign(geometry::Placement{}) == 1);
  CHECK(geometry::determinant_sign(placement_of({"-1", "0", "0", "0", "1", "0", "0", "0", "1"})) ==
        -1);
  CHECK(geometry::determinant_sign(placement_of({"1", "0", "0", "0", "1", "0", "0", "0", "0"})) ==
        0);
  // The rows are multiples as decimals, but not as doubles; the other two matrices differ a little.
  CHECK(geometry::determinant_sign(
            placement_of({"0.1", "0.2", "0.3", "0.7", "1.4", "2.1", "5", "1", "9"})) == 0);
  CHECK(geometry::determinant_sign(placement_of(
            {"0.1", "0.2", "0", "0.7", "1.40000000000000001", "0", "0", "0", "1e-300"})) == 1);
  CHECK(geometry::determinant_sign(placement_of(
            {"0.1", "0.2", "0", "0.7", "1.39999999999999999", "0", "0", "0", "1e300"})) == -1);
}

TEST_CASE("a rotation is one exactly or not at all") {
  CHECK(geometry::is_rotation(geometry::Placement{}));
  CHECK(geometry::is_rotation(placement_of({"0", "-1", "0", "1", "0", "0", "0", "0", "1"})));
  CHECK(geometry::is_rotation(
      placement_of({"0.6", "-0.8", "0", "0.8", "0.6", "0", "0", "0", "1.0"})));
  CHECK_FALSE(geometry::is_rotation(placement_of({"0", "1", "0", "1", "0", "0", "0", "0", "1"})));
  CHECK_FALSE(geometry::is_rotation(
      placement_of({"0.6", "-0.8", "0", "0.8", "0.6000000000000001", "0", "0", "0", "1"})));
  CHECK_FALSE(geometry::is_rotation(placement_of({"2", "0", "0", "0", "2", "0", "0", "0", "2"})));
}

TEST_CASE("a placed solid has its vertices in the world, turned over it has its rings reversed") {
  geometry::Placement placement = placement_of({"0", "-2", "0", "2", "0", "0", "0", "0", "0.5"});
  placement.anchor = {{{1, 2}, {2, 2}, {3, 2}}};
  placement.srid = 7415;
  CHECK(geometry::place(placement, {1, 2, 3}) == std::array<double, 3>{96, 202, 301.5});
  SolidArrays arrays;
  arrays.vertices = {{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
  arrays.ring_vertices = {0, 1, 2};
  arrays.end_ring();
  arrays.end_facet();
  arrays.end_shell();
  const auto solid = Solid::make(arrays, Lattice{}, 0);
  REQUIRE(solid);
  const auto there = geometry::placed(*solid, placement);
  REQUIRE(there);
  CHECK(there->srid() == 7415);
  CHECK(there->world(0) == std::array<double, 3>{96, 202, 301.5});
  CHECK(geometry::turned_over(*solid).arrays().ring_vertices == std::vector<Index>{2, 1, 0});
  CHECK(geometry::turned_over(geometry::turned_over(*solid)) == *solid);
  CHECK_FALSE(geometry::placed(
      *solid, placement_of({"1e308", "1e308", "1e308", "0", "1", "0", "0", "0", "1"})));
}

}  // namespace watertight::test
