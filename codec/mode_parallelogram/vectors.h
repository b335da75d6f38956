// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vectors of doubles for predictions, and classes of measured quantities for contexts: + - * / and
// sqrt in the order written, so that every machine computes the same
// (docs/format-parallelogram.md, "Classes and angles"). Decisions on geometry never come from here.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "codec/entropy/context.h"
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

/// floor(x), limited to 0 to size - 1; 0 if x is not a number.
template <std::uint32_t size>
Context<size> bucket(double x) {
  if (!(x > 0)) return Context<size>(0U);
  return Context<size>(x >= static_cast<double>(size) ? size - 1 : static_cast<std::uint32_t>(x));
}

/// floor(2 log2(x)) + zero, limited to 0 to size - 1.
template <std::uint32_t size>
Context<size> log_bucket(double x, int zero) {
  if (!(x > 0)) return Context<size>(0U);
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);  // exact: x = fraction 2^exponent
  const int steps = 2 * (exponent - 1) + (fraction >= 0.7071067811865476 ? 1 : 0) + zero;
  return capped<size>(steps);
}

inline constexpr std::uint32_t kCosines = 8;

/// The class of the cosine of the angle between two vectors, finer near 1.
inline Context<kCosines> cosine_bucket(const Vector& a, const Vector& b) {
  constexpr std::array<double, kCosines - 1> kBounds{-0.5, 0.0, 0.5, 0.8, 0.92, 0.98, 0.995};
  const double sizes = std::sqrt(dot(a, a) * dot(b, b));
  if (!(sizes > 0)) return Context<kCosines>(0U);
  const double cosine = dot(a, b) / sizes;
  std::uint32_t at = 0;
  while (at < kBounds.size() && cosine >= kBounds[at]) ++at;
  return Context<kCosines>(at);
}

/// Divides a quantity into classes of equal width.
template <std::uint32_t size>
struct Scale {
  double per_unit = 1;  // the number of classes in one unit
  double from = 0;      // the value at which the first class begins

  Context<size> operator()(double x) const { return bucket<size>((x - from) * per_unit); }
};

}  // namespace watertight::codec::parallelogram
