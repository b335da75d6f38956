// SPDX-License-Identifier: GPL-3.0-or-later
//
// The exact turn of three points of a plane, with a filter that callers compile into their loops.
// Points of a plane are points with z = 0.
#pragma once

#include <cmath>

#include "geometry/predicates/predicates.h"

namespace watertight::geometry {

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
  return orient2d(a, b, c, 2);
}

}  // namespace watertight::geometry
