// SPDX-License-Identifier: GPL-3.0-or-later
//
// Stored features as triangles, for glTF and 3D Tiles. Internal to server/.
#pragma once

#include <string>

#include "server/features/feature_text.h"
#include "tiles/feature_mesh.h"

namespace watertight::server {

/// The feature in a frame; the properties of the service are those of its GeoJSON. Errors:
/// limit_exceeded for more vertices than are shown; those of tiles::mesh_of().
Result<tiles::FeatureMesh> mesh_of_shown(pipeline::ShownFeature feature, const tiles::Frame& frame);

/// The feature alone, as a .glb around its own middle. Errors: not_encodable without anything to
/// draw; those of ShownFeatureReader::read() and mesh_of_shown().
Result<Bytes> glb_of_feature(StoredFeature feature, const Limits& limits);

}  // namespace watertight::server
