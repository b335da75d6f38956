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
  Decoded decoded;
  std::size_t number = 0;      // its number in the block
  std::size_t feature = 0;     // the number of its feature
  std::size_t blob_bytes = 0;  // 0: it is in the page of its feature
};

/// A page file, and how the block has each of its solids.
struct Paged {
  Bytes file;
  std::vector<std::uint64_t> forms;  // those of BlockTexts::blob_bytes
  std::size_t bytes = 0;             // of the file, and of the blobs that are not in it
};

Status take_pages(codec::PageFileWriter writer, Paged& paged) {
  auto file = std::move(writer).finish();
  if (!file) return std::move(file).error();
  paged.file = *std::move(file);
  paged.bytes += paged.file.size();
  return Done{};
}

/// The blobs and the pages of features as they are.
Result<Paged> as_they_are(const BlockContents& contents) {
  Paged paged;
  codec::PageFileWriter writer;
  bool has_pages = false;
  for (const BlockFeature& feature : contents.features) {
    std::uint64_t in_page = 0;
    for (const StoredSolid& solid : feature.encoded.solids) {
      const bool is_in_page = solid.is_proven && solid.blob.empty();
      in_page += is_in_page ? 1 : 0;
      paged.forms.push_back(is_in_page ? kInPages : solid.is_proven ? solid.blob.size() : kNoBlob);
      paged.bytes += solid.blob.size();
    }
    if (in_page == 0) continue;
    if (feature.encoded.page.empty()) {
      return Error{ErrorCode::malformed, "a proven solid without a blob"};
    }
    writer.add_page(feature.encoded.page, in_page);
    has_pages = true;
  }
  if (!has_pages) return paged;
  if (Status taken = take_pages(std::move(writer), paged); !taken) return taken.error();
  return paged;
}

/// The solids that may be in pages: all but those whose blobs have Steiner vertices, which pages do
/// not keep.
Result<std::vector<PagedSolid>> solids_for_pages(const BlockContents& contents) {
  std::vector<PagedSolid> solids;
  std::size_t number = 0;
  for (std::size_t i = 0; i < contents.features.size(); ++i) {
    auto decoded = decode_solids(contents.features[i].encoded);
    if (!decoded) return std::move(decoded).error();
    auto next = decoded->begin();
    for (const StoredSolid& solid : contents.features[i].encoded.solids) {
      const std::size_t own = number++;
      if (!solid.is_proven) continue;
      Decoded& one = *next++;
      if (one.info.steiner_vertices > 0) continue;
      solids.push_back({std::move(one), own, i, solid.blob.size()});
    }
  }
  return solids;
}

/// The form of the solids that go into no pages.
Paged without_pages(const std::vector<PagedSolid>& solids, const Paged& as_is) {
  Paged paged{{}, as_is.forms, as_is.bytes - as_is.file.size()};
  for (const PagedSolid& solid : solids) paged.bytes -= solid.blob_bytes;
  return paged;
}

Status add(const PagedSolid& solid, const Solid& placed, codec::PageFileWriter& writer) {
  const auto boundary = OrientedBoundary::make(placed);
  if (!boundary) return boundary.error();
  return writer.add(*boundary, solid.decoded.info.acceptance);
}

Result<Paged> on_own_grids(const std::vector<PagedSolid>& solids, Paged paged,
                           const EncodeOptions& options) {
  codec::PageFileWriter writer(codec::kMaxPageSolids, options);
  for (const PagedSolid& solid : solids) {
    if (Status added = add(solid, solid.decoded.solid, writer); !added) return added.error();
    paged.forms[solid.number] = kInPages;
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
  std::vector<const Solid*> views;
  for (const PagedSolid& solid : solids) views.push_back(&solid.decoded.solid);
  const auto grid = BlockGrid::of(views);
  if (!grid) return Error{ErrorCode::not_encodable, "the solids have no grid in common"};
  codec::PageFileWriter writer(codec::kMaxPageSolids, options);
  for (std::size_t begin = 0, end = 0; begin < solids.size(); begin = end) {
    while (end < solids.size() && solids[end].feature == solids[begin].feature) ++end;
    const auto moved = moved_exactly(*grid, std::span(views).subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_moved = !moved.empty();
      const Solid& placed = is_moved ? moved[i - begin] : solids[i].decoded.solid;
      if (Status added = add(solids[i], placed, writer); !added) return added.error();
      paged.forms[solids[i].number] = is_moved ? kOnBlockGrid : kInPages;
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
  auto best = as_they_are(contents);
  if (!best) return best;
  const auto solids = solids_for_pages(contents);
  if (!solids) return solids.error();
  const Paged others = without_pages(*solids, *best);
  auto pages = on_own_grids(*solids, others, options);
  const auto reader = pages ? codec::PageFileReader::open(pages->file)
                            : Result<codec::PageFileReader>(pages.error());
  const bool have_one_grid =
      reader &&
      reader->page_count() <= (solids->size() + codec::kMaxPageSolids - 1) / codec::kMaxPageSolids;
  if (Status taken = take_smaller(std::move(pages), *best); !taken) return std::move(taken).error();
  if (have_one_grid) return best;
  if (Status taken = take_smaller(on_block_grid(*solids, others, options), *best); !taken) {
    return std::move(taken).error();
  }
  return best;
}

}  // namespace

Result<WrittenBlock> write_block(const BlockContents& contents,
                                 std::span<const BlockDocument> /*documents*/,
                                 const EncodeOptions& pages, SolidLayout layout) {
  const auto paged =
      layout == SolidLayout::blobs ? as_they_are(contents) : smallest_pages(contents, pages);
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
