// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether a point lies inside a closed triangulated surface, exactly. Internal to validate/.
#pragma once

#include <span>

#include "geometry/point.h"
#include "validate/overlap/box_tree.h"

namespace watertight::validate {

enum class Location : signed char { outside = -1, boundary = 0, inside = 1 };

/// Locates a point by the parity of the number of triangles that a ray from it meets. The ray runs
/// along +z and is moved by a symbolic step along x and a smaller one along y, so that it meets no
/// edge. Requires every edge of the surface to be met an
/// even number of times. Source: simulation of simplicity, Edelsbrunner & Muecke 1990, with the
/// point alone perturbed.
class PointLocator {
 public:
  /// Keeps the spans. Cost: O(n log n).
  PointLocator(std::span<const Point> vertices, std::span<const Triangle> triangles);
  /// Cost: the triangles above or below the point in plan, and a logarithm.
  Location locate(const Point& p) const;

 private:
  std::span<const Point> vertices_;
  std::span<const Triangle> triangles_;
  BoxTree tree_;
};

/// The same for a single point. Cost: linear.
Location locate(const Point& p, std::span<const Point> vertices,
                std::span<const Triangle> triangles);

}  // namespace watertight::validate
