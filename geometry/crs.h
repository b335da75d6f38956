// SPDX-License-Identifier: GPL-3.0-or-later
//
// Metres per unit of a coordinate reference system's axes: for tolerances and measures only.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "geometry/lattice.h"
#include "geometry/point.h"

namespace watertight {

struct AxisUnits {
  std::array<double, 3> metres_per_unit{1, 1, 1};
  std::string note;  // non-empty when something was assumed, e.g. "no CRS stated: metres assumed"
};

/// Units of the axes of EPSG code `srid` at the centre of `box` (world coordinates). Unknown and
/// unstated systems count as metres, with a note. A geographic code over coordinates that cannot
/// be degrees (|value| above 360 in an axis that should be an angle) counts as metres, with a note.
AxisUnits axis_units(std::uint32_t srid, const std::array<double, 3>& centre);

}  // namespace watertight
