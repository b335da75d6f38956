// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides whether two surfaces have a point in common, and whether they are close to each other.
// Internal to validate/.
#pragma once

#include "validate/overlap/solid_overlap.h"

namespace watertight::validate {

/// True if two surfaces have a point in common. Exact. Cost: near linear in the triangles inside
/// the overlap of the boxes; the product of their numbers if all of them meet.
bool do_touch(const RegionSurface& first, const RegionSurface& second);

/// True if a point of one surface is at most `metres` from a point of the other one. Distances are
/// computed in doubles. Requires a grid of the world (`step_metres` is diagonal) and metres > 0.
/// Cost: that of do_touch(), with boxes that are wider by the distance.
bool is_gap_at_most(const RegionSurface& first, const RegionSurface& second,
                    const StepMetres& step_metres, double metres);

}  // namespace watertight::validate
