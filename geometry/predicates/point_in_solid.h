// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes points inside a triangle, and decides exactly whether such a point lies inside a closed
// surface. Comparisons of several solids need this for a triangle whose corners all touch another
// solid.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "geometry/point.h"

namespace watertight::geometry {

/// The point (w0 a + w1 b + w2 c) / 2^exponent of a triangle. Requires positive weights that sum to
/// 2^exponent, exponent <= 52.
struct TrianglePoint {
  std::array<Point, 3> corners;
  std::array<std::uint64_t, 3> weights{1, 1, 2};
  int exponent = 2;
};

/// Point `number` of those that an exponent gives inside a triangle: the points (i, i^2) of a
/// parabola. No three points of one exponent are on one line, so a segment in the plane of the
/// triangle meets at most two of them. Requires 1 <= number <= triangle_points(exponent).
TrianglePoint triangle_point(const std::array<Point, 3>& corners, int exponent,
                             std::uint64_t number);
/// The number of points that triangle_point() gives for an exponent.
std::uint64_t triangle_points(int exponent);

/// The point as doubles if these hold it exactly and a quick test shows this: the corners are
/// integers that are not too large, as on nearly every lattice. Else nothing.
std::optional<Point> exact_doubles(const TrianglePoint& point);

/// +1 if the point is inside the closed surface, 0 if on the surface, -1 if outside. Computed in
/// rational numbers, for points that doubles do not hold. Requires that every edge of the surface
/// belongs to an even number of triangles. Cost: linear; a microsecond and more for each triangle
/// above or below the point.
int locate_exactly(const TrianglePoint& point, std::span<const Point> vertices,
                   std::span<const Triangle> triangles);

}  // namespace watertight::geometry
