// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures that are computed in rational numbers, with one rounding at the end.
#pragma once

#include <array>
#include <span>

#include "geometry/solid.h"

namespace watertight::geometry {

/// The centre of mass of a closed solid in world units, each coordinate the exact one, rounded
/// once. `triangles` fill the facets with the orientation of the facets. Requires a volume that is
/// not zero. Cost: linear.
std::array<double, 3> centroid(const Solid& solid, std::span<const Triangle> triangles);

/// The volume of the part of a closed solid below a height in world units, the exact one, rounded
/// once; the height counts as its shortest decimal, as coordinates do. 0 below the solid, its
/// volume above it. Requires a finite height. Cost: linear; some microseconds for each triangle
/// that the height cuts.
double volume_below(const Solid& solid, std::span<const Triangle> triangles, double height);

}  // namespace watertight::geometry
