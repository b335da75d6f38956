// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "codec/page_file.h"
#include "pipeline/blocks/block.h"
#include "pipeline/blocks/block_texts.h"

namespace watertight::pipeline {
namespace {

void write_part(ByteWriter& writer, ByteView part) {
  writer.varint(part.size());
  writer.append(part);
}

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
  std::vector<std::uint64_t> blob_bytes;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    blob_bytes.push_back(paged->is_in_file[i] ? 0 : blobs[i]->empty() ? kNoBlob : blobs[i]->size());
  }
  ByteWriter block;
  write_part(block, pack_block_texts(contents, blob_bytes));
  write_part(block, paged->file);
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (!paged->is_in_file[i]) block.append(*blobs[i]);
  }
  return std::move(block).bytes();
}

}  // namespace watertight::pipeline
