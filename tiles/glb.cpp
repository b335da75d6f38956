// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/glb.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tiles/property_table.h"

namespace watertight::tiles {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// Numbers of the glTF specification.
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kPoints = 0;
constexpr int kLines = 1;
constexpr int kTriangles = 4;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kAlignment = 8;  // of the arrays of property tables

struct LookMaterial {
  const char* name;
  std::array<double, 3> colour;  // linear
};
constexpr std::array<LookMaterial, kLooks> kMaterials{{{"roof", {0.42, 0.10, 0.06}},
                                                       {"wall", {0.66, 0.60, 0.50}},
                                                       {"ground", {0.20, 0.20, 0.20}},
                                                       {"building", {0.60, 0.56, 0.50}},
                                                       {"terrain", {0.36, 0.40, 0.22}},
                                                       {"vegetation", {0.08, 0.28, 0.06}},
                                                       {"water", {0.06, 0.22, 0.46}},
                                                       {"transport", {0.18, 0.18, 0.20}},
                                                       {"other", {0.45, 0.45, 0.52}},
                                                       {"finding", {0.78, 0.02, 0.05}}}};

using VertexPosition = std::array<float, 3>;

/// A list of corners with one material and one mode of drawing.
struct Primitive {
  int mode = kTriangles;
  std::size_t look = 0;
  std::vector<Index> corners;
};

/// The geometry of all features with common vertices.
struct Geometry {
  std::vector<VertexPosition> positions;
  std::vector<std::uint32_t> feature_ids;  // of each vertex
  std::vector<Primitive> primitives;
};

/// Metres from the origin, y up.
VertexPosition position_in_gltf(const GridPosition& position, const GridPosition& origin) {
  std::array<double, 3> metres{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    metres[axis] = (static_cast<double>(position[axis]) - origin[axis]) / kStepsOfAMetre;
  }
  // Adding zero makes -0 to +0.
  return {static_cast<float>(metres[0] + 0.0), static_cast<float>(metres[2] + 0.0),
          static_cast<float>(-metres[1] + 0.0)};
}

Geometry geometry_of(std::span<const FeatureMesh* const> features, const GridPosition& origin) {
  Geometry geometry;
  std::array<Primitive, kLooks + 2> all;
  for (std::size_t look = 0; look < kLooks; ++look) all[look].look = look;
  Primitive& lines = all[kLooks];
  Primitive& points = all[kLooks + 1];
  lines.mode = kLines;
  points.mode = kPoints;
  lines.look = points.look = static_cast<std::size_t>(Look::other);
  for (std::size_t id = 0; id < features.size(); ++id) {
    const FeatureMesh& feature = *features[id];
    const auto first = static_cast<Index>(geometry.positions.size());
    for (const GridPosition& vertex : feature.vertices) {
      geometry.positions.push_back(position_in_gltf(vertex, origin));
      geometry.feature_ids.push_back(static_cast<std::uint32_t>(id));
    }
    for (std::size_t look = 0; look < kLooks; ++look) {
      for (const Triangle& triangle : feature.triangles[look]) {
        for (const Index corner : triangle) all[look].corners.push_back(first + corner);
      }
    }
    for (const auto& line : feature.lines) {
      for (const Index end : line) lines.corners.push_back(first + end);
    }
    for (const Index point : feature.points) points.corners.push_back(first + point);
  }
  for (Primitive& primitive : all) {
    if (!primitive.corners.empty()) geometry.primitives.push_back(std::move(primitive));
  }
  return geometry;
}

/// Orders triangles so that neighbours follow each other, and vertices by their first use; drops
/// vertices without use.
void order_by_use(Geometry& geometry) {
  std::vector<Index> place(geometry.positions.size(), kNone);
  std::vector<VertexPosition> positions;
  std::vector<std::uint32_t> feature_ids;
  for (Primitive& primitive : geometry.primitives) {
    if (primitive.mode == kTriangles) {
      meshopt_optimizeVertexCache(primitive.corners.data(), primitive.corners.data(),
                                  primitive.corners.size(), geometry.positions.size());
    }
    for (Index& corner : primitive.corners) {
      Index& placed = place[corner];
      if (placed == kNone) {
        placed = static_cast<Index>(positions.size());
        positions.push_back(geometry.positions[corner]);
        feature_ids.push_back(geometry.feature_ids[corner]);
      }
      corner = placed;
    }
  }
  geometry.positions = std::move(positions);
  geometry.feature_ids = std::move(feature_ids);
}

template <class Value>
ByteView bytes_of(std::span<const Value> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

/// The JSON and the binary part of a .glb as they grow.
class GlbWriter {
 public:
  explicit GlbWriter(Compression compression) : compression_(compression) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Watertight"}};
    json_["extensionsUsed"] = Json::array({"EXT_mesh_features", "EXT_structural_metadata"});
    if (compression == Compression::meshopt) {
      json_["extensionsUsed"].push_back("EXT_meshopt_compression");
      json_["extensionsRequired"] = Json::array({"EXT_meshopt_compression"});
    }
  }

  Json& json() { return json_; }

  /// Adds a view of bytes as they are; returns its number.
  std::size_t add_view(ByteView bytes) {
    const std::size_t offset = append(bytes.empty() ? ByteView(kNothing) : bytes);
    return add({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", binary_.size() - offset}});
  }

  /// Adds vertices of `stride` bytes, a multiple of 4.
  std::size_t add_vertices(ByteView bytes, std::size_t stride) {
    const std::size_t count = bytes.size() / stride;
    Json view{{"byteStride", stride}, {"target", kArrayBuffer}};
    if (compression_ == Compression::none) return add_plain(bytes, std::move(view));
    Bytes coded(meshopt_encodeVertexBufferBound(count, stride));
    coded.resize(
        meshopt_encodeVertexBuffer(coded.data(), coded.size(), bytes.data(), count, stride));
    return add_coded(coded, bytes.size(), stride, "ATTRIBUTES", std::move(view));
  }

  /// Adds corners of triangles, or of lines and points; returns the number of the view.
  std::size_t add_corners(const Primitive& primitive, std::size_t vertices) {
    const std::vector<Index>& corners = primitive.corners;
    const bool is_short = is_short_index(vertices);
    Json view{{"target", kElementArrayBuffer}};
    if (compression_ == Compression::none) {
      if (!is_short) return add_plain(bytes_of(std::span(corners)), std::move(view));
      const std::vector<std::uint16_t> narrow(corners.begin(), corners.end());
      return add_plain(bytes_of(std::span(narrow)), std::move(view));
    }
    const bool is_triangles = primitive.mode == kTriangles;
    Bytes coded(is_triangles ? meshopt_encodeIndexBufferBound(corners.size(), vertices)
                             : meshopt_encodeIndexSequenceBound(corners.size(), vertices));
    coded.resize(is_triangles ? meshopt_encodeIndexBuffer(coded.data(), coded.size(),
                                                          corners.data(), corners.size())
                              : meshopt_encodeIndexSequence(coded.data(), coded.size(),
                                                            corners.data(), corners.size()));
    const std::size_t stride = is_short ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
    return add_coded(coded, corners.size() * stride, stride, is_triangles ? "TRIANGLES" : "INDICES",
                     std::move(view));
  }

  static bool is_short_index(std::size_t vertices) { return vertices < 65535; }

  std::size_t add_accessor(Json accessor) {
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
  }

  Bytes finish() {
    pad(binary_);
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    if (compression_ == Compression::meshopt) {
      json_["buffers"].push_back(
          {{"byteLength", expanded_},
           {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    }
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + kAlignment - 1) / kAlignment * kAlignment, ' ');
    Bytes file;
    file.reserve(28 + text.size() + binary_.size());
    append_word(file, kMagic);
    append_word(file, 2);
    append_word(file, 28 + text.size() + binary_.size());
    append_word(file, text.size());
    append_word(file, kJsonChunk);
    file.insert(file.end(), text.begin(), text.end());
    append_word(file, binary_.size());
    append_word(file, kBinaryChunk);
    file.insert(file.end(), binary_.begin(), binary_.end());
    return file;
  }

 private:
  static constexpr std::array<std::uint8_t, 1> kNothing{0};

  static void append_word(Bytes& file, std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
      file.push_back(static_cast<std::uint8_t>(value >> shift));
    }
  }

  static void pad(Bytes& bytes) {
    bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
  }

  std::size_t append(ByteView bytes) {
    pad(binary_);
    const std::size_t offset = binary_.size();
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
    return offset;
  }

  std::size_t add(Json view) {
    json_["bufferViews"].push_back(std::move(view));
    return json_["bufferViews"].size() - 1;
  }

  std::size_t add_plain(ByteView bytes, Json more) {
    Json view{{"buffer", 0}, {"byteOffset", append(bytes)}, {"byteLength", bytes.size()}};
    view.update(more);
    return add(std::move(view));
  }

  /// Adds a view whose bytes are compressed; the place in the second buffer, which is in no file,
  /// is where a program expands them.
  std::size_t add_coded(ByteView coded, std::size_t size, std::size_t stride, const char* mode,
                        Json more) {
    expanded_ = (expanded_ + kAlignment - 1) / kAlignment * kAlignment;
    Json view{{"buffer", 1}, {"byteOffset", expanded_}, {"byteLength", size}};
    view.update(more);
    view["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0},          {"byteOffset", append(coded)}, {"byteLength", coded.size()},
        {"byteStride", stride}, {"count", size / stride},      {"mode", mode}};
    expanded_ += size;
    return add(std::move(view));
  }

  Compression compression_;
  Json json_;
  Bytes binary_;
  std::size_t expanded_ = 0;
};

/// The accessor of the positions, with the bounds that glTF demands.
std::size_t add_positions(GlbWriter& writer, const std::vector<VertexPosition>& positions) {
  VertexPosition low = positions.front();
  VertexPosition high = low;
  for (const VertexPosition& position : positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], position[axis]);
      high[axis] = std::max(high[axis], position[axis]);
    }
  }
  const std::size_t view =
      writer.add_vertices(bytes_of(std::span(positions)), sizeof(VertexPosition));
  return writer.add_accessor({{"bufferView", view},
                              {"componentType", kFloat},
                              {"count", positions.size()},
                              {"type", "VEC3"},
                              {"min", low},
                              {"max", high}});
}

