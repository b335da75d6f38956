// SPDX-License-Identifier: GPL-3.0-or-later
//
// The surface that a writer of the pivot walk asks for the truth: the triangles given, as
// half-edges, and which of them the walk has used. Private to the walk.
#pragma once

#include <vector>

#include "geometry/mesh/half_edges.h"
#include "geometry/point.h"

namespace watertight::codec::walk {

struct BoundaryMesh;

class WalkTruth {
 public:
  /// Takes the triangles of `mesh`. False unless within each component given each half-edge comes
  /// once and has its opposite, and each vertex below `vertex_count`, and no other, is used.
  /// Cost: O(n log n).
  bool take(BoundaryMesh& mesh, Index vertex_count);

  /// True if the triangles at each vertex form one fan.
  bool is_manifold() const;

  Index from(Index half_edge) const { return geometry::start_of(triangles_, half_edge); }
  Index to(Index half_edge) const { return geometry::end_of(triangles_, half_edge); }
  Index corner(Index half_edge) const { return geometry::corner_of(triangles_, half_edge); }
  Index twin_of(Index half_edge) const { return twin_[half_edge]; }

  void use(Index half_edge) { is_used_[half_edge / 3] = true; }
  /// The first half-edge of an unused triangle with these corners in this order, or kNone.
  Index find_unused(const Triangle& triangle) const;
  /// The first half-edge of an unused triangle that leaves a vertex, or kNone.
  Index any_unused_at(Index vertex) const;
  /// The least vertex of an unused triangle, or kNone.
  Index unused_vertex() const;

 private:
  std::vector<Triangle> triangles_;
  std::vector<Index> twin_;
  std::vector<Index> first_;       // vertex -> into half_edges_
  std::vector<Index> half_edges_;  // by vertex left, then vertex reached
  std::vector<bool> is_used_;
};

}  // namespace watertight::codec::walk
