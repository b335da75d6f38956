// SPDX-License-Identifier: GPL-3.0-or-later
//
// Layout: magic (8 bytes), version (1), length of the texts, the texts as one Zstandard frame, the
// blobs one after the other, CRC-32C of all before (4). All texts are compressed together, as
// features of one document resemble each other. They are: format, header, framing, feature count;
// for each feature id, type, SRID, skeleton, solid count; for each solid object id, LoD, geometry,
// ordinal and the length of its blob. A text is a varint of its length and its bytes.
#include "pipeline/container.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/checksum.h"
#include "formats/packed_text.h"

namespace watertight {
namespace {

// As PNG's: a byte above 127, and line ends that a text-mode transfer would change.
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'W', 'T', 'F', '\r', '\n', 0x1A, '\n'};
constexpr std::uint8_t kVersion = 1;
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

Status write_feature_part(ByteWriter& writer, const StoredFeature& feature) {
  const auto skeleton = unpacked_skeleton(feature);
  if (!skeleton) return skeleton.error();
  write_text(writer, feature.id);
  write_text(writer, feature.type);
  writer.varint(feature.srid);
  write_text(writer, *skeleton);
  writer.varint(feature.solids.size());
  for (const StoredSolid& solid : feature.solids) {
    write_text(writer, solid.object_id);
    write_text(writer, solid.lod);
    writer.varint(solid.geometry);
    writer.varint(solid.ordinal);
    writer.varint(solid.blob.size());
  }
  return Done{};
}

/// False when the texts and blobs do not hold one.
bool read_feature_part(ByteReader& reader, ByteReader& blobs, StoredFeature& feature) {
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
    const std::uint64_t size = reader.varint();
    if (size > blobs.remaining()) return false;
    const ByteView blob = blobs.take(static_cast<std::size_t>(size));
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

Result<Bytes> write_container(const StoredDocument& document) {
  ByteWriter texts;
  write_text(texts, document.format);
  write_text(texts, document.header);
  write_text(texts, ByteView(document.framing));
  texts.varint(document.features.size());
  for (const StoredFeature& feature : document.features) {
    if (feature.format != document.format || feature.header != document.header) {
      return Error{ErrorCode::invalid_argument, "the features are of several documents"};
    }
    if (Status status = write_feature_part(texts, feature); !status) return status.error();
  }
  const auto packed = pack_text(as_text(texts.bytes()));
  if (!packed) return packed;
  ByteWriter writer;
  writer.append(kMagic);
  writer.u8(kVersion);
  write_text(writer, ByteView(*packed));
  for (const StoredFeature& feature : document.features) {
    for (const StoredSolid& solid : feature.solids) writer.append(solid.blob);
  }
  writer.u32(crc32c(writer.bytes()));
  return std::move(writer).bytes();
}

Result<StoredDocument> read_container(ByteView bytes, const Limits& limits) {
  auto content = checked_content(bytes, limits);
  if (!content) return std::move(content).error();
  ByteReader blobs(*content);
  const ByteView packed = read_bytes(blobs);
  if (blobs.failed()) return malformed("truncated Watertight file", kMagic.size() + 1);
  const auto texts = unpack_text(packed, limits.bytes);
  if (!texts) return texts.error();
  ByteReader reader(as_bytes(*texts));
  StoredDocument document;
  document.format = read_text(reader);
  document.header = read_text(reader);
  const ByteView framing = read_bytes(reader);
  document.framing.assign(framing.begin(), framing.end());
  const std::uint64_t count = reader.varint();
  if (reader.failed() || count > reader.remaining()) {
    return malformed("malformed texts of a Watertight file", kMagic.size() + 1);
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    StoredFeature feature;
    if (!read_feature_part(reader, blobs, feature)) {
      return malformed("malformed feature " + std::to_string(i), kMagic.size() + 1);
    }
    feature.format = document.format;
    document.features.push_back(std::move(feature));
  }
  if (reader.remaining() > 0 || blobs.remaining() > 0) {
    return malformed("bytes after the last feature", bytes.size() - kChecksumBytes);
  }
  return document;
}

Result<Document> decode_container(ByteView bytes, const Limits& limits) {
  auto stored = read_container(bytes, limits);
  if (!stored) return std::move(stored).error();
  const auto format = format_named(stored->format);
  if (!format) return format.error();
  Document document;
  document.format = *format;
  document.header = std::move(stored->header);
  document.framing = std::move(stored->framing);
  for (StoredFeature& feature : stored->features) {
    auto part = from_stored(feature, limits);
    if (!part) return std::move(part).error();
    document.features.push_back(std::move(part->features.front()));
    feature = StoredFeature();
  }
  return document;
}

}  // namespace watertight
