// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids for formats that have no facets with holes.
#pragma once

#include "base/result.h"
#include "geometry/solid.h"

namespace watertight::tessellate {

/// The solid with each facet that has holes replaced by its canonical triangles. Errors:
/// not_encodable where the rings of such a facet are not simple. Cost: that of
/// triangulate_facets().
Result<Solid> without_holes(const Solid& source);

}  // namespace watertight::tessellate
