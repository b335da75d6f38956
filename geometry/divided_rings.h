// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rings that touch: a vertex of one ring may lie inside an edge of another ring of the same facet
// (OGC Simple Features lets rings touch in a point). The vertex then splits the edge: a ring a, b,
// ... counts as a, v, b, ... The triangulation of facets, the rules of shells and OrientedBoundary
// use divided rings. A solid is stored and written with its rings as submitted.
#pragma once

#include <span>
#include <vector>

#include "geometry/solid.h"

namespace watertight::geometry {

/// A vertex inside an edge of another ring of the same facet.
struct RingTouch {
  Index corner = 0;  // the index in ring_vertices of the start of the edge
  Index vertex = 0;  // the vertex inside the edge
  friend bool operator==(const RingTouch&, const RingTouch&) = default;
};

/// The touches of the rings of the given facets, ordered by corner and then along the edge. The
/// test is exact: the vertex lies on the edge in space, not only in a projection. A vertex that
/// also belongs to the ring of the edge is no touch (that ring meets itself). A facet with so many
/// touches that its rings must share segments gets none. Requires merged vertices and facets in
/// ascending order. Cost: O(n log n + pairs of an edge and a vertex that are close along each
/// axis); after 100 million such pairs the remaining facets get no touches.
std::vector<RingTouch> ring_touches(const Solid& solid, std::span<const Index> facets);

/// The touches of all facets of a solid.
std::vector<RingTouch> ring_touches(const Solid& solid);

/// A solid whose rings have the vertices that split their edges.
struct DividedRings {
  Solid solid;
  std::vector<Index> corner_of;  // corner -> the source's corner at which the undivided edge starts
};

/// Puts the vertices of touches into the edges that they split. Vertices, facets, shells and the
/// order of rings stay. Requires touches of this solid in the order of ring_touches(). Cost:
/// linear.
DividedRings divide_rings(const Solid& solid, std::span<const RingTouch> touches);

}  // namespace watertight::geometry
