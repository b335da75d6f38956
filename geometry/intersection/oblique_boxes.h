// SPDX-License-Identifier: GPL-3.0-or-later
//
// Axis-parallel boxes of triangles with three more pairs of bounds, for triangles whose
// axis-parallel boxes all overlap: bounds of the directions in which a triangle is seen from a
// common vertex, or bounds along axes that follow the triangles. Private to geometry/.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/intersection/box_member.h"

namespace watertight::geometry {

/// Adds to a triangle's box the bounds of the directions, as unit vectors, from the vertex `apex`
/// to its points. If a triangle with this vertex and any other triangle have more than the vertex
/// in common, their boxes overlap.
BoxMember<6> seen_from(Index apex, std::span<const Point> points, const Triangle& triangle,
                       const BoxMember<3>& box);

/// Three axes at right angles: the first along the triangles' long edges, the second along their
/// normals as far as the normals agree.
class ObliqueAxes {
 public:
  ObliqueAxes(std::span<const Point> points, std::span<const Triangle> triangles,
              std::span<const Index> members);

  /// Adds to a triangle's box its bounds along the axes.
  BoxMember<6> box(std::span<const Point> points, const Triangle& triangle,
                   const BoxMember<3>& box) const;

 private:
  using Vector = std::array<double, 3>;

  Point centre_;
  double scale_ = 0;  // one over the largest distance from the centre along an axis of space
  std::array<Vector, 3> axes_{};
};

}  // namespace watertight::geometry
