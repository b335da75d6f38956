// SPDX-License-Identifier: GPL-3.0-or-later
//
// New vertices on the lattice of a solid, which is made finer for them where it is too coarse. Old
// vertices keep their exact world coordinates. Internal to repair/.
#pragma once

#include <span>

#include "base/result.h"
#include "geometry/lattice/lattice.h"
#include "geometry/vector3.h"
#include "repair/edited_solid.h"

namespace watertight::repair {

/// Appends vertices at places as metres_of() gives them, each rounded to the lattice. The lattice
/// becomes finer by powers of ten (of two, where it is binary) until its step is at most
/// `step_metres` or coordinates reach 2^30. Errors: limit_exceeded where no lattice holds all
/// vertices exactly. Cost: linear.
Status add_vertices(EditedSolid& solid, const geometry::Vector3& units,
                    std::span<const geometry::Vector3> places, double step_metres);

/// Points of two lattices on one, the first ones before the second ones, without rounding. Errors:
/// limit_exceeded. Cost: linear.
Result<geometry::LatticePoints> on_one_lattice(const Lattice& first, std::span<const Point> points,
                                               const Lattice& second,
                                               std::span<const Point> others);

}  // namespace watertight::repair
