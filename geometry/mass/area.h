// SPDX-License-Identifier: GPL-3.0-or-later
//
// Areas of triangles as sums of square roots, rounded once.
#pragma once

#include <span>

#include "geometry/solid.h"

namespace watertight::geometry {

/// The area of triangles of a solid in world units squared: the exact sum, rounded once to the
/// nearest double. Cost: linear, a tenth of a microsecond a triangle; where pairs of doubles do not
/// decide the rounding, or do not hold the coordinates, some microseconds a triangle.
double area_of(const Solid& solid, std::span<const Triangle> triangles);

}  // namespace watertight::geometry
