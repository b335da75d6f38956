// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "codec/page_file.h"
#include "geometry/valid_solid.h"
#include "pipeline/blocks/block.h"
#include "pipeline/blocks/block_grid.h"
#include "pipeline/blocks/block_texts.h"

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kInPages = 0;

void write_part(ByteWriter& writer, ByteView part) {
  writer.varint(part.size());
  writer.append(part);
}

/// A solid that is proven, on its way into the pages.
struct PagedSolid {
  const Bytes* blob = nullptr;
  std::size_t number = 0;   // its number in the block
  std::size_t feature = 0;  // the number of its feature
};

/// A page file, and how the block has each of its solids.
struct Paged {
  Bytes file;
  std::vector<std::uint64_t> forms;  // those of BlockTexts::blob_bytes
  std::size_t bytes = 0;             // of the file, and of the blobs that are not in it
};

/// The blobs as they are.
Paged without_pages(const BlockContents& contents) {
  Paged paged;
  for (const BlockFeature& feature : contents.features) {
    for (const StoredSolid& solid : feature.encoded.solids) {
      paged.forms.push_back(solid.blob.empty() ? kNoBlob : solid.blob.size());
      paged.bytes += solid.blob.size();
    }
  }
  return paged;
}

/// The solids that may be in pages: all but those whose blobs have Steiner vertices, which pages do
/// not keep.
Result<std::vector<PagedSolid>> solids_for_pages(const BlockContents& contents) {
  std::vector<PagedSolid> solids;
  std::size_t number = 0;
  for (std::size_t i = 0; i < contents.features.size(); ++i) {
    for (const StoredSolid& solid : contents.features[i].encoded.solids) {
      const std::size_t own = number++;
      if (solid.blob.empty()) continue;
      const auto info = codec::describe(solid.blob);
      if (!info) return info.error();
      if (info->steiner_vertices == 0) solids.push_back({&solid.blob, own, i});
    }
  }
  return solids;
}

Status take_pages(codec::PageFileWriter writer, Paged& paged) {
  auto file = std::move(writer).finish();
  if (!file) return std::move(file).error();
  paged.file = *std::move(file);
  paged.bytes += paged.file.size();
  return Done{};
}

Result<Paged> on_own_grids(const std::vector<PagedSolid>& solids, Paged paged,
                           const EncodeOptions& options) {
  codec::PageFileWriter writer(codec::kMaxPageSolids, options);
  for (const PagedSolid& solid : solids) {
    if (Status added = writer.add_blob(*solid.blob); !added) return added.error();
    paged.forms[solid.number] = kInPages;
    paged.bytes -= solid.blob->size();
  }
  if (Status taken = take_pages(std::move(writer), paged); !taken) return taken.error();
  return paged;
}

/// The solids of a feature on the grid; none unless a reader makes the very solids from them.
std::vector<Solid> moved_exactly(const BlockGrid& grid, std::span<const Solid* const> solids) {
  std::vector<Solid> moved;
  std::vector<const Solid*> views;
  for (const Solid* solid : solids) {
    auto on_grid = grid.moved(*solid);
    if (!on_grid) return {};
    moved.push_back(*std::move(on_grid));
  }
  for (const Solid& solid : moved) views.push_back(&solid);
  const auto placed = on_lattice_of_decimals(views);
  const bool is_exact =
      placed && std::equal(placed->begin(), placed->end(), solids.begin(),
                           [](const Solid& a, const Solid* b) { return a == *b; });
  return is_exact ? moved : std::vector<Solid>();
}

/// All solids that can be on one grid in pages on that grid, the others on their own.
Result<Paged> on_block_grid(const std::vector<PagedSolid>& solids, Paged paged,
                            const EncodeOptions& options) {
  std::vector<Decoded> decoded;
  std::vector<const Solid*> views;
  for (const PagedSolid& solid : solids) {
    auto one = decode(*solid.blob);
    if (!one) return std::move(one).error();
    decoded.push_back(*std::move(one));
  }
  for (const Decoded& one : decoded) views.push_back(&one.solid);
  const auto grid = BlockGrid::of(views);
  if (!grid) return Error{ErrorCode::not_encodable, "the solids have no grid in common"};
  codec::PageFileWriter writer(codec::kMaxPageSolids, options);
  for (std::size_t begin = 0, end = 0; begin < solids.size(); begin = end) {
    while (end < solids.size() && solids[end].feature == solids[begin].feature) ++end;
    const auto moved = moved_exactly(*grid, std::span(views).subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_moved = !moved.empty();
      const auto boundary = OrientedBoundary::make(is_moved ? moved[i - begin] : decoded[i].solid);
      if (!boundary) return boundary.error();
      if (Status added = writer.add(*boundary, decoded[i].info.acceptance); !added)
        return added.error();
      paged.forms[solids[i].number] = is_moved ? kOnBlockGrid : kInPages;
      paged.bytes -= solids[i].blob->size();
    }
  }
  if (Status taken = take_pages(std::move(writer), paged); !taken) return taken.error();
  return paged;
}

/// Takes pages that are smaller than the best so far. Errors: all but that a solid cannot be in
/// pages.
Status take_smaller(Result<Paged> pages, Paged& best) {
  if (!pages && pages.error().code != ErrorCode::not_encodable) return std::move(pages).error();
  if (pages && pages->bytes < best.bytes) best = *std::move(pages);
  return Done{};
}

Result<Paged> smallest_pages(const BlockContents& contents, const EncodeOptions& options) {
  const Paged blobs = without_pages(contents);
  const auto solids = solids_for_pages(contents);
  if (!solids) return solids.error();
  auto pages = on_own_grids(*solids, blobs, options);
  const auto reader = pages ? codec::PageFileReader::open(pages->file)
                            : Result<codec::PageFileReader>(pages.error());
  const bool have_one_grid =
      reader &&
      reader->page_count() <= (solids->size() + codec::kMaxPageSolids - 1) / codec::kMaxPageSolids;
  Paged best = blobs;
  if (Status taken = take_smaller(std::move(pages), best); !taken) return std::move(taken).error();
  if (have_one_grid) return best;
  if (Status taken = take_smaller(on_block_grid(*solids, blobs, options), best); !taken) {
    return std::move(taken).error();
  }
  return best;
}

}  // namespace

Result<WrittenBlock> write_block(const BlockContents& contents,
                                 std::span<const BlockDocument> /*documents*/,
                                 const EncodeOptions& pages, SolidLayout layout) {
  const auto paged =
      layout == SolidLayout::blobs ? without_pages(contents) : smallest_pages(contents, pages);
  if (!paged) return paged.error();
  const PackedTexts texts = pack_block_texts(contents, paged->forms);
  ByteWriter block;
  write_part(block, texts.bytes);
  write_part(block, paged->file);
  std::size_t number = 0;
  for (const BlockFeature& feature : contents.features) {
    for (const StoredSolid& solid : feature.encoded.solids) {
      if (paged->forms[number++] == solid.blob.size()) block.append(solid.blob);
    }
  }
  return WrittenBlock{std::move(block).bytes(), texts.text_bytes};
}

}  // namespace watertight::pipeline
