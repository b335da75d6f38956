// SPDX-License-Identifier: GPL-3.0-or-later
//
// The surface over a domain that comes nearest to given points: the old region of a hole that is to
// be filled, where it is known by points only.
#pragma once

#include <span>
#include <vector>

#include "base/result.h"
#include "spline/dms_domain.h"

namespace watertight::spline {

/// A point in space for a place of the domain.
struct FitPoint {
  Index triangle = 0;  // has u inside or, but for rounding, on its border
  Point u;
  Point value;
};

struct FittedSurface {
  std::vector<Point> coefficients;
  double condition = 0;         // estimate, in the 1-norm, for the matrix of the normal equations
  double largest_distance = 0;  // of the surface from a given point
};

/// The coefficients with the least sum of squared distances. Errors: malformed if a triangle is not
/// there, or if the points do not determine the surface (condition above kMostCondition): each
/// triangle needs as many points as it has functions, well spread. Cost: that of a sparse Cholesky
/// factorization.
Result<FittedSurface> fit_surface(const DmsDomain& domain, std::span<const FitPoint> points);

}  // namespace watertight::spline
