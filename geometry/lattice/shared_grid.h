// SPDX-License-Identifier: GPL-3.0-or-later
//
// One grid for solids and for instances of geometry templates as they stand in the world, so that
// several solids can be compared.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/lattice/common_lattice.h"
#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::geometry {

/// A solid, or the solid of a geometry template with the placement of an instance (null for a solid
/// that is no instance). The caller keeps both alive.
struct StandingSolid {
  const Solid* solid = nullptr;
  const Placement* placement = nullptr;
};

/// One grid for several solids.
class SharedGrid {
 public:
  /// The CommonLattice of the solids, without rounding: in the world for solids without
  /// placements, in the coordinates of the template for solids that have one placement. Nothing for
  /// solids with different placements or without a CommonLattice. Cost: linear in the solids.
  static std::optional<SharedGrid> of_one_placement(std::vector<StandingSolid> solids);

  /// The coarsest grid of powers of ten that holds the exact decimal world coordinates of all
  /// vertices. Where the vertices spread over 2^52 steps or more along an axis, they are rounded to
  /// the finest grid on which they do not. Nothing when a vertex is 2^53 steps or more from the
  /// origin, or the origin is no grid number. Requires solids with vertices. Cost: linear in the
  /// vertices.
  static std::optional<SharedGrid> in_world(std::vector<StandingSolid> solids);

  const Lattice& lattice() const { return lattice_; }
  /// The placement of the template in whose coordinates the grid is; null if the grid is in the
  /// world.
  const Placement* placement() const { return placement_; }
  /// The world coordinates of a point of the grid, rounded to doubles.
  std::array<double, 3> world(const Point& p) const;

  std::size_t size() const { return solids_.size(); }
  Box box(std::size_t solid) const { return boxes_[solid]; }
  /// The vertices of a solid on the grid; nothing if one is 2^53 steps or more from the origin.
  /// Cost: linear.
  std::optional<std::vector<Point>> vertices(std::size_t solid) const;
  /// True if facets that turn outward in the template turn inward on the grid.
  bool is_turned_over(std::size_t solid) const;
  /// For each axis, true if vertices of the solid may be rounded along it, by half a step at most.
  const std::array<bool, 3>& rounded_axes(std::size_t solid) const { return rounded_axes_[solid]; }

 private:
  struct World;
  explicit SharedGrid(std::vector<StandingSolid> solids);
  bool share_placement();
  bool put_in_world();

  std::vector<StandingSolid> solids_;
  Lattice lattice_;
  std::optional<CommonLattice> common_;  // the lattice that of_one_placement() sets
  std::shared_ptr<const World> world_;   // the maps from solids to the grid that in_world() sets
  const Placement* placement_ = nullptr;
  std::vector<Box> boxes_;
  std::vector<std::array<bool, 3>> rounded_axes_;
};

}  // namespace watertight::geometry
