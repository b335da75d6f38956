// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <limits>

#include "geometry/lattice/moved_lattice.h"

namespace watertight::test {

TEST_CASE("a decimal lattice moves by decimals, a binary one by doubles") {
  Lattice decimal;
  decimal.step = {GridNumber{1, -3}, GridNumber{1, -3}, GridNumber{1, -3}};
  decimal.origin = {GridNumber{84616468, -3}, GridNumber{447, 3}, GridNumber{-7, -1}};
  const auto moved = geometry::moved_lattice(decimal, {0.1, -447000, 0.7});
  REQUIRE(moved);
  CHECK(moved->origin == std::array{GridNumber{84616568, -3}, GridNumber{}, GridNumber{}});
  CHECK(moved->step == decimal.step);
  Lattice binary;
  binary.kind = LatticeKind::binary;
  binary.step = {GridNumber{1, -10}, GridNumber{1, -10}, GridNumber{1, -10}};
  const auto other = geometry::moved_lattice(binary, {0.1, 0.5, 3});
  REQUIRE(other);
  CHECK(other->world(0, 0) == 0.1);
  CHECK(other->origin[1] == GridNumber{1, -1});
  CHECK(other->origin[2] == GridNumber{3, 0});
}

TEST_CASE("a lattice is not moved where points would be rounded") {
  Lattice decimal;
  CHECK(geometry::moved_lattice(decimal, {1e-300, 0, 0}));
  decimal.origin[0] = GridNumber{1, 3};
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(geometry::moved_lattice(decimal, {1e-300, 0, 0}).error().code == ErrorCode::limit_exceeded);
  CHECK(geometry::moved_lattice(decimal, {0, infinity, 0}).error().code ==
        ErrorCode::limit_exceeded);
  Lattice doubles;
  doubles.kind = LatticeKind::float64;
  CHECK(geometry::moved_lattice(doubles, {1, 0, 0}).error().code == ErrorCode::unsupported);
}

}  // namespace watertight::test
