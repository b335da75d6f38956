// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/ratio/peers.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "codec/page/integer_solid.h"
#include "formats/ewkb.h"

namespace watertight {
namespace {

constexpr int kZstdLevel = 19;

std::size_t zstd_size(ByteView bytes) {
  std::vector<char> buffer(ZSTD_compressBound(bytes.size()));
  return ZSTD_compress(buffer.data(), buffer.size(), bytes.data(), bytes.size(), kZstdLevel);
}

std::array<std::int64_t, 3> integers(const Point& p) {
  return {static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y),
          static_cast<std::int64_t>(p.z)};
}

std::string join(const std::vector<std::string>& items) {
  std::string text = "[";
  for (const std::string& item : items) text += (text.size() > 1 ? "," : "") + item;
  return text + "]";
}

std::string point_text(const codec::GridPoint& c) {
  return join({std::to_string(c[0]), std::to_string(c[1]), std::to_string(c[2])});
}

/// The nested arrays of a CityJSON Solid, with each vertex index mapped by `number`.
template <class Number>
std::string boundaries(const Solid& solid, const Number& number) {
  std::vector<std::string> shells;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    std::vector<std::string> facets;
    for (Index facet = solid.facets_of(shell).begin; facet < solid.facets_of(shell).end; ++facet) {
      std::vector<std::string> rings;
      for (Index ring = solid.rings_of(facet).begin; ring < solid.rings_of(facet).end; ++ring) {
        std::vector<std::string> indices;
        for (const Index vertex : solid.ring(ring)) {
          indices.push_back(std::to_string(number(vertex)));
        }
        rings.push_back(join(indices));
      }
      facets.push_back(join(rings));
    }
    shells.push_back(join(facets));
  }
  return join(shells);
}

std::string city_json(const Solid& solid) {
  std::vector<std::string> vertices;
  for (const Point& p : solid.vertices()) vertices.push_back(point_text(integers(p)));
  return "{\"vertices\":" + join(vertices) +
         ",\"boundaries\":" + boundaries(solid, [](Index vertex) { return vertex; }) + "}";
}

std::size_t meshopt_size(const Solid& solid, std::span<const Triangle> triangles) {
  std::vector<std::array<std::int32_t, 3>> vertices;
  for (const Point& p : solid.vertices()) {
    const auto c = integers(p);
    if (std::max({c[0], c[1], c[2]}) > std::numeric_limits<std::int32_t>::max()) return 0;
    vertices.push_back({static_cast<std::int32_t>(c[0]), static_cast<std::int32_t>(c[1]),
                        static_cast<std::int32_t>(c[2])});
  }
  std::vector<unsigned int> indices;
  for (const Triangle& triangle : triangles) {
    indices.insert(indices.end(), triangle.begin(), triangle.end());
  }
  // The reordering suits meshoptimizer's coders.
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices.size());
  const std::size_t used = meshopt_optimizeVertexFetch(
      vertices.data(), indices.data(), indices.size(), vertices.data(), vertices.size(), 12);
  Bytes coded(meshopt_encodeVertexBufferBound(used, 12));
  coded.resize(meshopt_encodeVertexBuffer(coded.data(), coded.size(), vertices.data(), used, 12));
  Bytes faces(meshopt_encodeIndexBufferBound(indices.size(), used));
  faces.resize(
      meshopt_encodeIndexBuffer(faces.data(), faces.size(), indices.data(), indices.size()));
  coded.insert(coded.end(), faces.begin(), faces.end());
  return std::min(coded.size(), zstd_size(coded));
}

std::size_t draco_size(const Solid& solid, std::span<const Triangle> triangles) {
  const Box box = solid.box();  // its minimum is 0 in a lattice's normal form
  if (std::max({box.max.x, box.max.y, box.max.z}) > std::numeric_limits<std::int32_t>::max())
    return 0;
  draco::Mesh mesh;
  mesh.set_num_points(solid.vertex_count());
  draco::GeometryAttribute position;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false,
                3 * sizeof(std::int32_t), 0);
  const int attribute = mesh.AddAttribute(position, true, solid.vertex_count());
  for (Index vertex = 0; vertex < solid.vertex_count(); ++vertex) {
    const auto c = integers(solid.vertices()[vertex]);
    const std::array<std::int32_t, 3> value{static_cast<std::int32_t>(c[0]),
                                            static_cast<std::int32_t>(c[1]),
                                            static_cast<std::int32_t>(c[2])};
    mesh.attribute(attribute)->SetAttributeValue(draco::AttributeValueIndex(vertex), value.data());
  }
  for (const Triangle& triangle : triangles) {
    mesh.AddFace({draco::PointIndex(triangle[0]), draco::PointIndex(triangle[1]),
                  draco::PointIndex(triangle[2])});
  }
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);  // compression level 10
  draco::EncoderBuffer buffer;
  return encoder.EncodeMeshToBuffer(mesh, &buffer).ok() ? buffer.size() : 0;
}

}  // namespace

PeerBytes measure_peers(const Solid& solid, std::span<const Triangle> triangles) {
  PeerBytes bytes;
  const Bytes wkb = formats::write_ewkb(solid);
  bytes.wkb = wkb.size();
  bytes.wkb_zstd = zstd_size(wkb);
  bytes.city_json_zstd = zstd_size(as_bytes(city_json(solid)));
  bytes.draco = draco_size(solid, triangles);
  bytes.meshopt = meshopt_size(solid, triangles);
  return bytes;
}

std::size_t whole_city_json_zstd(std::span<const Solid* const> solids) {
  std::vector<codec::GriddedSolid> gridded;
  codec::GridPoint corner{INT64_MAX, INT64_MAX, INT64_MAX};
  for (const Solid* solid : solids) {
    auto on_grid = codec::grid_solid(*solid);
    if (!on_grid) continue;
    for (const codec::GridPoint& vertex : on_grid->solid.vertices) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        corner[axis] = std::min(corner[axis], vertex[axis]);
      }
    }
    gridded.push_back(std::move(*on_grid));
  }
  std::map<codec::GridPoint, std::size_t> numbers;
  std::vector<std::string> vertices;
  std::string objects;
  for (std::size_t i = 0; i < gridded.size(); ++i) {
    for (const codec::GridPoint& vertex : gridded[i].solid.vertices) {
      if (!numbers.emplace(vertex, numbers.size()).second) continue;
      vertices.push_back(
          point_text({vertex[0] - corner[0], vertex[1] - corner[1], vertex[2] - corner[2]}));
    }
    objects +=
        (i == 0 ? "\"" : ",\"") + std::to_string(i) +
        "\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"Solid\",\"lod\":\"2\"," +
        "\"boundaries\":" +
        boundaries(*solids[i],
                   [&](Index vertex) { return numbers.at(gridded[i].solid.vertices[vertex]); }) +
        "}]}";
  }
  return zstd_size(as_bytes("{\"type\":\"CityJSON\",\"version\":\"2.0\",\"CityObjects\":{" +
                            objects + "},\"vertices\":" + join(vertices) + "}"));
}

}  // namespace watertight
