// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the columns of earlier solids of a page that are near a predicted column, the best first. A
// vertex in one of these columns is coded by the rank of the column. For mode `polygon`.
#pragma once

#include <span>
#include <vector>

#include "codec/mode_polygon/plane_geometry.h"

namespace watertight::codec::polygon {

/// The score of a column, lower for those that are more likely. With the offset from `base` turned
/// by `turn`: `across_weight` times the magnitude of the first coordinate, plus that of the second.
struct ColumnScore {
  GridColumn base{};
  Turn turn{Flat{}};
  std::uint64_t across_weight = 1;
  std::uint64_t operator()(const GridColumn& column) const;
};

/// The `keep` columns of the least score, ties by the column, among the last `window` columns less
/// than the base of the score and the first `window` others. Requires sorted `columns`.
/// Cost: O(window log keep).
std::vector<GridColumn> nearest_columns(std::span<const GridColumn> columns,
                                        const ColumnScore& score, std::size_t window,
                                        std::size_t keep);

}  // namespace watertight::codec::polygon
