// SPDX-License-Identifier: GPL-3.0-or-later
//
// Boxes of triangles in single precision, rounded so that triangles that meet have boxes that
// overlap. The box partition divides and compares these boxes. Private to geometry/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "geometry/point.h"

namespace watertight::geometry {

inline constexpr float kFloatStep = std::numeric_limits<float>::epsilon();

/// A triangle and its bounds along D directions.
template <std::size_t D>
struct BoxMember {
  std::array<float, D> low;
  std::array<float, D> high;
  Index triangle;
};

/// A float below `value`, by at most two units in the last place. Requires |value| < 2^120.
inline float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest - std::abs(nearest) * kFloatStep - std::numeric_limits<float>::min();
}

inline float rounded_up(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest + std::abs(nearest) * kFloatStep + std::numeric_limits<float>::min();
}

template <std::size_t D>
bool do_overlap(const BoxMember<D>& a, const BoxMember<D>& b) {
  bool result = true;
  for (std::size_t axis = 0; axis < D; ++axis) {
    result = result && a.low[axis] <= b.high[axis] && b.low[axis] <= a.high[axis];
  }
  return result;
}

/// The half-open bounds of a part in D directions. The parts of a partition do not overlap and
/// leave no gap, so every point lies in exactly one part, also the low corner of the overlap of two
/// boxes.
template <std::size_t D>
struct PartBounds {
  std::array<float, D> low;
  std::array<float, D> high;

  static PartBounds everything() {
    PartBounds bounds;
    bounds.low.fill(-std::numeric_limits<float>::infinity());
    bounds.high.fill(std::numeric_limits<float>::infinity());
    return bounds;
  }
  /// True if the low corner of the overlap of two boxes lies within the bounds. The boxes may have
  /// more directions than the bounds.
  template <std::size_t A>
  bool owns(const BoxMember<A>& a, const BoxMember<A>& b) const {
    static_assert(A >= D);
    for (std::size_t axis = 0; axis < D; ++axis) {
      const float corner = std::max(a.low[axis], b.low[axis]);
      if (corner < low[axis] || corner >= high[axis]) return false;
    }
    return true;
  }
};

}  // namespace watertight::geometry
