// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vectors of doubles for predictions and contexts: + - * / and sqrt in the order written, so that
// every machine computes the same. Decisions on geometry never come from here.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "geometry/vector3.h"

namespace watertight::codec::parallelogram {

using Vector = geometry::Vector3;
using geometry::cross;
using geometry::dot;
using geometry::length;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;

/// `a` times the reciprocal of its length (part of the format: a quotient would be rounded
/// otherwise), or 0.
inline Vector unit_by_reciprocal(const Vector& a) {
  const double size = length(a);
  return size > 0 ? a * (1 / size) : Vector{};
}

inline constexpr double kHalfTurn = 3.141592653589793;

/// The angle between two vectors, 0 to kHalfTurn, to about a quarter of a degree.
inline double angle_between(const Vector& a, const Vector& b) {
  const double along = dot(a, b);
  const double across = length(cross(a, b));
  const double least = along < 0 ? -along : along;
  if (!(least + across > 0)) return 0;
  const bool is_steep = across > least;
  const double t = is_steep ? least / across : across / least;
  const double sharp = t * (kHalfTurn / 4 + 0.273 * (1 - t));
  const double acute = is_steep ? kHalfTurn / 2 - sharp : sharp;
  return along < 0 ? kHalfTurn - acute : acute;
}

/// log2(x) for x > 0, linear between powers of two.
inline double rough_log2(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  return exponent - 2 + 2 * fraction;
}

}  // namespace watertight::codec::parallelogram
