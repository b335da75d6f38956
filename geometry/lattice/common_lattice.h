// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids of different lattices on one grid, exactly. For comparisons of several solids.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "geometry/lattice/lattice.h"

namespace watertight::geometry {

/// The coarsest grid of integers that holds the points of several lattices of one kind.
class CommonLattice {
 public:
  /// Nothing when the lattices are of different kinds, or their steps and origins have no common
  /// divisor within 18 digits. Requires sane lattices. Cost: linear.
  static std::optional<CommonLattice> of(std::span<const Lattice> lattices);

  const Lattice& lattice() const { return lattice_; }
  /// A point of one of the lattices on this one; nothing if a coordinate is 2^53 or beyond.
  std::optional<Point> moved(const Point& p, const Lattice& from) const;

 private:
  Lattice lattice_;
};

}  // namespace watertight::geometry
