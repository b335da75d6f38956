// SPDX-License-Identifier: GPL-3.0-or-later
//
// A part of the round trips that bench/codec/round_trips makes for a million solids.
#include <catch2/catch_test_macros.hpp>

#include "tests/generated/round_trip.h"

using namespace watertight;

TEST_CASE("what is encoded comes back, in every mode, alone and in pages") {
  generated::RoundTrips trips;
  for (std::uint64_t seed = 1; seed <= 800; ++seed) trips.check_generated(seed, 1500);
  for (const std::string& failure : trips.failures()) {
    INFO(failure);
    CHECK(false);
  }
  for (const char* mode : {"raw", "bitmap", "walk", "polygon", "parallelogram", "automatic"}) {
    INFO(mode);
    CHECK(trips.counts().at(std::string(mode).append(": encoded")) > 20);
  }
}
