// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/container_file.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/parallel.h"
#include "pipeline/stored/feature_facts.h"

namespace watertight::pipeline {
namespace {

/// The bytes that the first request asks for: commit, roots and headers of most files.
constexpr std::uint64_t kTailBytes = 12U << 10U;
constexpr std::uint64_t kHeadBytes = sizeof(kContainerMagic) + 1;
/// The most requests for blocks, so that a box takes six with those for the index.
constexpr std::size_t kBlockRequests = 4;
constexpr std::size_t kPageRequests = 1;

/// The error of a file that has bytes after its last commit.
Error torn_file(const Error& reason, std::uint64_t committed, std::uint64_t size) {
  if (committed == 0) return reason;
  Error error = reason;
  error.message = "torn Watertight file: " + std::to_string(size - committed) +
                  " bytes after its last commit are no part of it (" + reason.message + ")";
  return error;
}

/// The error with the offset of `extent` added to its own.
Error inside(Error error, std::uint64_t offset) {
  if (error.code == ErrorCode::malformed)
    error.byte_offset = offset + error.byte_offset.value_or(0);
  return error;
}

}  // namespace

Result<ContainerFile> ContainerFile::open(FileBytes file, const Limits& limits, TornTail torn) {
  ContainerFile opened(RangeCache(std::move(file)), limits);
  Status status = opened.read_last_commit();
  const bool has_commit = status && opened.committed_ > 0;
  // Without a commit at the end, or without an index, the records have to be walked over.
  if (status && (!has_commit || !opened.has_index())) status = opened.read_all(torn);
  if (status) status = opened.read_documents();
  if (!status) return std::move(status).error();
  return opened;
}

Result<ContainerFile> ContainerFile::open(ByteView bytes, const Limits& limits, TornTail torn) {
  ContainerFile opened{RangeCache(bytes), limits};
  Status status = opened.read_all(torn);
  if (status) status = opened.read_documents();
  if (!status) return std::move(status).error();
  return opened;
}

/// Reads the commit that ends the file, if one does.
Status ContainerFile::read_last_commit() {
  const std::uint64_t size = ranges_.size();
  if (size <= kHeadBytes) return Done{};
  const std::uint64_t tail_size = std::min(size, kTailBytes);
  auto tail = ranges_.keep({size - tail_size, tail_size});
  if (!tail) return std::move(tail).error();
  const auto commit_size = size_of_last_commit(*tail);
  if (!commit_size || *commit_size > size - kHeadBytes) return Done{};
  const auto bytes = ranges_.keep({size - *commit_size, *commit_size});
  if (!bytes) return bytes.error();
  const auto found = read_record(*bytes, size - *commit_size);
  if (!found || found->kind != RecordKind::commit || found->extent.end() != size) return Done{};
  return take_commit(*found);
}

/// Walks over all records of the file.
Status ContainerFile::read_all(TornTail torn) {
  const std::uint64_t size = ranges_.size();
  const auto head = ranges_.get({0, std::min(size, kHeadBytes)});
  if (!head) return head.error();
  if (Status checked = check_head(*head); !checked) return checked;
  if (size > limits_.bytes) {
    return Error{ErrorCode::limit_exceeded,
                 std::to_string(size) + " bytes; the limit is " + std::to_string(limits_.bytes)};
  }
  const bool is_known = committed_ > 0 || ranges_.bytes_read() >= size;
  if (!is_known && torn == TornTail::refuse) {
    return malformed_file("no commit ends this Watertight file: it is torn or damaged", size);
  }
  const auto bytes = ranges_.keep({0, size});
  if (!bytes) return bytes.error();
  const Walk walk = walk_records(*bytes);
  if (walk.torn && (walk.committed == 0 || torn == TornTail::refuse)) {
    return torn_file(*walk.torn, walk.committed, size);
  }
  torn_ = walk.torn;
  if (Status taken = take_commit(walk.records.back()); !taken) return taken;
  return has_index() ? check_index(walk.records) : walk_blocks(walk.records);
}

Status ContainerFile::take_commit(const Record& record) {
  committed_ = record.extent.end();
  commit_offset_ = record.extent.offset;
  commit_ = {};
  if (record.payload.empty()) return Done{};
  auto commit = read_commit(record.payload, commit_offset_);
  if (!commit) return std::move(commit).error();
  commit_ = *std::move(commit);
  blocks_ = 0;
  first_blocks_.clear();
  for (const BlockPage& page : commit_.block_pages) {
    first_blocks_.push_back(blocks_);
    blocks_ += page.blocks;
  }
  pages_.assign(commit_.block_pages.size(), std::nullopt);
  return Done{};
}

/// The blocks of a file without an index.
Status ContainerFile::walk_blocks(const std::vector<Record>& records) {
  for (const Record& record : records) {
    if (record.kind == RecordKind::block) walked_.push_back({record.extent, 0, {}});
  }
  blocks_ = walked_.size();
  return Done{};
}

/// Checks that the index has the blocks that are in the file.
Status ContainerFile::check_index(const std::vector<Record>& records) {
  std::uint64_t number = 0;
  for (const Record& record : records) {
    if (record.kind != RecordKind::block) continue;
    if (number == blocks_) return malformed_file("a block that no index has", record.extent.offset);
    const auto found = entry(number++);
    if (!found) return found.error();
    if (found->extent == record.extent) continue;
    return malformed_file("the index of blocks names another place", record.extent.offset);
  }
  if (number == blocks_) return Done{};
  return malformed_file("the index names a block that is not there", commit_offset_);
}

/// The bytes of an extent, which the budget counts.
Result<ByteView> ContainerFile::bytes_of(const Extent& extent) {
  auto bytes = ranges_.get(extent);
  if (ranges_.bytes_read() > counted_) {
    budget_.add_bytes(ranges_.bytes_read() - counted_);
    counted_ = ranges_.bytes_read();
  }
  return bytes;
}

Result<Record> ContainerFile::record(const Extent& extent, RecordKind kind) {
  const auto bytes = bytes_of(extent);
  if (!bytes) return bytes.error();
  auto found = read_record(*bytes, extent.offset);
  if (!found) return found;
  if (found->kind == kind && found->extent == extent) return found;
  return malformed_file("a record of another kind or length than its file says", extent.offset);
}

Status ContainerFile::read_documents() {
  if (commit_.deleted.size > 0) {
    const auto found = record(commit_.deleted, RecordKind::index);
    if (!found) return found.error();
    const auto deleted = read_deleted(found->payload, found->extent.offset);
    if (!deleted) return deleted.error();
    deleted_.insert(deleted->begin(), deleted->end());
    if (!deleted_.empty() && deleted_.rbegin()->block >= blocks_) {
      return malformed_file("a deleted feature of a block that is not there", found->extent.offset);
    }
  }
  if (commit_.documents.size > 0) {
    const auto found = record(commit_.documents, RecordKind::documents);
    if (!found) return found.error();
    auto block = read_block(found->payload, {}, budget_);
    if (!block) return inside(std::move(block).error(), commit_.documents.offset);
    if (!block->features.empty()) {
      return malformed_file("features in the record of documents", commit_.documents.offset);
    }
    documents_ = std::move(block->documents);
    return Done{};
  }
  if (blocks_ == 0) return Done{};
  auto block = read(0);
  if (!block) return std::move(block).error();
  documents_ = block->documents;
  ahead_.emplace(0, *std::move(block));
  return Done{};
}

std::size_t ContainerFile::page_of(std::uint64_t block) const {
  const auto after = std::upper_bound(first_blocks_.begin(), first_blocks_.end(), block);
  return static_cast<std::size_t>(after - first_blocks_.begin()) - 1;
}

Result<const std::vector<BlockEntry>*> ContainerFile::entries_of_page(std::size_t page) {
  auto& kept = pages_[page];
  if (kept) return &*kept;
  const BlockPage& root = commit_.block_pages[page];
  const auto found = record(root.extent, RecordKind::index);
  if (!found) return found.error();
  auto entries = read_block_page(found->payload, root);
  if (!entries) return std::move(entries).error();
  kept = *std::move(entries);
  return &*kept;
}

Result<BlockEntry> ContainerFile::entry(std::uint64_t block) {
  if (!has_index()) return walked_[block];
  const std::size_t page = page_of(block);
  const auto entries = entries_of_page(page);
  if (!entries) return entries.error();
  return (**entries)[block - first_blocks_[page]];
}

Result<ReadBlock> ContainerFile::read(std::uint64_t block) {
  const auto place = entry(block);
  if (!place) return place.error();
  const auto found = record(place->extent, RecordKind::block);
  if (!found) return found.error();
  auto read = read_block(found->payload, documents_, budget_);
  if (!read) return inside(std::move(read).error(), place->extent.offset);
  return read;
}

/// Checks that a block has what the index says.
Status ContainerFile::check_block(std::uint64_t number, const BlockEntry& entry,
                                  const ReadBlock& block) const {
  if (!has_index()) return Done{};
  if (entry.features != block.features.size()) {
    return malformed_file("the index of blocks states another number of features",
                          entry.extent.offset);
  }
  for (const ReadFeature& feature : block.features) {
    // An index that was made anew has no boxes of deleted features.
    if (deleted_.contains({number, feature.ordinal})) continue;
    const auto box = box_of(feature.encoded, feature.solids, limits_);
    if (!box) return box.error();
    if (*box && !(entry.box && entry.box->contains(flat(**box)))) {
      return malformed_file("a feature is outside of the box that the index states",
                            entry.extent.offset);
    }
  }
  std::optional<std::set<std::uint64_t>> hashes;
  for (const Asked& asked : asked_) {
    if (asked.block != number) continue;
    if (!hashes) {
      hashes.emplace();
      for (const ReadFeature& feature : block.features) {
        for (const std::string& id : ids_of(feature.encoded)) {
          hashes->insert(cut_hash(id_hash(id), commit_.ids.bits));
        }
      }
    }
    if (!hashes->contains(asked.hash)) {
      return malformed_file("the index of ids names a block without the id", asked.offset);
    }
  }
  return Done{};
}

void ContainerFile::read_ahead(std::uint64_t first, unsigned threads) {
  // Else what it may claim grows with what is read, and the payloads do not stay.
  if (!ranges_.has_all()) return;
  std::vector<std::uint64_t> numbers;
  std::vector<ByteView> payloads;
  for (std::uint64_t number = first; number < std::min(first + threads, blocks_); ++number) {
    if (ahead_.contains(number)) continue;
    const auto place = entry(number);
    if (!place) break;
    const auto found = record(place->extent, RecordKind::block);
    if (!found) break;
    numbers.push_back(number);
    payloads.push_back(found->payload);
  }
  const ReadBudget start = budget_;
  std::vector<ReadBudget> budgets(numbers.size(), start);
  std::vector<std::optional<Result<ReadBlock>>> blocks(numbers.size());
  geometry::for_each_piece(numbers.size(), threads, [&](std::size_t i, bool /*is_caller*/) {
    blocks[i].emplace(read_block(payloads[i], documents_, budgets[i]));
  });
  // A block that fails, or does not fit beside those before it, is read again when it is asked for:
  // so the error does not depend on the number of threads.
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!*blocks[i] || !budget_.take_since(start, budgets[i])) return;
    ahead_.emplace(numbers[i], **std::move(blocks[i]));
  }
}

