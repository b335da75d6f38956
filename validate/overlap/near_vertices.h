// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds points that nearly coincide with another point, for warning 801 and for snapping. Internal
// to validate/.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "geometry/point.h"

namespace watertight::validate {

struct NearPoints {
  std::vector<Index> points;  // the points with another point at most `reach` away; ascending
  Index first = kNone;        // the closest pair, first < second
  Index second = kNone;
  double distance = 0;  // the distance of the closest pair
};

/// Finds all points that have another point at most `reach` away. The search is for the nearest
/// neighbour of each point, so the number of near pairs does not matter. If `cancel` (may be empty)
/// returns true, the search ends with the points found so far. Deterministic. Cost: O(n log n)
/// except for points arranged to defeat the search.
NearPoints near_points(std::span<const Point> points, double reach, const CancelPoll& cancel);

}  // namespace watertight::validate
