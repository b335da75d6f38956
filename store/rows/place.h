// SPDX-License-Identifier: GPL-3.0-or-later
//
// The place number of a feature: in the order of place numbers, neighbours in space are near each
// other.
#pragma once

#include <cstdint>
#include <optional>

#include "store/solid_store.h"

namespace watertight::store {

/// The place number of a feature without a box: it comes after all others.
inline constexpr std::int64_t kNoPlace = INT64_MAX;

/// The place number: the number of the cell that holds the box's centre, along a Hilbert curve
/// through 2^31 by 2^31 cells. It is not negative; kNoPlace without a box. Cells are half a unit
/// wide, or 2^-21 where all coordinates are within 360 and may be degrees; the outermost cells are
/// endless. Requires finite numbers. Source: J. Skilling, "Programming the Hilbert curve", 2004 (in
/// two dimensions, as commonly written).
std::int64_t place_number(const std::optional<StoredBox>& box);

}  // namespace watertight::store
