// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapping: another solid, in which vertices within a tolerance are one. Only on request. Internal
// to validate/.
#pragma once

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::validate {

struct SnappedSolid {
  Solid solid;      // the same arrays; a snapped vertex has the coordinates it was moved to
  Index moved = 0;  // number of vertices that moved
};

/// Each vertex moves to the first earlier vertex, in the order of the solid, that did not move
/// itself and is at most `metres` away (val3dity's rule), as placed where a placement is given.
/// Requires metres > 0.
/// Errors: limit_exceeded if the tolerance is too small for the size of the solid; cancelled.
/// Cost: O(n log n).
Result<SnappedSolid> snap_vertices(const Solid& solid, double metres, const CancelPoll& cancel = {},
                                   const geometry::Placement* placement = nullptr);

}  // namespace watertight::validate
