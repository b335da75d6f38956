// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/container_reader.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/checksum.h"
#include "codec/page_file.h"
#include "formats/text/packed_text.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kHeadBytes = sizeof(kContainerMagic) + 1;
constexpr std::size_t kChecksumBytes = 4;

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

/// The texts of a part. `sizes` are the bytes of each solid's blob, 0 for a solid in the page file.
struct Texts {
  std::uint8_t version = 1;  // that of the file
  ContainerPart part;
  std::vector<std::uint64_t> sizes;
};

/// Takes `count` items from those that may still come; false when there are fewer.
bool take_items(std::uint64_t count, std::uint64_t& items_left) {
  if (count > items_left) return false;
  items_left -= count;
  return true;
}

/// Reads a feature; false when the texts do not hold one.
bool read_feature(ByteReader& reader, std::uint64_t documents, std::uint64_t& items_left,
                  Texts& texts) {
  bool is_in_range = true;
  ContainerFeature& feature = texts.part.features.emplace_back();
  feature.document = reader.varint();
  feature.encoded.id = read_text(reader);
  feature.encoded.type = read_text(reader);
  feature.encoded.srid = read_index(reader, is_in_range);
  feature.encoded.skeleton = read_text(reader);
  if (texts.version > 1) feature.encoded.findings = read_text(reader);
  const std::uint64_t count = reader.varint();
  if (!take_items(count, items_left)) return false;
  for (std::uint64_t i = 0; i < count && !reader.failed() && is_in_range; ++i) {
    StoredSolid& solid = feature.encoded.solids.emplace_back();
    solid.object_id = read_text(reader);
    solid.lod = read_text(reader);
    solid.geometry = read_index(reader, is_in_range);
    solid.ordinal = read_index(reader, is_in_range);
    texts.sizes.push_back(reader.varint());
    solid.is_proven = texts.version == 1 || texts.sizes.back() != kNoBlob;
    if (!solid.is_proven) solid.report = read_text(reader);
  }
  return !reader.failed() && is_in_range && feature.document < documents;
}

/// Reads the texts of a part that follows `documents` documents; false when the texts do not fit.
bool read_texts(ByteView bytes, std::uint64_t documents, std::uint64_t& items_left, Texts& texts) {
  ByteReader reader(bytes);
  const std::uint64_t added = reader.varint();
  if (!take_items(added, items_left)) return false;
  for (std::uint64_t i = 0; i < added && !reader.failed(); ++i) {
    ContainerDocument& document = texts.part.new_documents.emplace_back();
    document.format = read_text(reader);
    document.header = read_text(reader);
    const ByteView framing = read_bytes(reader);
    document.framing.assign(framing.begin(), framing.end());
  }
  const std::uint64_t features = reader.varint();
  if (reader.failed() || !take_items(features, items_left)) return false;
  for (std::uint64_t i = 0; i < features; ++i) {
    if (!read_feature(reader, documents + added, items_left, texts)) return false;
  }
  return reader.remaining() == 0;
}

/// Takes the vertices of a solid from those that may still come. Errors: limit_exceeded.
Status take_vertices(const Decoded& decoded, std::uint64_t& vertices_left) {
  const std::uint64_t count = decoded.solid.vertex_count();
  if (count > vertices_left) {
    return Error{ErrorCode::limit_exceeded,
                 "the solids have more vertices than a Watertight file of this length may claim"};
  }
  vertices_left -= count;
  return Done{};
}

/// The solids of a page file in order.
Result<std::vector<Decoded>> decode_pages(ByteView file, const Limits& limits,
                                          std::uint64_t& vertices_left, std::uint64_t& pages) {
  const auto reader = codec::PageFileReader::open(file, limits);
  if (!reader) return reader.error();
  pages = reader->page_count();
  std::vector<std::optional<Decoded>> found(reader->size());
  for (std::size_t i = 0; i < reader->page_count(); ++i) {
    auto page = reader->page(i);
    if (!page) return std::move(page).error();
    for (auto& solid : *page) {
      if (Status taken = take_vertices(solid.decoded, vertices_left); !taken) {
        return std::move(taken).error();
      }
      found[solid.number] = std::move(solid.decoded);
    }
  }
  std::vector<Decoded> solids;
  for (std::optional<Decoded>& solid : found) solids.push_back(*std::move(solid));
  return solids;
}

}  // namespace

