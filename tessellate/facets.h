// SPDX-License-Identifier: GPL-3.0-or-later
//
// The canonical triangulation of planar facets (docs/robustness.md, "What is proven"): a
// constrained 2D Delaunay triangulation of each facet's rings on an exact coordinate-plane
// projection. A facet has the same triangles whatever the order of vertices, rings and facets. For
// validate, delaunay and codec.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/divided_rings.h"
#include "geometry/solid.h"

namespace watertight::tessellate {

/// The exact projection of a facet. The dropped axis is the one with the largest component of the
/// exact doubled area vector in world scale; of equal components the first in the order x, y, z.
/// World scale counts the lattice step of each axis and, where the solid's SRID is of a geographic
/// system, a degree as 2^17 units of height.
struct Projection {
  int axis = 2;  // 0 x, 1 y, 2 z: the dropped axis
  bool is_mirrored =
      false;  // the exterior ring turns clockwise in the projection of orient2d(axis)
  bool is_degenerate = false;  // the area vector is exactly zero
};
Projection facet_projection(const Solid& solid, Index facet);

enum class FacetState : std::uint8_t {
  triangulated,
  degenerate,  // the facet has no area
  not_simple,  // rings cross, touch or nest wrongly in the projection: no triangulation
};

/// The triangles of all facets, grouped by facet. The vertex order of a triangle keeps the facet's
/// orientation.
struct FacetTriangles {
  std::vector<Triangle> triangles;
  std::vector<Index> facet_of;    // triangle -> facet
  std::vector<Index> first{0};    // facet -> first triangle; facet_count + 1 entries
  std::vector<FacetState> state;  // facet -> state
  /// The solid with divided rings, if vertices of rings split edges of other rings in triangulated
  /// facets; else absent.
  std::optional<geometry::DividedRings> divided;

  /// The solid whose ring edges are edges of the triangles.
  const Solid& divided_solid(const Solid& solid) const { return divided ? divided->solid : solid; }
};

/// Triangulates all facets of a solid. Requires merged vertices. Facets whose rings are not simple
/// in projection get no triangles. Rings may share vertices, and a vertex of a ring may lie inside
/// an edge of another (geometry/divided_rings.h). Guarantees: the triangles of a triangulated facet
/// use exactly its ring vertices, cover the region between its rings, and are the same set for
/// every numbering of the input. Cost: O(n log n) per facet; twice that for a solid with split
/// edges.
FacetTriangles triangulate_facets(const Solid& solid);

}  // namespace watertight::tessellate
