// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points that nearly coincide with another: measured, for warning 801 and for snapping. Internal to
// validate/.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "geometry/point.h"

namespace watertight::validate {

struct NearPoints {
  std::vector<Index> points;  // those with another at most `reach` away; ascending
  Index first = kNone;        // the closest pair, first < second
  Index second = kNone;
  double distance = 0;  // of the closest pair
};

/// All points that have another at most `reach` away. Every point's nearest neighbour is looked
/// for, so it does not matter how many pairs are near. `cancel` (may be empty) ends the search with
/// what was found. Deterministic. Cost: O(n log n) but for points placed against it.
NearPoints near_points(std::span<const Point> points, double reach, const CancelPoll& cancel);

}  // namespace watertight::validate
