// SPDX-License-Identifier: GPL-3.0-or-later
//
// Divides the edges of facets until all their parts are edges of the canonical Delaunay
// tetrahedralization. A constrained Delaunay tetrahedralization then exists. Private to delaunay/.
#pragma once

#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/canonical_delaunay.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// The facets of a solid with divided edges, in one shell. A facet that lies exactly in a plane
/// stays a polygon; each triangle of another one is a facet of its own.
struct ProtectedSolid {
  Solid solid;  // vertices: those of the source in their order, then Steiner vertices
  std::vector<Index> facet_of;  // facet -> facet of the source
  CanonicalDelaunay delaunay;   // of all vertices
};

/// Requires a solid that passed the exact tests, with rings that are divided as `triangles` are.
/// `is_taken_apart`: facet -> its triangles become facets of their own; empty for none. Every
/// Steiner vertex lies exactly on its edge, at a fraction of a power of two; the set of Steiner
/// vertices depends on the coordinates alone.
/// Errors: limit_exceeded where there would be more Steiner vertices than 24 for each vertex and
/// 1,024, or than 16,384, for more than 65,536 vertices, after 64 rounds, or where doubles have no
/// point on an edge; cancelled. Cost: one Delaunay tetrahedralization of all points, and for each
/// Steiner vertex a look at the points of its part's extent along x. Source: H. Si, K. Gärtner,
/// "Meshing piecewise linear complexes by constrained Delaunay tetrahedralizations" (2005), section
/// 3: the vertex that sees an edge under the largest angle tells how far from an end the edge is
/// divided. Departures: such a place is exact within 3 % of the distance, so that few bits hold it;
/// all missing edges are divided before their points are inserted.
Result<ProtectedSolid> protect_edges(const Solid& solid,
                                     const tessellate::FacetTriangles& triangles,
                                     const std::vector<bool>& is_taken_apart,
                                     const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
