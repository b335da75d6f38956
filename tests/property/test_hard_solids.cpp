// SPDX-License-Identifier: GPL-3.0-or-later
//
// A part of bench/cdt/prove_families: solids that are hard to tetrahedralize are proven without an
// engine.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string_view>
#include <vector>

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

TEST_CASE("no Steiner point on an edge takes the edge of another shell away") {
  // Edge 3-7 of the outer shell and edge 10-13 of the inner one cross in the middle of both. Once a
  // Steiner point there divided the one, and the other was gone with two faces.
  const std::vector<Point> points{{0, 0, -256},  {6, 2, 0},    {0, -6, 6},  {-6, -6, 6},
                                  {-12, -6, 12}, {-6, -6, 12}, {0, 0, 6},   {-6, 0, 6},
                                  {-6, -3, 7},   {-5, -4, 7},  {-7, -4, 7}, {-2, -3, 3},
                                  {-3, -2, 5},   {-5, -2, 5}};
  const auto facet = [&](const std::vector<std::size_t>& corners) {
    Ring ring;
    for (const std::size_t corner : corners) ring.push_back(points[corner]);
    return Facet{ring};
  };
  const Shell outer{facet({0, 1, 2, 3}), facet({4, 5, 6, 7}), facet({3, 2, 5, 4}),
                    facet({2, 1, 6, 5}), facet({1, 0, 7, 6}), facet({0, 3, 4, 7})};
  const Shell inner{facet({8, 9, 10}),  facet({11, 10, 9}), facet({8, 12, 9}),
                    facet({11, 9, 12}), facet({8, 13, 12}), facet({11, 12, 13}),
                    facet({8, 10, 13}), facet({11, 13, 10})};
  CertifyOptions options;
  options.tolerances.planarity_metres = 1e30;
  options.tolerances.planarity_degrees = 360;
  const Report report = certify(solid_of({outer, inner}, millimetres()), nullptr, options).report;
  CHECK(report.verdict == Verdict::undecided);
  REQUIRE_FALSE(report.attempts.empty());
  for (const delaunay::RungAttempt& attempt : report.attempts) {
    INFO(attempt.outcome);
    CHECK(attempt.result != delaunay::RungOutcome::refused_by_certificate);
  }
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
