// SPDX-License-Identifier: GPL-3.0-or-later
//
// The facets that directed edges bound. For clip_z.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::tessellate {

/// From the first vertex to the second; what it bounds is on its left.
using DirectedEdge = std::array<Index, 2>;

/// The rings of a facet, the exterior one first.
using LoopedFacet = std::vector<std::vector<Index>>;

/// Takes edges away that another one runs along the other way, and those that begin where they end.
/// The rest is sorted. Cost: O(n log n).
void cancel_opposite_edges(std::vector<DirectedEdge>& edges);

/// The facets that edges bound, seen in a projection. Where a boundary visits a vertex twice it is
/// split, so that rings that touch are rings of their own; an edge there and back alone bounds
/// nothing. Every decision is exact. Requires sorted edges between different vertices, as many of
/// which begin as end at each vertex. Errors: malformed if they bound no facets: a ring on one
/// line, or a hole outside of all exterior rings. Cost: O(n log n), and the vertices of exterior
/// rings for each hole.
Result<std::vector<LoopedFacet>> facets_of_edges(std::span<const DirectedEdge> edges,
                                                 std::span<const Point> vertices,
                                                 const Projection& projection);

}  // namespace watertight::tessellate
