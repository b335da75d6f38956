// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where a feature is, besides its solids.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "geometry/lattice/lattice.h"

namespace watertight::formats {

/// Minima and maxima on x, y and z.
struct CoordinateRanges {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
};

/// The world coordinates of the vertices of a skeleton that no solid of it uses: those of surfaces,
/// lines, points and places of templates. Nothing without any, and for a text that is no skeleton
/// of a city model. Cost: linear, the text as JSON values.
std::optional<CoordinateRanges> ranges_of_other_vertices(
    std::string_view skeleton, const std::optional<geometry::Transform>& transform);

}  // namespace watertight::formats
