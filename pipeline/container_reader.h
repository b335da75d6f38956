// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads a Watertight file part by part (docs/cli.md has the layout).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/limits.h"
#include "codec/blob.h"
#include "pipeline/container.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The first bytes of a Watertight file. Like those of PNG they have a byte above 127, and line
/// ends that a text-mode transfer would change.
inline constexpr std::uint8_t kContainerMagic[8] = {0x89, 'W', 'T', 'F', '\r', '\n', 0x1A, '\n'};
/// In place of the bytes of a blob, of which there are more: the solid is not proven.
inline constexpr std::uint64_t kNoBlob = 1;

/// A document that features of this part and later ones may belong to.
struct ContainerDocument {
  std::string format;
  std::string header;
  Bytes framing;
};

struct ContainerFeature {
  std::uint64_t document = 0;   // number of the document in the file
  EncodedFeature encoded;       // the feature, with empty blobs
  std::vector<Decoded> solids;  // one for each proven solid of encoded.solids
};

/// The feature as it was before encoding. Errors: those of decode_feature().
Result<Feature> restored(ContainerFeature feature, Format format, const Limits& limits);

struct ContainerPart {
  std::vector<ContainerDocument> new_documents;
  std::vector<ContainerFeature> features;
  std::uint64_t pages = 0;
  std::uint64_t solid_bytes = 0;  // the bytes of the page file and the blobs
};

/// Reads a file that may be hostile: memory is bounded by the bytes that were read and by the
/// limits.
class ContainerReader {
 public:
  /// Checks version and checksum. `bytes` must outlive the reader.
  /// Errors: malformed; unsupported; limit_exceeded.
  static Result<ContainerReader> open(ByteView bytes, const Limits& limits);
  /// The next part, nullopt after the last. Errors: malformed; limit_exceeded; those of decode().
  Result<std::optional<ContainerPart>> next();

 private:
  // Texts may be compressed a thousandfold, so the bytes of the file bound the number of their
  // items.
  static constexpr std::uint64_t kFreeItems = 65'536;
  static constexpr std::uint64_t kItemsPerByte = 4;

  ContainerReader(ByteView parts, const Limits& limits, std::uint8_t version)
      : parts_(parts),
        version_(version),
        limits_(limits),
        texts_left_(limits.expanded_from(parts.size())),
        vertices_left_(limits.claimed_by(parts.size())),
        items_left_(kFreeItems + kItemsPerByte * parts.size()) {}
  Error malformed(std::string message) const;

  ByteReader parts_;
  std::uint8_t version_;
  Limits limits_;
  std::uint64_t texts_left_;     // bytes of all texts that may still come
  std::uint64_t vertices_left_;  // vertices of all solids that may still come
  std::uint64_t items_left_;     // documents, features and solids that may still come
  std::uint64_t documents_ = 0;
};

}  // namespace watertight::pipeline