/// The accessor of the feature ids: glTF allows no whole numbers of 32 bits for vertices.
std::size_t add_feature_ids(GlbWriter& writer, const std::vector<std::uint32_t>& ids,
                            std::size_t features) {
  const bool is_short = features <= 65536;
  std::size_t view = 0;
  if (is_short) {
    view = writer.add_vertices(bytes_of(std::span(ids)), sizeof(std::uint32_t));
  } else {
    const std::vector<float> wide(ids.begin(), ids.end());
    view = writer.add_vertices(bytes_of(std::span(wide)), sizeof(float));
  }
  return writer.add_accessor({{"bufferView", view},
                              {"componentType", is_short ? kUnsignedShort : kFloat},
                              {"count", ids.size()},
                              {"type", "SCALAR"}});
}

/// Adds the properties of the features.
void add_properties(GlbWriter& writer, std::span<const FeatureMesh* const> features) {
  const std::vector<PropertyColumn> columns = property_columns(features);
  Json table{{"class", "feature"}, {"count", features.size()}, {"properties", Json::object()}};
  for (const PropertyColumn& column : columns) {
    Json& property = table["properties"][column.id];
    if (column.is_number) {
      property["values"] = writer.add_view(bytes_of(std::span(column.numbers)));
    } else {
      property["values"] = writer.add_view(as_bytes(column.text));
      property["stringOffsets"] = writer.add_view(bytes_of(std::span(column.offsets)));
      property["stringOffsetType"] = "UINT32";
    }
  }
  writer.json()["extensions"]["EXT_structural_metadata"] = {
      {"schema", {{"id", "watertight"}, {"classes", {{"feature", property_class(columns)}}}}},
      {"propertyTables", Json::array({std::move(table)})}};
}

