// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <cmath>
#include <thread>
#include <vector>

#include "projection/projection.h"

namespace watertight {
namespace {

using Catch::Matchers::WithinAbs;
using projection::Position;
using projection::Rectangle;
using projection::System;

constexpr double kFewMetres = 5e-5;  // of degrees: the agreement of published values

TEST_CASE("well-known points have their published longitude and latitude") {
  struct Sample {
    std::uint32_t srid;
    Position stored;
    double longitude;
    double latitude;
  };
  // The tower of Amersfoort is the origin of the Dutch grid; the others are plain by definition.
  for (const Sample& sample :
       {Sample{28992, {155000, 463000, 1}, 5.387206, 52.155174},
        Sample{7415, {155000, 463000, 1}, 5.387206, 52.155174},
        Sample{25833, {500000, 0, 0}, 15, 0}, Sample{6697, {139.7, 35.6, 40}, 139.7, 35.6},
        Sample{4979, {13.4, 52.5, 40}, 13.4, 52.5}}) {
    INFO(sample.srid);
    std::vector<Position> positions{sample.stored};
    REQUIRE(projection::transform(sample.srid, System::longitude_latitude, positions));
    CHECK_THAT(positions[0][0], WithinAbs(sample.longitude, kFewMetres));
    CHECK_THAT(positions[0][1], WithinAbs(sample.latitude, kFewMetres));
    CHECK(positions[0][2] == sample.stored[2]);
  }
}

TEST_CASE("positions above each other, in any order, have one place") {
  const std::vector<Position> stored{{155000, 463000, 1},
                                     {85000, 447000, 2},
                                     {155000, 463000, -3},
                                     {85000, 447000.5, 4},
                                     {85000, 447000, 2}};
  std::vector<Position> together = stored;
  REQUIRE(projection::transform(28992, System::longitude_latitude, together));
  for (std::size_t i = 0; i < stored.size(); ++i) {
    std::vector<Position> alone{stored[i]};
    REQUIRE(projection::transform(28992, System::longitude_latitude, alone));
    CHECK(together[i] == alone[0]);
  }
}

TEST_CASE("earth-centred coordinates are those of the ellipsoid's axes") {
  std::vector<Position> positions{{0, 0, 0}, {90, 0, 100}, {0, 90, 0}, {180, -90, 10}};
  projection::to_earth_centred(positions);
  const std::vector<Position> expected{
      {6378137, 0, 0}, {0, 6378237, 0}, {0, 0, 6356752.314245}, {0, 0, -6356762.314245}};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK_THAT(positions[i][axis], WithinAbs(expected[i][axis], 1e-6));
    }
  }
}

TEST_CASE("web mercator has its equator and meridian at zero") {
  std::vector<Position> positions{{0, 0, 7}, {180, 0, 7}};
  REQUIRE(projection::transform(4326, System::web_mercator, positions));
  CHECK_THAT(positions[0][0], WithinAbs(0, 1e-6));
  CHECK_THAT(positions[0][1], WithinAbs(0, 1e-6));
  CHECK_THAT(positions[1][0], WithinAbs(20037508.342789, 1e-3));
}

TEST_CASE("a rectangle there and back holds itself") {
  const Rectangle city{{78000, 457000}, {79000, 458000}};
  const auto outside = projection::bounds_of(28992, System::longitude_latitude, city);
  REQUIRE(outside);
  const auto back = projection::bounds_in(28992, System::longitude_latitude, *outside);
  REQUIRE(back);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    CHECK(outside->min[axis] < outside->max[axis]);
    CHECK(back->min[axis] <= city.min[axis]);
    CHECK(back->max[axis] >= city.max[axis]);
  }
}

TEST_CASE("systems without x and y on a map, and places outside of them, are refused") {
  std::vector<Position> positions{{1, 2, 3}};
  for (const std::uint32_t srid : {0U, 1U, 4978U, 5709U, 999999U}) {
    INFO(srid);
    const Status status = projection::transform(srid, System::longitude_latitude, positions);
    REQUIRE_FALSE(status);
    CHECK(status.error().code == ErrorCode::unsupported);
    CHECK_FALSE(projection::bounds_of(srid, System::longitude_latitude, {{0, 0}, {1, 1}}));
  }
  positions = {{1e300, 1e300, 0}};
  CHECK_FALSE(projection::transform(25833, System::longitude_latitude, positions));
  std::vector<Position> none;
  CHECK(projection::transform(25833, System::longitude_latitude, none));
}

TEST_CASE("the authority's order of axes is known") {
  CHECK(projection::is_north_first(4326));
  CHECK(projection::is_north_first(6697));
  CHECK(projection::is_north_first(31468));
  CHECK_FALSE(projection::is_north_first(28992));
  CHECK_FALSE(projection::is_north_first(7415));
  CHECK_FALSE(projection::is_north_first(999999));
}

TEST_CASE("threads transform at the same time, and alike") {
  std::vector<Position> results(4);
  {
    std::vector<std::jthread> threads;
    for (Position& result : results) {
      threads.emplace_back([&result] {
        for (int i = 0; i < 200; ++i) {
          std::vector<Position> positions{{155000.0 + i, 463000, 0}};
          if (projection::transform(28992, System::longitude_latitude, positions)) {
            result = positions[0];
          }
        }
      });
    }
  }
  for (const Position& result : results) CHECK(result == results[0]);
  CHECK(results[0][0] > 5);
}

}  // namespace
}  // namespace watertight
