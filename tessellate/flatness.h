// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides exactly whether the points of a facet are in one plane. A flat facet is the same set of
// points under every triangulation; a facet that is not flat is defined by its canonical triangles.
// For validate and delaunay.
#pragma once

#include "geometry/point.h"
#include "geometry/solid.h"

namespace watertight::tessellate {

/// True if four points are in one plane. Exact for any finite doubles; much faster than orient3d()
/// where the answer is yes and the coordinates are integers. Requires four different points.
bool are_coplanar(const Point& a, const Point& b, const Point& c, const Point& d);

/// True if all ring vertices of a facet are in one plane, exactly. Cost: linear.
bool is_flat(const Solid& solid, Index facet);

}  // namespace watertight::tessellate
