// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <vector>

#include "codec/mode_polygon/nearest_columns.h"
#include "tests/random.h"

using namespace watertight;
using codec::polygon::ColumnScore;
using codec::polygon::GridColumn;
using codec::polygon::NearColumns;
using codec::polygon::Turn;

namespace {

/// All columns of the window by their rank, with nothing left out.
std::vector<NearColumns::Scored> ranked(const std::vector<GridColumn>& columns,
                                        const ColumnScore& score, std::size_t window) {
  const auto middle = std::lower_bound(columns.begin(), columns.end(), score.base);
  const auto before = std::min<std::ptrdiff_t>(middle - columns.begin(), std::ssize(columns));
  const auto reach = static_cast<std::ptrdiff_t>(window);
  std::vector<NearColumns::Scored> scored;
  for (auto column = middle - std::min(before, reach);
       column != middle + std::min(columns.end() - middle, reach); ++column) {
    scored.emplace_back(score(*column), *column);
  }
  std::sort(scored.begin(), scored.end());
  return scored;
}

}  // namespace

TEST_CASE("near columns are ranked as if the score of every column in the window were compared") {
  test::Random random(7);
  for (const std::int64_t size : {3L, 40L, 5'000L, 1L << 45, 1L << 53}) {
    for (int round = 0; round < 200; ++round) {
      const auto any = [&] { return random.between(1 - size, size - 1); };
      std::vector<GridColumn> columns(static_cast<std::size_t>(random.between(1, 90)));
      for (GridColumn& column : columns) column = {any(), any()};
      std::sort(columns.begin(), columns.end());
      columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
      ColumnScore score;
      score.base = {any(), any()};
      score.turn = Turn({static_cast<double>(any()), static_cast<double>(any())});
      score.across_weight = round % 2 == 0 ? 1 : 4;
      const auto window = static_cast<std::size_t>(random.between(1, 60));
      const auto expected = ranked(columns, score, window);
      const NearColumns near(columns, score, window);
      REQUIRE(near.size() == expected.size());
      REQUIRE((expected.empty() || near.nearest() == expected.front()));
      for (std::size_t rank = 0; rank < expected.size(); ++rank) {
        REQUIRE(near.at(rank) == expected[rank]);
        REQUIRE(near.rank_of(expected[rank].second) == rank);
      }
      for (const GridColumn& column : columns) {
        const bool is_in_window =
            std::any_of(expected.begin(), expected.end(),
                        [&](const NearColumns::Scored& scored) { return scored.second == column; });
        REQUIRE((near.rank_of(column) < near.size()) == is_in_window);
      }
    }
  }
}
