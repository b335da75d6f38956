// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures of a solid in world units: exact signed volume, area, box, genus, counts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "geometry/solid.h"

namespace watertight::geometry {

struct Measures {
  double volume = 0;  // the signed volume in world units cubed: the exact value rounded once
  double area = 0;    // the area of all facets in world units squared: the exact value rounded once
  std::array<double, 3> box_min{};
  std::array<double, 3> box_max{};
  std::int64_t genus = 0;  // the sum over all shells of (2 - Euler characteristic) / 2
  Index vertices = 0;
  Index facets = 0;
  Index rings = 0;
  Index shells = 0;
};

/// The exact sign (-1, 0, +1) of the signed volume that triangles enclose. The order of the
/// vertices of a triangle is its orientation.
int volume_sign(std::span<const Point> vertices, std::span<const Triangle> triangles);

/// Six times the exact signed volume in lattice units, rounded once to the nearest double.
double six_volume(std::span<const Point> vertices, std::span<const Triangle> triangles);

/// The measures of a solid, whose facets `triangles` fill with the orientation of the facets.
/// Requires merged vertices; the genus is meaningful for closed 2-manifold shells.
Measures measure(const Solid& solid, std::span<const Triangle> triangles);

}  // namespace watertight::geometry
