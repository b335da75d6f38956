// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/ratio/peers.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/bytes.h"
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

std::string city_json(const Solid& solid) {
  std::vector<std::string> vertices;
  for (const Point& p : solid.vertices()) {
    const auto c = integers(p);
    vertices.push_back(join({std::to_string(c[0]), std::to_string(c[1]), std::to_string(c[2])}));
  }
  std::vector<std::string> shells;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    std::vector<std::string> facets;
    for (Index facet = solid.facets_of(shell).begin; facet < solid.facets_of(shell).end; ++facet) {
      std::vector<std::string> rings;
      for (Index ring = solid.rings_of(facet).begin; ring < solid.rings_of(facet).end; ++ring) {
        std::vector<std::string> indices;
        for (const Index vertex : solid.ring(ring)) indices.push_back(std::to_string(vertex));
        rings.push_back(join(indices));
      }
      facets.push_back(join(rings));
    }
    shells.push_back(join(facets));
  }
  return "{\"vertices\":" + join(vertices) + ",\"boundaries\":" + join(shells) + "}";
}

std::size_t draco_size(const Solid& solid, std::span<const Triangle> triangles) {
  const Box box = solid.box();  // the minimum is 0 in a lattice's normal form
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
  const Bytes wkb = write_ewkb(solid);
  bytes.wkb = wkb.size();
  bytes.wkb_zstd = zstd_size(wkb);
  bytes.city_json_zstd = zstd_size(as_bytes(city_json(solid)));
  bytes.draco = draco_size(solid, triangles);
  return bytes;
}

}  // namespace watertight
