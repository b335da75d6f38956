// SPDX-License-Identifier: GPL-3.0-or-later
//
// The index of ids: for the hash of each id of a feature or city object the block that has it, in
// pages (docs/format-file.md, "Pages of ids"). Hashes are cut to a few bits, so a block may be
// named that does not have an id; no block that has it is missing.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/file/records.h"

namespace watertight::pipeline {

/// An entry of the index: the first bits of the hash of an id, and the number of a block.
struct IdEntry {
  std::uint64_t hash = 0;
  std::uint64_t block = 0;
  friend auto operator<=>(const IdEntry&, const IdEntry&) = default;
};

/// A page of entries, as the commit names it.
struct IdPage {
  Extent extent;
  std::uint64_t first = 0;  // the hash of its first entry
};
struct IdPages {
  std::uint8_t bits = 0;  // of the hashes
  std::vector<IdPage> pages;
};

/// All 64 bits of the hash of an id.
std::uint64_t id_hash(std::string_view id);
/// The first bits of a hash.
std::uint64_t cut_hash(std::uint64_t hash, std::uint8_t bits);
/// The number of bits for so many entries: another id has the bits of a given one in a block that
/// does not have it with a chance of about 1 in 100.
std::uint8_t bits_for(std::size_t entries);

/// The payloads of the pages of these entries, which are ascending.
struct WrittenIdPage {
  Bytes payload;
  std::uint64_t first = 0;
};
std::vector<WrittenIdPage> write_id_pages(std::span<const IdEntry> entries);
/// The entries of a page. Blocks are below `blocks`. Errors: malformed.
Result<std::vector<IdEntry>> read_id_page(ByteView payload, const IdPage& page, std::uint8_t bits,
                                          std::uint64_t blocks);

}  // namespace watertight::pipeline
