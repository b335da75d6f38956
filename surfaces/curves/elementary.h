// SPDX-License-Identifier: GPL-3.0-or-later
//
// The curves and surfaces that files name by radius and axis, as rational Bezier pieces: exactly,
// and without sines, so that every machine computes the same. A full turn is four pieces over
// [0, 4].
#pragma once

#include <vector>

#include "surfaces/curves/pieces.h"

namespace watertight::surfaces {

/// A right-handed frame of unit vectors.
struct Frame {
  Vector3 origin{};
  Vector3 x{1, 0, 0};
  Vector3 y{0, 1, 0};
  Vector3 z{0, 0, 1};
};
/// The frame with this axis z; x is the part of `reference` across it, or of another vector if
/// they are parallel.
Frame frame_of(const Vector3& origin, const Vector3& axis, const Vector3& reference);
/// The map from coordinates in a frame to those around it.
Affine affine_of(const Frame& frame);

/// Lines through all points in turn. Requires two points.
Curve polyline(const std::vector<Vector3>& points);
/// The ellipse with these radii along x and y, from x to y.
Curve ellipse(const Frame& frame, double radius_x, double radius_y);
/// The part from one parameter to another, up the curve; on a closed curve `to` may be less. The
/// whole of a closed curve if they are equal.
Curve part_of(const Curve& curve, double from, double to);
Curve reversed(const Curve& curve);

/// A curve turned around the axis z of a frame: u goes around, v along the curve.
Surface revolved(const Curve& curve, const Frame& frame);
/// A curve moved along a vector: u goes along the curve, v along the vector, endlessly.
Surface extruded(const Curve& curve, const Vector3& direction);

Surface cylinder(const Frame& frame, double radius);
/// The cone with a radius in the plane z = 0 that grows by `slope` with z: v from the tip upwards.
/// Requires a positive slope.
Surface cone(const Frame& frame, double radius, double slope);
Surface sphere(const Frame& frame, double radius);
Surface torus(const Frame& frame, double major, double minor);

/// The tangent of an angle in radians, within [0, pi / 2), with the same bits everywhere.
double tangent(double angle);

}  // namespace watertight::surfaces
