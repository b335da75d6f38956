// SPDX-License-Identifier: GPL-3.0-or-later
//
// Polynomials as surfaces over a triangulation: their coefficients are values of their blossom.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 2.2 (there without the formula).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "spline/dms_domain.h"

namespace watertight::spline {

/// The polynomial sum c[a][b] x^a y^b over a + b <= kMostDegree.
struct Polynomial {
  std::array<std::array<double, kMostDegree + 1>, kMostDegree + 1> c{};

  double value(const Point& u) const;
};

/// The blossom of a polynomial at as many points as the degree that it is taken for: symmetric,
/// affine in each point, and the polynomial where all are equal. Terms of a higher degree must be
/// 0.
double blossom(const Polynomial& polynomial, std::span<const Point> points);

/// The coefficients with which the functions of a domain sum up to a polynomial whose degree is at
/// most the domain's.
std::vector<double> polynomial_coefficients(const DmsDomain& domain, const Polynomial& polynomial);

}  // namespace watertight::spline
