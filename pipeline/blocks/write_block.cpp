// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "codec/page_file.h"
#include "formats/text/packed_text.h"
#include "pipeline/blocks/block.h"
#include "pipeline/blocks/block_bytes.h"

namespace watertight::pipeline {
namespace {

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

void write_feature(ByteWriter& writer, const BlockFeature& feature, bool has_numbers,
                   const std::vector<bool>& is_paged, std::size_t first_solid) {
  const EncodedFeature& encoded = feature.encoded;
  writer.varint(feature.document);
  if (has_numbers) writer.varint(feature.number);
  write_text(writer, encoded.id);
  write_text(writer, encoded.type);
  writer.varint(encoded.srid);
  write_text(writer, encoded.skeleton);
  write_text(writer, encoded.findings);
  writer.varint(encoded.solids.size());
  for (std::size_t i = 0; i < encoded.solids.size(); ++i) {
    const StoredSolid& solid = encoded.solids[i];
    write_text(writer, solid.object_id);
    write_text(writer, solid.lod);
    writer.varint(solid.geometry);
    writer.varint(solid.ordinal);
    const std::size_t size = is_paged[first_solid + i] ? 0 : solid.blob.size();
    writer.varint(solid.is_proven ? size : kNoBlob);
    if (!solid.is_proven) write_text(writer, solid.report);
  }
}

ByteWriter texts_of(const BlockContents& contents, const std::vector<bool>& is_paged) {
  ByteWriter texts;
  texts.varint(contents.documents.size());
  for (const BlockDocument& document : contents.documents) {
    write_text(texts, document.format);
    write_text(texts, document.header.str());
    write_text(texts, ByteView(document.framing));
  }
  texts.varint(2 * contents.features.size() + (contents.has_numbers ? 1 : 0));
  std::size_t solids = 0;
  for (const BlockFeature& feature : contents.features) {
    write_feature(texts, feature, contents.has_numbers, is_paged, solids);
    solids += feature.encoded.solids.size();
  }
  return texts;
}

}  // namespace

Result<Bytes> write_block(const BlockContents& contents,
                          std::span<const BlockDocument> /*documents*/, const EncodeOptions& pages,
                          SolidLayout layout) {
  std::vector<const Bytes*> blobs;
  for (const BlockFeature& feature : contents.features) {
    for (const StoredSolid& solid : feature.encoded.solids) blobs.push_back(&solid.blob);
  }
  const auto paged = pages_if_smaller(blobs, pages, layout);
  if (!paged) return paged.error();
  const ByteWriter texts = texts_of(contents, paged->is_in_file);
  const auto packed = formats::pack_text(as_text(texts.bytes()));
  if (!packed) return packed.error();
  ByteWriter block;
  write_text(block, ByteView(packed->bytes));
  write_text(block, ByteView(paged->file));
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (!paged->is_in_file[i]) block.append(*blobs[i]);
  }
  return std::move(block).bytes();
}

}  // namespace watertight::pipeline
