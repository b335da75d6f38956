// SPDX-License-Identifier: GPL-3.0-or-later
//
// The optimum against all surfaces of a few points.
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <random>

#include "exhaustive.h"

namespace watertight::fill {
namespace {

struct RandomLoops {
  std::vector<Point> points;
  std::vector<Loop> loops;
};

/// Jagged loops around different centres.
RandomLoops random_input(std::mt19937& numbers, const std::vector<std::size_t>& sizes) {
  std::uniform_real_distribution<double> place(-1, 1);
  RandomLoops input;
  for (const std::size_t size : sizes) {
    const Point centre{place(numbers), place(numbers), place(numbers)};
    Loop& loop = input.loops.emplace_back();
    for (std::size_t i = 0; i < size; ++i) {
      loop.push_back(static_cast<Index>(input.points.size()));
      input.points.push_back(
          {centre.x + place(numbers), centre.y + place(numbers), centre.z + place(numbers)});
    }
  }
  return input;
}

void add_facets_behind(std::mt19937& numbers, const RandomLoops& input, FillOptions& options) {
  std::uniform_real_distribution<double> direction(-1, 1);
  for (const Loop& loop : input.loops) {
    auto& behind = options.behind.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      behind.push_back({direction(numbers), direction(numbers), direction(numbers)});
    }
  }
}

void compare(const RandomLoops& input, FillOptions options) {
  options.space = CandidateSpace::all;
  const std::optional<double> expected = test::least_weight(input.points, input.loops, options);
  const Result<LoopFill> found = triangulate_loops(input.points, input.loops, options);
  REQUIRE(found.has_value() == expected.has_value());
  if (!found) return;
  REQUIRE(test::is_filling(input.loops, found->triangles, options.has_both_senses));
  const auto weight = [&](const LoopFill& fill) {
    return options.objective == Objective::area ? fill.area : fill.angle;
  };
  CHECK(weight(*found) == Catch::Approx(*expected).margin(1e-7));
  options.keeps_all_sets = true;
  const Result<LoopFill> with_all_sets = triangulate_loops(input.points, input.loops, options);
  REQUIRE(with_all_sets);
  CHECK(weight(*with_all_sets) == weight(*found));
}

void compare_all_objectives(const std::vector<std::size_t>& sizes, unsigned seed, int rounds) {
  std::mt19937 numbers(seed);
  for (int round = 0; round < rounds; ++round) {
    CAPTURE(sizes, seed, round);
    const RandomLoops input = random_input(numbers, sizes);
    FillOptions options;
    options.has_both_senses = round % 2 == 1 && sizes.size() > 1;
    compare(input, options);
    if (!options.has_both_senses) {
      FillOptions with_facets = options;
      add_facets_behind(numbers, input, with_facets);
      compare(input, with_facets);
    }
    options.objective = Objective::area;
    compare(input, options);
  }
}

}  // namespace

TEST_CASE("one loop is filled as well as by trying all surfaces") {
  compare_all_objectives({3}, 1, 3);
  compare_all_objectives({5}, 2, 10);
  compare_all_objectives({6}, 3, 30);
  compare_all_objectives({7}, 4, 5);
}

TEST_CASE("two loops are filled as well as by trying all surfaces") {
  compare_all_objectives({3, 3}, 5, 30);
  compare_all_objectives({3, 4}, 6, 14);
  compare_all_objectives({4, 4}, 7, 3);
}

TEST_CASE("three loops are filled as well as by trying all surfaces") {
  compare_all_objectives({3, 3, 3}, 8, 4);
}

TEST_CASE("triangles that are not allowed are left out as by trying all surfaces") {
  std::mt19937 numbers(9);
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    const RandomLoops input = random_input(
        numbers, round % 2 == 0 ? std::vector<std::size_t>{6} : std::vector<std::size_t>{3, 3});
    const auto seed = static_cast<unsigned>(numbers());
    FillOptions options;
    options.is_allowed = [seed](const Triangle& t) {
      return ((t[0] * 31 + t[1] * 17 + t[2] * 7 + seed) >> 1U) % 4 != 0;
    };
    compare(input, options);
  }
}

}  // namespace watertight::fill
