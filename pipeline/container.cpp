// SPDX-License-Identifier: GPL-3.0-or-later
//
// Layout: magic (8 bytes), version (1), format name, header, feature count, features, CRC-32C of
// all before (4). Texts and blobs are a varint of their length and their bytes.
#include "pipeline/container.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/checksum.h"

namespace watertight {
namespace {

// As PNG's: a byte above 127, and line ends that a text-mode transfer would change.
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'W', 'T', 'F', '\r', '\n', 0x1A, '\n'};
constexpr std::uint8_t kVersion = 0;
constexpr std::size_t kChecksumBytes = 4;

void write_text(ByteWriter& writer, ByteView text) {
  writer.varint(text.size());
  writer.append(text);
}

void write_text(ByteWriter& writer, std::string_view text) { write_text(writer, as_bytes(text)); }

ByteView read_bytes(ByteReader& reader) {
  const std::uint64_t size = reader.varint();
  return reader.take(size > reader.remaining() ? reader.remaining() + 1
                                               : static_cast<std::size_t>(size));
}

std::string read_text(ByteReader& reader) { return std::string(as_text(read_bytes(reader))); }

std::uint32_t read_index(ByteReader& reader, bool& is_in_range) {
  const std::uint64_t value = reader.varint();
  if (value > std::numeric_limits<std::uint32_t>::max()) is_in_range = false;
  return static_cast<std::uint32_t>(value);
}

void write_feature_part(ByteWriter& writer, const StoredFeature& feature) {
  write_text(writer, feature.id);
  write_text(writer, feature.type);
  writer.varint(feature.srid);
  write_text(writer, feature.skeleton);
  writer.varint(feature.solids.size());
  for (const StoredSolid& solid : feature.solids) {
    write_text(writer, solid.object_id);
    write_text(writer, solid.lod);
    writer.varint(solid.geometry);
    writer.varint(solid.ordinal);
    write_text(writer, ByteView(solid.blob));
  }
}

/// False when the bytes do not hold one.
bool read_feature_part(ByteReader& reader, StoredFeature& feature) {
  bool is_in_range = true;
  feature.id = read_text(reader);
  feature.type = read_text(reader);
  feature.srid = read_index(reader, is_in_range);
  feature.skeleton = read_text(reader);
  const std::uint64_t count = reader.varint();
  if (count > reader.remaining()) return false;  // a solid takes more than one byte
  for (std::uint64_t i = 0; i < count && !reader.failed() && is_in_range; ++i) {
    StoredSolid solid;
    solid.object_id = read_text(reader);
    solid.lod = read_text(reader);
    solid.geometry = read_index(reader, is_in_range);
    solid.ordinal = read_index(reader, is_in_range);
    const ByteView blob = read_bytes(reader);
    solid.blob.assign(blob.begin(), blob.end());
    feature.solids.push_back(std::move(solid));
  }
  return !reader.failed() && is_in_range;
}

Error malformed(std::string message, std::uint64_t offset) {
  return Error{ErrorCode::malformed, std::move(message), offset, {}};
}

/// The bytes between version and checksum.
Result<ByteView> checked_content(ByteView bytes, const Limits& limits) {
  if (bytes.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, std::to_string(bytes.size()) + " bytes; the limit is " +
                                                std::to_string(limits.bytes)};
  }
  if (!is_container(bytes)) return malformed("not a Watertight file", 0);
  if (bytes.size() < kMagic.size() + 1 + kChecksumBytes) {
    return malformed("truncated Watertight file", bytes.size());
  }
  if (bytes[kMagic.size()] != kVersion) {
    return Error{ErrorCode::unsupported,
                 "Watertight file of version " + std::to_string(bytes[kMagic.size()]) +
                     "; this program reads version " + std::to_string(kVersion),
                 kMagic.size(),
                 {}};
  }
  const ByteView checked = bytes.first(bytes.size() - kChecksumBytes);
  ByteReader checksum(bytes.last(kChecksumBytes));
  if (checksum.u32() != crc32c(checked)) {
    return malformed("truncated or damaged Watertight file: its checksum differs", checked.size());
  }
  return checked.subspan(kMagic.size() + 1);
}

}  // namespace

bool is_container(ByteView bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

Result<Bytes> write_container(std::span<const StoredFeature> features) {
  ByteWriter writer;
  writer.append(kMagic);
  writer.u8(kVersion);
  write_text(writer, features.empty() ? std::string_view() : features.front().format);
  write_text(writer, features.empty() ? std::string_view() : features.front().header);
  writer.varint(features.size());
  for (const StoredFeature& feature : features) {
    if (feature.format != features.front().format || feature.header != features.front().header) {
      return Error{ErrorCode::invalid_argument, "the features are of several documents"};
    }
    write_feature_part(writer, feature);
  }
  writer.u32(crc32c(writer.bytes()));
  return std::move(writer).bytes();
}

Result<std::vector<StoredFeature>> read_container(ByteView bytes, const Limits& limits) {
  auto content = checked_content(bytes, limits);
  if (!content) return std::move(content).error();
  const std::size_t start = kMagic.size() + 1;
  ByteReader reader(*content);
  const std::string format = read_text(reader);
  const std::string header = read_text(reader);
  const std::uint64_t count = reader.varint();
  if (reader.failed() || count > reader.remaining()) {
    return malformed("truncated or malformed Watertight file", start + reader.position());
  }
  std::vector<StoredFeature> features;
  for (std::uint64_t i = 0; i < count; ++i) {
    StoredFeature feature;
    if (!read_feature_part(reader, feature)) {
      return malformed("malformed feature " + std::to_string(i), start + reader.position());
    }
    feature.format = format;
    // One header is shared by all; a copy for each could be made to take any amount of memory.
    if (i == 0) feature.header = header;
    features.push_back(std::move(feature));
  }
  if (reader.remaining() > 0) {
    return malformed("bytes after the last feature", start + reader.position());
  }
  return features;
}

Result<Document> decode_container(ByteView bytes, const Limits& limits) {
  auto features = read_container(bytes, limits);
  if (!features) return std::move(features).error();
  Document document;
  for (StoredFeature& stored : *features) {
    auto part = from_stored(stored, limits);
    if (!part) return std::move(part).error();
    if (document.features.empty()) {
      document.format = part->format;
      document.header = std::move(part->header);
    }
    document.features.push_back(std::move(part->features.front()));
    stored = StoredFeature();
  }
  return document;
}

}  // namespace watertight
