// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>

#include "geometry/crs/crs.h"
#include "geometry/crs/crs_table.h"

namespace watertight::test {

using Units = std::array<double, 3>;

TEST_CASE("metric systems have metres and no note") {
  for (const std::uint32_t code : {7415U, 28992U, 31256U, 2056U, 25832U, 32634U, 4978U, 4936U}) {
    INFO(code);
    CHECK(geometry::axis_units(code, {84616, 447422, 3}).metres_per_unit == Units{1, 1, 1});
    CHECK(geometry::axis_units(code, {84616, 447422, 3}).note.empty());
  }
}

TEST_CASE("unstated and unknown systems count as metres with a note") {
  CHECK(geometry::axis_units(0, {}).metres_per_unit == Units{1, 1, 1});
  CHECK(geometry::axis_units(0, {}).note ==
        "no coordinate reference system stated: metres assumed");
  for (const std::uint32_t code : {1U, 7'000'000U, 4'294'967'295U}) {
    CHECK(geometry::axis_units(code, {}).metres_per_unit == Units{1, 1, 1});
    CHECK(geometry::axis_units(code, {}).note.find("not known") != std::string::npos);
  }
}

TEST_CASE("systems in feet have feet") {
  // New York Long Island (US survey feet), Arizona (international feet), New York with heights in
  // feet.
  CHECK(geometry::axis_units(2263, {}).metres_per_unit[0] == 1200.0 / 3937.0);
  CHECK(geometry::axis_units(2223, {}).metres_per_unit == Units{0.3048, 0.3048, 0.3048});
  CHECK(!geometry::axis_units(2263, {}).note.empty());
}

TEST_CASE("geographic systems have metres per degree at the centre") {
  // The lengths of a degree at latitude 52, on the WGS 84 ellipsoid, are 68.678 km and 111.268 km.
  for (const std::uint32_t code : {4326U, 4979U, 4258U, 4937U, 6668U}) {
    const geometry::AxisUnits units = geometry::axis_units(code, {4.36, 52.0, 10.0});
    INFO(code);
    CHECK(std::abs(units.metres_per_unit[0] - 68678) < 5);
    CHECK(std::abs(units.metres_per_unit[1] - 111268) < 5);
    CHECK(units.metres_per_unit[2] == 1);
    CHECK(units.note.find("longitude first") != std::string::npos);
  }
  const geometry::AxisUnits tokyo = geometry::axis_units(6697, {35.68, 139.7, 20.0});
  CHECK(tokyo.note.find("latitude first") != std::string::npos);
  CHECK(std::abs(tokyo.metres_per_unit[0] - 110951) < 50);
  CHECK(std::abs(tokyo.metres_per_unit[1] - 90500) < 100);
  const geometry::AxisUnits pole = geometry::axis_units(4326, {0, 90, 0});
  CHECK(pole.metres_per_unit[0] > 0);
}

TEST_CASE("a geographic code over coordinates that cannot be angles counts as metres") {
  const geometry::AxisUnits units = geometry::axis_units(4326, {1502.3, 341200.5, 180.0});
  CHECK(units.metres_per_unit == Units{1, 1, 1});
  CHECK(units.note.find("cannot be angles") != std::string::npos);
  CHECK(geometry::axis_units(4326, {std::nan(""), 0, 0}).metres_per_unit == Units{1, 1, 1});
}

TEST_CASE("geographic systems have angles up to a full turn, others none") {
  for (const std::uint32_t code : {4326U, 4979U, 6697U, 7034U, 7084U, 4937U}) {
    INFO(code);
    CHECK(geometry::largest_angle(code) == 360);
  }
  CHECK(geometry::largest_angle(4807) == 400);  // NTF (Paris), whose angles are in grads
  for (const std::uint32_t code : {0U, 1U, 4978U, 7415U, 25832U, 2263U, 4'294'967'295U}) {
    INFO(code);
    CHECK(geometry::largest_angle(code) == 0);
  }
}

TEST_CASE("geographic systems put latitude first, except those named after the other order") {
  for (const std::uint32_t code : {4326U, 4979U, 4258U, 6668U, 6697U, 4937U}) {
    INFO(code);
    CHECK(geometry::pole_of_first_axis(code) == 90);
  }
  CHECK(geometry::pole_of_first_axis(4807) == 100);  // NTF (Paris), whose angles are in grads
  for (const std::uint32_t code : {0U, 1U, 4978U, 7415U, 25832U, 31467U, 7034U, 7042U, 7084U}) {
    INFO(code);
    CHECK(geometry::pole_of_first_axis(code) == 0);
  }
}

TEST_CASE("the table of codes is sorted without overlap") {
  std::uint32_t last = 0;
  for (const geometry::CrsRun& run : geometry::crs_runs()) {
    REQUIRE(run.first > last);
    REQUIRE(run.last >= run.first);
    last = run.last;
  }
  CHECK(geometry::crs_runs().size() > 1000);
}

}  // namespace watertight::test
