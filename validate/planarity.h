// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far points are from a plane: measured in doubles, in metres, never deciding anything but the
// tolerance rules 203 and 204; and whether they are in one plane, exactly. Internal to validate/.
#pragma once

#include <array>
#include <span>

#include "geometry/point.h"

namespace watertight {

/// Exact for any finite doubles; much faster than orient3d() where the answer is yes and the
/// coordinates are integers. Requires four different points.
bool are_coplanar(const Point& a, const Point& b, const Point& c, const Point& d);

using Vector = std::array<double, 3>;

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Zero stays zero.
Vector unit(const Vector& v);

struct PlaneDistance {
  double metres = 0;      // the largest distance of a point from the plane
  std::size_t point = 0;  // which point
};

/// The least-squares plane through the points (total least squares: the eigenvector of the
/// smallest eigenvalue of the covariance, by cyclic Jacobi rotations).
PlaneDistance distance_to_fitted_plane(std::span<const Vector> points);

/// The plane through the points' mean with the given normal.
PlaneDistance distance_to_plane(std::span<const Vector> points, const Vector& normal);

}  // namespace watertight
