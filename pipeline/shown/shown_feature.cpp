// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/shown/shown_feature.h"

#include <algorithm>

#include "base/json_text.h"
#include "formats/city_json/city_json.h"

namespace watertight::pipeline {
namespace {

constexpr std::size_t kMostReaders = 64;

/// The facts about a feature that the store knows.
std::vector<std::pair<std::string, std::string>> own_properties(const StoredFeature& feature) {
  std::vector<std::pair<std::string, std::string>> properties;
  const auto add = [&](std::string_view name, std::string value) {
    properties.emplace_back(std::string(kOwnProperty).append(name), std::move(value));
  };
  add("type", json_string(feature.type));
  add("proven", feature.is_proven() ? "true" : "false");
  add("solids", std::to_string(feature.solids.size()));
  add("unproven_solids", std::to_string(feature.unproven()));
  add("version", std::to_string(feature.version));
  return properties;
}

Error damaged(const Error& error) {
  return {ErrorCode::unavailable, "the stored feature cannot be decoded: " + to_string(error)};
}

}  // namespace

Result<formats::CityFeature> ShownFeatureReader::read_city(const Document& document) {
  const std::string_view header = document.header;
  auto reader = readers_.find(header);
  if (reader == readers_.end()) {
    auto made = formats::CityFeatureReader::make(header, limits_);
    if (!made) return std::move(made).error();
    if (readers_.size() >= kMostReaders) readers_.clear();
    reader = readers_.emplace(std::string(header), *std::move(made)).first;
  }
  const auto text = formats::write_feature(document, document.features.front());
  if (!text) return text.error();
  return reader->second.read(*text, lod_, limits_);
}

Result<ShownFeature> ShownFeatureReader::read(StoredFeature stored) {
  ShownFeature shown{stored.id, stored.type, stored.srid, {}, own_properties(stored)};
  auto document = from_stored(std::move(stored), limits_);
  if (!document) return damaged(document.error());
  const auto repaired =
      std::ranges::count_if(document->features.front().solids,
                            [](const SubmittedSolid& solid) { return !solid.repair.empty(); });
  shown.properties.emplace_back(std::string(kOwnProperty) + "repaired_solids",
                                std::to_string(repaired));
  const bool is_city =
      document->format == Format::city_json || document->format == Format::city_json_seq;
  if (!is_city && document->format != Format::gml) {
    shown.city = formats::city_feature_of(document->features.front());
    return shown;
  }
  if (!is_city) document = formats::as_city_model(*document);
  if (!document) return damaged(document.error());
  auto city = read_city(*document);
  if (!city) return damaged(city.error());
  shown.city = *std::move(city);
  return shown;
}

}  // namespace watertight::pipeline
