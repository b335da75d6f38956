// SPDX-License-Identifier: GPL-3.0-or-later
//
// Facts about coordinate reference systems: the metres per unit of their axes (for tolerances and
// measures only), which systems are geographic, and which put latitude first.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "geometry/lattice/lattice.h"
#include "geometry/point.h"

namespace watertight::geometry {

struct AxisUnits {
  std::array<double, 3> metres_per_unit{1, 1, 1};
  std::string note;  // the assumptions, e.g. "no CRS stated: metres assumed"; "" if there are none
};

/// Units of the axes of EPSG code `srid` at the centre of a box (world coordinates), from a table
/// of all codes of the EPSG data set (crs_table.cpp). Unknown and unstated systems count as metres,
/// with a note. For a geographic system the units are metres per degree (or grad) on the WGS 84
/// ellipsoid at the centre; x is longitude, as in most files whatever the authority's order, unless
/// y is beyond 90 degrees and x is not. A geographic code with coordinates that cannot be angles
/// (beyond a full turn) counts as metres, with a note. Cost: logarithmic.
AxisUnits axis_units(std::uint32_t srid, const std::array<double, 3>& centre);

/// The largest coordinate of a geographic system that can be an angle: a full turn, 360 (degrees)
/// or 400 (grads). 0 for other systems and for unknown codes. Cost: logarithmic.
double largest_angle(std::uint32_t srid);

/// The angle of the pole, 90 (degrees) or 100 (grads), for systems whose first axis is latitude by
/// the authority's definition. 0 for other systems, among them the geographic ones of France that
/// EPSG names "(lon-lat)", and for unknown codes. Cost: logarithmic.
double pole_of_first_axis(std::uint32_t srid);

}  // namespace watertight::geometry
