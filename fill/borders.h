// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops around a hole, with vertices numbered from 0 through all loops. Internal to fill/.
#pragma once

#include <cstdint>
#include <vector>

#include "fill/angles.h"
#include "geometry/vector3.h"

namespace watertight::fill {

/// A vertex of the loops. Numbers follow the lexicographic order of the places.
using Vertex = std::uint16_t;
inline constexpr Vertex kNoVertex = 0xFFFF;

/// The place of each vertex of loops, and its neighbours along its loop.
struct Borders {
  std::vector<geometry::Vector3> places;  // vertex -> place in metres
  std::vector<Vertex> next;               // vertex -> the next one of its loop
  std::vector<std::uint8_t> loop;         // vertex -> number of its loop
  std::vector<std::uint32_t> position;    // vertex -> number in its loop
  std::vector<std::uint32_t> lengths;     // loop -> number of vertices
  /// Vertex -> direction from the edge to the next vertex into the facet of the shell there; zero
  /// where there is none.
  std::vector<geometry::Vector3> behind;

  std::size_t size() const { return places.size(); }
  bool is_border(Vertex a, Vertex b) const { return next[a] == b || next[b] == a; }
  /// The number of edges from one vertex to another one of its loop in the loop's sense.
  std::uint32_t steps(Vertex from, Vertex to) const {
    return position[to] >= position[from] ? position[to] - position[from]
                                          : position[to] + lengths[loop[from]] - position[from];
  }
};

}  // namespace watertight::fill
