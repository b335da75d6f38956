// SPDX-License-Identifier: GPL-3.0-or-later
//
// The surface that a writer gives to the walk of mode walk: its triangles as half-edges, and for
// each triangle whether the walk has reached it. The walk looks up the true answers in this
// surface, for instance which triangle is beyond a gate. A reader has no such surface. Private to
// the walk.
#pragma once

#include <vector>

#include "geometry/mesh/half_edges.h"
#include "geometry/point.h"

namespace watertight::codec::walk {

struct BoundaryMesh;

/// The triangles that are to be coded. A triangle is unused until the walk reaches it.
class GivenSurface {
 public:
  /// Takes the triangles of `mesh`. Returns true if each half-edge of a component comes once and
  /// has a twin in the component, and the triangles use each vertex below `vertex_count` and no
  /// other vertex. Cost: O(n log n).
  bool take(BoundaryMesh& mesh, Index vertex_count);

  /// True if the triangles at each vertex form one fan.
  bool is_manifold() const;

  Index from(Index half_edge) const { return geometry::start_of(triangles_, half_edge); }
  Index to(Index half_edge) const { return geometry::end_of(triangles_, half_edge); }
  Index corner(Index half_edge) const { return geometry::corner_of(triangles_, half_edge); }
  Index twin_of(Index half_edge) const { return twin_[half_edge]; }

  /// Notes that the walk has reached the triangle of this half-edge.
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
  std::vector<Index> first_;       // vertex -> index of its first element in half_edges_
  std::vector<Index> half_edges_;  // all half-edges, sorted by start, then by end
  std::vector<bool> is_used_;      // triangle -> whether the walk has reached it
};

}  // namespace watertight::codec::walk
