// SPDX-License-Identifier: GPL-3.0-or-later
//
// Boundaries of solids as triangles in world coordinates, and the search for triangles of two
// boundaries that are near each other.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "geometry/solid.h"
#include "geometry/vector3.h"

namespace watertight::geometry {

/// The boundary of a closed solid. `triangles` fill the facets with the orientation of the facets.
struct Surface {
  const Solid* solid = nullptr;
  std::span<const Triangle> triangles;
};

/// A triangle of a surface with its corners in world units, each coordinate the nearest double. The
/// box that holds these corners holds the exact ones as well as a rounded box can: exact boxes that
/// have a point in common are rounded to boxes that have one.
struct WorldTriangle {
  std::array<Vector3, 3> corners;
  Vector3 low;
  Vector3 high;
  Index number = 0;  // of the triangle in the surface
};

/// The triangles of a surface. Cost: linear.
std::vector<WorldTriangle> world_triangles(const Surface& surface);

/// The axis along which two sets of triangles are spread the most.
std::size_t longest_axis(std::span<const WorldTriangle> one, std::span<const WorldTriangle> other);

/// True if no coordinates of two triangles are farther apart than `reach` along an axis.
inline bool are_near(const WorldTriangle& a, const WorldTriangle& b, double reach) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.low[axis] - b.high[axis] > reach || b.low[axis] - a.high[axis] > reach) return false;
  }
  return true;
}

/// Calls `visit(a, b)` for the triangles a of `one` and b of `other` that are near each other.
/// `reach`, in world units, may become smaller by a visit, never larger. Ends where `is_cancelled`
/// says so, and after a visit that returns false. Cost: O(n log n), and a comparison for each pair
/// that is near along the longest axis.
template <class Visit>
void visit_near_pairs(std::vector<WorldTriangle> one, std::vector<WorldTriangle> other,
                      const double& reach, const CancelPoll& is_cancelled, const Visit& visit) {
  constexpr std::size_t kStepsOfPoll = 64;
  const std::size_t axis = longest_axis(one, other);
  const auto is_lower = [axis](const WorldTriangle& a, const WorldTriangle& b) {
    return std::pair(a.low[axis], a.number) < std::pair(b.low[axis], b.number);
  };
  std::ranges::sort(one, is_lower);
  std::ranges::sort(other, is_lower);
  // A plane moves along the axis. The triangles that it has not left wait for those of the other
  // surface.
  std::vector<const WorldTriangle*> waiting_of_one;
  std::vector<const WorldTriangle*> waiting_of_other;
  std::size_t steps = 0;
  for (std::size_t i = 0, j = 0; i < one.size() || j < other.size();) {
    if (++steps % kStepsOfPoll == 0 && is_cancelled && is_cancelled()) return;
    const bool is_of_one =
        j == other.size() || (i < one.size() && one[i].low[axis] <= other[j].low[axis]);
    const WorldTriangle& next = is_of_one ? one[i++] : other[j++];
    auto& partners = is_of_one ? waiting_of_other : waiting_of_one;
    std::erase_if(partners, [&](const WorldTriangle* partner) {
      return next.low[axis] - partner->high[axis] > reach;
    });
    for (const WorldTriangle* partner : partners) {
      if (!are_near(next, *partner, reach)) continue;
      if (!(is_of_one ? visit(next, *partner) : visit(*partner, next))) return;
    }
    (is_of_one ? waiting_of_one : waiting_of_other).push_back(&next);
  }
}

}  // namespace watertight::geometry
