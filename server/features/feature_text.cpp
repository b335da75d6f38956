// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/feature_text.h"

#include <array>
#include <utility>
#include <vector>

#include "base/json_text.h"
#include "formats/city_json/city_json.h"
#include "formats/geo_json/geo_json.h"

namespace watertight::server {
namespace {

using Properties = std::vector<std::pair<std::string, std::string>>;

constexpr int kDecimalsOfDegrees = 9;  // a tenth of a millimetre
constexpr int kDecimalsOfMetres = 4;
constexpr int kMostDecimalsOfHeights = 20;
constexpr std::size_t kMostReaders = 64;

/// The facts about a feature that the store knows.
Properties own_properties(const StoredFeature& feature) {
  const auto add = [](Properties& out, std::string_view name, std::string value) {
    out.emplace_back(std::string(kOwnProperty).append(name), std::move(value));
  };
  Properties properties;
  add(properties, "type", json_string(feature.type));
  add(properties, "proven", feature.is_proven() ? "true" : "false");
  add(properties, "solids", std::to_string(feature.solids.size()));
  add(properties, "unproven_solids", std::to_string(feature.unproven()));
  add(properties, "version", std::to_string(feature.version));
  return properties;
}

/// Brings the shapes into another system, with as many decimals as its unit needs.
Status bring_into(PlaceSystem system, std::uint32_t srid, formats::CityShapes& shapes) {
  const Status changed = change_system(system, srid, shapes.positions);
  if (!changed) return changed;
  if (system == PlaceSystem::storage) {
    if (shapes.decimals && projection::is_north_first(srid)) {
      std::swap((*shapes.decimals)[0], (*shapes.decimals)[1]);
    }
    return Done{};
  }
  const int plane = system == PlaceSystem::web_mercator ? kDecimalsOfMetres : kDecimalsOfDegrees;
  const int heights = shapes.decimals ? (*shapes.decimals)[2] : kMostDecimalsOfHeights;
  shapes.decimals = {plane, plane, heights};
  return Done{};
}

Error damaged(const Error& error) {
  return {ErrorCode::unavailable, "the stored feature cannot be decoded: " + to_string(error)};
}

}  // namespace

bool is_large(const StoredFeature& feature) {
  std::size_t bytes = feature.skeleton.bytes.size() + feature.page.size();
  for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size();
  return bytes > kSmallBody;
}

std::string json_fg_head(PlaceSystem system, std::uint32_t srid) {
  std::string head =
      R"("conformsTo":["http://www.opengis.net/spec/json-fg-1/1.0/conf/core",)"
      R"("http://www.opengis.net/spec/json-fg-1/1.0/conf/polyhedra"],"coordRefSys":)";
  return head.append(json_string(system_uri(system, srid))).append(",");
}

Result<FeatureForm> FeatureForm::of_request(const Target& target, std::uint32_t srid,
                                            bool is_json_fg) {
  auto system = system_of_request(target, "crs", srid);
  if (!system) return std::move(system).error();
  FeatureForm form{is_json_fg, *system, std::nullopt};
  if (is_json_fg && target.parameter("crs") == nullptr) form.system = PlaceSystem::storage;
  if (const std::string* lod = target.parameter("lod")) form.lod = *lod;
  return form;
}

std::string FeatureForm::name() const {
  std::string name = is_json_fg ? "jsonfg" : "geojson";
  switch (system) {
    case PlaceSystem::crs84h:
      break;
    case PlaceSystem::crs84:
      name += "-crs84";
      break;
    case PlaceSystem::web_mercator:
      name += "-mercator";
      break;
    case PlaceSystem::storage:
      name += "-storage";
      break;
  }
  if (lod) name += "-lod" + percent_encode(*lod);
  return name;
}

Result<formats::CityFeature> FeatureWriter::read_city(const Document& document,
                                                      const std::string& id) {
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
  return reader->second.read(*text, id, form_.lod, limits_);
}

Result<ShownFeature> FeatureWriter::read(StoredFeature stored) {
  ShownFeature shown{stored.id, stored.type, stored.srid, {}, own_properties(stored)};
  auto document = pipeline::from_stored(std::move(stored), limits_);
  if (!document) return damaged(document.error());
  const bool is_city =
      document->format == Format::city_json || document->format == Format::city_json_seq;
  if (!is_city && document->format != Format::gml) {
    shown.city = formats::city_feature_of(document->features.front());
    return shown;
  }
  if (!is_city) document = formats::as_city_model(*document);
  if (!document) return damaged(document.error());
  auto city = read_city(*document, shown.id);
  if (!city) return damaged(city.error());
  shown.city = *std::move(city);
  return shown;
}

Result<std::string> FeatureWriter::write(StoredFeature stored) {
  auto shown = read(std::move(stored));
  if (!shown) return std::move(shown).error();
  formats::CityFeature& city = shown->city;
  const Status brought = city.is_too_large ? Error{ErrorCode::limit_exceeded,
                                                   "the geometry has more vertices than are shown"}
                                           : bring_into(form_.system, shown->srid, city.shapes);
  if (!brought) {
    city.shapes = {};
    shown->properties.emplace_back(std::string(kOwnProperty) + "no_geometry",
                                   json_string(brought.error().message));
  }
  return form_.is_json_fg
             ? formats::json_fg_feature(shown->id, shown->type, city, shown->properties)
             : formats::geo_json_feature(shown->id, city, shown->properties);
}

}  // namespace watertight::server
