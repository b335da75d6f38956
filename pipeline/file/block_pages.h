// SPDX-License-Identifier: GPL-3.0-or-later
//
// The index of blocks: where each stands and the box around its features, in pages
// (docs/format-file.md, "Pages of blocks").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/file/records.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

/// A box in x and y.
struct FlatBox {
  std::array<double, 2> min{};
  std::array<double, 2> max{};
  void include(const FlatBox& other);
  bool contains(const FlatBox& other) const;
  bool meets(const FlatBox& other) const;  // closed boxes
  friend bool operator==(const FlatBox&, const FlatBox&) = default;
};
FlatBox flat(const store::StoredBox& box);

/// A block of a file.
struct BlockEntry {
  Extent extent;
  std::uint64_t features = 0;  // with those that are deleted
  std::optional<FlatBox> box;  // around the features that have one; contains them
};

/// A page of entries, as the commit names it.
struct BlockPage {
  Extent extent;
  std::uint64_t blocks = 0;
  std::optional<FlatBox> box;  // around the boxes of its blocks
};

/// The payload of a page with these entries, which are ascending, and its box. The boxes become
/// those that a reader gets: they contain the given ones.
struct WrittenBlockPage {
  Bytes payload;
  BlockPage page;  // without its extent
};
WrittenBlockPage write_block_page(std::span<const BlockEntry> entries);
/// The entries of a page. Each block ends before the page. Errors: malformed.
Result<std::vector<BlockEntry>> read_block_page(ByteView payload, const BlockPage& page);

/// The most blocks of a page that a writer makes: some 4 KiB.
inline constexpr std::size_t kPageBlocks = 320;

}  // namespace watertight::pipeline
