// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points that lie on an edge exactly, and lengths. Private to delaunay/.
#pragma once

#include <array>
#include <optional>

#include "geometry/point.h"

namespace watertight::delaunay {

/// A point on the segment from p to q whose place (0 at p, 1 at q) is the fraction of a power of
/// two with the fewest bits that is well within two places and that doubles hold. If there is none,
/// the middle of the segment; none if doubles do not hold this one either.
std::optional<Point> point_between(const Point& p, const Point& q,
                                   const std::array<double, 2>& places);

/// Rounded.
double squared_distance(const Point& p, const Point& q);

}  // namespace watertight::delaunay
