// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where an instance of a geometry template stands: an affine map, and what it does to the solid.
// The map is exact; single points and solids in the world are rounded.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/lattice/lattice.h"
#include "geometry/solid.h"

namespace watertight::geometry {

/// world = linear * template + offset + anchor, in the exact decimals of the document.
struct Placement {
  std::array<std::array<GridNumber, 3>, 3> linear{
      // row by row
      {{{{1, 0}, {0, 0}, {0, 0}}}, {{{0, 0}, {1, 0}, {0, 0}}}, {{{0, 0}, {0, 0}, {1, 0}}}}};
  std::array<GridNumber, 3> offset{};  // the matrix's own shift
  std::array<GridNumber, 3> anchor{};  // the point that the instance stands on
  std::uint32_t srid = 0;              // of the world
  friend auto operator<=>(const Placement&, const Placement&) = default;
};

/// Exact sign (-1, 0, +1) of the linear part's determinant.
int determinant_sign(const Placement& placement);

/// True if the linear part is a rotation, exactly: its inverse is its transpose, its determinant 1.
bool is_rotation(const Placement& placement);

/// The nearest double of a decimal.
double rounded(const GridNumber& decimal);

/// The linear part as nearest doubles, row by row.
std::array<std::array<double, 3>, 3> linear_part(const Placement& placement);

/// Where the template's origin lies in the world, rounded.
std::array<double, 3> shift_of(const Placement& placement);

/// Where a point of the template lies in the world, rounded; not finite beyond the doubles.
std::array<double, 3> place(const Placement& placement, const std::array<double, 3>& point);

/// The solid with rounded vertices in the world, for measures and pictures; nothing is decided on
/// it. Errors: malformed if a coordinate leaves the doubles.
Result<Solid> placed(const Solid& solid, const Placement& placement);

/// The solid with all rings reversed. Under a map with negative determinant the facets of a solid
/// turn as those of the solid turned over do under a map with positive determinant.
Solid turned_over(const Solid& solid);

}  // namespace watertight::geometry
