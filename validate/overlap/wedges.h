// SPDX-License-Identifier: GPL-3.0-or-later
//
// The wedges of a facet around a vertex that several of its rings pass: the parts of the facet's
// inside at the vertex, each between two ring edges. Internal to validate/.
#pragma once

#include <vector>

#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::validate {

/// The inside of a facet at a vertex, from the ring edge that leaves corner `from` to the ring edge
/// that arrives at corner `to`. Corners are indices in ring_vertices.
struct Wedge {
  Index from = 0;
  Index to = 0;
};

/// The wedges around all vertices that the rings of the facet pass more than once; at other
/// vertices, the wedge of a corner is from the corner to itself. None if the facet is not
/// triangulated, or if its rings do not turn as they should. Cost: O(n log n) for facets with
/// interior rings, else constant.
std::vector<Wedge> shared_wedges(const Solid& solid, const tessellate::FacetTriangles& facets,
                                 Index facet);

}  // namespace watertight::validate
