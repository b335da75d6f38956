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

/// The coefficients with the least sum of squared distances and `stiffness` (an area of the
/// parameter plane) times the energy of thin_plate.h over the whole domain. With a stiffness above
/// 0, degree 2 only, three points not on a line determine the surface; without, each triangle needs
/// as many points as it has functions, well spread. Errors: malformed if a triangle is not there,
/// or if the points do not determine the surface (condition above kMostCondition); unsupported for
/// a stiffness with another degree. Cost: that of a sparse Cholesky factorization.
Result<FittedSurface> fit_surface(const DmsDomain& domain, std::span<const FitPoint> points,
                                  double stiffness = 0);

}  // namespace watertight::spline
