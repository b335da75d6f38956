// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: G. H. Golub and C. F. Van Loan, Matrix Computations, section 8.5 (cyclic Jacobi).
#include "geometry/fitted_plane.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace watertight::geometry {
namespace {

using Triple = std::array<double, 3>;

template <class Real>
using VectorOf = std::array<Real, 3>;
template <class Real>
using MatrixOf = std::array<VectorOf<Real>, 3>;

constexpr unsigned kBits = 512;
/// Cyclic Jacobi converges quadratically: 3 x 3 matrices need 5 to 8 sweeps in doubles, 4 more in
/// 512 bits.
constexpr int kMostSweeps = 40;
/// Doubles are enough where the bound of the rounding error is at most kSafeShare of the difference
/// between the result and the limit and, for a result beyond the limit, at most kDigitsShare of the
/// result.
constexpr double kSafeShare = 1e-3;
constexpr double kDigitsShare = 1e-6;

double square_root(double x) { return std::sqrt(x); }
mpf_class square_root(const mpf_class& x) { return sqrt(x); }
double magnitude(double x) { return std::fabs(x); }
mpf_class magnitude(const mpf_class& x) { return abs(x); }
template <class Real>
Real number(double x);
template <>
double number<double>(double x) {
  return x;
}
template <>
mpf_class number<mpf_class>(double x) {
  return mpf_class(x, kBits);
}

/// An off-diagonal element at or below this share of the trace is zero.
template <class Real>
Real negligible(const MatrixOf<Real>& m);
template <>
double negligible<double>(const MatrixOf<double>&) {
  return 0;
}
template <>
mpf_class negligible<mpf_class>(const MatrixOf<mpf_class>& m) {
  mpf_class share = m[0][0] + m[1][1] + m[2][2];
  mpf_div_2exp(share.get_mpf_t(), share.get_mpf_t(), kBits - 64);
  return share;
}

/// Rotates the matrix so that m[p][q] becomes zero, and applies the rotation to the vectors. The
/// tangent of twice the angle is 1 / theta.
template <class Real>
void rotate(MatrixOf<Real>& m, MatrixOf<Real>& vectors, std::size_t p, std::size_t q,
            const Real& zero) {
  if (magnitude(m[p][q]) <= zero) return;
  const Real theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const Real sign = number<Real>(theta >= 0 ? 1.0 : -1.0);
  const Real root = square_root(Real(theta * theta + 1));
  const Real t = sign / (magnitude(theta) + root);
  const Real c = 1 / square_root(Real(t * t + 1));
  const Real s = t * c;
  const auto turn = [&](Real& first, Real& second) {
    const Real a = first;
    const Real b = second;
    first = c * a - s * b;
    second = s * a + c * b;
  };
  for (std::size_t k = 0; k < 3; ++k) turn(m[k][p], m[k][q]);
  for (std::size_t k = 0; k < 3; ++k) turn(m[p][k], m[q][k]);
  for (std::size_t k = 0; k < 3; ++k) turn(vectors[k][p], vectors[k][q]);
}

/// The plane fitted to points.
template <class Real>
struct FittedPlane {
  VectorOf<Real> mean;
  VectorOf<Real> normal;
  VectorOf<Real> eigenvalues;  // the eigenvalues of the covariance, ascending
};

template <class Real>
VectorOf<Real> zeros() {
  return {number<Real>(0), number<Real>(0), number<Real>(0)};
}

template <class Real>
VectorOf<Real> difference(const Triple& p, const VectorOf<Real>& mean) {
  VectorOf<Real> d = zeros<Real>();
  for (std::size_t i = 0; i < 3; ++i) d[i] = number<Real>(p[i]) - mean[i];
  return d;
}

template <class Real>
MatrixOf<Real> covariance(std::span<const Triple> points, const VectorOf<Real>& mean) {
  MatrixOf<Real> m{zeros<Real>(), zeros<Real>(), zeros<Real>()};
  for (const Triple& p : points) {
    const VectorOf<Real> d = difference(p, mean);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) m[i][j] += d[i] * d[j];
    }
  }
  return m;
}

