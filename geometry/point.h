// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points and boxes in lattice coordinates (doubles that are exact, see geometry/lattice/lattice.h).
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <span>

namespace watertight::geometry {

using Index = std::uint32_t;
inline constexpr Index kNone = std::numeric_limits<Index>::max();

struct Point {
  double x = 0;
  double y = 0;
  double z = 0;

  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  /// The lexicographic order by x, y, z. It is total: coordinates are finite and never -0.
  friend auto operator<=>(const Point&, const Point&) = default;
};

using Triangle = std::array<Index, 3>;
using Tetrahedron = std::array<Index, 4>;

/// A closed axis-parallel box; empty when min > max.
struct Box {
  Point min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Point max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  bool is_empty() const { return min.x > max.x; }
  void include(const Point& p) {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] < min[axis]) min[axis] = p[axis];
      if (p[axis] > max[axis]) max[axis] = p[axis];
    }
  }
  /// True if the closed boxes share a point.
  bool overlaps(const Box& other) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (min[axis] > other.max[axis] || max[axis] < other.min[axis]) return false;
    }
    return true;
  }
};

inline Box box_of(std::span<const Point> points) {
  Box box;
  for (const Point& p : points) box.include(p);
  return box;
}

}  // namespace watertight::geometry

namespace watertight {

using geometry::Box;
using geometry::Index;
using geometry::kNone;
using geometry::Point;
using geometry::Triangle;

}  // namespace watertight
