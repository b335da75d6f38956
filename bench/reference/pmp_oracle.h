// SPDX-License-Identifier: GPL-3.0-or-later
//
// An independent oracle for "no two triangles of this boundary meet except in shared vertices and
// edges": CGAL's Polygon Mesh Processing. Used by bench/reference only.
#pragma once

#include <cstddef>
#include <span>

#include "geometry/point.h"

namespace watertight {

/// The number of triangle pairs that intersect other than in shared vertices and edges, by
/// PMP::triangle_soup_self_intersections. Requires merged vertices.
std::size_t count_pmp_intersections(std::span<const Point> vertices,
                                    std::span<const Triangle> triangles);

}  // namespace watertight
