// SPDX-License-Identifier: GPL-3.0-or-later
//
// The wedges of a facet around a vertex that several of its rings pass: which two ring edges bound
// the facet's inside there. Internal to validate/.
#pragma once

#include <vector>

#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::validate {

/// From the ring edge that leaves the vertex at corner `from` to the one that arrives at corner
/// `to`, through the inside of the facet. Corners are indices in ring_vertices.
struct Wedge {
  Index from = 0;
  Index to = 0;
};

/// The wedges around all vertices that the rings of the facet pass more than once; elsewhere the
/// wedge of a corner is the corner's own. None when the facet is not triangulated, or when its
/// rings do not turn as they should. Cost: O(n log n) for facets with interior rings, else
/// constant.
std::vector<Wedge> shared_wedges(const Solid& solid, const tessellate::FacetTriangles& facets,
                                 Index facet);

}  // namespace watertight::validate
