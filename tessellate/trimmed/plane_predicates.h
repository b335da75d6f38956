// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact decisions about points of the (u, v) plane, which are points with z = 0. Internal to
// tessellate/trimmed/.
#pragma once

#include <cmath>

#include "geometry/point.h"
#include "geometry/predicates/predicates.h"

namespace watertight::tessellate {

/// The sign of the turn a, b, c: +1 is a left turn. Exact for finite doubles.
inline int turn(const Point& a, const Point& b, const Point& c) {
  constexpr double kError = 16.0 / 9007199254740992.0;  // more than the roundings below can cause
  constexpr double kSmall = 1e-200;                     // more than underflow can cause
  constexpr double kLarge = 1e300;
  const double left = (b.x - a.x) * (c.y - a.y);
  const double right = (b.y - a.y) * (c.x - a.x);
  const double value = left - right;
  const double size = std::abs(left) + std::abs(right);
  if (std::abs(value) > kError * size + kSmall && size < kLarge) return value > 0 ? 1 : -1;
  return geometry::orient2d(a, b, c, 2);
}

/// The order of the sweep: by v, and by u among points of equal v, as if the plane were turned a
/// little.
inline bool is_below(const Point& a, const Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// +1 if d lies inside the circle through a, b and c, which turn left; -1 if outside, 0 if on it.
/// Exact for finite doubles.
int side_of_circle(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace watertight::tessellate
