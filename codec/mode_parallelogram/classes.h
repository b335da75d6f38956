// SPDX-License-Identifier: GPL-3.0-or-later
//
// Classes of measured quantities, as contexts (docs/format-parallelogram.md, "Classes and angles").
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "codec/entropy/context.h"
#include "codec/mode_parallelogram/vectors.h"

namespace watertight::codec::parallelogram {

/// floor(x), limited to 0 to size - 1; 0 if x is no number.
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

/// Classes of equal width.
template <std::uint32_t size>
struct Scale {
  double per_unit = 1;  // classes
  double from = 0;      // where the first class begins

  Context<size> operator()(double x) const { return bucket<size>((x - from) * per_unit); }
};

}  // namespace watertight::codec::parallelogram
