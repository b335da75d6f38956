// SPDX-License-Identifier: GPL-3.0-or-later
//
// The placement of an instance of a geometry template: an affine map, and the solid and points
// under this map. The map is exact; points and solids in the world are rounded.
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
  std::array<GridNumber, 3> offset{};  // the shift that the matrix contains
  std::array<GridNumber, 3> anchor{};  // the point that the instance stands on
  std::uint32_t srid = 0;              // the EPSG code of the world coordinates, 0 if not stated
  friend auto operator<=>(const Placement&, const Placement&) = default;
};

/// The exact sign (-1, 0, +1) of the linear part's determinant.
int determinant_sign(const Placement& placement);

/// True if the linear part is a rotation, exactly: its inverse is its transpose, its determinant 1.
bool is_rotation(const Placement& placement);

/// The nearest double of a decimal.
double rounded(const GridNumber& decimal);

/// The linear part as nearest doubles, row by row.
std::array<std::array<double, 3>, 3> linear_part(const Placement& placement);

/// The world coordinates of the template's origin, rounded.
std::array<double, 3> shift_of(const Placement& placement);

/// The world coordinates of a point of the template, rounded; not finite beyond the range of
/// doubles.
std::array<double, 3> place(const Placement& placement, const std::array<double, 3>& point);

/// The solid with rounded vertices in the world, for measures and pictures, never for decisions.
/// Errors: malformed if a coordinate is beyond the range of doubles.
Result<Solid> placed(const Solid& solid, const Placement& placement);

/// The solid with all rings reversed. A map with a negative determinant reverses the orientation of
/// all facets; turning the solid over before restores it.
Solid turned_over(const Solid& solid);

}  // namespace watertight::geometry
