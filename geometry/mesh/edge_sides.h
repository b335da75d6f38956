// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sorts half-edges by their edges, and pairs each half-edge with one that runs the other way.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::geometry {

/// A half-edge as one side of the edge between two vertices. Sides are ordered by edge; the upward
/// sides of an edge come before its downward sides, and sides of one direction are ordered by
/// half-edge.
struct EdgeSide {
  Index low = 0;             // the smaller vertex
  Index high = 0;            // the greater vertex
  bool is_downward = false;  // the half-edge runs from the greater to the smaller vertex
  Index half_edge = 0;
  friend auto operator<=>(const EdgeSide&, const EdgeSide&) = default;
  bool has_edge_of(const EdgeSide& other) const { return low == other.low && high == other.high; }
};

/// The sides of the half-edges of triangles `first` to `last` - 1 (geometry/mesh/half_edges.h),
/// sorted. Cost: O(n log n).
std::vector<EdgeSide> sides_of_triangles(std::span<const Triangle> triangles, Index first,
                                         Index last);

/// The sides of the half-edges of rings `first` to `last` - 1, sorted: half-edge i begins at
/// ring_vertices[i], and the first half-edge of ring r is ring_offsets[r]. Cost: O(n log n).
std::vector<EdgeSide> sides_of_rings(std::span<const Index> ring_vertices,
                                     std::span<const Index> ring_offsets, Index first, Index last);

/// Calls `visit` with the sides of each edge in turn. Requires that the sides of an edge are
/// consecutive.
template <class Side, class Visit>
void for_each_edge(std::span<Side> sides, const Visit& visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].has_edge_of(sides[begin])) ++end;
    visit(sides.subspan(begin, end - begin));
    begin = end;
  }
}

/// The number of upward sides of an edge. Requires that the upward sides come first.
std::size_t upward_count(std::span<const EdgeSide> edge);

/// The twins of half-edges: element i is the twin of half-edge `first_half_edge` + i. The first
/// upward and the first downward half-edge of an edge are twins, so are the second ones, and so on.
/// Nothing unless each edge has as many upward as downward sides. Requires the sides of all
/// half-edges from `first_half_edge` on; the sides of an edge must be consecutive and the upward
/// ones first. Cost: linear.
std::optional<std::vector<Index>> paired(std::span<const EdgeSide> sides, Index first_half_edge);

}  // namespace watertight::geometry
