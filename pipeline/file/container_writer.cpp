// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/container_writer.h"

#include <algorithm>
#include <optional>

#include "pipeline/stored/feature_facts.h"

namespace watertight::pipeline {
namespace {

// Blocks of a file that is to be small: few enough features for memory, many enough to compress.
constexpr std::size_t kBlockFeatures = 4096;
constexpr std::size_t kBlockBytes = 16U << 20U;
// Blocks of a file that is read in ranges, after compression.
constexpr std::size_t kRangeBytes = 20U << 10U;
/// An index whose hashes have so many bits fewer than a new one would have is made anew.
constexpr std::uint8_t kMissingBits = 2;

std::size_t bytes_of(const EncodedFeature& feature) {
  std::size_t bytes = feature.id.size() + feature.skeleton.size() + feature.page.size();
  for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size() + solid.report.size();
  return bytes;
}

/// Whether features can be added to a document of a file: not if its bytes are kept.
bool can_grow(const BlockDocument& document) {
  return document.framing.empty() &&
         document.format != formats::to_string(formats::Format::city_json);
}

void include(std::optional<FlatBox>& all, const std::optional<store::StoredBox>& box) {
  if (!box) return;
  if (!all) all = flat(*box);
  all->include(flat(*box));
}

/// The box of a feature, from its solids if it does not state one.
Result<std::optional<store::StoredBox>> known_box(const EncodedFeature& feature) {
  if (feature.box) return feature.box;
  const auto solids = decode_solids(feature);
  if (!solids) return solids.error();
  return box_of(feature, *solids);
}

}  // namespace

Result<FilePurpose> file_purpose_named(const std::string& name) {
  if (name == "size") return FilePurpose::size;
  if (name == "ranges") return FilePurpose::ranges;
  return Error{ErrorCode::invalid_argument, "unknown purpose of a file: '" + name + "'"};
}

ContainerWriter::ContainerWriter(ContainerOptions options) : options_(options) {
  options_.pages.certificate = nullptr;
  written_ = file_head();
  offset_ = written_.size();
}

Result<ContainerWriter> ContainerWriter::append(ContainerFile& file, ContainerOptions options) {
  ContainerWriter writer(options);
  writer.written_.clear();
  writer.offset_ = file.committed();
  writer.is_appending_ = true;
  writer.commit_ = file.commit();
  writer.deleted_ = file.deleted();
  writer.documents_ = file.documents();
  for (std::size_t i = 0; i < writer.documents_.size(); ++i) {
    const BlockDocument& document = writer.documents_[i];
    if (!can_grow(document)) continue;
    writer.numbers_.try_emplace({document.format, document.header}, i);
  }
  writer.blocks_ = file.block_count();
  Status taken = file.has_index() ? writer.take_index(file) : writer.take_blocks(file);
  if (!taken) return std::move(taken).error();
  return writer;
}

/// Takes the ids from the index of a file, or from its blocks if the index has grown too much.
Status ContainerWriter::take_index(ContainerFile& file) {
  auto ids = file.id_entries();
  if (!ids) return std::move(ids).error();
  ids_ = *std::move(ids);
  bits_ = commit_.ids.bits;
  if (bits_ + kMissingBits >= bits_for(ids_.size())) return Done{};
  ids_.clear();
  bits_ = 64;
  commit_.block_pages.clear();
  return take_blocks(file);
}

/// Takes index and counts from the blocks of a file without an index.
Status ContainerWriter::take_blocks(ContainerFile& file) {
  commit_.features = 0;
  commit_.solids = 0;
  for (std::uint64_t number = 0; number < file.block_count(); ++number) {
    const auto place = file.entry(number);
    if (!place) return place.error();
    auto block = file.block(number);
    if (!block) return std::move(block).error();
    BlockEntry entry{place->extent, block->features.size(), {}};
    for (const DeletedFeature& deleted : deleted_)
      entry.features += deleted.block == number ? 1 : 0;
    for (const ReadFeature& feature : block->features) {
      ++commit_.features;
      commit_.solids += feature.encoded.solids.size();
      const auto box = box_of(feature.encoded, feature.solids);
      if (!box) return box.error();
      include(entry.box, *box);
      for (const std::string& id : ids_of(feature.encoded)) ids_.push_back({id_hash(id), number});
    }
    entries_.push_back(entry);
  }
  return Done{};
}

void ContainerWriter::add_document(const std::string& format, const SharedText& header,
                                   Bytes framing) {
  const auto [number, is_new] = numbers_.try_emplace({format, header}, documents_.size());
  if (!is_new && framing.empty()) return;
  number->second = documents_.size();
  documents_.push_back({format, header, std::move(framing)});
  has_new_documents_ = true;
}

Status ContainerWriter::add(EncodedFeature feature) {
  return add_to_block({0, 0, std::move(feature)}, false);
}

Status ContainerWriter::add(EncodedFeature feature, std::uint64_t number) {
  return add_to_block({0, number, std::move(feature)}, true);
}

Status ContainerWriter::add_to_block(BlockFeature feature, bool has_number) {
  add_document(feature.encoded.format, feature.encoded.header);
  feature.document = numbers_.at({feature.encoded.format, feature.encoded.header});
  const std::size_t bytes = bytes_of(feature.encoded);
  const bool is_other = has_number != open_.has_numbers || is_too_much(bytes);
  if (is_full() || (is_other && !open_.features.empty())) {
    if (Status closed = close_block(); !closed) return closed;
  }
  open_.has_numbers = has_number;
  open_bytes_ += bytes;
  open_.features.push_back(std::move(feature));
  return Done{};
}

/// The bytes before compression that a block is to have.
double ContainerWriter::block_bytes() const {
  if (options_.purpose == FilePurpose::size) return kBlockBytes;
  return std::min<double>(bytes_per_byte_ * kRangeBytes, kBlockBytes);
}

bool ContainerWriter::is_full() const {
  return open_.features.size() >= kBlockFeatures ||
         static_cast<double>(open_bytes_) >= block_bytes();
}

/// Whether a feature is so large that others should not be read with it.
bool ContainerWriter::is_too_much(std::size_t bytes) const {
  return static_cast<double>(open_bytes_ + bytes) > 1.5 * block_bytes();
}

/// Writes a record; returns where it stands.
Extent ContainerWriter::write(RecordKind kind, ByteView payload) {
  const Bytes record = write_record(kind, payload);
  written_.insert(written_.end(), record.begin(), record.end());
  const Extent extent{offset_, record.size()};
  offset_ += record.size();
  return extent;
}

/// The payload of a block that readers take.
Result<Bytes> ContainerWriter::payload_of(const BlockContents& contents,
                                          std::span<const BlockDocument> documents) {
  auto block = write_block(contents, documents, options_.pages, options_.layout);
  if (!block) return std::move(block).error();
  std::uint64_t items = contents.documents.size() + contents.features.size();
  for (const BlockFeature& feature : contents.features) items += feature.encoded.solids.size();
  if (budget_.take(block->payload.size(), block->text_bytes, items)) {
    return std::move(block->payload);
  }
  return Error{ErrorCode::limit_exceeded,
               "the document becomes so small that readers would take the file for a bomb"};
}

/// Writes the open block, and notes for the index what it has.
Status ContainerWriter::close_block() {
  const auto payload = payload_of(open_, documents_);
  if (!payload) return payload.error();
  const Status noted = note(open_.features, write(RecordKind::block, *payload));
  if (!noted) return noted;
  bytes_per_byte_ = static_cast<double>(open_bytes_) / static_cast<double>(payload->size());
  open_ = {};
  open_bytes_ = 0;
  return Done{};
}

Status ContainerWriter::note(const std::vector<BlockFeature>& features, const Extent& extent) {
  BlockEntry& entry = entries_.emplace_back(BlockEntry{extent, features.size(), {}});
  for (const BlockFeature& feature : features) {
    const EncodedFeature& encoded = feature.encoded;
    ++commit_.features;
    commit_.solids += encoded.solids.size();
    const auto box = known_box(encoded);
    if (!box) return box.error();
    include(entry.box, *box);
    for (const std::string& id : ids_of(encoded)) {
      ids_.push_back({cut_hash(id_hash(id), bits_), blocks_});
    }
  }
  ++blocks_;
  return Done{};
}

bool ContainerWriter::remove(const DeletedFeature& feature, std::uint64_t solids) {
  if (!deleted_.insert(feature).second) return false;
  has_new_deleted_ = true;
  --commit_.features;
  commit_.solids -= solids;
  return true;
}

Bytes ContainerWriter::take() { return std::exchange(written_, {}); }

/// Whether the file has one block at most and all else is in it.
bool ContainerWriter::is_read_whole() const { return !is_appending_ && blocks_ == 0; }

void ContainerWriter::write_ids() {
  const std::uint8_t bits = std::min(bits_, bits_for(ids_.size()));
  for (IdEntry& entry : ids_) entry.hash >>= bits_ - bits;
  std::sort(ids_.begin(), ids_.end());
  ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  commit_.ids = {bits, {}};
  for (const WrittenIdPage& page : write_id_pages(ids_)) {
    commit_.ids.pages.push_back({write(RecordKind::index, page.payload), page.first});
  }
}

/// Writes the index. What every reader needs stands last, near the commit.
void ContainerWriter::write_index() {
  if (!entries_.empty()) write_ids();
  for (std::size_t first = 0; first < entries_.size(); first += kPageBlocks) {
    const std::size_t count = std::min(kPageBlocks, entries_.size() - first);
    WrittenBlockPage page = write_block_page(std::span(entries_).subspan(first, count));
    page.page.extent = write(RecordKind::index, page.payload);
    commit_.block_pages.push_back(page.page);
  }
  if (has_new_deleted_) {
    const std::vector<DeletedFeature> all(deleted_.begin(), deleted_.end());
    commit_.deleted = write(RecordKind::index, write_deleted(all));
  }
}

/// Writes all documents anew, if the last record of them does not have all.
Status ContainerWriter::write_documents() {
  if (!has_new_documents_ && commit_.documents.size > 0) return Done{};
  BlockContents contents;
  contents.documents = documents_;
  const auto payload = payload_of(contents, {});
  if (!payload) return payload.error();
  commit_.documents = write(RecordKind::documents, *payload);
  return Done{};
}

Result<ContainerWriter::Rest> ContainerWriter::finish_in_parts() && {
  if (is_read_whole()) {
    open_.documents = std::exchange(documents_, {});
    if (!open_.documents.empty()) {
      const auto payload = payload_of(open_, open_.documents);
      if (!payload) return payload.error();
      write(RecordKind::block, *payload);
    }
    return Rest{std::move(written_), write_record(RecordKind::commit, {})};
  }
  if (!open_.features.empty()) {
    if (Status closed = close_block(); !closed) return std::move(closed).error();
  }
  write_index();
  if (Status written = write_documents(); !written) return std::move(written).error();
  return Rest{std::move(written_), write_record(RecordKind::commit, write_commit(commit_))};
}

Result<Bytes> ContainerWriter::finish() && {
  auto rest = std::move(*this).finish_in_parts();
  if (!rest) return std::move(rest).error();
  rest->records.insert(rest->records.end(), rest->commit.begin(), rest->commit.end());
  return std::move(rest->records);
}

}  // namespace watertight::pipeline
