// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points whose coordinates are rational numbers. Private to geometry/.
#pragma once

#include <gmpxx.h>

#include <array>
#include <span>

#include "geometry/point.h"

namespace watertight::geometry {

using RationalPoint = std::array<mpq_class, 3>;

/// +1 if the point is inside the closed surface, 0 if on the surface, -1 if outside, as for
/// locate_exactly() of a point of a triangle.
int locate_rational(const RationalPoint& point, std::span<const Point> vertices,
                    std::span<const Triangle> triangles);

}  // namespace watertight::geometry
