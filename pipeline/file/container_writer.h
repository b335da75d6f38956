// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes a Watertight file feature by feature, or the bytes that add features to one
// (docs/format-file.md).
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/blocks/block.h"
#include "pipeline/file/container_file.h"

namespace watertight::pipeline {

/// For what the file is: to be small, or to be read in ranges, by blocks of some 20 KiB.
enum class FilePurpose : std::uint8_t { size, ranges };
/// The purpose named "size" or "ranges". Errors: invalid_argument.
Result<FilePurpose> file_purpose_named(const std::string& name);

struct ContainerOptions {
  EncodeOptions pages = {};  // how solids are coded in pages; no certificate
  SolidLayout layout = SolidLayout::pages;
  FilePurpose purpose = FilePurpose::size;
};

/// Memory: one block, the documents, and 16 bytes for each id if the file has an index. A file of
/// one block has none.
class ContainerWriter {
 public:
  /// A new file.
  explicit ContainerWriter(ContainerOptions options = {});
  /// Adds to a file: the bytes of take() and finish() belong at its ContainerFile::committed().
  /// Reads its index; all of a file without one. Errors: those of `file`.
  static Result<ContainerWriter> append(ContainerFile& file, ContainerOptions options = {});

  /// Adds the document of the features with this format and header that follow, if there is none or
  /// it has a framing. Without this call the first such feature adds it. A document of a file that
  /// is added to gets no more features if it has a framing or is a CityJSON. Cost: logarithmic in
  /// the number of documents.
  void add_document(const std::string& format, const SharedText& header, Bytes framing = {});
  /// Adds a feature. Features of a document keep their order. Errors: those of write_block();
  /// limit_exceeded when readers would refuse the file for what it claims (docs/format-file.md,
  /// "Limits").
  Status add(EncodedFeature feature);
  /// Adds a feature whose number in its document is kept; all features of a block have one, or
  /// none.
  Status add(EncodedFeature feature, std::uint64_t number);
  /// Marks a feature of the file that is added to as deleted; false if it is so already.
  bool remove(const DeletedFeature& feature, std::uint64_t solids);

  /// The bytes written since the last call, to be appended to the file.
  Bytes take();
  /// The rest of the file. Errors: those of add().
  Result<Bytes> finish() &&;
  /// The rest of the file in two parts: what must be safe on the disk before the second, the
  /// commit, is written. Errors: those of add().
  struct Rest {
    Bytes records;
    Bytes commit;
  };
  Result<Rest> finish_in_parts() &&;

 private:
  Status add_to_block(BlockFeature feature, bool has_number);
  double block_bytes() const;
  bool is_full() const;
  bool is_too_much(std::size_t bytes) const;
  Status close_block();
  Result<Bytes> payload_of(const BlockContents& contents, std::span<const BlockDocument> documents);
  Status note(const std::vector<BlockFeature>& features, const Extent& extent);
  Status take_index(ContainerFile& file);
  Status take_blocks(ContainerFile& file);
  Extent write(RecordKind kind, ByteView payload);
  void write_index();
  Status write_documents();
  void write_ids();
  bool is_read_whole() const;

  ContainerOptions options_;
  std::uint64_t offset_ = 0;  // where the next byte goes in the file
  Bytes written_;
  WriteBudget budget_;
  std::vector<BlockDocument> documents_;
  std::map<std::pair<std::string, SharedText>, std::uint64_t> numbers_;  // of the documents
  bool has_new_documents_ = false;
  BlockContents open_;
  std::size_t open_bytes_ = 0;       // before compression
  double bytes_per_byte_ = 6;        // before compression for each after it, in the last block
  std::uint64_t blocks_ = 0;         // that are written
  std::vector<BlockEntry> entries_;  // of the blocks that no page has yet
  std::vector<IdEntry> ids_;         // with hashes of bits_ bits
  std::uint8_t bits_ = 64;
  std::set<DeletedFeature> deleted_;
  bool has_new_deleted_ = false;
  bool is_appending_ = false;
  Commit commit_;
};

}  // namespace watertight::pipeline
