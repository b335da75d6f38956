// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds where shells of one solid touch inside each other's facets and edges. Different shells may
// touch in points and along edges; a tetrahedralization then must have these points and edges
// within the facets, and engines need them in their input.
#pragma once

#include <string>

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

struct ContactTriangles {
  /// The canonical triangles divided at vertices and edges of other shells that lie exactly on
  /// them. Grouped by facet and turned alike, as the canonical triangles are. Empty without
  /// contacts.
  tessellate::FacetTriangles triangles;
  std::vector<bool> is_touched;  // facet -> holds a vertex or an edge of another shell
  /// A text for people if two edges of different shells (or folds of facets that are not planar)
  /// cross in a point that is no vertex of the solid, so that no triangulation by the vertices
  /// exists; else empty.
  std::string obstacle;
  bool has_contacts() const { return !is_touched.empty(); }
};

/// Requires merged vertices, `canonical` = triangulate_facets(solid), and a solid that passed the
/// exact tests. A solid of one shell has no contacts and costs nothing.
/// Errors: cancelled; limit_exceeded for more than 20 million contacts. Cost: that of
/// intersecting_pairs(), and for each facet its triangles times its contacts.
Result<ContactTriangles> divide_at_contacts(const Solid& solid,
                                            const tessellate::FacetTriangles& canonical,
                                            const CancelPoll& is_cancelled = {});

/// True if the point lies in the closed triangle, exactly. `axis` is an axis along which the
/// triangle has an area in projection.
bool is_on_triangle(std::span<const Point> points, const Triangle& triangle, const Point& point,
                    int axis);

}  // namespace watertight::delaunay
