// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exact tests of a tetrahedron against a triangle. Private to delaunay/.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "geometry/point.h"

namespace watertight::delaunay {

/// How a tetrahedron lies to the plane of a triangle, and whether it holds points of the triangle.
class Section {
 public:
  /// Keeps references.
  Section(std::span<const Point> points, const Triangle& triangle,
          const geometry::Tetrahedron& tetrahedron);

  /// True if the closed tetrahedron holds a point of the inside of the triangle. Two convex
  /// polygons in a plane are apart if and only if the line of an edge of one parts them.
  bool meets_inside() const;

  /// True if the closed tetrahedron holds a point of the inside of an edge. May also be true if it
  /// only touches the line of the edge along a segment.
  bool meets_edge(std::size_t edge) const;

 private:
  int orientation(Index a, Index b, Index c, Index d) const;
  bool meets_plane() const;
  bool is_beyond_a_face(const std::array<std::size_t, 3>& corners) const;
  std::array<int, 2> range_beside(std::size_t edge) const;

  std::span<const Point> points_;
  const Triangle& triangle_;
  const geometry::Tetrahedron& tetrahedron_;
  std::array<int, 4> side_{};  // of each corner to the triangle's plane
};

}  // namespace watertight::delaunay
