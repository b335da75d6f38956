// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coefficients that bend a surface the least over a part of its domain while the rest keeps its
// own.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 4: the least integral of F_xx^2 + 2 F_xy^2 + F_yy^2. For degree 2 it is
// exact, as the second derivatives are constant on pieces.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/result.h"
#include "spline/dms_domain.h"

namespace watertight::spline {

struct ThinPlate {
  std::vector<Point> coefficients;  // of all functions; those of old ones are as given
  std::size_t unknowns = 0;         // functions that got a coefficient
  std::size_t old_functions = 0;    // of those with a coefficient: that reach into the hole
  double energy = 0;                // of all three coordinates over the hole
  double condition = 0;  // estimate, in the 1-norm, for the matrix with a diagonal near 1
};

/// `hole` lists the triangles, in ascending order, whose functions get new coefficients; the energy
/// is that over these triangles. `coefficients` has a place for each function of the domain; those
/// of the hole's functions are not read. Errors: unsupported for other degrees than 2, malformed
/// where no function reaches the hole from outside or the condition is above kMostCondition (the
/// border does not hold the surface). Cost: that of a sparse Cholesky factorization, and for each
/// triangle the square of the knot triangles that meet it.
Result<ThinPlate> least_thin_plate(const DmsDomain& domain, std::span<const Index> hole,
                                   std::vector<Point> coefficients);

inline constexpr double kMostCondition = 1e12;

/// The energy of a surface over triangles of its domain. Degree 2 only.
double thin_plate_energy(const DmsDomain& domain, std::span<const Index> triangles,
                         std::span<const Point> coefficients);

}  // namespace watertight::spline
