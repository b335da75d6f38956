// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds out why a facet's rings bound no region: where rings meet themselves or each other, and
// which interior rings lie outside the exterior ring or inside another. The decisions are exact in
// the facet's projection. For validate, on facets that triangulate_facets() did not triangulate.
#pragma once

#include <vector>

#include "base/cancel.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::tessellate {

enum class RingProblemKind : std::uint8_t {
  collapsed,         // all points of the ring lie on one line
  self_contact,      // a ring meets itself other than where neighbouring edges join
  rings_meet,        // two rings share more than single points, or cross in a point
  same_ring,         // two rings have the same vertices
  outside_exterior,  // an interior ring lies outside the exterior ring
  nested             // an interior ring lies inside another interior ring
};

struct RingProblem {
  RingProblemKind kind = RingProblemKind::collapsed;
  Index ring = 0;            // the index of the ring in the facet
  Index edge = kNone;        // the index in the ring of the vertex where the edge starts
  Index other_ring = kNone;  // the index of the other ring; equal to `ring` for a self_contact
  Index other_edge = kNone;  // the index in the other ring of the vertex where the edge starts
  Point witness;             // lattice coordinates, each the nearest double to the exact point
};

struct RingProblems {
  std::vector<RingProblem> problems;  // ordered by ring, kind, edge, other ring, other edge
  bool is_complete = true;  // false: more than `most` problems, too many pairs, or cancelled
};

/// Finds at most `most` problems of the rings of a facet. Requires merged vertices. Rings below 3
/// vertices are left out and edges of no length ignored. A vertex inside an edge of another ring
/// splits that edge (geometry/divided_rings.h) and is no problem by itself; edges are given as
/// indices in the rings of `solid`. `cancel` is called about every 2^16 steps; if it returns true,
/// the search ends with the problems found so far.
/// Cost: O(n log n + pairs of edges that overlap in one axis), bounded; nesting O(rings x n).
RingProblems ring_problems(const Solid& solid, Index facet, std::size_t most,
                           const CancelPoll& cancel = {});

/// +1 if a simple ring turns left in the projection along `axis`, -1 if right, 0 if it has a spike
/// at its smallest vertex. Exact. Requires at least 3 vertices.
int ring_turn(const Solid& solid, Index ring, int axis);

}  // namespace watertight::tessellate
