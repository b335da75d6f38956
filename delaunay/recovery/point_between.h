// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points that lie on an edge exactly, and lengths. Private to delaunay/.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/point.h"

namespace watertight::delaunay {

/// A point of a segment at a place: 0 at its first end, 1 at its second.
struct PlacedPoint {
  Point point;
  double place = 0;
  friend bool operator==(const PlacedPoint&, const PlacedPoint&) = default;
};

/// The point of the segment from p to q at a place; none if doubles do not hold it.
std::optional<PlacedPoint> point_at(const Point& p, const Point& q, double place);

/// The point at the place that is the fraction of a power of two with the fewest bits, at most 40,
/// that is well within two places and at which doubles hold the point; none if there is none.
std::optional<PlacedPoint> point_between(const Point& p, const Point& q,
                                         const std::array<double, 2>& places);

/// The centre of a tetrahedron, rounded: by additions and divisions by 4 only.
Point centre_of(const std::vector<Point>& points, const geometry::Tetrahedron& tetrahedron);

/// Rounded.
double squared_distance(const Point& p, const Point& q);

}  // namespace watertight::delaunay
