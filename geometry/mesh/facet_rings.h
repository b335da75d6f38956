// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rings of facets that are known as triangles. For the modes that store triangles of facets.
#pragma once

#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight::geometry {

/// A ring and one of the triangles inside it. The smallest vertex comes first.
struct FacetRing {
  Index triangle = 0;
  std::vector<Index> vertices;
};

/// The rings along the half-edges (geometry/mesh/half_edges.h) that do not lie inside a facet.
/// Those inside a facet have an `inner_twin`, all others kNone. Where the boundary of a facet
/// visits a vertex twice it is split there, so that holes that touch come apart. Rings come in the
/// order of their boundaries' first half-edges. Cost: O(n log n).
std::vector<FacetRing> facet_rings(std::span<const Triangle> triangles,
                                   std::span<const Index> inner_twin);

}  // namespace watertight::geometry
