// SPDX-License-Identifier: GPL-3.0-or-later
//
// Data of the Delaunay step: tetrahedralizations and the piecewise linear complex they conform to.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/point.h"

namespace watertight::delaunay {

/// A face of a tetrahedralization that belongs to an input facet.
struct ConstrainedFace {
  Triangle vertices{};
  Index facet = kNone;
  friend auto operator<=>(const ConstrainedFace&, const ConstrainedFace&) = default;
};

/// Tetrahedra cover the convex hull of the points. The first `input_count` points are the input's
/// vertices, in order and unmoved; the rest are Steiner points.
struct Tetrahedralization {
  std::vector<Point> points;
  Index input_count = 0;
  std::vector<geometry::Tetrahedron> tetrahedra;  // positively oriented: orient3d(0,1,2,3) > 0
  std::vector<ConstrainedFace> constrained;
};

/// The constraints of a CDT: triangles (3 x triangle_count indices) with their facet numbers.
struct PiecewiseLinearComplex {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;
  std::vector<Index> facet_of;  // triangle -> facet
};

}  // namespace watertight::delaunay
