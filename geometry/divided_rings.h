// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rings that touch: a vertex of one ring may lie inside an edge of another ring of the same facet
// (OGC Simple Features lets rings touch in a point). The vertex then splits the edge: a ring a, b,
// ... counts as a, v, b, ... Used by the triangulation of facets, the rules of shells and closed
// boundaries. A solid is stored and written with its rings as submitted.
#pragma once

#include <span>
#include <vector>

#include "geometry/solid.h"

namespace watertight::geometry {

/// A vertex of another ring of the facet inside an edge.
struct RingTouch {
  Index corner = 0;  // where the edge starts: index in ring_vertices
  Index vertex = 0;
  friend bool operator==(const RingTouch&, const RingTouch&) = default;
};

/// The touches of the rings of these facets, by corner and then along the edge. Exact: the vertex
/// lies on the edge in space, not only in a projection. A vertex that the edge's own ring has too
/// is no touch (that ring meets itself). Facets whose rings must share segments get no touches.
/// Requires merged vertices and facets in ascending order. Cost: O(n log n + pairs of an edge and a
/// vertex that are close along each axis); after 100 million such pairs the remaining facets get
/// none.
std::vector<RingTouch> ring_touches(const Solid& solid, std::span<const Index> facets);

/// The touches of all facets with several rings.
std::vector<RingTouch> ring_touches(const Solid& solid);

/// A solid whose rings have the vertices that split their edges.
struct DividedRings {
  Solid solid;
  std::vector<Index> corner_of;  // corner -> corner of the source at which its edge starts
};

/// Vertices, facets, shells and the order of rings stay. Requires touches of this solid in the
/// order of ring_touches(). Cost: linear.
DividedRings divide_rings(const Solid& solid, std::span<const RingTouch> touches);

}  // namespace watertight::geometry
