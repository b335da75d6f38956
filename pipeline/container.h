// SPDX-License-Identifier: GPL-3.0-or-later
//
// The Watertight file: documents with their solids in pages, in one file (docs/cli.md has the
// layout). `encode` and `export` write it, `decode` reads it, the service gives it as a download.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The version of the layout: 2 can hold solids that are not proven, 1 cannot.
inline constexpr std::uint8_t kContainerVersion = 2;

/// True if the bytes start like a Watertight file (of any version).
bool is_container(ByteView bytes);

/// How a Watertight file keeps its solids: in pages, as small as possible, or as the blobs that the
/// features have, which costs no encoding.
enum class SolidLayout : std::uint8_t { pages, blobs };

/// Writes a Watertight file feature by feature. Memory: one part (some thousand features), and the
/// header of each document.
class ContainerWriter {
 public:
  /// `pages` says how the solids are coded in pages. Solids with Steiner vertices stay blobs.
  /// A file of version 1, which older programs read too, holds proven solids only.
  explicit ContainerWriter(const EncodeOptions& pages = {}, SolidLayout layout = SolidLayout::pages,
                           std::uint8_t version = kContainerVersion);

  /// Adds the document of the features with this format and header. Without this call the first
  /// such feature adds it. Cost: linear in the number of documents.
  void add_document(const std::string& format, const SharedText& header, Bytes framing = {});
  /// Adds a feature. Features of a document keep their order. Errors: malformed (a blob is
  /// damaged); limit_exceeded; not_encodable; unsupported (not proven, in a file of version 1).
  Status add(EncodedFeature feature);
  /// The bytes written since the last call, to be appended to the file.
  Bytes take();
  /// The rest of the file. Errors: those of add().
  Result<Bytes> finish() &&;

 private:
  Status close_part();
  void write(ByteView bytes);

  EncodeOptions pages_;
  SolidLayout layout_;
  std::uint8_t version_;
  std::map<std::pair<std::string, SharedText>, std::uint64_t> documents_;  // by format and header
  std::uint64_t new_documents_ = 0;
  ByteWriter new_document_texts_;
  // The features of the open part, each with the number of its document.
  std::vector<std::pair<std::uint64_t, EncodedFeature>> features_;
  std::size_t part_bytes_ = 0;
  std::uint32_t checksum_ = 0;
  Bytes written_;
};

/// Writes a whole document, whose features must have its format and header. Errors:
/// invalid_argument if they do not; those of ContainerWriter::add().
Result<Bytes> write_container(const EncodedDocument& document, const EncodeOptions& pages = {},
                              SolidLayout layout = SolidLayout::pages);

/// The documents in a Watertight file, with all their features. The bytes may be hostile. Errors:
/// malformed (with byte offset), unsupported (version), limit_exceeded; those of decode().
Result<std::vector<Document>> decode_container(ByteView bytes, const Limits& limits = {});

/// The contents of a Watertight file, counted.
/// A solid that is not proven, and its place in the document.
struct UnprovenSolid {
  std::string feature;
  std::string object_id;
  std::string lod;
  std::uint32_t geometry = 0;
  std::uint32_t ordinal = 0;
  std::string report;  // JSON
};

struct ContainerInfo {
  std::vector<Format> formats;  // the format of each document
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t unproven_features = 0;  // the features among them that are not proven
  std::vector<UnprovenSolid> unproven;  // the solids among them that are not proven
  /// The geometries that are no solids, by type; city models only.
  std::map<std::string, std::uint64_t> other_geometries;
  std::uint64_t pages = 0;
  std::uint64_t solid_bytes = 0;        // the bytes of page files and blobs
  std::map<std::string, double> parts;  // the bytes by part of the stream
};

/// Decodes all solids and counts them. Errors: those of decode_container().
Result<ContainerInfo> describe_container(ByteView bytes, const Limits& limits = {});

}  // namespace watertight::pipeline
