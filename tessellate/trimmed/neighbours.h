// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which triangles of a plane triangulation share which edge. Edge 3 t + k goes from corner k of
// triangle t to the next. Internal to tessellate/trimmed/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/point.h"
#include "tessellate/trimmed/region.h"

namespace watertight::tessellate {

inline std::uint32_t next_edge(std::uint32_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
inline std::uint32_t previous_edge(std::uint32_t edge) {
  return edge % 3 == 0 ? edge + 2 : edge - 1;
}
inline Index& start_of(std::span<Triangle> triangles, std::uint32_t edge) {
  return triangles[edge / 3][edge % 3];
}
inline Index start_of(std::span<const Triangle> triangles, std::uint32_t edge) {
  return triangles[edge / 3][edge % 3];
}

/// For each edge the number of the one between the same points in the other direction, or kNone.
/// Cost: linear.
std::vector<std::uint32_t> opposites_of(std::span<const PlaneEdge> edges, std::size_t point_count);

/// For each edge the edge of the other triangle, or kNone. Cost: linear.
std::vector<std::uint32_t> twins_of(std::span<const Triangle> triangles, std::size_t point_count);

/// The corners around the two triangles that share an edge; the edge joins the first and third.
std::array<Index, 4> quadrangle_at(std::span<const Triangle> triangles, std::uint32_t edge,
                                   std::uint32_t twin);

/// Replaces an edge by the other diagonal of its two triangles. The diagonal is the edge before
/// `edge`; `edge`, its former twin and the edges after them are the sides of the quadrangle.
void flip(std::span<Triangle> triangles, std::span<std::uint32_t> twins, std::uint32_t edge);

/// True if the edge between the first and the third corner of a convex quadrangle, which turns
/// left, is Delaunay (flip_to_delaunay).
bool is_delaunay(std::span<const Point> points, const std::array<Index, 4>& quadrangle);

/// flip_to_delaunay() where only the given edges may not be Delaunay.
void restore_delaunay(std::span<const Point> points, std::span<Triangle> triangles,
                      std::span<std::uint32_t> twins, std::span<const std::uint32_t> edges);

}  // namespace watertight::tessellate
