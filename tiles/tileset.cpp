// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/tileset.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace watertight::tiles {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kThinnest = 0.5;  // metres: half the least side of a box, for renderers

/// The box of a tile around its origin, as a bounding volume.
Json box_json(const Tile& tile) {
  const GridPosition origin = origin_of(tile);
  std::array<double, 12> box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box[3 + axis * 4] = kThinnest;
    if (tile.box.is_empty()) continue;
    const double low = tile.box.min[axis] - origin[axis] / kStepsOfAMetre;
    const double high = tile.box.max[axis] - origin[axis] / kStepsOfAMetre;
    box[axis] = (low + high) / 2;
    box[3 + axis * 4] = std::max((high - low) / 2, kThinnest);
  }
  return {{"box", box}};
}

/// The matrix of a tile, which counts in the system of the tile above it.
Json transform_json(const Tile& tile, const Tile* above, const Frame& frame) {
  const GridPosition origin = origin_of(tile);
  const GridPosition from = above == nullptr ? GridPosition{} : origin_of(*above);
  std::array<double, 3> way{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way[axis] = (static_cast<double>(origin[axis]) - from[axis]) / kStepsOfAMetre;
  }
  std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (above == nullptr) matrix = frame.matrix();
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = matrix[12 + row];
    for (std::size_t k = 0; k < 3; ++k) {
      sum += (above == nullptr ? matrix[k * 4 + row] : (k == row ? 1.0 : 0.0)) * way[k];
    }
    matrix[12 + row] = sum;
  }
  return matrix;
}

class TilesetWriter {
 public:
  TilesetWriter(std::span<const Tile> tiles, const Frame& frame,
                const std::function<std::string(const Tile&)>& uri)
      : tiles_(tiles), frame_(frame), uri_(uri) {}

  Json tile_json(std::size_t number, const Tile* above) const {
    const Tile& tile = tiles_[number];
    Json json{{"transform", transform_json(tile, above, frame_)},
              {"boundingVolume", box_json(tile)},
              {"geometricError", tile.largest_below}};
    if (above == nullptr) json["refine"] = "ADD";
    if (!tile.items.empty()) json["content"] = {{"uri", uri_(tile)}};
    if (!tile.children.empty()) {
      Json& children = json["children"] = Json::array();
      for (const std::size_t child : tile.children) children.push_back(tile_json(child, &tile));
    }
    return json;
  }

 private:
  std::span<const Tile> tiles_;
  const Frame& frame_;
  const std::function<std::string(const Tile&)>& uri_;
};

}  // namespace

GridPosition origin_of(const Tile& tile) {
  GridPosition origin{};
  if (tile.box.is_empty()) return origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis] = static_cast<std::int32_t>(
        std::round((tile.box.min[axis] + tile.box.max[axis]) / 2 * kStepsOfAMetre));
  }
  return origin;
}

std::string content_name(const Tile& tile) {
  std::string name = std::to_string(tile.level);
  name.append("/").append(std::to_string(tile.x)).append("/").append(std::to_string(tile.y));
  if (tile.part > 0) name.append("-").append(std::to_string(tile.part));
  return name.append(".glb");
}

std::string tileset_json(std::span<const Tile> tiles, const Frame& frame,
                         const std::function<std::string(const Tile&)>& uri) {
  const std::vector<Tile> none(1);
  const std::span<const Tile> all = tiles.empty() ? std::span<const Tile>(none) : tiles;
  const Json json{{"asset", {{"version", "1.1"}, {"generator", "Watertight"}}},
                  {"geometricError", all.front().box.diagonal()},
                  {"root", TilesetWriter(all, frame, uri).tile_json(0, nullptr)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace watertight::tiles
