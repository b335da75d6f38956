// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/dense/mesh_peers.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace watertight {
namespace {

std::vector<std::array<std::int32_t, 3>> relative_positions(const codec::IntegerSolid& mesh) {
  codec::GridPoint least = mesh.vertices.front();
  for (const codec::GridPoint& p : mesh.vertices) {
    for (std::size_t k = 0; k < 3; ++k) least[k] = std::min(least[k], p[k]);
  }
  std::vector<std::array<std::int32_t, 3>> result;
  for (const codec::GridPoint& p : mesh.vertices) {
    std::array<std::int32_t, 3> relative{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (p[k] - least[k] > std::numeric_limits<std::int32_t>::max()) return {};
      relative[k] = static_cast<std::int32_t>(p[k] - least[k]);
    }
    result.push_back(relative);
  }
  return result;
}

std::size_t draco_size(const codec::IntegerSolid& mesh,
                       const std::vector<std::array<std::int32_t, 3>>& positions) {
  if (positions.empty()) return 0;
  draco::Mesh draco_mesh;
  draco_mesh.set_num_points(mesh.vertices.size());
  draco::GeometryAttribute position;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false,
                3 * sizeof(std::int32_t), 0);
  const int attribute = draco_mesh.AddAttribute(position, true, mesh.vertices.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    draco_mesh.attribute(attribute)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                       positions[i].data());
  }
  for (std::size_t i = 0; i < mesh.ring_vertices.size(); i += 3) {
    draco_mesh.AddFace({draco::PointIndex(mesh.ring_vertices[i]),
                        draco::PointIndex(mesh.ring_vertices[i + 1]),
                        draco::PointIndex(mesh.ring_vertices[i + 2])});
  }
  draco::Encoder encoder;
  // Compression level 10; wide numbers take level 8, because the trials of level 10 would take
  // minutes and gigabytes.
  std::int32_t widest = 0;
  for (const auto& p : positions) widest = std::max({widest, p[0], p[1], p[2]});
  const int speed = widest < (1 << 20) ? 0 : 2;
  encoder.SetSpeedOptions(speed, speed);
  draco::EncoderBuffer buffer;
  return encoder.EncodeMeshToBuffer(draco_mesh, &buffer).ok() ? buffer.size() : 0;
}

std::size_t zstd_size(const std::vector<unsigned char>& bytes, std::size_t size) {
  std::vector<char> buffer(ZSTD_compressBound(size));
  return ZSTD_compress(buffer.data(), buffer.size(), bytes.data(), size, 19);
}

}  // namespace

std::size_t draco_bytes(const codec::IntegerSolid& mesh) {
  return draco_size(mesh, relative_positions(mesh));
}

std::size_t draco_connectivity_bytes(const codec::IntegerSolid& mesh) {
  return draco_size(mesh, std::vector<std::array<std::int32_t, 3>>(mesh.vertices.size()));
}

std::size_t meshopt_bytes(const codec::IntegerSolid& mesh) {
  const auto positions = relative_positions(mesh);
  if (positions.empty()) return 0;
  std::vector<unsigned> indices(mesh.ring_vertices.begin(), mesh.ring_vertices.end());
  std::vector<unsigned> ordered(indices.size());
  meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), positions.size());
  std::vector<unsigned> remap(positions.size());
  meshopt_optimizeVertexFetchRemap(remap.data(), ordered.data(), ordered.size(), positions.size());
  std::int32_t widest = 0;
  for (const auto& p : positions) widest = std::max({widest, p[0], p[1], p[2]});
  const bool is_narrow = widest < 65536;
  for (unsigned& index : ordered) index = remap[index];
  std::vector<unsigned char> vertex_bytes(
      meshopt_encodeVertexBufferBound(positions.size(), is_narrow ? 8 : 12));
  std::size_t vertex_size = 0;
  if (is_narrow) {
    std::vector<std::array<std::uint16_t, 4>> values(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) values[remap[i]][k] = positions[i][k];
    }
    vertex_size = meshopt_encodeVertexBuffer(vertex_bytes.data(), vertex_bytes.size(),
                                             values.data(), values.size(), 8);
  } else {
    std::vector<std::array<std::int32_t, 3>> values(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) values[remap[i]] = positions[i];
    vertex_size = meshopt_encodeVertexBuffer(vertex_bytes.data(), vertex_bytes.size(),
                                             values.data(), values.size(), 12);
  }
  meshopt_encodeIndexVersion(1);
  std::vector<unsigned char> index_bytes(
      meshopt_encodeIndexBufferBound(ordered.size(), positions.size()));
  const std::size_t index_size = meshopt_encodeIndexBuffer(index_bytes.data(), index_bytes.size(),
                                                           ordered.data(), ordered.size());
  return zstd_size(vertex_bytes, vertex_size) + zstd_size(index_bytes, index_size);
}

}  // namespace watertight
