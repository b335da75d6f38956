// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapping: makes another solid, in which vertices within a tolerance have the same coordinates.
// Done only on request. For validate/ and repair/.
#pragma once

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/placement.h"
#include "geometry/solid.h"

namespace watertight::validate {

struct SnappedSolid {
  Solid solid;      // the given solid with the coordinates of moved vertices changed
  Index moved = 0;  // the number of vertices that moved
};

/// Snaps the vertices of a solid. Each vertex moves to the first earlier vertex, in the order of
/// the solid, that did not move itself and is at most `metres` away (val3dity's rule). With a
/// placement, distances are those of the placed solid. Requires metres > 0.
/// Errors: limit_exceeded if the tolerance is too small for the size of the solid; cancelled.
/// Cost: O(n log n).
Result<SnappedSolid> snap_vertices(const Solid& solid, double metres, const CancelPoll& cancel = {},
                                   const geometry::Placement* placement = nullptr);

}  // namespace watertight::validate