Result<ReadBlock> ContainerFile::block(std::uint64_t number) {
  auto ahead = ahead_.extract(number);
  auto read_now = ahead ? Result<ReadBlock>(std::move(ahead.mapped())) : read(number);
  if (!read_now) return read_now;
  ReadBlock block = *std::move(read_now);
  const auto place = entry(number);
  if (!place) return place.error();
  if (Status checked = check_block(number, *place, block); !checked) {
    return std::move(checked).error();
  }
  for (ReadFeature& feature : block.features) {
    if (feature.document >= documents_.size()) {
      return malformed_file("a feature of a document that is not there", place->extent.offset);
    }
    feature.encoded.format = documents_[feature.document].format;
    feature.encoded.header = documents_[feature.document].header;
  }
  std::erase_if(block.features, [&](const ReadFeature& feature) {
    return deleted_.contains({number, feature.ordinal});
  });
  return block;
}

std::vector<std::uint64_t> ContainerFile::all_blocks() const {
  std::vector<std::uint64_t> blocks;
  for (std::uint64_t i = 0; i < blocks_; ++i) blocks.push_back(i);
  return blocks;
}

/// Fetches blocks, and before them the pages of the index that say where they stand.
Status ContainerFile::fetch_blocks(const std::vector<std::uint64_t>& blocks) {
  std::set<std::size_t> pages;
  for (const std::uint64_t block : blocks) pages.insert(page_of(block));
  std::vector<Extent> extents;
  for (const std::size_t page : pages) {
    if (!pages_[page]) extents.push_back(commit_.block_pages[page].extent);
  }
  if (Status fetched = ranges_.fetch(std::move(extents), kPageRequests); !fetched) return fetched;
  extents.clear();
  for (const std::uint64_t block : blocks) {
    const auto found = entry(block);
    if (!found) return found.error();
    extents.push_back(found->extent);
  }
  return ranges_.fetch(std::move(extents), kBlockRequests);
}

