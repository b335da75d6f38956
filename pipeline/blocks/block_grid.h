// SPDX-License-Identifier: GPL-3.0-or-later
//
// One grid for the solids of a block whose lattices differ, so that they share a page. Solids from
// texts have steps as fine as their digits need; what their coordinates have in common is that they
// are decimals, or the shortest decimals of doubles. Internal to pipeline/blocks.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/lattice/common_lattice.h"
#include "geometry/solid.h"

namespace watertight::pipeline {

class BlockGrid {
 public:
  /// The coarser of two grids: the common lattice of the solids, and for each axis the coarsest
  /// power of two of which the nearest doubles of all coordinates are multiples. Nothing when there
  /// is neither. Cost: linear.
  static std::optional<BlockGrid> of(std::span<const Solid* const> solids);

  /// The solid on the grid; where that is one of doubles, with the nearest doubles as its
  /// coordinates. Nothing when a coordinate is not below 2^53.
  std::optional<Solid> moved(const Solid& solid) const;

 private:
  std::optional<geometry::CommonLattice> common_;  // none: the grid is one of doubles
  Lattice lattice_;
};

/// The solids on the lattice of all their coordinates in normal form (geometry/lattice/lattice.h),
/// with decimals as they are and binary numbers as the shortest decimals of their doubles: the
/// solids as the reader of a text makes them. Nothing when there is no such lattice without
/// rounding. Cost: linear.
std::optional<std::vector<Solid>> on_lattice_of_decimals(std::span<const Solid* const> solids);

}  // namespace watertight::pipeline
