// SPDX-License-Identifier: GPL-3.0-or-later
//
// The surface that a writer of the pivot walk asks for the truth: the triangles given, as
// half-edges, and which of them the walk has used. Private to the walk.
#pragma once

#include <vector>

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

  Index from(Index half_edge) const { return triangles_[half_edge / 3][half_edge % 3]; }
  Index to(Index half_edge) const { return from(turned(half_edge, 1)); }
  Index corner(Index half_edge) const { return from(turned(half_edge, 2)); }
  Index twin_of(Index half_edge) const { return twin_[half_edge]; }
  /// The half-edge `corners` farther in the same triangle.
  static Index turned(Index half_edge, Index corners) {
    return half_edge / 3 * 3 + (half_edge % 3 + corners) % 3;
  }

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
