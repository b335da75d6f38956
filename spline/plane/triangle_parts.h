// SPDX-License-Identifier: GPL-3.0-or-later
//
// The 16 equal parts into which lines along its edges divide a triangle. Internal to spline/.
#pragma once

#include <array>
#include <cstddef>

#include "spline/simplex_spline.h"

namespace watertight::spline {

inline constexpr std::size_t kPartsAlongEdge = 4;
inline constexpr std::size_t kParts = kPartsAlongEdge * kPartsAlongEdge;

/// The number of the part that has a point of the triangle; rounding may choose a neighbour, whose
/// part_corners have the point too.
std::size_t part_of(const std::array<Point, 3>& corners, const Point& u);

/// The corners of a part, which turn as the triangle does, a little outside of it.
std::array<Point, 3> part_corners(const std::array<Point, 3>& corners, std::size_t part);

}  // namespace watertight::spline
