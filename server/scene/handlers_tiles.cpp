// SPDX-License-Identifier: GPL-3.0-or-later
//
// The handlers of a collection as 3D Tiles. The service keeps no tiles: the address of a tile has
// the part of the plane and the ranks of the features in it (store/solid_store.h), so that it means
// the same features however often the collection changes.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "server/handlers.h"
#include "server/items/kept_answer.h"
#include "server/scene/finding_pins.h"
#include "server/scene/stored_mesh.h"
#include "tiles/glb.h"
#include "tiles/pin.h"
#include "tiles/tileset.h"

namespace watertight::server {
namespace {

constexpr std::uint64_t kPlacesAtOnce = 10'000;
constexpr std::size_t kMostFeatures = 512;     // of a tile
constexpr std::uint64_t kMostBytes = 2 << 20;  // packed, of a tile of several features
constexpr std::size_t kMostTriangles = std::size_t{1} << 22;  // of a tile

std::string text_of(double number) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return {text.data(), end};
}

/// Numbers with commas between them.
template <std::size_t kCount>
std::string text_of(const std::array<double, kCount>& numbers) {
  std::string text;
  for (const double number : numbers) text.append(text.empty() ? "" : ",").append(text_of(number));
  return text;
}

template <class Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

/// The finite numbers of a parameter; nothing if there are not as many.
template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbers_of(const Target& target, std::string_view name) {
  const std::string* value = target.parameter(name);
  if (value == nullptr) return std::nullopt;
  std::array<double, kCount> numbers{};
  std::string_view rest = *value;
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t comma = rest.find(',');
    const bool is_last = comma == std::string_view::npos;
    if (is_last != (i + 1 == kCount) || !read_number(rest.substr(0, comma), numbers[i]) ||
        !std::isfinite(numbers[i])) {
      return std::nullopt;
    }
    rest.remove_prefix(is_last ? rest.size() : comma + 1);
  }
  return numbers;
}

/// A rank as the address of a tile has it: "SIZE:NUMBER".
std::string text_of(const tiles::TileRank& rank) {
  return text_of(rank.size).append(":").append(std::to_string(rank.number));
}

std::optional<store::SizeRank> rank_of(const Target& target, std::string_view name) {
  const std::string* value = target.parameter(name);
  if (value == nullptr) return std::nullopt;
  const std::size_t colon = value->find(':');
  store::SizeRank rank;
  const std::string_view text = *value;
  if (colon == std::string::npos || !read_number(text.substr(0, colon), rank.size) ||
      !read_number(text.substr(colon + 1), rank.number) || !std::isfinite(rank.size)) {
    return std::nullopt;
  }
  return rank;
}

/// Whether a tree of tiles can hold a box.
bool is_near(const store::StoredBox& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(box.min[axis] > -store::kFarthest && box.max[axis] < store::kFarthest)) return false;
  }
  return true;
}

/// Whether a layer of the findings is wanted instead of the features.
bool is_of_findings(const Target& target) {
  const std::string* layer = target.parameter("layer");
  return layer != nullptr && *layer == "findings";
}

/// The features of a collection that have a place and are in the wanted layer, as items of a tree.
Result<std::vector<tiles::TileItem>> items_of(const RoutedRequest& request,
                                              const std::string& collection) {
  std::vector<tiles::TileItem> items;
  std::string after;
  do {
    if (request.is_cancelled && request.is_cancelled()) {
      return Error{ErrorCode::cancelled, "the tileset was not finished in time"};
    }
    auto page = request.service.store->places(collection, kPlacesAtOnce, after,
                                              is_of_findings(request.target));
    if (!page) return std::move(page).error();
    for (const store::PlacedFeature& feature : page->features) {
      if (!is_near(feature.box)) continue;
      items.push_back({{feature.box.min, feature.box.max},
                       {store::plane_size(feature.box), feature.number},
                       std::max<std::uint64_t>(1, feature.bytes)});
    }
    after = std::move(page->next);
  } while (!after.empty());
  return items;
}

