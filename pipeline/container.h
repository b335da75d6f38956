// SPDX-License-Identifier: GPL-3.0-or-later
//
// The Watertight file: documents with their solids in pages, in one file (docs/format-file.md).
// `encode` and `export` write it, `decode` reads it, the service gives it as a download.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/file/container_file.h"
#include "pipeline/file/container_writer.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// Writes a whole document, whose features must have its format and header. A file for ranges has
/// its features in the order of their places, with their numbers in the document. Errors:
/// invalid_argument if the features are of other documents; those of ContainerWriter::add().
Result<Bytes> write_container(const EncodedDocument& document,
                              const ContainerOptions& options = {});

/// The numbers of the features in the order of their places, as a file for ranges has them.
std::vector<std::size_t> order_of_places(const std::vector<EncodedFeature>& features);

/// The feature as it was before encoding. Errors: those of decode_feature().
Result<Feature> restored(ReadFeature feature, const Limits& limits);

/// The documents in a Watertight file, with all their features. The bytes may be hostile. Errors:
/// malformed (with byte offset), unsupported (version), limit_exceeded; those of decode().
Result<std::vector<Document>> decode_container(ByteView bytes, const Limits& limits = {});
/// The same for an opened file, with several blocks read at once where `threads` is greater than 1.
/// Features come in the order of their documents.
Result<std::vector<Document>> decode_container(ContainerFile& file, const Limits& limits = {},
                                               unsigned threads = 1);

/// A solid of which there is something to say, and its place in the document.
struct NotedSolid {
  std::string feature;
  std::string object_id;
  std::string lod;
  std::uint32_t geometry = 0;
  std::uint32_t ordinal = 0;
  std::string note;  // JSON
};

/// The contents of a Watertight file, counted.
struct ContainerInfo {
  std::vector<Format> formats;  // the format of each document
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
  std::uint64_t unproven_features = 0;  // the features among them that are not proven
  std::vector<NotedSolid> unproven;     // the solids among them that are not proven, with reports
  std::vector<NotedSolid> repaired;     // the solids among them that were repaired, and how
  /// The geometries that are no solids, by type; city models only.
  std::map<std::string, std::uint64_t> other_geometries;
  std::uint64_t pages = 0;
  std::uint64_t solid_bytes = 0;        // the bytes of page files and blobs
  std::map<std::string, double> parts;  // the bytes by part of the stream
  std::vector<BlockEntry> blocks;       // with the boxes of a file with an index
  std::uint64_t deleted = 0;            // the features that are deleted
};

/// Decodes all solids and counts them. Errors: those of decode_container().
Result<ContainerInfo> describe_container(ByteView bytes, const Limits& limits = {});
Result<ContainerInfo> describe_container(ContainerFile& file);

}  // namespace watertight::pipeline
