// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures how far points are from the plane fitted through them by least squares. Only tolerance
// rules use the result. For validate/.
#pragma once

#include <array>
#include <span>

namespace watertight::geometry {

struct PlaneDistance {
  double distance = 0;    // the largest distance of a point from the plane, in the points' unit
  std::size_t point = 0;  // the index of the first point with that distance
};

/// The largest distance of a point from the plane fitted to all points. The plane passes through
/// the mean of the points, and its normal makes the sum of the squared distances least (total least
/// squares: the normal is the eigenvector of the smallest eigenvalue of the covariance, by cyclic
/// Jacobi rotations). Points that are listed twice count twice.
///
/// The distance is computed in doubles where a bound of the rounding error is far below the
/// difference between the result and `limit`, and far below a result beyond `limit`; else in
/// 512-bit arithmetic. No size of coordinates underflows or overflows before the result does. Every
/// machine computes the same doubles. Fewer than 4 points have distance 0. Requires finite points.
/// Cost: linear; some 0.2 ms where doubles do not suffice.
PlaneDistance distance_to_fitted_plane(std::span<const std::array<double, 3>> points, double limit);

}  // namespace watertight::geometry
