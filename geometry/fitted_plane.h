// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far points are from the plane fitted through them by least squares. A measurement, in the
// unit of the points: it decides nothing but tolerance rules. For validate.
#pragma once

#include <array>
#include <span>

namespace watertight::geometry {

struct PlaneDistance {
  double distance = 0;    // the largest distance of a point from the plane
  std::size_t point = 0;  // which point: the first with that distance
};

/// The plane passes through the mean of the points, and its normal is the direction in which the
/// sum of their squared distances to it is least (total least squares: the eigenvector of the
/// smallest eigenvalue of the covariance, by cyclic Jacobi rotations). Points that are listed
/// twice count twice.
///
/// Computed in doubles where a bound of their rounding is far below the distance of the result
/// from `limit`, and far below a result beyond it; else in 512-bit arithmetic. No size of
/// coordinates underflows or overflows before the result does. The same doubles on every machine.
/// Fewer than 4 points are on their plane. Requires finite points. Cost: linear; some 0.2 ms where
/// doubles do not suffice.
PlaneDistance distance_to_fitted_plane(std::span<const std::array<double, 3>> points, double limit);

}  // namespace watertight::geometry
