// SPDX-License-Identifier: GPL-3.0-or-later
//
// Stored features as map programs get them: one geometry and one list of properties.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/geo_json/city_shapes.h"
#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The names of the properties that the program adds to the attributes of a feature begin so.
inline constexpr std::string_view kOwnProperty = "wt_";

/// A stored feature as it is shown, in the storage CRS.
struct ShownFeature {
  std::string id;
  std::string type;
  std::uint32_t srid = 0;
  formats::CityFeature city;
  /// The properties that the program adds: name, JSON text.
  std::vector<std::pair<std::string, std::string>> properties;
};

/// Reads stored features; keeps what features of one document share from one feature to the next.
class ShownFeatureReader {
 public:
  /// `lod`: the level of detail that is shown; nothing: the highest of each object.
  ShownFeatureReader(std::optional<std::string> lod, const Limits& limits)
      : lod_(std::move(lod)), limits_(limits) {}

  /// Errors: unavailable for a feature that cannot be decoded. Cost: that of decoding the feature.
  Result<ShownFeature> read(StoredFeature stored);

 private:
  Result<formats::CityFeature> read_city(const Document& document);

  std::optional<std::string> lod_;
  Limits limits_;
  std::map<std::string, formats::CityFeatureReader, std::less<>> readers_;  // by header
};

}  // namespace watertight::pipeline
