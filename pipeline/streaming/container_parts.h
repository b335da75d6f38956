// SPDX-License-Identifier: GPL-3.0-or-later
//
// The documents of a Watertight file for a store, block by block.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "formats/city_json/city_json.h"
#include "pipeline/file/container_file.h"

namespace watertight::pipeline {

/// What becomes of a CityJSON that the file holds as a whole, not by its features: it is refused,
/// or its text is made again and split, which takes the memory of a document that is read whole.
enum class WholeModels : std::uint8_t { refuse, split };

class ContainerParts {
 public:
  /// `bytes` must outlive the object. Errors: those of ContainerFile::open().
  static Result<ContainerParts> open(ByteView bytes, const Limits& limits,
                                     WholeModels models = WholeModels::refuse);

  /// The documents with features in the next block, each with these features only; nullopt
  /// after the last block. Features of city models have the sources and instances, and documents
  /// the templates, that their text would give. Errors: those of ContainerFile::block() and
  /// decode_feature(); malformed when skeleton and solids do not fit; unsupported for a CityJSON as
  /// a whole that is refused.
  Result<std::optional<std::vector<Document>>> next();

 private:
  struct Shared {
    Document document;  // without features
    std::optional<formats::CityHeader> header;
  };
  ContainerParts(ContainerFile file, const Limits& limits, WholeModels models)
      : file_(std::move(file)), limits_(limits), models_(models) {}
  Status add(const BlockDocument& added);
  Result<Document> split(const formats::CityHeader& header, const Feature& model) const;

  ContainerFile file_;
  std::uint64_t next_ = 0;  // the number of the next block
  Limits limits_;
  WholeModels models_;
  std::vector<Shared> documents_;
};

}  // namespace watertight::pipeline
