// SPDX-License-Identifier: GPL-3.0-or-later
//
// Lattice coordinates and world coordinates as rational numbers. Private to geometry/.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cstddef>

#include "geometry/lattice/lattice.h"
#include "geometry/point.h"
#include "geometry/predicates/rational_point.h"

namespace watertight::geometry {

mpq_class step_of(const Lattice& lattice, std::size_t axis);
mpq_class origin_of(const Lattice& lattice, std::size_t axis);

/// The shortest decimal that reads back as a number, which is finite.
mpq_class decimal(double number);

/// A coordinate in world units. It counts as its shortest decimal, except where the coordinates of
/// the lattice are doubles themselves. Requires a finite one.
mpq_class world_coordinate(const Lattice& lattice, double coordinate);

/// The same as one of the lattice, which need not be an integer.
mpq_class lattice_coordinate(const Lattice& lattice, std::size_t axis, double coordinate);

/// A point of the lattice in world units, exactly.
RationalPoint world_point(const Lattice& lattice, const Point& point);

/// The nearest double.
double nearest(const mpq_class& value);

}  // namespace watertight::geometry
