// SPDX-License-Identifier: GPL-3.0-or-later
//
// The edges of a Delaunay tetrahedralization: the faces around each edge, and the neighbours of
// each vertex, as flat arrays. For the walk of mode walk.
#pragma once

#include <span>
#include <vector>

#include "delaunay/canonical_delaunay.h"
#include "geometry/point.h"

namespace watertight::codec::walk {

class DelaunayEdges {
 public:
  /// Cost: O(n log n); about 300 bytes per vertex.
  DelaunayEdges(const delaunay::CanonicalDelaunay& delaunay, Index vertex_count);

  /// The faces at the edge between two different vertices, as indices into
  /// CanonicalDelaunay::faces, ascending; none if there is no such edge. Cost: logarithmic in the
  /// degree of a vertex.
  std::span<const Index> faces_at(Index a, Index b) const;
  /// The neighbours of `v` that are greater than `v`, ascending.
  std::span<const Index> greater_neighbours(Index v) const {
    return std::span(greater_).subspan(first_edge_[v], first_edge_[v + 1] - first_edge_[v]);
  }
  /// The neighbours of `v` that are smaller than `v`, ascending.
  std::span<const Index> smaller_neighbours(Index v) const {
    return std::span(smaller_).subspan(first_smaller_[v],
                                       first_smaller_[v + 1] - first_smaller_[v]);
  }

 private:
  /// Lists the smaller neighbours of each vertex from the lists of greater neighbours.
  void turn_edges(Index vertex_count);

  std::vector<Index> first_edge_;  // vertex -> its first edge to a greater vertex
  std::vector<Index> greater_;     // edge -> its greater vertex
  std::vector<Index> first_face_;  // edge -> index of its first face in faces_
  std::vector<Index> faces_;
  std::vector<Index> first_smaller_;
  std::vector<Index> smaller_;
};

}  // namespace watertight::codec::walk
