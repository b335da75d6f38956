// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact decisions about points of the (u, v) plane, which are points with z = 0. Internal to
// tessellate/trimmed/.
#pragma once

#include "geometry/point.h"
#include "geometry/predicates/turn.h"

namespace watertight::tessellate {

using geometry::turn;

/// The order of the sweep: by v, and by u among points of equal v, as if the plane were turned a
/// little.
inline bool is_below(const Point& a, const Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// +1 if d lies inside the circle through a, b and c, which turn left; -1 if outside, 0 if on it.
/// Exact for finite doubles.
int side_of_circle(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace watertight::tessellate
