// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tessellates solids of known measures, and checks the polyhedra.
#pragma once

#include <functional>

#include "surfaces/tessellate_boundary.h"

namespace watertight::test {

struct Wanted {
  double volume = 0;
  double area = 0;
};

using Distance = std::function<double(const surfaces::Vector3&)>;  // from the curved surface

enum class Points : int { ten = 3, ninety_one = 12 };  // parts of a side of a triangle

/// The largest distance of so many points of each triangle from the surface.
double farthest(const surfaces::TessellatedBoundary& result, const Distance& distance,
                Points points = Points::ninety_one);

/// Tessellates, and checks the verdict, the measures and the distance of the curved faces.
surfaces::TessellatedBoundary check(const surfaces::BoundaryRepresentation& solid, double chord,
                                    const Wanted& wanted, const Distance& distance = {});

}  // namespace watertight::test
