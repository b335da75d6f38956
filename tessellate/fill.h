// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles of facets that triangulate_facets() refuses because their rings cross, touch or nest
// wrongly: the region inside an odd number of rings (the even-odd rule). For display: nothing is
// decided or stored by such triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/solid.h"

namespace watertight::tessellate {

/// Triangles by their corners, lattice coordinates.
using FilledFacet = std::vector<std::array<Point, 3>>;

/// Fills a facet by the even-odd rule, on the projection along the axis in which the facet is
/// thinnest. Vertices stay; where edges cross, the corner is on the plane through three vertices
/// that are far from each other. Triangles turn as the exterior ring does where it has a turn. A
/// facet on one line has none. `pairs` is the number of pairs of edges that may still be looked at
/// and decreases; nothing, and no further work, when more of the facet overlap along one axis.
/// Cost: quadratic in the edges of the facet in the worst case.
std::optional<FilledFacet> fill_facet(const Solid& solid, Index facet, std::uint64_t& pairs);

}  // namespace watertight::tessellate
