// SPDX-License-Identifier: GPL-3.0-or-later
//
// The sense in which a ring turns. Internal to repair/.
#pragma once

#include "repair/edited_solid.h"

namespace watertight::repair {

/// +1 or -1 for a ring that turns left or right in the projection of a facet
/// (tessellate/facets.h), 0 without a turn at its smallest point. Exact. Requires a simple ring.
int turn_of(const EditedSolid& solid, const EditedFacet& facet, const Ring& ring);

}  // namespace watertight::repair
