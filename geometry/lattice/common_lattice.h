// SPDX-License-Identifier: GPL-3.0-or-later
//
// One exact grid for solids of different lattices, so that several solids can be compared.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "geometry/lattice/lattice.h"

namespace watertight::geometry {

/// The coarsest grid of integers that holds the points of several lattices of one kind.
class CommonLattice {
 public:
  /// The common grid; nothing when the lattices are of different kinds, or when their steps and
  /// origins have no common divisor within 18 digits. Requires sane lattices. Cost: linear.
  static std::optional<CommonLattice> of(std::span<const Lattice> lattices);

  const Lattice& lattice() const { return lattice_; }
  /// A point of `from`, one of the lattices, in coordinates of the common grid; nothing if one of
  /// these coordinates is not below 2^53 in magnitude.
  std::optional<Point> moved(const Point& p, const Lattice& from) const;

 private:
  Lattice lattice_;
};

}  // namespace watertight::geometry