template <class Real>
FittedPlane<Real> fit(std::span<const Triple> points) {
  FittedPlane<Real> plane{zeros<Real>(), zeros<Real>(), zeros<Real>()};
  for (const Triple& p : points) {
    for (std::size_t i = 0; i < 3; ++i) plane.mean[i] += number<Real>(p[i]);
  }
  for (Real& component : plane.mean) component /= number<Real>(static_cast<double>(points.size()));
  MatrixOf<Real> m = covariance(points, plane.mean);
  const Real zero = negligible<Real>(m);
  MatrixOf<Real> vectors{zeros<Real>(), zeros<Real>(), zeros<Real>()};
  for (std::size_t i = 0; i < 3; ++i) vectors[i][i] = number<Real>(1);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    if (magnitude(m[0][1]) <= zero && magnitude(m[0][2]) <= zero && magnitude(m[1][2]) <= zero) {
      break;
    }
    rotate(m, vectors, 0, 1, zero);
    rotate(m, vectors, 0, 2, zero);
    rotate(m, vectors, 1, 2, zero);
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return m[a][a] < m[b][b]; });
  for (std::size_t i = 0; i < 3; ++i) plane.eigenvalues[i] = m[order[i]][order[i]];
  Real length = number<Real>(0);
  for (std::size_t i = 0; i < 3; ++i) {
    plane.normal[i] = vectors[i][order[0]];
    length += plane.normal[i] * plane.normal[i];
  }
  length = square_root(length);
  for (Real& component : plane.normal) component /= length;
  return plane;
}

double rounded(double x) { return x; }
double rounded(const mpf_class& x) { return x.get_d(); }

template <class Real>
PlaneDistance largest_distance(std::span<const Triple> points, const FittedPlane<Real>& plane) {
  PlaneDistance result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VectorOf<Real> d = difference(points[i], plane.mean);
    const Real height = d[0] * plane.normal[0] + d[1] * plane.normal[1] + d[2] * plane.normal[2];
    const double distance = rounded(Real(magnitude(height)));
    if (distance > result.distance) result = {distance, i};
  }
  return result;
}

/// A bound of the rounding error of a distance, for points at most 1 from the first one along each
/// axis: the covariance is wrong by at most e = 8 (n + 8) units of rounding of its largest
/// eigenvalue, which turns the normal by at most 4 e / (gap of the two smallest eigenvalues).
double rounding(const FittedPlane<double>& plane, std::size_t count) {
  const double unit = 8 * (static_cast<double>(count) + 8) * 0x1p-53;
  const double gap = plane.eigenvalues[1] - plane.eigenvalues[0];
  return gap > 0 ? 4 * (unit + unit * 4 * plane.eigenvalues[2] / gap) : HUGE_VAL;
}

}  // namespace

PlaneDistance distance_to_fitted_plane(std::span<const Triple> points, double limit) {
  if (points.size() < 4) return {};
  double largest = 0;
  for (const Triple& p : points) {
    for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, std::fabs(p[i] - points[0][i]));
  }
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  const int exponent = std::ilogb(largest) + 1;
  // The scale is applied as two factors, since it may exceed the range of doubles. Both factors are
  // powers of two, so nothing is rounded.
  const double factor = std::ldexp(1.0, -exponent / 2);
  const double rest = std::ldexp(1.0, -exponent - -exponent / 2);
  std::vector<Triple> scaled(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      scaled[k][i] = (points[k][i] - points[0][i]) * factor * rest;
    }
  }
  const FittedPlane<double> plane = fit<double>(scaled);
  PlaneDistance result = largest_distance(scaled, plane);
  const double error = rounding(plane, points.size());
  const double scaled_limit = std::ldexp(limit, -exponent);
  const bool is_known =
      error <= kSafeShare * std::fabs(result.distance - scaled_limit) &&
      (result.distance <= scaled_limit || error <= kDigitsShare * result.distance);
  if (!is_known) result = largest_distance(scaled, fit<mpf_class>(scaled));
  result.distance = std::ldexp(result.distance, exponent);
  return result;
}

}  // namespace watertight::geometry
