// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rung 1 of the CDT ladder: makes the triangles of a boundary faces of a tetrahedralization by
// changing it where they are missing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/point.h"

namespace watertight::delaunay {

struct RecoveredFaces {
  std::vector<Point> points;  // the points given, then Steiner points
  std::vector<geometry::Tetrahedron> tetrahedra;
  /// The triangles given, or the parts into which Steiner points on their edges divide them.
  std::vector<Triangle> triangles;
  std::vector<Index> source;  // triangle -> the number of the given one of which it is a part
  std::size_t missing = 0;    // triangles that are still no faces
};

/// Requires positive tetrahedra that fill the convex hull of `points` once, triangles that meet
/// in common vertices and edges only, and the numbers of those that are no faces. Returns
/// tetrahedra that fill the hull too. All is bounded by numbers of steps, in proportion to the
/// number of triangles: a triangle for which nothing is found stays missing. Same input, same
/// result. Errors: cancelled. Cost: some 0.01 ms for each missing triangle where flips find it, and
/// at most some 0.2 ms for each triangle of the boundary. Source: flips and Steiner points as in
/// Si, "TetGen" (2015), section 4. Departures: a point on an edge lies in the middle of what the
/// edge crosses, exactly; edge removal chooses the best triangulation of a ring.
Result<RecoveredFaces> recover_faces(std::span<const Point> points,
                                     std::vector<geometry::Tetrahedron> tetrahedra,
                                     std::span<const Triangle> triangles,
                                     std::span<const Index> missing,
                                     const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