Result<std::vector<IdEntry>> ContainerFile::entries_of_ids(const IdPage& page) {
  const auto found = record(page.extent, RecordKind::index);
  if (!found) return found.error();
  return read_id_page(found->payload, page, commit_.ids.bits, blocks_);
}

/// Begins a selection: a file that is open for long is read many times.
void ContainerFile::start_selection() {
  budget_.start_anew();
  asked_.clear();
}

Result<std::vector<std::uint64_t>> ContainerFile::blocks_of(const std::vector<std::string>& ids) {
  start_selection();
  if (!has_index()) return all_blocks();
  std::map<std::size_t, std::vector<std::uint64_t>> hashes;  // by page
  const std::vector<IdPage>& pages = commit_.ids.pages;
  for (const std::string& id : ids) {
    const std::uint64_t hash = cut_hash(id_hash(id), commit_.ids.bits);
    const auto after = std::upper_bound(
        pages.begin(), pages.end(), hash,
        [](std::uint64_t value, const IdPage& page) { return value < page.first; });
    if (after == pages.begin()) continue;
    hashes[static_cast<std::size_t>(after - pages.begin()) - 1].push_back(hash);
  }
  std::vector<Extent> extents;
  for (const auto& [page, wanted] : hashes) extents.push_back(pages[page].extent);
  if (Status fetched = ranges_.fetch(extents, extents.size()); !fetched) {
    return std::move(fetched).error();
  }
  std::set<std::uint64_t> blocks;
  for (const auto& [page, wanted] : hashes) {
    const auto entries = entries_of_ids(pages[page]);
    if (!entries) return entries.error();
    for (const std::uint64_t hash : wanted) {
      auto found = std::lower_bound(entries->begin(), entries->end(), IdEntry{hash, 0});
      for (; found != entries->end() && found->hash == hash; ++found) {
        blocks.insert(found->block);
        asked_.push_back({found->block, hash, pages[page].extent.offset});
      }
    }
  }
  std::vector<std::uint64_t> all(blocks.begin(), blocks.end());
  if (Status fetched = fetch_blocks(all); !fetched) return std::move(fetched).error();
  return all;
}

