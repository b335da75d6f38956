// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether triangles of the plane meet in whole edges and vertices only. Internal to spline/.
#pragma once

#include <span>

#include "base/result.h"
#include "spline/plane/triangle_grid.h"

namespace watertight::spline {

/// Error malformed if a corner is no vertex, a number is not finite, a triangle does not turn left,
/// or two triangles meet in more than a whole edge or a vertex. Exact. Cost: linear in the pairs of
/// triangles that are near each other.
Status check_triangulation(std::span<const Point> vertices, std::span<const Triangle> triangles);

}  // namespace watertight::spline