/// The frame of a tileset: around the middle of a box, on the Earth where there is a way to it.
tiles::Frame frame_at(std::uint32_t srid, const std::array<double, 2>& place) {
  const tiles::Frame::Position origin{place[0], place[1], 0};
  const auto frame = tiles::Frame::at(srid, origin);
  return frame ? *frame : *tiles::Frame::at(0, origin);
}

/// The box in metres of the frame around a box in the storage CRS: around points of its top and its
/// bottom, and as much more as the Earth is curved between them. Errors: those of Frame::place().
Result<tiles::TileBox> box_in_frame(std::uint32_t srid, const tiles::Frame& frame,
                                    const tiles::TileBox& box) {
  constexpr int kSteps = 4;
  constexpr double kCurvature =
      1e-8;  // metres for a square metre; 2^-7 / radius is an eighth of it
  std::vector<tiles::Frame::Position> points;
  for (int x = 0; x <= kSteps; ++x) {
    for (int y = 0; y <= kSteps; ++y) {
      for (const double z : {box.min[2], box.max[2]}) {
        points.push_back({box.min[0] + (box.max[0] - box.min[0]) * x / kSteps,
                          box.min[1] + (box.max[1] - box.min[1]) * y / kSteps, z});
      }
    }
  }
  const auto placed = frame.place(srid, points);
  if (!placed) return placed.error();
  tiles::TileBox around;
  for (const tiles::GridPosition& position : *placed) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double metres = position[axis] / tiles::kStepsOfAMetre;
      around.min[axis] = std::min(around.min[axis], metres);
      around.max[axis] = std::max(around.max[axis], metres);
    }
  }
  const double side = std::max(around.max[0] - around.min[0], around.max[1] - around.min[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    around.min[axis] -= kCurvature * side * side;
    around.max[axis] += kCurvature * side * side;
  }
  return around;
}

/// The box with room for pins.
tiles::TileBox box_with_pins(tiles::TileBox box) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    box.min[axis] -= tiles::kPinRadius;
    box.max[axis] += tiles::kPinRadius;
  }
  box.max[2] += tiles::kPinHeight;
  return box;
}

/// Writes the addresses of tiles, in the order of the tree.
class AddressWriter {
 public:
  /// `rest` are the parameters that all addresses have.
  AddressWriter(std::span<const tiles::Tile> tree, std::span<const tiles::TileItem> items,
                std::string rest)
      : tree_(tree), items_(items), rest_(std::move(rest)), addresses_(tree.size()) {
    if (!tree.empty()) write(0, nullptr);
  }

  std::vector<std::string> take() { return std::move(addresses_); }

 private:
  void write(std::size_t number, const tiles::TileRank* below) {
    const tiles::Tile& tile = tree_[number];
    const tiles::TileRank& from = items_[tile.items.back()].rank;
    const tiles::TileBounds& bounds = tile.bounds;
    std::string address = "3dtiles/content?";
    address.append(rest_).append("&bounds=");
    address.append(text_of(std::array{bounds.min[0], bounds.min[1], bounds.max[0], bounds.max[1]}));
    address.append("&from=").append(text_of(from));
    if (below != nullptr) address.append("&below=").append(text_of(*below));
    addresses_[number] = std::move(address);
    const tiles::TileRank* least = &from;
    for (const std::size_t child : tile.children) {
      write(child, least);
      // Tiles of one square follow each other by rank.
      if (tree_[child].part > 0) least = &items_[tree_[child].items.back()].rank;
    }
  }

  std::span<const tiles::Tile> tree_;
  std::span<const tiles::TileItem> items_;
  std::string rest_;
  std::vector<std::string> addresses_;
};

/// Whether tiles are wanted without compression.
bool is_plain(const Target& target) {
  const std::string* compression = target.parameter("compression");
  return compression != nullptr && *compression == "none";
}

