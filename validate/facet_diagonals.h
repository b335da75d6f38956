// SPDX-License-Identifier: GPL-3.0-or-later
//
// The diagonals of the canonical triangulation of facets: where diagonals touch other facets, and
// which diagonals can be flipped so that other triangles fill the facet. Facets of a shell share an
// edge only where a segment is on the boundary of both facets. Where the segment is a diagonal of
// one facet, the facets touch or cross along the segment, although their triangles only have an
// edge in common. Internal to validate/.
#pragma once

#include <array>
#include <vector>

#include "geometry/intersection/box_partition.h"
#include "tessellate/facets.h"

namespace watertight::validate {

/// An edge of triangles of one facet.
struct FacetEdge {
  Index low = 0;  // the smaller vertex
  Index high = 0;
  Index facet = 0;
  // The triangles at the edge; the second is kNone for an edge on the facet's boundary.
  std::array<Index, 2> triangles{kNone, kNone};
  bool is_diagonal() const { return triangles[1] != kNone; }
};

/// The edges of a facet's triangles, sorted by their vertices. Cost: O(k log k).
std::vector<FacetEdge> facet_edges(const tessellate::FacetTriangles& facets, Index facet);

/// The pairs of triangles of different facets of one shell that have an edge in common which is a
/// diagonal of at least one of the facets, as ContactClass::edge_overlap with first < second. Of
/// several facets at one segment, each is paired with the first facet of which it is a diagonal.
/// Cost: O(n log n) for solids with facets of more than one triangle, else linear.
std::vector<geometry::IntersectingPair> diagonal_contacts(const Solid& solid,
                                                          const tessellate::FacetTriangles& facets);

/// A diagonal u-v of a facet between triangles (u, v, right) and (v, u, left) whose quadrilateral
/// is strictly convex in the facet's projection and not flat.
struct Diagonal {
  Index u = 0;
  Index v = 0;
  Index right = 0;   // the corner of `first` that is not on the diagonal
  Index left = 0;    // the corner of `second` that is not on the diagonal
  Index first = 0;   // a triangle at the diagonal
  Index second = 0;  // the other triangle at the diagonal
  std::array<Triangle, 2> flipped() const { return {{{u, left, right}, {left, v, right}}}; }
};

/// The diagonals of a facet that can be flipped and are folds. Exact. Cost: O(k log k).
std::vector<Diagonal> other_diagonals(const Solid& solid, const tessellate::FacetTriangles& facets,
                                      Index facet);

}  // namespace watertight::validate
