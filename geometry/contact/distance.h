// SPDX-License-Identifier: GPL-3.0-or-later
//
// Distances of solids and places, and segments that meet solids.
#pragma once

#include <array>

#include "base/cancel.h"
#include "geometry/contact/surface.h"

namespace watertight::geometry {

/// A place in world units. Its coordinates count as their shortest decimals, as those of solids do,
/// except beside a solid whose coordinates are doubles themselves. They are finite.
using Place = std::array<double, 3>;

/// The least distance of a point of one solid from a point of another, in world units; exactly 0 if
/// and only if the solids have a point in common, be it inside or on the boundary. The least
/// distance is found in rational numbers; its square is rounded once, then the root. Both solids
/// are in one reference system. A cancelled call gives a number without meaning. Cost: that of
/// visit_near_pairs(); some 100 microseconds for each pair of triangles that may be the nearest.
double distance(const Surface& one, const Surface& other, const CancelPoll& is_cancelled = {});

/// The same for a solid and a place. Cost: linear.
double distance(const Surface& surface, const Place& place);

/// True if a segment has a point in common with a solid, be it inside or on the boundary. Exact.
/// The ends may be the same. Cost: linear; some 20 microseconds for each triangle near the segment.
bool meets_segment(const Surface& surface, const Place& from, const Place& to);

}  // namespace watertight::geometry