Result<Feature> restored(ContainerFeature feature, Format format, const Limits& limits) {
  feature.encoded.format = std::string(formats::to_string(format));
  std::vector<Solid> solids;
  for (Decoded& decoded : feature.solids) solids.push_back(std::move(decoded.solid));
  auto document = decode_feature(feature.encoded, std::move(solids), limits);
  if (!document) return std::move(document).error();
  return std::move(document->features.front());
}

Result<ContainerReader> ContainerReader::open(ByteView bytes, const Limits& limits) {
  if (bytes.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, std::to_string(bytes.size()) + " bytes; the limit is " +
                                                std::to_string(limits.bytes)};
  }
  const auto malformed = [](std::string message, std::uint64_t offset) {
    return Error{ErrorCode::malformed, std::move(message), offset, {}};
  };
  if (bytes.size() < sizeof(kContainerMagic) ||
      !std::equal(std::begin(kContainerMagic), std::end(kContainerMagic), bytes.begin())) {
    return malformed("not a Watertight file", 0);
  }
  if (bytes.size() < kHeadBytes + kChecksumBytes) {
    return malformed("truncated Watertight file", bytes.size());
  }
  const std::uint8_t version = bytes[kHeadBytes - 1];
  if (version == 0 || version > kContainerVersion) {
    return Error{ErrorCode::unsupported,
                 "Watertight file of version " + std::to_string(version) +
                     "; this program reads versions 1 to " + std::to_string(kContainerVersion),
                 kHeadBytes - 1,
                 {}};
  }
  const ByteView checked = bytes.first(bytes.size() - kChecksumBytes);
  ByteReader checksum(bytes.last(kChecksumBytes));
  if (checksum.u32() != crc32c(checked)) {
    return malformed("truncated or damaged Watertight file: its checksum differs", checked.size());
  }
  return ContainerReader(checked.subspan(kHeadBytes), limits, version);
}

Error ContainerReader::malformed(std::string message) const {
  return {ErrorCode::malformed, std::move(message), kHeadBytes + parts_.position(), {}};
}

Result<std::optional<ContainerPart>> ContainerReader::next() {
  const ByteView packed = read_bytes(parts_);
  if (parts_.failed()) return malformed("truncated Watertight file");
  if (packed.empty()) {
    if (parts_.remaining() > 0) return malformed("bytes after the last part");
    return std::optional<ContainerPart>();
  }
  const auto text = formats::unpack_text(packed, texts_left_);
  if (!text) return text.error();
  texts_left_ -= text->size();
  Texts texts;
  texts.version = version_;
  if (!read_texts(as_bytes(*text), documents_, items_left_, texts)) {
    return malformed("malformed texts of a Watertight file");
  }
  ContainerPart& part = texts.part;
  for (const ContainerFeature& feature : part.features) {
    if (feature.encoded.skeleton.size() <= limits_.feature_bytes) continue;
    return Error{ErrorCode::limit_exceeded, "the text of the feature '" + feature.encoded.id +
                                                "' is longer than " +
                                                std::to_string(limits_.feature_bytes) + " bytes"};
  }
  documents_ += part.new_documents.size();
  const std::size_t before = parts_.remaining();
  const ByteView page_file = read_bytes(parts_);
  if (parts_.failed()) return malformed("truncated pages");
  std::vector<Decoded> paged;
  if (!page_file.empty()) {
    auto decoded = decode_pages(page_file, limits_, vertices_left_, part.pages);
    if (!decoded) return std::move(decoded).error();
    paged = *std::move(decoded);
  }
  std::size_t number = 0;
  std::size_t next_paged = 0;
  for (ContainerFeature& feature : part.features) {
    for (std::size_t i = 0; i < feature.encoded.solids.size(); ++i) {
      const std::uint64_t size = texts.sizes[number++];
      if (!feature.encoded.solids[i].is_proven) continue;
      if (size == 0) {
        if (next_paged == paged.size())
          return malformed("the pages hold fewer solids than the features");
        feature.solids.push_back(std::move(paged[next_paged++]));
        continue;
      }
      if (size > parts_.remaining()) return malformed("truncated blob");
      auto decoded = decode(parts_.take(static_cast<std::size_t>(size)), limits_);
      if (!decoded) return std::move(decoded).error();
      if (Status taken = take_vertices(*decoded, vertices_left_); !taken) {
        return std::move(taken).error();
      }
      feature.solids.push_back(*std::move(decoded));
    }
  }
  if (next_paged != paged.size())
    return malformed("the pages hold solids that belong to no feature");
  part.solid_bytes = before - parts_.remaining();
  return std::optional<ContainerPart>(std::move(part));
}

}  // namespace watertight::pipeline
