// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>
#include <utility>

#include "codec/page_file.h"
#include "pipeline/blocks/block.h"
#include "pipeline/blocks/block_grid.h"
#include "pipeline/blocks/block_texts.h"

namespace watertight::pipeline {
namespace {

ByteView read_bytes(ByteReader& reader) {
  const std::uint64_t size = reader.varint();
  return reader.take(size > reader.remaining() ? reader.remaining() + 1
                                               : static_cast<std::size_t>(size));
}

Status take_vertices(const Decoded& decoded, ReadBudget& budget) {
  if (budget.take_vertices(decoded.solid.vertex_count())) return Done{};
  return Error{ErrorCode::limit_exceeded,
               "the solids have more vertices than a Watertight file of this length may claim"};
}

/// The solids of a page file in order.
Result<std::vector<Decoded>> decode_pages(ByteView file, ReadBudget& budget, std::uint64_t& pages) {
  const auto reader = codec::PageFileReader::open(file, budget.limits());
  if (!reader) return reader.error();
  pages = reader->page_count();
  std::vector<std::optional<Decoded>> found(reader->size());
  for (std::size_t i = 0; i < reader->page_count(); ++i) {
    auto page = reader->page(i);
    if (!page) return std::move(page).error();
    for (auto& solid : *page) {
      if (Status taken = take_vertices(solid.decoded, budget); !taken) {
        return std::move(taken).error();
      }
      found[solid.number] = std::move(solid.decoded);
    }
  }
  std::vector<Decoded> solids;
  for (std::optional<Decoded>& solid : found) solids.push_back(*std::move(solid));
  return solids;
}

/// Gives the features their solids: those of the page file and those of the blobs, in order.
class SolidReader {
 public:
  SolidReader(ByteReader& block, ReadBudget& budget) : block_(block), budget_(budget) {}

  Status read(ReadBlock& block, const std::vector<std::uint64_t>& sizes) {
    const std::size_t before = block_.remaining();
    const ByteView page_file = read_bytes(block_);
    if (block_.failed()) return malformed("truncated pages");
    if (!page_file.empty()) {
      auto decoded = decode_pages(page_file, budget_, block.pages);
      if (!decoded) return std::move(decoded).error();
      paged_ = *std::move(decoded);
    }
    std::size_t number = 0;
    for (ReadFeature& feature : block.features) {
      std::vector<std::size_t> on_block_grid;
      for (const StoredSolid& solid : feature.encoded.solids) {
        const std::uint64_t size = sizes[number++];
        if (!solid.is_proven) continue;
        if (size == kOnBlockGrid) on_block_grid.push_back(feature.solids.size());
        if (Status added = add(feature, size); !added) return added;
      }
      if (!place(feature, on_block_grid)) {
        return malformed("the solids of a feature have no lattice in common");
      }
    }
    if (next_paged_ != paged_.size()) {
      return malformed("the pages hold solids that belong to no feature");
    }
    block.solid_bytes = before - block_.remaining();
    return Done{};
  }

 private:
  Error malformed(std::string message) const {
    return {ErrorCode::malformed, std::move(message), block_.position(), {}};
  }

  /// Gives solids that are on the grid of the block their lattice. False if there is none.
  static bool place(ReadFeature& feature, const std::vector<std::size_t>& numbers) {
    if (numbers.empty()) return true;
    std::vector<const Solid*> solids;
    for (const std::size_t number : numbers) solids.push_back(&feature.solids[number].solid);
    auto placed = on_lattice_of_decimals(solids);
    if (!placed) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      Decoded& decoded = feature.solids[numbers[i]];
      decoded.solid = std::move((*placed)[i]);
      decoded.info.lattice = decoded.solid.lattice();
    }
    return true;
  }

  Status add(ReadFeature& feature, std::uint64_t blob_bytes) {
    if (blob_bytes == 0 || blob_bytes == kOnBlockGrid) {
      if (next_paged_ == paged_.size()) {
        return malformed("the pages hold fewer solids than the features");
      }
      feature.solids.push_back(std::move(paged_[next_paged_++]));
      return Done{};
    }
    if (blob_bytes > block_.remaining()) return malformed("truncated blob");
    auto decoded = decode(block_.take(static_cast<std::size_t>(blob_bytes)), budget_.limits());
    if (!decoded) return std::move(decoded).error();
    if (Status taken = take_vertices(*decoded, budget_); !taken) return taken;
    feature.solids.push_back(*std::move(decoded));
    return Done{};
  }

  ByteReader& block_;
  ReadBudget& budget_;
  std::vector<Decoded> paged_;
  std::size_t next_paged_ = 0;
};

}  // namespace

Result<ReadBlock> read_block(ByteView bytes, std::span<const BlockDocument> documents,
                             ReadBudget& budget) {
  ByteReader reader(bytes);
  const auto malformed = [&reader](std::string message) {
    return Error{ErrorCode::malformed, std::move(message), reader.position(), {}};
  };
  const ByteView packed = read_bytes(reader);
  if (reader.failed()) return malformed("truncated block");
  auto texts = unpack_block_texts(packed, documents.size(), budget);
  if (!texts) return std::move(texts).error();
  const std::uint64_t longest = budget.limits().feature_bytes;
  for (const ReadFeature& feature : texts->block.features) {
    if (feature.encoded.skeleton.size() <= longest) continue;
    return Error{ErrorCode::limit_exceeded, "the text of the feature '" + feature.encoded.id +
                                                "' is longer than " + std::to_string(longest) +
                                                " bytes"};
  }
  SolidReader solids(reader, budget);
  if (Status read = solids.read(texts->block, texts->blob_bytes); !read)
    return std::move(read).error();
  if (reader.remaining() > 0) return malformed("bytes after the last blob of a block");
  return std::move(texts->block);
}

}  // namespace watertight::pipeline