/// The refusal of a compression or a layer that there is not.
std::optional<Response> refused_choice(const Target& target) {
  const std::string* compression = target.parameter("compression");
  if (compression != nullptr && *compression != "none" && *compression != "meshopt") {
    return refuse(400, "invalid-argument", "compression is meshopt or none");
  }
  const std::string* layer = target.parameter("layer");
  if (layer != nullptr && *layer != "features" && *layer != "findings") {
    return refuse(400, "invalid-argument", "layer is features or findings");
  }
  return std::nullopt;
}

/// The middle of a collection in the plane, which is the origin of the frame of all its layers.
/// `items`: the box around those of the layer.
std::array<double, 2> middle_of(const store::StoredCollection& collection,
                                const tiles::TileBox& items) {
  tiles::TileBox all = items;
  if (collection.box && is_near(*collection.box)) all = {collection.box->min, collection.box->max};
  return {(all.min[0] + all.max[0]) / 2, (all.min[1] + all.max[1]) / 2};
}

/// The text of the tileset of a collection.
Result<std::string> tileset_of(const RoutedRequest& request,
                               const store::StoredCollection& collection) {
  const auto items = items_of(request, collection.id);
  if (!items) return items.error();
  std::vector<tiles::Tile> tree =
      tiles::tile_tree(*items, {.items = kMostFeatures, .weight = kMostBytes});
  if (tree.empty()) return tiles::tileset_json({}, tiles::Frame(), tiles::content_name);
  const tiles::TileBox all = tree.front().box;
  const std::array<double, 2> middle = middle_of(collection, all);
  const bool has_pins = is_of_findings(request.target);
  const tiles::Frame frame = frame_at(collection.srid, middle);
  std::string rest = "frame=" + text_of(middle);
  if (is_plain(request.target)) rest += "&compression=none";
  if (has_pins) rest += "&layer=findings";
  std::vector<std::string> addresses = AddressWriter(tree, *items, std::move(rest)).take();
  const auto around = box_in_frame(collection.srid, frame, all);
  if (!around) return around.error();
  const double side = std::max(all.max[0] - all.min[0], all.max[1] - all.min[1]);
  const double metres = std::max(around->max[0] - around->min[0], around->max[1] - around->min[1]);
  const double scale = side > 0 ? metres / side : 1;  // metres of a unit of the storage CRS
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const auto box = box_in_frame(collection.srid, frame, tree[i].box);
    if (!box) return box.error();
    tree[i].box = has_pins ? box_with_pins(*box) : *box;
    tree[i].largest_below *= scale;
    addresses[i].append("&origin=");
    std::array<double, 3> origin{};
    for (std::size_t axis = 0; axis < 3; ++axis) origin[axis] = tiles::origin_of(tree[i])[axis];
    addresses[i].append(text_of(origin));
  }
  return tiles::tileset_json(tree, frame, [&](const tiles::Tile& tile) {
    return addresses[static_cast<std::size_t>(&tile - tree.data())];
  });
}

/// A tile that a client wants.
struct TileRequest {
  store::RankQuery query;
  std::array<double, 2> frame{};
  tiles::GridPosition origin{};
};

std::optional<TileRequest> tile_request(const Target& target) {
  const auto frame = numbers_of<2>(target, "frame");
  const auto origin = numbers_of<3>(target, "origin");
  const auto bounds = numbers_of<4>(target, "bounds");
  const auto from = rank_of(target, "from");
  const auto below = rank_of(target, "below");
  const bool is_below_wrong = target.parameter("below") != nullptr && !below;
  if (!frame || !origin || !bounds || !from || is_below_wrong) return std::nullopt;
  TileRequest wanted;
  wanted.frame = *frame;
  wanted.query = {
      target.segments[1], {(*bounds)[0], (*bounds)[1]}, {(*bounds)[2], (*bounds)[3]}, *from, below};
  wanted.query.only_unproven = is_of_findings(target);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(std::abs((*origin)[axis]) < INT32_MAX)) return std::nullopt;
    wanted.origin[axis] = static_cast<std::int32_t>((*origin)[axis]);
  }
  return wanted;
}

