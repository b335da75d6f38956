// SPDX-License-Identifier: GPL-3.0-or-later
//
// The layout: magic (8 bytes), version (1), the parts, a zero byte, CRC-32C of all bytes before
// (4). A part is the length of its texts, the texts as one Zstandard frame, the length of its page
// file (0 for none), the page file, and the blobs of the solids that no page has. All texts of a
// part are compressed together, as features of one document resemble each other; parts are small
// enough for memory and large enough to compress well.
#include "pipeline/container.h"

#include <algorithm>
#include <utility>

#include "base/checksum.h"
#include "codec/page_file.h"
#include "formats/text/packed_text.h"
#include "pipeline/container_reader.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kPartFeatures = 4096;
constexpr std::size_t kPartBytes = 16U << 20U;  // the most bytes of skeletons and blobs in a part

void write_text(ByteWriter& writer, ByteView text) {
  writer.varint(text.size());
  writer.append(text);
}

void write_text(ByteWriter& writer, std::string_view text) { write_text(writer, as_bytes(text)); }

/// The page file of the solids that may be in pages: all but the solids whose blobs have Steiner
/// vertices, which pages do not keep.
struct Paged {
  Bytes file;
  std::size_t blob_bytes = 0;    // the bytes of the blobs that the file replaces
  std::vector<bool> is_in_file;  // for each solid, whether it is in the file
};

Result<Paged> make_pages(const std::vector<const Bytes*>& blobs, const EncodeOptions& options) {
  codec::PageFileWriter writer(codec::kMaxPageSolids, options);
  Paged paged;
  for (const Bytes* blob : blobs) {
    if (blob->empty()) {
      paged.is_in_file.push_back(false);
      continue;
    }
    const auto info = codec::describe(*blob);
    if (!info) return info.error();
    paged.is_in_file.push_back(info->steiner_vertices == 0);
    if (!paged.is_in_file.back()) continue;
    paged.blob_bytes += blob->size();
    if (Status status = writer.add_blob(*blob); !status) return status.error();
  }
  auto file = std::move(writer).finish();
  if (!file) return std::move(file).error();
  paged.file = *std::move(file);
  return paged;
}

/// The page file, or an empty one where the blobs are smaller or wanted.
Result<Paged> pages_if_smaller(const std::vector<const Bytes*>& blobs, const EncodeOptions& options,
                               SolidLayout layout) {
  Paged none;
  none.is_in_file.resize(blobs.size());
  if (layout == SolidLayout::blobs) return none;
  auto paged = make_pages(blobs, options);
  if (!paged && paged.error().code != ErrorCode::not_encodable) return paged;
  if (!paged || paged->file.size() >= paged->blob_bytes) return none;
  return paged;
}

void write_feature(ByteWriter& writer, std::uint64_t document, const EncodedFeature& feature,
                   const std::vector<bool>& is_paged, std::size_t first_solid,
                   std::uint8_t version) {
  writer.varint(document);
  write_text(writer, feature.id);
  write_text(writer, feature.type);
  writer.varint(feature.srid);
  write_text(writer, feature.skeleton);
  if (version > 1) write_text(writer, feature.findings);
  writer.varint(feature.solids.size());
  for (std::size_t i = 0; i < feature.solids.size(); ++i) {
    const StoredSolid& solid = feature.solids[i];
    write_text(writer, solid.object_id);
    write_text(writer, solid.lod);
    writer.varint(solid.geometry);
    writer.varint(solid.ordinal);
    const std::size_t size = is_paged[first_solid + i] ? 0 : solid.blob.size();
    writer.varint(solid.is_proven ? size : kNoBlob);
    if (!solid.is_proven) write_text(writer, solid.report);
  }
}

}  // namespace

bool is_container(ByteView bytes) {
  return bytes.size() >= sizeof(kContainerMagic) &&
         std::equal(std::begin(kContainerMagic), std::end(kContainerMagic), bytes.begin());
}

ContainerWriter::ContainerWriter(const EncodeOptions& pages, SolidLayout layout,
                                 std::uint8_t version)
    : pages_(pages), layout_(layout), version_(version) {
  pages_.certificate = nullptr;
  write(kContainerMagic);
  write(ByteView(&version_, 1));
}

void ContainerWriter::write(ByteView bytes) {
  checksum_ = crc32c(bytes, checksum_);
  written_.insert(written_.end(), bytes.begin(), bytes.end());
}

void ContainerWriter::add_document(const std::string& format, const SharedText& header,
                                   Bytes framing) {
  if (!documents_.try_emplace({format, header}, documents_.size()).second) return;
  ++new_documents_;
  write_text(new_document_texts_, format);
  write_text(new_document_texts_, header.str());
  write_text(new_document_texts_, ByteView(framing));
}

Status ContainerWriter::add(EncodedFeature feature) {
  if (version_ == 1 && !feature.is_proven()) {
    return Error{ErrorCode::unsupported, "feature '" + feature.id + "' is not proven"};
  }
  add_document(feature.format, feature.header);
  part_bytes_ += feature.skeleton.size();
  for (const StoredSolid& solid : feature.solids) part_bytes_ += solid.blob.size();
  const std::uint64_t document = documents_.at({feature.format, feature.header});
  features_.emplace_back(document, std::move(feature));
  if (features_.size() < kPartFeatures && part_bytes_ < kPartBytes) return Done{};
  return close_part();
}

