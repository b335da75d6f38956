// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/intersection/triangle_reach.h"

#include <algorithm>
#include <cmath>

namespace watertight::geometry {
namespace {

/// More than the relative error of a difference, a product and two sums of doubles, 4 * 2^-53.
constexpr double kRounding = 0x1p-50;

}  // namespace

TriangleReach::TriangleReach(const Point& a, const Point& b, const Point& c)
    : origin_(a), corners_{Vector3{}, difference(b, a), difference(c, a)} {
  std::size_t count = 0;
  extents_[count++] = extent_along(cross(corners_[1], corners_[2]));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 edge = corners_[(i + 1) % 3] - corners_[i];
    extents_[count++] = extent_along({0, edge[2], -edge[1]});
    extents_[count++] = extent_along({edge[2], 0, -edge[0]});
    extents_[count++] = extent_along({edge[1], -edge[0], 0});
  }
}

// The direction is taken as it is: it need not be exactly the normal of anything.
TriangleReach::Extent TriangleReach::extent_along(const Vector3& direction) const {
  Extent extent{direction, 0, 0};
  for (const Vector3& corner : corners_) {
    double sum = 0;
    double magnitude = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double product = direction[axis] * corner[axis];
      sum += product;
      magnitude += std::abs(product);
    }
    extent.low = std::min(extent.low, sum - magnitude * kRounding);
    extent.high = std::max(extent.high, sum + magnitude * kRounding);
  }
  return extent;
}

bool TriangleReach::is_apart_from(const Box& box) const {
  const Vector3 below = difference(box.min, origin_);
  const Vector3 above = difference(box.max, origin_);
  return std::any_of(extents_.begin(), extents_.end(), [&](const Extent& extent) {
    double low = 0;
    double high = 0;
    double magnitude = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = extent.direction[axis] * below[axis];
      const double b = extent.direction[axis] * above[axis];
      low += std::min(a, b);
      high += std::max(a, b);
      magnitude += std::max(std::abs(a), std::abs(b));
    }
    const double room = magnitude * kRounding;
    return low - room > extent.high || high + room < extent.low;
  });
}

}  // namespace watertight::geometry
