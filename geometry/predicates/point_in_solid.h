// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points inside a triangle, and whether such a point lies inside a closed surface, exactly. For
// comparisons of several solids: where a triangle whose corners all touch another solid lies.
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

/// Points inside the triangle of which no three are on one line for one exponent, so that a segment
/// in its plane meets at most two of the `count` points of that exponent: the points (i, i^2) of a
/// parabola. Requires 1 <= number <= triangle_points(exponent).
TrianglePoint triangle_point(const std::array<Point, 3>& corners, int exponent,
                             std::uint64_t number);
std::uint64_t triangle_points(int exponent);

/// The point as doubles if they hold it exactly and a quick test shows this (integers that are not
/// too large, as on nearly every lattice).
std::optional<Point> exact_doubles(const TrianglePoint& point);

/// +1 if the point is inside the closed surface, 0 if it is on it, -1 outside. In rationals: for
/// points that are no doubles. Requires every edge of the surface to be met an even number of
/// times. Cost: linear; a microsecond and more for each triangle above or below the point.
int locate_exactly(const TrianglePoint& point, std::span<const Point> vertices,
                   std::span<const Triangle> triangles);

}  // namespace watertight::geometry