Status ContainerWriter::close_part() {
  std::vector<const Bytes*> blobs;
  for (const auto& [document, feature] : features_) {
    for (const StoredSolid& solid : feature.solids) blobs.push_back(&solid.blob);
  }
  const auto paged = pages_if_smaller(blobs, pages_, layout_);
  if (!paged) return paged.error();
  ByteWriter texts;
  texts.varint(new_documents_);
  texts.append(new_document_texts_.bytes());
  texts.varint(features_.size());
  std::size_t solids = 0;
  for (const auto& [document, feature] : features_) {
    write_feature(texts, document, feature, paged->is_in_file, solids, version_);
    solids += feature.solids.size();
  }
  const auto packed = formats::pack_text(as_text(texts.bytes()));
  if (!packed) return packed.error();
  ByteWriter part;
  write_text(part, ByteView(packed->bytes));
  write_text(part, ByteView(paged->file));
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (!paged->is_in_file[i]) part.append(*blobs[i]);
  }
  write(part.bytes());
  features_.clear();
  new_document_texts_ = {};
  new_documents_ = 0;
  part_bytes_ = 0;
  return Done{};
}

Bytes ContainerWriter::take() { return std::exchange(written_, {}); }

Result<Bytes> ContainerWriter::finish() && {
  if (!features_.empty() || new_documents_ > 0) {
    if (Status status = close_part(); !status) return status.error();
  }
  constexpr std::uint8_t kEnd = 0;
  write(ByteView(&kEnd, 1));
  ByteWriter checksum;
  checksum.u32(checksum_);
  write(checksum.bytes());
  return std::move(written_);
}

Result<Bytes> write_container(const EncodedDocument& document, const EncodeOptions& pages,
                              SolidLayout layout) {
  const bool all_proven =
      std::all_of(document.features.begin(), document.features.end(),
                  [](const EncodedFeature& feature) { return feature.is_proven(); });
  ContainerWriter writer(pages, layout, all_proven ? 1 : kContainerVersion);
  writer.add_document(document.format, document.header, document.framing);
  for (const EncodedFeature& feature : document.features) {
    if (feature.format != document.format || feature.header != document.header) {
      return Error{ErrorCode::invalid_argument, "the features are of several documents"};
    }
    if (Status status = writer.add(feature); !status) return status.error();
  }
  return std::move(writer).finish();
}

Result<std::vector<Document>> decode_container(ByteView bytes, const Limits& limits) {
  auto reader = ContainerReader::open(bytes, limits);
  if (!reader) return std::move(reader).error();
  std::vector<Document> documents;
  for (;;) {
    auto part = reader->next();
    if (!part) return std::move(part).error();
    if (!*part) return documents;
    for (ContainerDocument& added : (*part)->new_documents) {
      const auto format = formats::format_named(added.format);
      if (!format) return format.error();
      Document& document = documents.emplace_back();
      document.format = *format;
      document.header = std::move(added.header);
      document.framing = std::move(added.framing);
    }
    for (ContainerFeature& feature : (*part)->features) {
      Document& document = documents[feature.document];
      auto whole = restored(std::move(feature), document.format, limits);
      if (!whole) return std::move(whole).error();
      document.features.push_back(*std::move(whole));
    }
  }
}

namespace {

void list_unproven(const EncodedFeature& feature, ContainerInfo& info) {
  if (!feature.is_proven()) ++info.unproven_features;
  for (const StoredSolid& solid : feature.solids) {
    if (solid.is_proven) continue;
    info.unproven.push_back(
        {feature.id, solid.object_id, solid.lod, solid.geometry, solid.ordinal, solid.report});
  }
}

}  // namespace

Result<ContainerInfo> describe_container(ByteView bytes, const Limits& limits) {
  auto reader = ContainerReader::open(bytes, limits);
  if (!reader) return std::move(reader).error();
  ContainerInfo info;
  for (;;) {
    auto part = reader->next();
    if (!part) return std::move(part).error();
    if (!*part) return info;
    for (ContainerDocument& added : (*part)->new_documents) {
      const auto format = formats::format_named(added.format);
      if (!format) return format.error();
      info.formats.push_back(*format);
    }
    info.features += (*part)->features.size();
    info.pages += (*part)->pages;
    info.solid_bytes += (*part)->solid_bytes;
    for (const ContainerFeature& feature : (*part)->features) {
      info.solids += feature.encoded.solids.size();
      list_unproven(feature.encoded, info);
      for (const auto& [type, count] : other_geometries(feature.encoded)) {
        info.other_geometries[type] += count;
      }
      for (const Decoded& decoded : feature.solids) {
        for (const codec::BlobInfo::Part& bytes_of : decoded.info.parts) {
          info.parts[bytes_of.name] += bytes_of.bytes;
        }
      }
    }
  }
}

}  // namespace watertight::pipeline
