// SPDX-License-Identifier: GPL-3.0-or-later
//
// A Watertight file that is read in ranges: its last commit, then only the parts of the index and
// the blocks that are asked for (docs/format-file.md). Makes no call of an operating system.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/blocks/block.h"
#include "pipeline/file/commit.h"
#include "pipeline/file/file_bytes.h"

namespace watertight::pipeline {

/// What becomes of bytes after the last commit, as a writer leaves them that was stopped: the file
/// is refused, or it is what that commit says.
enum class TornTail : std::uint8_t { refuse, leave_out };

/// A file that may be hostile: memory is bounded by the bytes that were read and by the limits.
/// Not thread-safe.
class ContainerFile {
 public:
  /// Opens a file in ranges: reads its end, and all of it if it is small, has no index or is torn.
  /// Errors: malformed; unsupported (version); limit_exceeded; those of the callback.
  static Result<ContainerFile> open(FileBytes file, const Limits& limits,
                                    TornTail torn = TornTail::refuse);
  /// Opens a file in memory, which must outlive the object, and verifies all of its records.
  /// Errors: as above.
  static Result<ContainerFile> open(ByteView bytes, const Limits& limits,
                                    TornTail torn = TornTail::refuse);

  /// The bytes of the file, those up to the end of the last commit, and the reason why others
  /// follow it, if they do.
  std::uint64_t size() const { return ranges_.size(); }
  std::uint64_t committed() const { return committed_; }
  const std::optional<Error>& torn() const { return torn_; }
  /// The number of bytes that were read so far.
  std::uint64_t bytes_read() const { return ranges_.bytes_read(); }

  const std::vector<BlockDocument>& documents() const { return documents_; }
  std::uint64_t block_count() const { return blocks_; }
  /// Whether the file has an index of its blocks and ids.
  bool has_index() const { return !commit_.block_pages.empty(); }
  /// The last commit. Its counts are 0 in a file with an empty one.
  const Commit& commit() const { return commit_; }
  const std::set<DeletedFeature>& deleted() const { return deleted_; }

  /// Where a block stands, and what the index says about it: nothing in a file without one.
  /// Requires block < block_count(). Errors: malformed; those of the callback.
  Result<BlockEntry> entry(std::uint64_t block);
  /// The features of a block that are not deleted; each has format and header. Requires block <
  /// block_count(). Errors: those of read_block(); malformed if the index says otherwise; those of
  /// the callback.
  Result<ReadBlock> block(std::uint64_t block);
  /// Reads blocks from `first` on, one on each of `threads` threads, for the calls of block() that
  /// follow. These report what is wrong, as if nothing had been read ahead. Reads nothing of a file
  /// that is not in memory. Memory: `threads` blocks, each within what the file may still claim.
  void read_ahead(std::uint64_t first, unsigned threads);

  /// The blocks that may have one of these ids, of features or of city objects; all blocks in a
  /// file without an index. Ascending. The blocks are fetched. What was claimed by blocks that were
  /// read before does not count any more. Errors: those of entry().
  Result<std::vector<std::uint64_t>> blocks_of(const std::vector<std::string>& ids);
  /// The blocks that may have features whose boxes meet a box. As blocks_of().
  Result<std::vector<std::uint64_t>> blocks_in(const FlatBox& box);
  /// All entries of the index of ids. Errors: malformed; those of the callback.
  Result<std::vector<IdEntry>> id_entries();

 private:
  struct Asked {
    std::uint64_t block = 0;
    std::uint64_t hash = 0;  // of the index
    std::uint64_t offset = 0;
  };
  ContainerFile(RangeCache ranges, const Limits& limits)
      : ranges_(std::move(ranges)), limits_(limits), budget_(limits) {}
  Status read_last_commit();
  Status read_all(TornTail torn);
  Status take_commit(const Record& record);
  Status walk_blocks(const std::vector<Record>& records);
  Status check_index(const std::vector<Record>& records);
  Status read_documents();
  Result<ByteView> bytes_of(const Extent& extent);
  Result<Record> record(const Extent& extent, RecordKind kind);
  Result<const std::vector<BlockEntry>*> entries_of_page(std::size_t page);
  std::size_t page_of(std::uint64_t block) const;
  Result<std::vector<IdEntry>> entries_of_ids(const IdPage& page);
  Result<ReadBlock> read(std::uint64_t block);
  void start_selection();
  Status check_block(std::uint64_t number, const BlockEntry& entry, const ReadBlock& block) const;
  Status fetch_blocks(const std::vector<std::uint64_t>& blocks);
  std::vector<std::uint64_t> all_blocks() const;

  RangeCache ranges_;
  Limits limits_;
  ReadBudget budget_;
  std::uint64_t counted_ = 0;  // the bytes that the budget knows of
  std::uint64_t committed_ = 0;
  std::uint64_t commit_offset_ = 0;
  std::optional<Error> torn_;
  Commit commit_;
  std::uint64_t blocks_ = 0;
  std::vector<BlockEntry> walked_;           // of a file without an index
  std::vector<std::uint64_t> first_blocks_;  // of each page
  std::vector<std::optional<std::vector<BlockEntry>>> pages_;
  std::vector<BlockDocument> documents_;
  std::map<std::uint64_t, ReadBlock> ahead_;  // blocks that were read before they were asked for
  std::set<DeletedFeature> deleted_;
  std::vector<Asked> asked_;  // entries of ids that led to a block, for check_block()
};

}  // namespace watertight::pipeline
