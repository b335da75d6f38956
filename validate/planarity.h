// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vectors in metres, in doubles, for measurements. Only tolerance rules depend on such vectors.
// Internal to validate/.
#pragma once

#include "geometry/vector3.h"

namespace watertight::validate {

using Vector = geometry::Vector3;
using geometry::cross;
using geometry::dot;
using geometry::length;
using geometry::operator-;

/// The unit vector in the direction of v; zero stays zero. No size of v underflows or overflows.
Vector direction_of(const Vector& v);

/// The unit vector in the direction of cross(u, v), for vectors of any size.
Vector unit_normal(const Vector& u, const Vector& v);

}  // namespace watertight::validate
