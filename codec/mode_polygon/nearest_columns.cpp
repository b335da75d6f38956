// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_polygon/nearest_columns.h"

#include <algorithm>
#include <vector>

#include "base/assert.h"

namespace watertight::codec::polygon {
namespace {

std::uint64_t magnitude(std::int64_t value) {
  return static_cast<std::uint64_t>(value < 0 ? -value : value);
}

/// A bound that no score of a column is below, by the column's distance from the base on one axis.
/// A turned offset is within two steps of the true rotation, which keeps its length, and beyond
/// 2^44 steps within 2^-40 of its length.
std::uint64_t least_score(std::int64_t distance) {
  const std::uint64_t steps = magnitude(distance);
  const std::uint64_t slack = 4 + (steps >> 40U);
  return steps > slack ? steps - slack : 0;
}

}  // namespace

std::uint64_t ColumnScore::operator()(const GridColumn& column) const {
  const GridColumn turned = turn.forward({column[0] - base[0], column[1] - base[1]});
  return across_weight * magnitude(turned[0]) + magnitude(turned[1]);
}

NearColumns::NearColumns(std::span<const GridColumn> columns, const ColumnScore& score,
                         std::size_t window)
    : score_(score) {
  const auto middle = static_cast<std::size_t>(
      std::lower_bound(columns.begin(), columns.end(), score.base) - columns.begin());
  middle_ = std::min(middle, window);
  const std::size_t first = middle - middle_;
  columns_ = columns.subspan(first, std::min(columns.size(), middle + window) - first);
}

/// Calls `visit` with each column whose score is at most `limit`, from the base outward. `visit`
/// may lower the limit. Leaves out columns by least_score(), which costs far less than their
/// scores.
template <class Visit>
void NearColumns::visit(const std::uint64_t& limit, const Visit& visit) const {
  const auto is_beyond = [&](std::size_t i, std::size_t axis) {
    return least_score(columns_[i][axis] - score_.base[axis]) > limit;
  };
  const auto consider = [&](std::size_t i) {
    if (is_beyond(i, 1)) return;
    const Scored scored{score_(columns_[i]), columns_[i]};
    if (scored.first <= limit) visit(scored);
  };
  for (std::size_t i = middle_; i < columns_.size() && !is_beyond(i, 0); ++i) consider(i);
  for (std::size_t i = middle_; i > 0 && !is_beyond(i - 1, 0); --i) consider(i - 1);
}

NearColumns::Scored NearColumns::nearest() const {
  WATERTIGHT_ASSERT(size() > 0);
  Scored best{UINT64_MAX, {}};
  visit(best.first, [&](const Scored& scored) { best = std::min(best, scored); });
  return best;
}

NearColumns::Scored NearColumns::at(std::size_t rank) const {
  WATERTIGHT_ASSERT(rank < size());
  std::vector<Scored> best;  // a heap of the rank + 1 best so far, the worst of them first
  best.reserve(rank + 2);
  std::uint64_t limit = UINT64_MAX;
  visit(limit, [&](const Scored& scored) {
    best.push_back(scored);
    std::push_heap(best.begin(), best.end());
    if (best.size() > rank + 1) {
      std::pop_heap(best.begin(), best.end());
      best.pop_back();
    }
    if (best.size() == rank + 1) limit = best.front().first;
  });
  return best.front();
}

std::size_t NearColumns::rank_of(const GridColumn& column) const {
  if (!std::binary_search(columns_.begin(), columns_.end(), column)) return size();
  const Scored own{score_(column), column};
  std::size_t rank = 0;
  visit(own.first, [&](const Scored& scored) { rank += scored < own ? 1 : 0; });
  return rank;
}

}  // namespace watertight::codec::polygon
