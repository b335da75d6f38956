// SPDX-License-Identifier: GPL-3.0-or-later
//
// The map from lattice coordinates of a solid to metres in the world, for all measurements: by the
// units of the solid's reference system, and for a geometry template by the placement of an
// instance. Internal to validate/.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::validate {

class MetricMap {
 public:
  /// `placement` is null for a solid whose coordinates are world coordinates.
  MetricMap(const Solid& solid, const geometry::Placement* placement);

  /// The vector in metres between two points of the lattice, rounded.
  std::array<double, 3> metres(const Point& from, const Point& to) const;

  /// True if each lattice axis keeps its direction, so that two different points of the grid are at
  /// least the shortest step apart.
  bool keeps_axes() const { return !matrix_; }
  /// The assumption about the units, "" when none was made.
  const std::string& note() const { return note_; }

 private:
  std::array<double, 3> per_step_{1, 1, 1};
  std::optional<std::array<std::array<double, 3>, 3>> matrix_;  // rows: axes of the world
  std::string note_;
};

}  // namespace watertight::validate
