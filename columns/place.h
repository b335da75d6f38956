// SPDX-License-Identifier: GPL-3.0-or-later
//
// The place of a value in a text: the column to which it belongs. Internal to columns/.
#pragma once

#include <cstdint>

#include "columns/models/context_mixer.h"

namespace watertight::columns {

/// The numbers that have models of their own.
enum class Role : std::uint8_t {
  none,
  vertex_index,  // an index of a vertex, in a ring of a surface
  vertex_count,  // the number of vertices of a feature
  vertex_run,    // the vertices that a solid has: first, length, first, length, ...
  position,      // a coordinate in a list of positions, x y z x y z ... or x y x y ...
  coordinate     // a coordinate of a vertex that no solid has, x y z x y z ...
};

struct Place {
  Hash path = 0;                  // the object or array in which the value is
  Hash column = 0;                // the path with the key, or with the position in an array of few
  Hash key = 0;                   // in an object: its last key; in an array: 0
  std::uint32_t index = 0;        // the number of values and structures before it in its array
  std::uint32_t last_length = 0;  // the length of the last array at this path
  std::uint32_t axes = 0;         // of the positions of a list: 2 or 3
  bool is_in_array = false;
  Role role = Role::none;
};

}  // namespace watertight::columns
