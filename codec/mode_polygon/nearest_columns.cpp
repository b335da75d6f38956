// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_polygon/nearest_columns.h"

#include <algorithm>
#include <utility>

namespace watertight::codec::polygon {
namespace {

std::uint64_t magnitude(std::int64_t value) {
  return static_cast<std::uint64_t>(value < 0 ? -value : value);
}

}  // namespace

std::uint64_t ColumnScore::operator()(const GridColumn& column) const {
  const GridColumn turned = turn.forward({column[0] - base[0], column[1] - base[1]});
  return across_weight * magnitude(turned[0]) + magnitude(turned[1]);
}

std::vector<GridColumn> nearest_columns(std::span<const GridColumn> columns,
                                        const ColumnScore& score, std::size_t window,
                                        std::size_t keep) {
  const auto middle = static_cast<std::size_t>(
      std::lower_bound(columns.begin(), columns.end(), score.base) - columns.begin());
  const std::size_t first = middle > window ? middle - window : 0;
  const std::size_t last = std::min(columns.size(), middle + window);
  std::vector<std::pair<std::uint64_t, GridColumn>> scored;
  scored.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) scored.emplace_back(score(columns[i]), columns[i]);
  keep = std::min(keep, scored.size());
  const auto end = scored.begin() + static_cast<std::ptrdiff_t>(keep);
  std::partial_sort(scored.begin(), end, scored.end());
  std::vector<GridColumn> nearest;
  nearest.reserve(keep);
  for (std::size_t i = 0; i < keep; ++i) nearest.push_back(scored[i].second);
  return nearest;
}

}  // namespace watertight::codec::polygon
