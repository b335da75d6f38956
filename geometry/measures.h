// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures of a solid: exact signed volume, area, box, genus, counts. World units.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "geometry/solid.h"

namespace watertight::geometry {

struct Measures {
  double volume = 0;  // world units cubed; the exact value rounded once
  double area = 0;    // world units squared; rounded sum
  std::array<double, 3> box_min{};
  std::array<double, 3> box_max{};
  std::int64_t genus = 0;  // handles: sum over shells of (2 - euler characteristic) / 2
  Index vertices = 0;
  Index facets = 0;
  Index rings = 0;
  Index shells = 0;
};

/// Exact sign (-1, 0, +1) of the volume enclosed by the facets [facets.begin, facets.end) given as
/// triangles, oriented by their vertex order. Computed in exact arithmetic.
int volume_sign(std::span<const Point> vertices, std::span<const Triangle> triangles);

/// Six times the exact signed volume in lattice units, rounded once to the nearest double.
double six_volume(std::span<const Point> vertices, std::span<const Triangle> triangles);

/// Measures of a solid whose facets are triangulated as given (facet orientation kept).
/// Requires vertices merged; genus is meaningful for closed 2-manifold shells.
Measures measure(const Solid& solid, std::span<const Triangle> triangles);

}  // namespace watertight::geometry
