// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pins, which show places in a tileset.
#pragma once

#include "tiles/feature_mesh.h"

namespace watertight::tiles {

inline constexpr double kPinHeight = 8;  // metres
inline constexpr double kPinRadius = 1;  // metres

/// Adds a closed body of eight triangles that stands on its tip, which is at the place; it is wide
/// above, so that it is seen from afar over roofs.
void add_pin(FeatureMesh& mesh, const GridPosition& place);

}  // namespace watertight::tiles
