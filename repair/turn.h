// SPDX-License-Identifier: GPL-3.0-or-later
//
// The sense in which a ring turns. Internal to repair/.
#pragma once

#include <optional>

#include "repair/edited_solid.h"

namespace watertight::repair {

/// The axis along which a facet is projected (tessellate/facets.h); nothing for one on a line.
/// Cost: linear in the facet.
std::optional<int> projection_axis(const EditedSolid& solid, const EditedFacet& facet);

/// +1 or -1 for a ring that turns left or right in the projection along an axis, 0 without a turn
/// at its smallest point. Exact. Requires a simple ring. Cost: linear in the ring.
int turn_of(const EditedSolid& solid, const Ring& ring, int axis);

}  // namespace watertight::repair
