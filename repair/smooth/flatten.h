// SPDX-License-Identifier: GPL-3.0-or-later
//
// Lays a collar and its hole into the plane. Internal to repair/.
#pragma once

#include <span>
#include <vector>

#include "repair/smooth/collar.h"

namespace watertight::repair {

struct Flattened {
  std::vector<Point> places;  // of the collar's vertices; z is 0
  double stretch = 1;         // the largest factor by which a length in the collar changes, >= 1
};

/// Up to two maps in the order of their stretch: along the area vector of the hole, and the
/// conformal one (spline/plane/conformal_map.h) of the collar with the hole closed by `closing`
/// (triangles by local numbers, may be empty). Where neither will do, the conformal one of the
/// collar alone. None turns a triangle of the collar over; exact. Triangles may still lie on each
/// other. `metres` has the places of the collar's vertices.
std::vector<Flattened> flatten(const Collar& collar, std::span<const Triangle> closing,
                               std::span<const geometry::Vector3> metres);

}  // namespace watertight::repair
