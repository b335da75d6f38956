// SPDX-License-Identifier: GPL-3.0-or-later
//
// Powers of two for the axes of a solid. A tetrahedralization stays one under them, but the
// Delaunay tetrahedralization of the scaled points is another one. Private to delaunay/.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/solid.h"

namespace watertight::delaunay {

/// A factor for each axis, at least 1.
using AxisScale = std::array<double, 3>;

/// Brings the lattice steps of all axes within a factor of 1.5, with a degree as 2^17 metres: a
/// solid in degrees and metres then has about its true shape. No factor but 1 where the units are
/// equal.
AxisScale equal_units(const Solid& solid);

/// Brings the extents of all axes within a factor of two.
AxisScale equal_extents(const geometry::Box& box);

/// The points under a scaling; none where a coordinate would not come back.
std::optional<std::vector<Point>> scaled(std::span<const Point> points, const AxisScale& scale);

/// Divides the coordinates of points by a scaling.
void unscale(std::vector<Point>& points, const AxisScale& scale);

}  // namespace watertight::delaunay
