// SPDX-License-Identifier: GPL-3.0-or-later
//
// A solid by its curved boundary, as files of CAD and BIM have it: vertices; edges on curves;
// faces on surfaces, between loops of edges.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/point.h"
#include "surfaces/curves/pieces.h"

namespace watertight::surfaces {

struct BoundaryEdge {
  Index start = kNone;  // vertices
  Index end = kNone;
  Curve curve;                 // without pieces: the segment from start to end
  bool is_along_curve = true;  // the curve runs from start to end
};

struct OrientedEdge {
  Index edge = kNone;
  bool is_forward = true;
};
using EdgeLoop = std::vector<OrientedEdge>;

/// Makes a loop run the other way.
inline void turn(EdgeLoop& loop) {
  std::reverse(loop.begin(), loop.end());
  for (OrientedEdge& edge : loop) edge.is_forward = !edge.is_forward;
}

struct BoundaryFace {
  std::string name;                // for people: "#104"
  std::optional<Surface> surface;  // none: a plane, which the loops define
  bool is_along_surface = true;    // the face's outer side is where u turns left to v
  /// Loops turn left around the face, seen from outside the solid.
  std::vector<EdgeLoop> loops;
  std::optional<std::size_t> outer;  // the loop around the face; none: the largest one of a plane
  std::string unreadable;            // why the face could not be read, "" if it was
};

struct BoundaryRepresentation {
  std::vector<Vector3> vertices;  // metres
  std::vector<BoundaryEdge> edges;
  std::vector<BoundaryFace> faces;
  std::vector<std::vector<Index>> shells;  // faces; the outer shell first
  double tolerance = 1e-5;  // metres: how far edges may be from their surfaces, as the file says
};

}  // namespace watertight::surfaces
