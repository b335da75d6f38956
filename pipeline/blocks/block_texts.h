// SPDX-License-Identifier: GPL-3.0-or-later
//
// The texts of a block (docs/format-file.md, "Blocks"): those of its documents and features, and
// three tables with all else that is kept of them. Internal to pipeline/blocks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "columns/columns.h"
#include "pipeline/blocks/block.h"

namespace watertight::pipeline {

/// In place of the bytes of a blob, of which there are more: the solid is not proven.
inline constexpr std::uint64_t kNoBlob = 1;
/// In place of the bytes of a blob: the solid is in the page file, on a grid that the block chose.
/// Its lattice is that of the decimals of all such solids of the feature.
inline constexpr std::uint64_t kOnBlockGrid = 2;

struct PackedTexts {
  Bytes bytes;
  std::uint64_t text_bytes = 0;  // before they were packed
};

/// Packs the texts of a block. `blob_bytes` has, for each solid of the features, the bytes of its
/// blob: 0 for one in the page file, or one of the constants above. Of a report the codes of
/// the errors are kept. Cost: pack_texts().
PackedTexts pack_block_texts(const BlockContents& contents,
                             std::span<const std::uint64_t> blob_bytes);

struct BlockTexts {
  ReadBlock block;                        // without solids
  std::vector<std::uint64_t> blob_bytes;  // as above
};

/// The texts of pack_block_texts(). `documents` is the number of documents of the file, 0 for a
/// block that has its own. Errors: malformed; limit_exceeded.
Result<BlockTexts> unpack_block_texts(ByteView bytes, std::size_t documents, ReadBudget& budget);

}  // namespace watertight::pipeline
