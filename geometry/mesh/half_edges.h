// SPDX-License-Identifier: GPL-3.0-or-later
//
// Half-edges of triangles: half-edge 3 t + k runs from corner k of triangle t to the next corner.
#pragma once

#include <span>

#include "geometry/point.h"

namespace watertight::geometry {

/// The half-edge of the same triangle that begins where `half_edge` ends.
constexpr Index next_half_edge(Index half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

/// The half-edge of the same triangle that ends where `half_edge` begins.
constexpr Index previous_half_edge(Index half_edge) {
  return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
}

/// The half-edge of the same triangle that begins `corners` corners after `half_edge` does.
constexpr Index turned_half_edge(Index half_edge, Index corners) {
  return half_edge / 3 * 3 + (half_edge % 3 + corners) % 3;
}

/// The vertex where a half-edge begins.
inline Index start_of(std::span<const Triangle> triangles, Index half_edge) {
  return triangles[half_edge / 3][half_edge % 3];
}

/// The vertex where a half-edge ends.
inline Index end_of(std::span<const Triangle> triangles, Index half_edge) {
  return triangles[half_edge / 3][(half_edge % 3 + 1) % 3];
}

/// The vertex of its triangle that a half-edge does not touch.
inline Index corner_of(std::span<const Triangle> triangles, Index half_edge) {
  return triangles[half_edge / 3][(half_edge % 3 + 2) % 3];
}

}  // namespace watertight::geometry
