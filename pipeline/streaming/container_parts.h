// SPDX-License-Identifier: GPL-3.0-or-later
//
// The documents of a Watertight file for a store, part by part.
#pragma once

#include <optional>
#include <vector>

#include "formats/city_json/city_json.h"
#include "pipeline/container_reader.h"

namespace watertight::pipeline {

class ContainerParts {
 public:
  /// `bytes` must outlive the object. Errors: those of ContainerReader::open().
  static Result<ContainerParts> open(ByteView bytes, const Limits& limits);

  /// The documents with features in the next part, each with these features only; nullopt
  /// after the last part. Features of city models have the sources and instances, and documents
  /// the templates, that their text would give. Errors: those of ContainerReader::next() and
  /// decode_feature(); malformed when skeleton and solids do not fit.
  Result<std::optional<std::vector<Document>>> next();

 private:
  struct Shared {
    Document document;  // without features
    std::optional<formats::CityHeader> header;
  };
  ContainerParts(const ContainerReader& reader, const Limits& limits)
      : reader_(reader), limits_(limits) {}
  Status add(ContainerDocument added);
  Result<Feature> whole(ContainerFeature feature) const;

  ContainerReader reader_;
  Limits limits_;
  std::vector<Shared> documents_;
};

}  // namespace watertight::pipeline
