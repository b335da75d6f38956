// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides exactly whether a point lies inside a closed triangulated surface. Internal to validate/.
#pragma once

#include <span>

#include "geometry/point.h"
#include "validate/overlap/box_tree.h"

namespace watertight::validate {

enum class Location : signed char { outside = -1, boundary = 0, inside = 1 };

/// Locates a point by the parity of the number of triangles that a ray from the point meets. The
/// ray runs along +z and is moved by a symbolic step along x and a smaller one along y, so that it
/// meets no edge. Requires that every edge of the surface belongs to an even number of triangles.
/// Source: simulation of simplicity, Edelsbrunner & Muecke 1990; only the point is perturbed.
class PointLocator {
 public:
  /// The locator keeps the spans, not their elements. Cost: O(n log n).
  PointLocator(std::span<const Point> vertices, std::span<const Triangle> triangles);
  /// Cost: linear in the triangles above or below the point, plus a logarithm of all triangles.
  Location locate(const Point& p) const;

 private:
  std::span<const Point> vertices_;
  std::span<const Triangle> triangles_;
  BoxTree tree_;
};

/// Locates a single point without a PointLocator. Cost: linear.
Location locate(const Point& p, std::span<const Point> vertices,
                std::span<const Triangle> triangles);

}  // namespace watertight::validate
