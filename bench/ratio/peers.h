// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes that other coders need for one solid on the same integer grid. Draco stores triangles
// only (polygons, holes and identity are lost); the others keep polygons.
#pragma once

#include <cstddef>
#include <span>

#include "geometry/solid.h"

namespace watertight {

struct PeerBytes {
  std::size_t wkb = 0;             // EWKB, doubles in world coordinates
  std::size_t wkb_zstd = 0;        // EWKB through zstd -19
  std::size_t city_json_zstd = 0;  // {"vertices":[ints],"boundaries":[...]} through zstd -19
  std::size_t draco = 0;  // Draco, compression level 10, int32 positions; 0: too wide for Draco
  // Meshoptimizer's vertex and index buffers through zstd -19; 0: too wide for it.
  std::size_t meshopt = 0;
};

/// Measures a solid; `triangles` is its canonical triangulation. Requires an integer lattice.
PeerBytes measure_peers(const Solid& solid, std::span<const Triangle> triangles);

/// The bytes of all solids as one CityJSON through zstd -19: one list of vertices, each once,
/// counted from the smallest corner of all. Requires that the solids have the same lattice steps.
std::size_t whole_city_json_zstd(std::span<const Solid* const> solids);

}  // namespace watertight
