// SPDX-License-Identifier: GPL-3.0-or-later
//
// The predicates of predicates.h, inlined for the inner loops of this folder's sources. Private to
// geometry/ (it includes CGAL).
//
// Based on: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates, 1997 (the first stage). Departures: calls that the filter does not decide are decided
// in 128-bit integers where the coordinates allow it, as on nearly every lattice, and else by CGAL.
// So an exact zero, the everyday case of planar facets, costs nanoseconds.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "geometry/point.h"

namespace watertight::geometry {

struct InlinePredicates {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  __extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)

  static int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
    const Point u = difference(b, a);
    const Point v = difference(c, a);
    const Point w = difference(d, a);
    const double yz = u.y * v.z;
    const double zy = u.z * v.y;
    const double zx = u.z * v.x;
    const double xz = u.x * v.z;
    const double xy = u.x * v.y;
    const double yx = u.y * v.x;
    const double value = w.x * (yz - zy) + w.y * (zx - xz) + w.z * (xy - yx);
    const double size = std::abs(w.x) * (std::abs(yz) + std::abs(zy)) +
                        std::abs(w.y) * (std::abs(zx) + std::abs(xz)) +
                        std::abs(w.z) * (std::abs(xy) + std::abs(yx));
    const double factor = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
    if (const int sign = certain_sign(value, size, factor)) return sign;
    return exact_orient3d(a, b, c, d);
  }

  static int orient2d(const Point& a, const Point& b, const Point& c, int axis) {
    const int first = axis == 2 ? 0 : axis + 1;
    const int second = axis == 0 ? 2 : axis == 1 ? 0 : 1;
    const double left = (b[first] - a[first]) * (c[second] - a[second]);
    const double right = (b[second] - a[second]) * (c[first] - a[first]);
    const double size = std::abs(left) + std::abs(right);
    if (const int sign = certain_sign(left - right, size, 1)) return sign;
    return exact_orient2d({a[first], a[second]}, {b[first], b[second]}, {c[first], c[second]});
  }

  /// A bound of the rounding error, relative to the sum of the magnitudes of the terms. A term
  /// passes through at most 8 roundings of 2^-53, the sum of the magnitudes through a few more; the
  /// bound allows for 16.
  static constexpr double kRelativeError = 16.0 / 9007199254740992.0;
  /// More than a product can lose by underflow (2^-1075).
  static constexpr double kUnderflow = 1e-200;

  static Point difference(const Point& p, const Point& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
  }

  template <class Number>
  static int sign_of(Number value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
  }

  /// True if p and q are integers whose difference is exact and below `longest` in magnitude.
  static bool has_short_difference(double p, double q, double longest = kLongest) {
    constexpr double kEnd = 4503599627370496.0;  // 2^52
    return std::abs(p) < kEnd && std::abs(q) < kEnd && std::abs(p - q) < longest &&
           static_cast<double>(static_cast<std::int64_t>(p)) == p &&
           static_cast<double>(static_cast<std::int64_t>(q)) == q;
  }

 private:
  static constexpr double kLongest = 1099511627776.0;  // 2^40

  /// The sign of `value` if rounding cannot have changed it, else 0. `factor` is the size of the
  /// numbers by which products of differences are multiplied.
  static int certain_sign(double value, double size, double factor) {
    constexpr double kLargest = 1e300;  // a bound of numbers that have not overflowed
    const double error = kRelativeError * size + kUnderflow * factor + kUnderflow;
    if (!(size < kLargest)) return 0;
    return value > error ? 1 : value < -error ? -1 : 0;
  }

  using Rows = std::array<std::array<std::int64_t, 3>, 3>;

  template <class Integer>
  static int determinant_sign(const Rows& rows) {
    const auto at = [&](std::size_t i, std::size_t k) { return static_cast<Integer>(rows[i][k]); };
    return sign_of(at(2, 0) * (at(0, 1) * at(1, 2) - at(0, 2) * at(1, 1)) +
                   at(2, 1) * (at(0, 2) * at(1, 0) - at(0, 0) * at(1, 2)) +
                   at(2, 2) * (at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0)));
  }

  static int exact_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
    Rows rows{};
    std::int64_t largest = 0;
    const std::array<const Point*, 3> others{&b, &c, &d};
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double p = (*others[i])[axis];
        if (!has_short_difference(p, a[axis])) return cgal_orient3d(a, b, c, d);
        const auto value = static_cast<std::int64_t>(p - a[axis]);
        rows[i][static_cast<std::size_t>(axis)] = value;
        largest = std::max(largest, std::abs(value));
      }
    }
    // The determinant has six terms, products of three differences: each term is below 2^60 if the
    // differences are below 2^20, and below 2^120 in any case.
    constexpr std::int64_t kSmall = std::int64_t{1} << 20U;
    return largest < kSmall ? determinant_sign<std::int64_t>(rows) : determinant_sign<Wide>(rows);
  }

  static int exact_orient2d(const std::array<double, 2>& a, const std::array<double, 2>& b,
                            const std::array<double, 2>& c) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (!has_short_difference(b[i], a[i]) || !has_short_difference(c[i], a[i])) {
        return CGAL::orientation(Kernel::Point_2(a[0], a[1]), Kernel::Point_2(b[0], b[1]),
                                 Kernel::Point_2(c[0], c[1]));
      }
    }
    const auto whole = [](double value) { return Wide{static_cast<std::int64_t>(value)}; };
    return sign_of(whole(b[0] - a[0]) * whole(c[1] - a[1]) -
                   whole(b[1] - a[1]) * whole(c[0] - a[0]));
  }

  static int cgal_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
    const auto in_space = [](const Point& p) { return Kernel::Point_3(p.x, p.y, p.z); };
    return CGAL::orientation(in_space(a), in_space(b), in_space(c), in_space(d));
  }
};

}  // namespace watertight::geometry
