// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/feature_text.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/json_text.h"
#include "formats/geo_json/geo_json.h"

namespace watertight::server {
namespace {

constexpr int kDecimalsOfDegrees = 9;  // a tenth of a millimetre
constexpr int kDecimalsOfMetres = 4;
constexpr int kMostDecimalsOfHeights = 20;

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

}  // namespace

bool is_large(const StoredFeature& feature) {
  std::size_t bytes = feature.skeleton.bytes.size() + feature.page.size();
  for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size();
  return bytes > kSmallBody;
}

bool wants_json_fg(const Target& target) {
  const std::string* list = target.parameter("profile");
  std::string_view rest = list == nullptr ? std::string_view() : std::string_view(*list);
  while (!rest.empty()) {
    const std::string_view name = rest.substr(0, rest.find(','));
    if (name == "jsonfg" || name == "[ogc-profile:jsonfg]" || name == profile_uri(true))
      return true;
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
  }
  return false;
}

std::string_view profile_uri(bool is_json_fg) {
  return is_json_fg ? "http://www.opengis.net/def/profile/OGC/0/jsonfg"
                    : "http://www.opengis.net/def/profile/OGC/0/rfc7946";
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

Result<std::string> FeatureWriter::write(StoredFeature stored) {
  auto shown = reader_.read(std::move(stored));
  if (!shown) return std::move(shown).error();
  formats::CityFeature& city = shown->city;
  const Status brought = city.is_too_large ? Error{ErrorCode::limit_exceeded,
                                                   "the geometry has more vertices than are shown"}
                                           : bring_into(form_.system, shown->srid, city.shapes);
  if (!brought) {
    city.shapes = {};
    shown->properties.emplace_back(std::string(pipeline::kOwnProperty) + "no_geometry",
                                   json_string(brought.error().message));
  }
  return form_.is_json_fg
             ? formats::json_fg_feature(shown->id, shown->type, city, shown->properties)
             : formats::geo_json_feature(shown->id, city, shown->properties);
}

}  // namespace watertight::server