Json material_of(std::size_t look) {
  const auto& [name, colour] = kMaterials[look];
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", 0.9}}},
          {"doubleSided", true}};
}

}  // namespace

Bytes write_glb(std::span<const FeatureMesh* const> features, const GridPosition& origin,
                Compression compression) {
  Geometry geometry = geometry_of(features, origin);
  order_by_use(geometry);
  GlbWriter writer(compression);
  const std::size_t positions = add_positions(writer, geometry.positions);
  const std::size_t ids = add_feature_ids(writer, geometry.feature_ids, features.size());
  Json primitives = Json::array();
  for (const Primitive& primitive : geometry.primitives) {
    const std::size_t view = writer.add_corners(primitive, geometry.positions.size());
    const bool is_short = GlbWriter::is_short_index(geometry.positions.size());
    const std::size_t corners =
        writer.add_accessor({{"bufferView", view},
                             {"componentType", is_short ? kUnsignedShort : kUnsignedInt},
                             {"count", primitive.corners.size()},
                             {"type", "SCALAR"}});
    writer.json()["materials"].push_back(material_of(primitive.look));
    const Json feature_ids =
        Json::array({{{"featureCount", features.size()}, {"attribute", 0}, {"propertyTable", 0}}});
    primitives.push_back({{"attributes", {{"POSITION", positions}, {"_FEATURE_ID_0", ids}}},
                          {"indices", corners},
                          {"mode", primitive.mode},
                          {"material", writer.json()["materials"].size() - 1},
                          {"extensions", {{"EXT_mesh_features", {{"featureIds", feature_ids}}}}}});
  }
  writer.json()["meshes"] = Json::array({{{"primitives", std::move(primitives)}}});
  writer.json()["nodes"] = Json::array({{{"mesh", 0}}});
  writer.json()["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
  writer.json()["scene"] = 0;
  add_properties(writer, features);
  return writer.finish();
}

}  // namespace watertight::tiles
