// SPDX-License-Identifier: GPL-3.0-or-later
//
// The references of an indoor model: which cell and state belong together, and the references that
// do not fit (703). Internal to validate/.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/cell_graph.h"

namespace watertight::validate {

using geometry::Index;
using geometry::kNone;

/// A reference that does not fit.
struct LinkFault {
  Index cell = kNone;      // the cell that it is about; kNone where no cell is known
  std::uint64_t line = 0;  // the line of the element that has the reference
  std::string detail;
};

/// Requires a graph that lives as long as this object. Cost: n log n in the links.
class IndoorLinks {
 public:
  explicit IndoorLinks(const geometry::CellGraph& graph);

  /// The state of a cell: the one to which the cell refers, else the first one that refers to the
  /// cell. kNone for kNone and for a cell without state.
  Index state_of(Index cell) const { return cell == kNone ? kNone : states_[cell]; }
  /// The cell of a state: the one to which the state refers, else the first one that refers to the
  /// state. kNone for kNone and for a state without cell.
  Index cell_of(Index state) const { return state == kNone ? kNone : cells_[state]; }

  /// The references that do not fit, in the order of cells, boundaries, states, transitions.
  std::vector<LinkFault> faults() const;

 private:
  const geometry::CellGraph& graph_;
  std::vector<Index> states_;  // by cell
  std::vector<Index> cells_;   // by state
};

}  // namespace watertight::validate
