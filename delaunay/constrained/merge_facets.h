// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes one facet of neighbouring facets that lie in one plane. Private to delaunay/.
#pragma once

#include <optional>
#include <vector>

#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// A solid with the surface of another one and fewer facets. Vertices inside a merged facet are
/// left out.
struct MergedFacets {
  Solid solid;
  std::vector<Index> source;  // facet -> one of the facets of the other solid of which it is made
};

/// Merges facets of one shell that lie exactly in one plane and share an edge that no other facet
/// has. Requires merged vertices, rings that are divided as the triangles are (divided_solid),
/// `canonical` = triangulate_facets(solid), and a solid that passed the exact tests. Facets that
/// have no neighbour in their plane stay as they are. Nothing if no facets can be merged.
///
/// Why both solids have the same surface: the facets of a group are parts of one plane that do not
/// overlap, and the rings of the merged facet are all edges that bound the group, in the same
/// direction; a part of a plane is given by its boundary.
/// Cost: O(n log n).
std::optional<MergedFacets> merge_flat_facets(const Solid& solid,
                                              const tessellate::FacetTriangles& canonical);

}  // namespace watertight::delaunay
