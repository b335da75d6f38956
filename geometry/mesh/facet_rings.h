// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rings of facets of which the triangles are known. For the modes of the codec that store the
// triangles of facets.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::geometry {

/// A ring of a facet and one of the triangles of that facet. The smallest vertex comes first.
struct FacetRing {
  Index triangle = 0;
  std::vector<Index> vertices;
};

/// The rings along the half-edges (geometry/mesh/half_edges.h) that do not lie inside a facet.
/// `inner_twin` has the twin of each half-edge inside a facet, and kNone for all others. Where the
/// boundary of a facet visits a vertex twice, the boundary is split, so that holes that touch are
/// rings of their own. The rings are in the order of the first half-edges of their boundaries.
/// Cost: O(n log n).
std::vector<FacetRing> facet_rings(std::span<const Triangle> triangles,
                                   std::span<const Index> inner_twin);

}  // namespace watertight::geometry
