// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>

#include "facet_solid.h"
#include "tessellate/fill.h"

namespace watertight {
namespace {

using Catch::Approx;
using test::facet_solid;

constexpr std::uint64_t kMany = 1'000'000;

/// The sum of the doubled areas in x and y, with their signs.
double turn_of(const tessellate::FilledFacet& triangles) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    sum += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  return sum;
}

TEST_CASE("edges that cross are cut, and lobes are filled") {
  std::uint64_t pairs = kMany;
  // A pentagram: its middle is inside two turns of the ring, so it is not filled.
  std::vector<Point> star;
  for (int i = 0; i < 5; ++i) {
    const double turn = 2 * i * 2 * 3.141592653589793 / 5;
    star.push_back({std::round(1e6 * std::cos(turn)), std::round(1e6 * std::sin(turn)), 7});
  }
  const auto filled = tessellate::fill_facet(facet_solid({star}), 0, pairs);
  REQUIRE(filled);
  CHECK(filled->size() == 5);
  for (const auto& triangle : *filled) {
    for (const Point& corner : triangle) CHECK(corner.z == 7);
  }
  CHECK(pairs < kMany);
}

TEST_CASE("triangles turn as the exterior ring does") {
  for (const bool is_left : {true, false}) {
    std::uint64_t pairs = kMany;
    std::vector<Point> ring{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
    if (!is_left) std::reverse(ring.begin(), ring.end());
    // The hole shares an edge with the exterior ring.
    const auto filled = tessellate::fill_facet(
        facet_solid({ring, {{0, 2, 0}, {2, 2, 0}, {2, 6, 0}, {0, 6, 0}}}), 0, pairs);
    REQUIRE(filled);
    CHECK(turn_of(*filled) == Approx(is_left ? 112 : -112));
  }
}

TEST_CASE("an edge that a ring goes there and back along bounds nothing") {
  std::uint64_t pairs = kMany;
  const auto filled = tessellate::fill_facet(
      facet_solid({{{0, 0, 0}, {4, 0, 0}, {9, 0, 0}, {4, 0, 0}, {4, 4, 0}}}), 0, pairs);
  REQUIRE(filled);
  CHECK(turn_of(*filled) == Approx(16));
}

TEST_CASE("a facet with more pairs of edges than wanted is left alone, as all after it") {
  std::uint64_t pairs = 2;
  const Solid solid = facet_solid({{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}}});
  CHECK_FALSE(tessellate::fill_facet(solid, 0, pairs));
  CHECK(pairs == 0);
}

TEST_CASE("a facet on a line has no triangles") {
  std::uint64_t pairs = kMany;
  const auto filled =
      tessellate::fill_facet(facet_solid({{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}}), 0, pairs);
  REQUIRE(filled);
  CHECK(filled->empty());
}

}  // namespace
}  // namespace watertight
