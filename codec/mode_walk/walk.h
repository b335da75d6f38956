// SPDX-License-Identifier: GPL-3.0-or-later
//
// The walk of mode walk: the connectivity of a triangulated boundary, given its vertices and their
// canonical Delaunay tetrahedralization. After a first triangle, each step codes the triangle
// beyond the open edge where it is most certain: the Delaunay faces around that edge are asked
// before all other triangles. For mode walk (docs/format-walk.md, "The walk").
// Source: research of this project; the idea of a front over Delaunay faces is that of Lewiner et
// al., "GEncode: geometry-driven compression for general meshes" (2006).
#pragma once

#include <span>
#include <vector>

#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "delaunay/canonical_delaunay.h"
#include "geometry/point.h"

namespace watertight::codec::walk {

/// Triangles whose edges meet in pairs, once in each direction within a component.
/// Half-edge 3 t + k runs from corner k of triangle t to the next corner.
struct BoundaryMesh {
  std::vector<Triangle> triangles;
  /// Component -> first triangle; one more entry at the end. Components are closed surfaces,
  /// connected through edges; several may share vertices and edges.
  std::vector<Index> component_first{0};
  std::vector<Index> twin;  // half-edge -> its twin, in the same component
  /// Triangle -> its index in the list that the caller gave; empty when reading.
  std::vector<Index> source;

  Index component_count() const { return static_cast<Index>(component_first.size() - 1); }
};

/// Codes the triangles of a boundary.
/// When writing, `mesh.triangles` and `mesh.component_first` hold closed oriented surfaces that use
/// each point; a component given may turn out to be several. Requires distinct points whose
/// coordinates are whole numbers that differ by less than 2^30, and `delaunay` =
/// canonical_delaunay(points), not empty.
/// On return, in either direction, `mesh` is complete and in the order of the walk.
/// Errors: not_encodable (a surface that is not closed, has equal triangles, or edges that meet
/// more than twice in one component; vertices of extreme degrees); reading: malformed.
/// Cost: O(n log n), a few microseconds per triangle; bounded by 256 steps per point.
Status code_boundary_walk(EntropyStream& stream, ModelBank& models, std::span<const Point> points,
                          const delaunay::CanonicalDelaunay& delaunay, BoundaryMesh& mesh);

}  // namespace watertight::codec::walk
