// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes facets faces of a Delaunay tetrahedralization that has all their edges: the result is the
// constrained Delaunay tetrahedralization. Private to delaunay/.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/point.h"

namespace watertight::delaunay {

/// A facet that lies exactly in a plane, as triangles that cover it once.
struct FlatFacet {
  std::vector<Triangle> triangles;  // sorted vertices, in order
  Index source = kNone;
  friend auto operator<=>(const FlatFacet&, const FlatFacet&) = default;
};

struct InsertedFacets {
  std::vector<geometry::Tetrahedron> tetrahedra;
  std::vector<FlatFacet> facets;  // in the order given; some have other triangles
  std::size_t missing = 0;        // triangles that are no faces
};

/// Requires the canonical Delaunay tetrahedralization of points in lexicographic order, and facets
/// that meet in common vertices and edges only, the edges of whose rings are all edges of it. Then
/// nothing is missing in the result unless a limit is reached: at most 2,048 geometric tests
/// for each triangle given, and 2^20. Errors: cancelled. Cost: that of the tetrahedra
/// that missing triangles cross, squared for each connected part of a facet.
/// Source: Diazzi, Panozzo, Vaxman, Attene, "Constrained Delaunay Tetrahedrization" (2023), section
/// 4; Shewchuk (2002) for why a constrained Delaunay tetrahedralization exists. Departure: the
/// triangles of a facet are those of the Delaunay triangulation in its plane.
Result<InsertedFacets> insert_facets(std::span<const Point> points,
                                     std::vector<geometry::Tetrahedron> tetrahedra,
                                     std::vector<FlatFacet> facets,
                                     const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
