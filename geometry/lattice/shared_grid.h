// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids and instances of geometry templates, where they stand, on one grid. For comparisons of
// several solids.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/lattice/common_lattice.h"
#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::geometry {

/// A solid, or the solid of a geometry template and where an instance puts it. Kept by the caller.
struct StandingSolid {
  const Solid* solid = nullptr;
  const Placement* placement = nullptr;
};

/// One grid for several solids.
class SharedGrid {
 public:
  /// For solids without placements, or that share one placement: the grid of their lattices, in
  /// the world or in the template, exactly. Nothing for others, and when their lattices have no
  /// CommonLattice. Cost: linear in the solids.
  static std::optional<SharedGrid> of_one_placement(std::vector<StandingSolid> solids);

  /// The solids where they stand, by exact decimals, on the coarsest grid of powers of ten that
  /// holds them; where that has 2^52 steps or more along an axis, vertices are rounded to the
  /// finest grid with fewer. Nothing when the origin is 2^53 steps from all vertices or more, or
  /// is no grid number. Requires solids with vertices. Cost: linear in the vertices.
  static std::optional<SharedGrid> in_world(std::vector<StandingSolid> solids);

  const Lattice& lattice() const { return lattice_; }
  /// From a template's coordinates to the world; null if the grid is in the world.
  const Placement* placement() const { return placement_; }
  /// The world coordinates of a point of the grid, rounded to doubles.
  std::array<double, 3> world(const Point& p) const;

  std::size_t size() const { return solids_.size(); }
  Box box(std::size_t solid) const { return boxes_[solid]; }
  /// The vertices of a solid; nothing if one is 2^53 steps away or more. Cost: linear.
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
  std::optional<CommonLattice> common_;  // of one placement
  std::shared_ptr<const World> world_;   // of other grids: from each solid to the grid
  const Placement* placement_ = nullptr;
  std::vector<Box> boxes_;
  std::vector<std::array<bool, 3>> rounded_axes_;
};

}  // namespace watertight::geometry
