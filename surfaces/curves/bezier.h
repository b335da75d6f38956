// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rational Bezier curves and patches: points, derivatives, parts, and bounds that hold for every
// parameter. Sums and products are rounded in the order written here, so that every machine
// computes the same. For all files of this folder.
//
// Source: G. Farin, Curves and Surfaces for CAGD: de Casteljau's algorithm, rational curves.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/vector3.h"

namespace watertight::surfaces {

using geometry::cross;
using geometry::dot;
using geometry::length;
using geometry::Vector3;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;

/// A control point (x, y, z) with weight w, as (w x, w y, w z, w).
struct WeightedPoint {
  Vector3 moment{};
  double weight = 1;
  Vector3 place() const { return moment * (1 / weight); }
};
WeightedPoint weighted(const Vector3& place, double weight);
/// a + t (b - a).
inline WeightedPoint between(const WeightedPoint& a, const WeightedPoint& b, double t) {
  return {a.moment + (b.moment - a.moment) * t, a.weight + (b.weight - a.weight) * t};
}

/// A curve over [0, 1]. Requires a control point and positive weights.
struct BezierCurve {
  std::vector<WeightedPoint> points;
  std::size_t degree() const { return points.size() - 1; }
};

struct CurvePoint {
  Vector3 place{};
  Vector3 derivative{};
};
/// The point at a parameter, also outside [0, 1]. Cost: quadratic in the degree.
CurvePoint point_at(const BezierCurve& curve, double t);

/// The part of a curve over [from, to], as a curve over [0, 1].
BezierCurve part_of(const BezierCurve& curve, double from, double to);

/// A bound of the distance between the curve and the segment of its ends. The curve is in the hull
/// of its control points; the bound counts how much of an inner one it can reach.
double chord_error_bound(const BezierCurve& curve);

/// A patch over [0, 1] x [0, 1]; control point (i, k) is points[k * columns + i], with i along u.
struct BezierPatch {
  std::size_t columns = 0;  // degree along u, plus 1
  std::vector<WeightedPoint> points;
  std::size_t rows() const { return points.size() / columns; }
};

struct SurfacePoint {
  Vector3 place{};
  Vector3 along_u{};  // the derivative by u
  Vector3 along_v{};
};
/// The point at (u, v), also outside the square. Cost: cubic in the degree.
SurfacePoint point_at(const BezierPatch& patch, double u, double v);

/// Bounds of the lengths of the second derivatives over the whole patch.
struct SecondDerivatives {
  double uu = 0;
  double uv = 0;
  double vv = 0;
};
SecondDerivatives second_derivatives(const BezierPatch& patch);

/// The patch over a part of the square, as a patch over the square.
BezierPatch part_of(const BezierPatch& patch, double from_u, double to_u, double from_v,
                    double to_v);

}  // namespace watertight::surfaces
