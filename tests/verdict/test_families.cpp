// SPDX-License-Identifier: GPL-3.0-or-later
//
// A part of bench/verdict: the first solids of each family must get no wrong verdict, as they are,
// and some of them also mirrored, renumbered, by the boundary alone and with each engine first.
#include <catch2/catch_test_macros.hpp>
#include <string_view>

#include "bench/verdict/judge.h"

namespace watertight::verdict {
namespace {

constexpr std::uint64_t kSeeds = 200;
constexpr std::uint64_t kVariantsEvery = 10;
constexpr std::uint64_t kEnginesEvery = 50;

void check_family(std::string_view name) {
  delaunay::EngineWorkers workers;
  std::uint64_t right = 0;
  for (const Family& family : families()) {
    if (family.name != name) continue;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const JudgeOptions options{&workers, seed % kVariantsEvery == 0, seed % kEnginesEvery == 0};
      for (const Judgement& judgement : judge(sample_of_seed(family, seed), seed, options)) {
        INFO("seed " << seed << ", " << judgement.variant << ", truth: "
                     << (judgement.truth.is_valid() ? "valid" : judgement.truth.reason)
                     << ", said: " << to_string(judgement.said));
        const bool is_right =
            judgement.outcome == Outcome::right || judgement.outcome == Outcome::allowed;
        CHECK(is_right);
        right += judgement.outcome == Outcome::right ? 1 : 0;
      }
    }
  }
  CHECK(right > kSeeds / 2);  // the other solids are unknown to the oracle, or beyond its bounds
}

TEST_CASE("cavities along diagonals of quads get the oracle's verdict") {
  check_family("diagonals");
}
TEST_CASE("hinges under a diagonal get the oracle's verdict") { check_family("hinges"); }
TEST_CASE("walls that cross along a diagonal get the oracle's verdict") { check_family("walls"); }
TEST_CASE("holes along the middle of a facet get the oracle's verdict") { check_family("prisms"); }
TEST_CASE("pairs that touch from within get the oracle's verdict") { check_family("groups"); }
TEST_CASE("pits, rims and cavities get the oracle's verdict") { check_family("pits"); }
TEST_CASE("rings that touch get the oracle's verdict") { check_family("touching_rings"); }
TEST_CASE("instances of templates are judged where they stand") { check_family("instances"); }
TEST_CASE("instances are compared with members of their template and with their building") {
  check_family("placed_groups");
}
TEST_CASE("large integers get the oracle's verdict") { check_family("large_integers"); }
TEST_CASE("sizes from 1e-300 to 1e300 get the oracle's verdict") { check_family("scales"); }
TEST_CASE("solids of no family get the oracle's verdict") { check_family("general"); }

}  // namespace
}  // namespace watertight::verdict
