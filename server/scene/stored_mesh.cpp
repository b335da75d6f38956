// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/scene/stored_mesh.h"

#include <array>
#include <utility>

#include "tiles/glb.h"
#include "tiles/tileset.h"

namespace watertight::server {

Result<tiles::FeatureMesh> mesh_of_shown(pipeline::ShownFeature feature,
                                         const tiles::Frame& frame) {
  if (feature.city.is_too_large) {
    return Error{ErrorCode::limit_exceeded, "the geometry has more vertices than are shown"};
  }
  auto mesh = tiles::mesh_of(std::move(feature.city), std::move(feature.id),
                             std::move(feature.type), feature.srid, frame);
  if (!mesh) return mesh;
  for (auto& property : feature.properties) mesh->properties.push_back(std::move(property));
  return mesh;
}

Result<Bytes> glb_of_feature(StoredFeature feature, const Limits& limits) {
  const Error nothing{ErrorCode::not_encodable, "this feature has no geometry to draw"};
  pipeline::ShownFeatureReader reader({}, limits);
  auto shown = reader.read(std::move(feature));
  if (!shown) return std::move(shown).error();
  if (shown->city.shapes.positions.empty() && !shown->city.is_too_large) return nothing;
  auto frame = shown->city.is_too_large
                   ? Result<tiles::Frame>(tiles::Frame())
                   : tiles::Frame::at(shown->srid, shown->city.shapes.positions.front());
  if (!frame) frame = tiles::Frame::at(0, shown->city.shapes.positions.front());
  const auto mesh = mesh_of_shown(*std::move(shown), *frame);
  if (!mesh) return mesh.error();
  if (mesh->is_empty()) return nothing;
  tiles::Tile tile;
  tile.box = mesh->box();
  const std::array<const tiles::FeatureMesh*, 1> alone{&*mesh};
  return tiles::write_glb(alone, tiles::origin_of(tile), tiles::Compression::none);
}

}  // namespace watertight::server
