// SPDX-License-Identifier: GPL-3.0-or-later
//
// The decision of the Delaunay tetrahedralization for any finite doubles. Private to delaunay/.
#pragma once

#include <array>

#include "geometry/point.h"

namespace watertight::delaunay {

/// True if p lies inside the sphere through the corners of a tetrahedron of positive orientation.
/// Ties are broken as in the canonical Delaunay tetrahedralization: as if each point were lifted
/// above the paraboloid, lexicographically greater ones infinitely farther. Exact. Requires five
/// distinct points. If p is coplanar with the first three corners, this is the test of p against
/// their circle.
bool is_in_perturbed_sphere(const std::array<const Point*, 4>& t, const Point& p);

}  // namespace watertight::delaunay