Result<std::vector<std::uint64_t>> ContainerFile::blocks_in(const FlatBox& box) {
  start_selection();
  if (!has_index()) return all_blocks();
  std::vector<std::size_t> met;
  std::vector<Extent> extents;
  for (std::size_t page = 0; page < pages_.size(); ++page) {
    const BlockPage& root = commit_.block_pages[page];
    if (!root.box || !root.box->meets(box)) continue;
    met.push_back(page);
    if (!pages_[page]) extents.push_back(root.extent);
  }
  if (Status fetched = ranges_.fetch(std::move(extents), kPageRequests); !fetched) {
    return std::move(fetched).error();
  }
  std::vector<std::uint64_t> blocks;
  for (const std::size_t page : met) {
    const auto entries = entries_of_page(page);
    if (!entries) return entries.error();
    for (std::size_t i = 0; i < (*entries)->size(); ++i) {
      const BlockEntry& found = (**entries)[i];
      if (found.box && found.box->meets(box)) blocks.push_back(first_blocks_[page] + i);
    }
  }
  if (Status fetched = fetch_blocks(blocks); !fetched) return std::move(fetched).error();
  return blocks;
}

Result<std::vector<IdEntry>> ContainerFile::id_entries() {
  std::vector<IdEntry> all;
  std::vector<Extent> extents;
  for (const IdPage& page : commit_.ids.pages) extents.push_back(page.extent);
  if (Status fetched = ranges_.fetch(std::move(extents), 1); !fetched) {
    return std::move(fetched).error();
  }
  for (const IdPage& page : commit_.ids.pages) {
    const auto entries = entries_of_ids(page);
    if (!entries) return entries.error();
    all.insert(all.end(), entries->begin(), entries->end());
  }
  return all;
}

}  // namespace watertight::pipeline
