// SPDX-License-Identifier: GPL-3.0-or-later
//
// A triangle among boxes: which boxes a triangle certainly does not meet.
#pragma once

#include <array>

#include "geometry/vector3.h"

namespace watertight::geometry {

/// The extent of a triangle along its normal and along the normals of its edges in the three
/// coordinate planes. A long oblique triangle fills little of its box; these directions separate it
/// from most boxes in there.
class TriangleReach {
 public:
  /// Requires finite coordinates below 2^300. Degenerate triangles are allowed.
  TriangleReach(const Point& a, const Point& b, const Point& c);

  /// True only if a plane lies between the triangle and the closed box. False says nothing: the
  /// comparison is one of doubles with a bound of their error. Cost: O(1).
  bool is_apart_from(const Box& box) const;

 private:
  static constexpr std::size_t kDirections = 10;

  struct Extent {
    Vector3 direction{};
    double low = 0;  // of the corners, with room for the rounding of their products
    double high = 0;
  };

  Extent extent_along(const Vector3& direction) const;

  Point origin_;                    // the first corner
  std::array<Vector3, 3> corners_;  // seen from the origin
  std::array<Extent, kDirections> extents_;
};

}  // namespace watertight::geometry
