// SPDX-License-Identifier: GPL-3.0-or-later
//
// Moves a lattice, and with it every solid on it, without rounding.
#pragma once

#include <array>

#include "geometry/lattice/lattice.h"

namespace watertight::geometry {

/// The lattice whose points all lie by `way` (world units) from those of `lattice`. On a decimal
/// lattice the numbers of the way count as their shortest decimals, as coordinates do; on a binary
/// one as they are. Errors: unsupported for a lattice of doubles, whose points would be rounded;
/// limit_exceeded if the origin would need more than 18 digits, or the way is not finite.
Result<Lattice> moved_lattice(const Lattice& lattice, const std::array<double, 3>& way);

}  // namespace watertight::geometry
