// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the columns of earlier solids of a page that are near a predicted column, the best first. A
// vertex in one of these columns is coded by the rank of the column. For mode `polygon`.
#pragma once

#include <span>
#include <utility>

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

/// The columns in a window around the base of a score: the last `window` columns less than the base
/// and the first `window` others. Their ranks are by the score, ties by the column.
class NearColumns {
 public:
  using Scored = std::pair<std::uint64_t, GridColumn>;

  /// Requires sorted `columns`, each once, that outlive the object. Cost: logarithmic.
  NearColumns(std::span<const GridColumn> columns, const ColumnScore& score, std::size_t window);

  std::size_t size() const { return columns_.size(); }
  /// The column of rank 0, and its score. Requires size() > 0. Cost: as rank_of().
  Scored nearest() const;
  /// The column of a rank, and its score. Requires rank < size(). Cost: O(window log rank), most
  /// often much less.
  Scored at(std::size_t rank) const;
  /// The rank of a column; size() if it is not in the window. Cost: O(window), most often much
  /// less.
  std::size_t rank_of(const GridColumn& column) const;

 private:
  template <class Visit>
  void visit(const std::uint64_t& limit, const Visit& visit) const;

  std::span<const GridColumn> columns_;  // those in the window
  std::size_t middle_;  // the index of the first one that is not less than the base
  ColumnScore score_;
};

}  // namespace watertight::codec::polygon
