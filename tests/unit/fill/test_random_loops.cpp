// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random loops, many of them degenerate: each is refused with a reason, or filled as it should be.
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <random>
#include <set>
#include <string>

#include "exhaustive.h"

namespace watertight::fill {
namespace {

/// WATERTIGHT_FILL_ROUNDS asks for more.
unsigned rounds() {
  const char* text = std::getenv("WATERTIGHT_FILL_ROUNDS");
  return text == nullptr ? 600 : static_cast<unsigned>(std::stoul(text));
}

class RandomHole {
 public:
  explicit RandomHole(unsigned seed) : numbers_(seed) {
    const unsigned loop_count = 1 + below(3);
    // A small grid gives points on one line, in one plane and twice.
    const unsigned grid = below(4) == 0 ? 3 + below(4) : 1000;
    const bool is_flat = below(5) == 0;
    for (unsigned i = 0; i < loop_count; ++i) {
      Loop& loop = loops.emplace_back();
      const unsigned size = 2 + below(loop_count == 1 ? 12 : 5);
      for (unsigned j = 0; j < size; ++j) {
        loop.push_back(static_cast<Index>(points.size()));
        points.push_back({static_cast<double>(below(grid)), static_cast<double>(below(grid)),
                          is_flat ? 0.0 : static_cast<double>(below(grid))});
      }
      if (below(30) == 0) loop.back() = below(40);
    }
    options.space = below(3) == 0 ? CandidateSpace::all : CandidateSpace::delaunay;
    options.objective = below(4) == 0 ? Objective::area : Objective::angle;
    options.has_both_senses = below(4) == 0;
    options.max_domains = 5'000;
    if (below(2) == 0) add_facets();
  }

  std::vector<Point> points;
  std::vector<Loop> loops;
  FillOptions options;

 private:
  unsigned below(unsigned end) { return static_cast<unsigned>(numbers_() % end); }
  void add_facets() {
    for (const Loop& loop : loops) {
      auto& behind = options.behind.emplace_back();
      for (std::size_t i = 0; i < loop.size(); ++i) {
        // Some facets have no direction, and some lie along their edge.
        behind.push_back({static_cast<double>(below(3)), static_cast<double>(below(3)),
                          static_cast<double>(below(3))});
      }
    }
  }

  std::mt19937 numbers_;
};

}  // namespace

TEST_CASE("random loops are refused with a reason or filled") {
  std::size_t filled_count = 0;
  for (unsigned seed = 1; seed <= rounds(); ++seed) {
    CAPTURE(seed);
    RandomHole hole(seed);
    const auto filled = triangulate_loops(hole.points, hole.loops, hole.options);
    if (!filled) {
      const std::set<ErrorCode> reasons{ErrorCode::invalid_argument, ErrorCode::not_found,
                                        ErrorCode::limit_exceeded};
      REQUIRE(reasons.contains(filled.error().code));
      REQUIRE(!filled.error().message.empty());
      continue;
    }
    ++filled_count;
    REQUIRE(test::is_filling(hole.loops, filled->triangles, hole.options.has_both_senses));
    hole.options.keeps_all_sets = true;
    const auto other = triangulate_loops(hole.points, hole.loops, hole.options);
    if (!other) continue;  // the budget
    const bool is_area = hole.options.objective == Objective::area;
    REQUIRE((is_area ? other->area == filled->area : other->angle == filled->angle));
  }
  CHECK(filled_count > rounds() / 10);
}

}  // namespace watertight::fill
