// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles of one curved face, between the points of its edges.
#pragma once

#include <vector>

#include "base/result.h"
#include "surfaces/boundary_representation.h"
#include "surfaces/vertex_pool.h"

namespace watertight::surfaces {

struct FaceTriangles {
  std::vector<Triangle> triangles;  // vertices of the pool; outer side up
  double gap = 0;                   // metres: FaceLoops::gap
  double chord_error = 0;  // metres: the largest measured distance of a triangle from the surface
  /// Edges whose chords cross in the plane of (u, v): with more points they may not. No triangles
  /// then.
  std::vector<Index> crossing;
  /// Edges beside which triangles are farther from the surface than the chord: with more points
  /// they need not be.
  std::vector<Index> coarse;
};

/// The curved faces that meet at each vertex on an edge.
struct FaceNeighbours {
  Index face = kNone;  // the face itself
  const std::vector<std::vector<Index>>& faces;
  /// Whether both vertices belong to one other curved face.
  bool share(Index a, Index b) const;
};

/// Tessellates a face on a surface so that its triangles are nowhere farther than `chord` from the
/// surface. `edges` has the vertices along each edge. Errors: unsupported with the reason for loops
/// that bound no part of the surface; limit_exceeded for more than `most` triangles. Cost:
/// O(n log n) for n triangles.
Result<FaceTriangles> tessellate_face(const BoundaryFace& face,
                                      const std::vector<EdgeSamples>& edges,
                                      const FaceNeighbours& neighbours, double tolerance,
                                      double chord, std::size_t most, VertexPool& pool);

}  // namespace watertight::surfaces
