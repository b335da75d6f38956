// SPDX-License-Identifier: GPL-3.0-or-later
//
// Features as one binary glTF 2.0: a primitive for each look, feature ids by EXT_mesh_features,
// properties by EXT_structural_metadata, buffers by EXT_meshopt_compression.
#pragma once

#include <array>
#include <span>

#include "base/bytes.h"
#include "tiles/feature_mesh.h"

namespace watertight::tiles {

enum class Compression : std::uint8_t { none, meshopt };

/// The features as a .glb whose origin is at `origin` of their frame; y is up, as glTF demands, z
/// points south. The name of a property in the table is one that the extension allows; `name` has
/// the attribute's own. A property is a number where all values are numbers, else a text; features
/// without a value have `noData`. Triangles have no normals, so that programs shade them flat. The
/// same features give the same bytes. Requires at least one feature that is not empty. Cost:
/// O(n log n).
Bytes write_glb(std::span<const FeatureMesh* const> features, const GridPosition& origin,
                Compression compression);

}  // namespace watertight::tiles
