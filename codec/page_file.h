// SPDX-License-Identifier: GPL-3.0-or-later
//
// A file of pages with an index (docs/format.md, "Container"). Solids are numbered in the order in
// which they were added, and packed into pages of solids on one grid. A reader finds a solid by its
// number and decodes only its page.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/page.h"

namespace watertight::codec {

/// Collects solids and writes a page whenever one is full. Memory: the open pages, with fewer than
/// `page_solids` solids for each grid, reference system and acceptance that occurs.
class PageFileWriter {
 public:
  /// `page_solids`, from 1 to kMaxPageSolids, is the number of solids of a full page: fewer make
  /// random access faster, more make the file smaller.
  explicit PageFileWriter(std::size_t page_solids = kMaxPageSolids, EncodeOptions options = {});
  ~PageFileWriter();
  PageFileWriter(PageFileWriter&&) noexcept;
  PageFileWriter& operator=(PageFileWriter&&) noexcept;

  /// Adds a solid. Errors: not_encodable.
  Status add(const ValidSolid& solid);
  /// Adds the solid of a blob, with the acceptance that the blob states and without its Steiner
  /// vertices. For stores, which keep blobs of valid solids only. Errors: not_encodable; those of
  /// decode().
  Status add_blob(ByteView blob, const Limits& limits = {});
  /// Adds a solid that its container makes again from this one, with the acceptance of that solid.
  /// For containers of blocks. Errors: not_encodable.
  Status add(const OrientedBoundary& boundary, const Acceptance& acceptance);
  /// Adds a page as it is, with all its solids in their order. Requires a page of `solids` solids.
  void add_page(ByteView page, std::uint64_t solids);
  /// Returns the bytes written since the last call; the caller appends them to the file.
  Bytes take();
  /// Returns the last bytes: the pages that are still open, and the index. Errors: not_encodable.
  Result<Bytes> finish() &&;

 private:
  struct OpenPage;
  struct Entry {
    std::uint64_t bytes = 0;
    std::vector<std::uint64_t> numbers;
  };
  Status close(OpenPage& page);

  std::size_t page_solids_;
  EncodeOptions options_;
  std::vector<OpenPage> open_;
  std::vector<Entry> index_;
  std::uint64_t count_ = 0;
  Bytes written_;
};

/// Finds solids in a page file. Trusts nothing.
class PageFileReader {
 public:
  /// Reads the index. `file` must outlive the reader. Errors: malformed; unsupported.
  static Result<PageFileReader> open(ByteView file, const Limits& limits = {});

  std::uint64_t size() const { return slot_of_.size(); }
  std::size_t page_count() const { return pages_.size(); }
  /// Returns the solid of this number. Decodes its page. Errors: invalid_argument if `number` is
  /// not below size(); those of decode_page().
  Result<Decoded> solid(std::uint64_t number) const;
  struct NumberedSolid {
    std::uint64_t number = 0;
    Decoded decoded;
  };
  /// Returns all solids of one page with their numbers. Requires page < page_count(). Errors: those
  /// of decode_page().
  Result<std::vector<NumberedSolid>> page(std::size_t page) const;

 private:
  struct PageSlot {
    std::size_t page = 0;
    std::size_t slot = 0;  // index of the solid in its page
  };
  PageFileReader() = default;

  Limits limits_;
  std::vector<ByteView> pages_;
  std::vector<std::vector<std::uint64_t>> numbers_;  // page -> the numbers of its solids
  std::vector<PageSlot> slot_of_;                    // number of a solid -> its page and slot
};

/// True if the bytes begin as those of a page file.
bool is_page_file(ByteView bytes);

}  // namespace watertight::codec
