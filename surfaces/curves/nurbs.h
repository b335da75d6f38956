// SPDX-License-Identifier: GPL-3.0-or-later
//
// B-spline curves and surfaces with knots and weights, as rational Bezier pieces.
//
// Source: L. Ramshaw, Blossoms are polar forms, 1989: a control point of a piece is the blossom of
// the piece's ends.
#pragma once

#include <cstddef>
#include <vector>

#include "base/result.h"
#include "surfaces/curves/pieces.h"

namespace watertight::surfaces {

inline constexpr std::size_t kMostDegree = 30;

/// Knots with multiplicities written out: degree + 1 + number of control points of them.
struct Knots {
  std::size_t degree = 0;
  std::vector<double> values;
};

/// The curve of a B-spline. A curve whose ends are one point is closed. Errors: malformed for
/// knots that decrease or are too few or too many, an inner knot more often than the degree, a
/// weight that is not positive, a number that is not finite; limit_exceeded for a degree above
/// kMostDegree.
Result<Curve> curve_of(const Knots& knots, const std::vector<Vector3>& points,
                       const std::vector<double>& weights);

/// The surface of a B-spline with control point (i, k) at points[k * columns + i], i along u.
/// Errors: as curve_of().
Result<Surface> surface_of(const Knots& u, const Knots& v, const std::vector<Vector3>& points,
                           const std::vector<double>& weights);

}  // namespace watertight::surfaces
