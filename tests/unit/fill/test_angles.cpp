// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

#include "fill/angles.h"

using watertight::fill::kHalfTurn;
using watertight::fill::radians;
using watertight::fill::Turn;
using watertight::fill::turn_between;
using watertight::fill::turn_to;

TEST_CASE("directions are within one unit of the arctangent") {
  std::mt19937 numbers(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  constexpr double kUnit = 6.283185307179586 / 4294967296.0;
  for (int i = 0; i < 100000; ++i) {
    const double scale = std::ldexp(1.0, i % 41 - 20);
    const double x = coordinate(numbers) * scale;
    const double y = coordinate(numbers) * (i % 3 == 0 ? 1 : scale);
    const Turn turn = turn_to(x, y);
    double expected = std::atan2(y, x);
    double found = radians(turn);
    if (expected < 0) expected += 6.283185307179586;
    double error = std::abs(found - expected);
    error = std::min(error, std::abs(error - 6.283185307179586));
    REQUIRE(error <= kUnit);
  }
}

TEST_CASE("directions along the axes are exact") {
  CHECK(turn_to(1, 0) == 0);
  CHECK(turn_to(5, 5) == kHalfTurn / 4);
  CHECK(turn_to(0, 3) == kHalfTurn / 2);
  CHECK(turn_to(-2, 0) == kHalfTurn);
  CHECK(turn_to(-2, -2) == kHalfTurn + kHalfTurn / 4);
  CHECK(turn_to(0, 0) == 0);
  CHECK(turn_to(0, -0.5) == kHalfTurn + kHalfTurn / 2);
}

TEST_CASE("the angle between directions is at most half a turn") {
  CHECK(turn_between(0, kHalfTurn) == kHalfTurn);
  CHECK(turn_between(10, 0xFFFFFFF6) == 20);
  CHECK(turn_between(0xFFFFFFF6, 10) == 20);
}
