// SPDX-License-Identifier: GPL-3.0-or-later
//
// Areas of triangles as sums of square roots, rounded once.
#pragma once

#include <span>

#include "geometry/solid.h"

namespace watertight::geometry {

/// The area of triangles of a solid in world units squared: the exact sum, rounded once to the
/// nearest double. Cost: linear, some tens of nanoseconds a triangle; a sum within 2^-100 of its
/// size from where the rounding changes, and lattices with unlike steps or large numbers, take
/// microseconds a triangle.
double area_of(const Solid& solid, std::span<const Triangle> triangles);

}  // namespace watertight::geometry
