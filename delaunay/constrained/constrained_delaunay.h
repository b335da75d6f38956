// SPDX-License-Identifier: GPL-3.0-or-later
//
// The constrained Delaunay tetrahedralization of a solid's boundary, with Steiner vertices on its
// edges. For rung 1 of the CDT ladder, where flips end without an answer (docs/cdt.md).
#pragma once

#include <cstddef>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

struct ConstrainedDelaunay {
  std::vector<Point> points;  // the vertices of the solid, then Steiner vertices on edges
  std::vector<geometry::Tetrahedron> tetrahedra;
  std::vector<Triangle> triangles;  // of the boundary, divided at Steiner vertices
  std::vector<Index> facet_of;      // triangle -> facet
  std::size_t missing = 0;          // triangles that are no faces, because a limit was reached
};

/// Requires a solid that passed the exact tests, with rings that are divided as `triangles` are.
/// Facets that lie exactly in a plane are polygons, except where `is_taken_apart` (facet -> true)
/// says that their triangles are to stay; empty: no facet. Same coordinates, same result, whatever
/// the numbering. Errors and cost: those of protect_edges() and insert_facets().
/// Source: Diazzi, Panozzo, Vaxman, Attene, "Constrained Delaunay Tetrahedrization" (2023).
Result<ConstrainedDelaunay> constrained_delaunay(const Solid& solid,
                                                 const tessellate::FacetTriangles& triangles,
                                                 const std::vector<bool>& is_taken_apart,
                                                 const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
