// SPDX-License-Identifier: GPL-3.0-or-later
//
// Vectors in metres, in doubles, for measurements: they decide nothing but tolerance rules.
// Internal to validate/.
#pragma once

#include "geometry/vector3.h"

namespace watertight::validate {

using Vector = geometry::Vector3;
using geometry::cross;
using geometry::dot;
using geometry::length;
using geometry::operator-;

/// The vector's direction, of length 1; zero stays zero. No size of vector underflows or overflows.
Vector direction_of(const Vector& v);

/// The direction of cross(u, v), of length 1, for vectors of any size.
Vector unit_normal(const Vector& u, const Vector& v);

}  // namespace watertight::validate
