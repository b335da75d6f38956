// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures and places of a solid in rational numbers: exact, with one rounding at the end.
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
/// once; the height counts as its shortest decimal on a decimal lattice, as coordinates do. 0 below
/// the solid, its volume above it. Requires a finite height. Cost: linear; some microseconds for
/// each triangle that the height cuts.
double volume_below(const Solid& solid, std::span<const Triangle> triangles, double height);

/// +1 if a place in world units is inside a closed solid, 0 if on its boundary, -1 if outside. The
/// decision is exact; on a decimal lattice coordinates count as their shortest decimals, as those
/// of the solid do, else as the doubles that they are. Requires finite coordinates. Cost: linear.
int locate(const Solid& solid, std::span<const Triangle> triangles,
           const std::array<double, 3>& place);

}  // namespace watertight::geometry
