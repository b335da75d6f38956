// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact signs for points in one box, inlined into the loops of this folder. Private to delaunay/.
#pragma once

#include "geometry/point.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {

/// geometry::orient3d with a filter whose bound is computed once. A term of the determinant passes
/// through at most 8 roundings of u = 2^-53, and the six terms are at most the product of the sides
/// of the box: the value is wrong by less than 9 u times six times this product, and by less than
/// the last term below if products underflow. The bound is larger than the roundings of the bound
/// itself. Signs that the filter does not decide are computed exactly.
class Signs {
 public:
  Signs() = default;
  /// For points in a box, which may be empty.
  explicit Signs(const geometry::Box& box) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;
    constexpr double kUnderflow = 1e-200;
    if (box.is_empty()) return;
    const double x = box.max.x - box.min.x;
    const double y = box.max.y - box.min.y;
    const double z = box.max.z - box.min.z;
    error_ = 6 * 16 * kUnit * (x * y * z) + kUnderflow * (x + y + z) + kUnderflow;
  }

  int orient3d(const Point& a, const Point& b, const Point& c, const Point& d) const {
    const Point u{b.x - a.x, b.y - a.y, b.z - a.z};
    const Point v{c.x - a.x, c.y - a.y, c.z - a.z};
    const Point w{d.x - a.x, d.y - a.y, d.z - a.z};
    const double value = w.x * (u.y * v.z - u.z * v.y) + w.y * (u.z * v.x - u.x * v.z) +
                         w.z * (u.x * v.y - u.y * v.x);
    // An overflow makes the bound infinite or the value no number: neither is decided here.
    if (value > error_) return 1;
    if (value < -error_) return -1;
    return geometry::orient3d(a, b, c, d);
  }

 private:
  double error_ = 0;
};

}  // namespace watertight::delaunay
