// SPDX-License-Identifier: GPL-3.0-or-later
//
// A block of a Watertight file: some features with all that is kept of them, compressed together
// (docs/format-file.md, "Blocks"). write_block() and read_block() alone know its bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/blocks/read_budget.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// What features of one document share.
struct BlockDocument {
  std::string format;  // to_string(Format)
  SharedText header;
  Bytes framing;  // Document::framing
};

/// A feature on its way into a block.
struct BlockFeature {
  std::uint64_t document = 0;  // the number of its document in the file
  std::uint64_t number = 0;    // its number in the document, if blocks do not keep that order
  EncodedFeature encoded;
};

/// The contents of a block: documents, features or both.
struct BlockContents {
  /// Documents that are in the block itself. A file of one block has all of its documents here, so
  /// that they are compressed with their features.
  std::vector<BlockDocument> documents;
  std::vector<BlockFeature> features;
  bool has_numbers = false;  // whether BlockFeature::number is kept
};

/// How a Watertight file keeps its solids: in pages, as small as possible, or as the blobs that the
/// features have, which costs no encoding.
enum class SolidLayout : std::uint8_t { pages, blobs };

struct WrittenBlock {
  Bytes payload;
  std::uint64_t text_bytes = 0;  // of its texts, before they were packed
};

/// A block. `documents` are those of the file, up to the last that a feature of the
/// block names; without documents of its own the block is read with them. Solids with Steiner
/// vertices stay blobs. Errors: malformed (a blob is damaged); limit_exceeded; not_encodable.
Result<WrittenBlock> write_block(const BlockContents& contents,
                                 std::span<const BlockDocument> documents,
                                 const EncodeOptions& pages, SolidLayout layout);

/// A feature as a block has it.
struct ReadFeature {
  std::uint64_t ordinal = 0;  // its index in the block
  std::uint64_t document = 0;
  std::uint64_t number = 0;
  EncodedFeature encoded;       // with empty blobs, and without format and header
  std::vector<Decoded> solids;  // one for each proven solid of encoded.solids
};

struct ReadBlock {
  std::vector<BlockDocument> documents;
  std::vector<ReadFeature> features;
  bool has_numbers = false;
  std::uint64_t pages = 0;
  std::uint64_t solid_bytes = 0;  // the bytes of the page file and the blobs
};

/// Reads a block that may be hostile. `documents` are all of the file, or none for a block that has
/// its own; each feature names one of them. Errors: malformed, with the offset in `bytes`;
/// limit_exceeded; those of decode().
Result<ReadBlock> read_block(ByteView bytes, std::span<const BlockDocument> documents,
                             ReadBudget& budget);

}  // namespace watertight::pipeline
