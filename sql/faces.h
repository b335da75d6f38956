// SPDX-License-Identifier: GPL-3.0-or-later
//
// The facets of a solid with their measures, for wt_faces.
#pragma once

#include <vector>

#include "geometry/solid.h"
#include "sql/bridge.h"

namespace watertight::sql {

/// A row for each facet, in the order of the solid. Requires a solid that was accepted. Cost: that
/// of triangulating the facets, and of a fitted plane for each.
std::vector<wt_face> faces_of(const Solid& solid);

}  // namespace watertight::sql
