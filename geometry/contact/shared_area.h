// SPDX-License-Identifier: GPL-3.0-or-later
//
// The area in which two solids stand wall to wall (party walls).
#pragma once

#include "base/cancel.h"
#include "geometry/contact/surface.h"

namespace watertight::geometry {

/// The largest angle in degrees between facing walls that count as parallel, where a tolerance is
/// stated.
inline constexpr double kMostAngleOfWalls = 10;

/// The area in world units squared where the boundaries of two solids face each other.
///
/// With a tolerance of 0: the area that facets in exactly the same plane, on different sides of it,
/// have in common. Every decision is exact, and the area is the exact one but for its last
/// rounding.
///
/// With a tolerance in world units: the area where triangles that face each other, parallel to
/// kMostAngleOfWalls, are at most the tolerance (its shortest decimal) apart, measured at right
/// angles to them. The area
/// is seen along the axis on which both stand most upright, and counted in the mean of both planes.
/// Layers closer to each other than the tolerance count once each.
///
/// Both solids are in one reference system. The order of the solids does not matter. Requires a
/// finite tolerance of 0 or more. A cancelled call gives a number without meaning. Cost: that of
/// visit_near_pairs(); some 50 microseconds for two triangles that share area.
double shared_area(const Surface& one, const Surface& other, double tolerance,
                   const CancelPoll& is_cancelled = {});

}  // namespace watertight::geometry
