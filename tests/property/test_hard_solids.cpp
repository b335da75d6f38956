// SPDX-License-Identifier: GPL-3.0-or-later
//
// A part of bench/cdt/prove_families: solids that are hard to tetrahedralize are proven without an
// engine.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string_view>

#include "tests/solids/builders.h"
#include "tests/solids/hard_solids.h"
#include "validate/certify.h"

using namespace watertight;
using namespace watertight::solids;

TEST_CASE("hard solids that pass the exact tests are proven without an engine") {
  for (const HardFamily& family : hard_families()) {
    std::size_t passed = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      CertifyOptions options;
      options.tolerances.planarity_metres = 1e30;
      options.tolerances.planarity_degrees = 360;
      const Report report = certify(hard_solid(family, seed), nullptr, options).report;
      if (report.attempts.empty()) continue;  // the exact tests refuse it
      ++passed;
      INFO(family.name << ' ' << seed << ": " << report.undecided_reason);
      CHECK(report.verdict == Verdict::valid);
    }
    INFO(family.name);
    CHECK(passed >= 3);
  }
}

TEST_CASE("Chazelle's polyhedron with ten notches is proven without an engine") {
  const Report report = certify(solid_of({chazelle(10)}, millimetres()), nullptr).report;
  INFO(report.undecided_reason);
  CHECK(report.verdict == Verdict::valid);
}

TEST_CASE("a cavity with an edge on a wall is proven without an engine") {
  // The wall's own diagonal crosses that edge, and is Delaunay.
  const auto touching =
      std::ranges::find(hard_families(), std::string_view("touching"), &HardFamily::name);
  for (const std::uint64_t seed : {13983, 21244, 29238, 52270}) {
    const Report report = certify(hard_solid(*touching, seed), nullptr).report;
    INFO(seed << ": " << report.undecided_reason);
    CHECK(report.verdict == Verdict::valid);
  }
}

TEST_CASE("edges of two shells that are divided at their common point leave a solid undecided") {
  // Once both edges got a Steiner point there, and the program ended with a crash.
  const auto touching =
      std::ranges::find(hard_families(), std::string_view("touching"), &HardFamily::name);
  const Report report = certify(hard_solid(*touching, 102595), nullptr).report;
  CHECK(report.verdict == Verdict::undecided);
  CHECK(report.undecided_reason.find("cross in a point that is not a vertex") != std::string::npos);
}

TEST_CASE("edges close beside each other do not take turns to cut small parts off") {
  // Once one of two edges got a Steiner point in each of 50 rounds, until the rounds ended.
  const auto plates =
      std::ranges::find(hard_families(), std::string_view("plates"), &HardFamily::name);
  CertifyOptions options;
  options.tolerances.planarity_metres = 1e30;
  options.tolerances.planarity_degrees = 360;
  const Report report = certify(hard_solid(*plates, 6355), nullptr, options).report;
  INFO(report.undecided_reason);
  CHECK(report.verdict == Verdict::valid);
}