/// A stored feature in the layer that is wanted.
Result<std::vector<tiles::FeatureMesh>> meshes_of(StoredFeature stored, const TileRequest& wanted,
                                                  std::uint32_t srid, const tiles::Frame& frame,
                                                  pipeline::ShownFeatureReader& reader,
                                                  const Limits& limits) {
  if (wanted.query.only_unproven) return pins_of(std::move(stored), srid, frame, limits);
  auto shown = reader.read(std::move(stored));
  if (!shown) return std::move(shown).error();
  std::vector<tiles::FeatureMesh> meshes;
  auto mesh = mesh_of_shown(*std::move(shown), frame);
  // One that is too large to be shown, or has no place, is left out.
  if (mesh && !mesh->is_empty()) meshes.push_back(*std::move(mesh));
  return meshes;
}

/// The features of a tile as a .glb. Errors: not_found without any; limit_exceeded.
Result<Bytes> content_of(const RoutedRequest& request, const TileRequest& wanted,
                         std::uint32_t srid) {
  SolidStore& store = *request.service.store;
  const auto ids = store.ranked(wanted.query, kMostFeatures + 1);
  if (!ids) return ids.error();
  const Error too_much{ErrorCode::limit_exceeded, "the tile has more than a tile may have"};
  if (ids->size() > kMostFeatures) return too_much;
  const tiles::Frame frame = frame_at(srid, wanted.frame);
  const Limits& limits = request.service.options.limits;
  pipeline::ShownFeatureReader reader(std::nullopt, limits);
  std::vector<tiles::FeatureMesh> meshes;
  std::size_t triangles = 0;
  for (const std::string& id : *ids) {
    if (request.is_cancelled && request.is_cancelled()) {
      return Error{ErrorCode::cancelled, "the tile was not finished in time"};
    }
    auto stored = store.get(wanted.query.collection, id);
    if (!stored && stored.error().code == ErrorCode::not_found) continue;
    if (!stored) return std::move(stored).error();
    auto added = meshes_of(*std::move(stored), wanted, srid, frame, reader, limits);
    if (!added) return std::move(added).error();
    for (tiles::FeatureMesh& mesh : *added) {
      triangles += mesh.triangle_count();
      if (triangles > kMostTriangles) return too_much;
      meshes.push_back(std::move(mesh));
    }
  }
  if (meshes.empty()) return Error{ErrorCode::not_found, "there is no feature in this tile"};
  std::vector<const tiles::FeatureMesh*> features;
  for (const tiles::FeatureMesh& mesh : meshes) features.push_back(&mesh);
  return tiles::write_glb(
      features, wanted.origin,
      is_plain(request.target) ? tiles::Compression::none : tiles::Compression::meshopt);
}

}  // namespace

Response get_tileset(const RoutedRequest& request) {
  if (auto refusal = refused_choice(request.target)) return *std::move(refusal);
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  return kept_or_made(request, *collection, "3dtiles", kJson,
                      [&] { return tileset_of(request, *collection); });
}

Response get_tile(const RoutedRequest& request) {
  if (auto refusal = refused_choice(request.target)) return *std::move(refusal);
  const auto wanted = tile_request(request.target);
  if (!wanted) {
    return refuse(400, "invalid-argument",
                  "this is no address of a tile: take those in tileset.json as they are");
  }
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  return kept_or_made(request, *collection, "3dtiles", kGltf, [&]() -> Result<std::string> {
    const auto content = content_of(request, *wanted, collection->srid);
    if (!content) return content.error();
    return std::string(as_text(*content));
  });
}

}  // namespace watertight::server
