// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ring edges of a shell, grouped by their two vertices. For validate/ and repair/.
#pragma once

#include <span>
#include <vector>

#include "geometry/solid.h"

namespace watertight::validate {

/// One passage of a ring along an edge.
struct EdgeUse {
  Index low = 0;   // the smaller vertex
  Index high = 0;  // the larger vertex
  Index facet = 0;
  Index corner = 0;  // the index in ring_vertices of the vertex where the passage starts
  bool has_edge_of(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// The ring of a corner and the index of the corner in that ring.
struct CornerPlace {
  Index ring_in_facet = 0;
  Index position = 0;  // the index of the corner in its ring
  Index next = 0;      // the next corner of the ring, as an index in ring_vertices
};
/// The ring and index of a corner of a facet. Cost: logarithmic in the rings of the facet.
CornerPlace place_of_corner(const Solid& solid, Index facet, Index corner);

/// The edges of shells, one shell at a time.
class EdgeTable {
 public:
  explicit EdgeTable(const Solid& solid) : solid_(solid), number_of_(solid.vertex_count(), kNone) {}

  /// Lists the edges of a shell instead of those listed before. Edges of no length and rings below
  /// 3 vertices are left out.
  /// Cost: linear in the shell where vertices are numbered in order of first use, or nearly.
  void examine(Index shell);

  /// The uses of the edges, sorted by vertices, then by corner.
  std::span<const EdgeUse> uses() const { return uses_; }
  /// The vertices of the edges, ascending.
  std::span<const Index> vertices() const { return vertices_; }
  /// The index of a vertex in vertices(). Requires a vertex of that list.
  Index number_of(Index vertex) const { return number_of_[vertex]; }
  bool is_forward(const EdgeUse& use) const {
    return solid_.arrays().ring_vertices[use.corner] == use.low;
  }

 private:
  template <class Visit>
  void for_each_passage(IndexRange facets, Visit visit) const;

  const Solid& solid_;
  std::vector<Index> number_of_;
  std::vector<Index> vertices_;
  std::vector<EdgeUse> uses_;
};

}  // namespace watertight::validate
