// SPDX-License-Identifier: GPL-3.0-or-later
//
// Stored features as GeoJSON, for lists and for one item. Internal to server/.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/geo_json/city_shapes.h"
#include "server/features/systems.h"
#include "server/handlers.h"

namespace watertight::server {

/// The choices of a client for the GeoJSON or JSON-FG of features.
struct FeatureForm {
  bool is_json_fg = false;
  PlaceSystem system = PlaceSystem::crs84h;
  std::optional<std::string> lod;  // nothing: the highest of each object

  /// The form that a request asks for, of features in EPSG system `srid`. JSON-FG is in the storage
  /// CRS unless the request names another. Errors: invalid_argument.
  static Result<FeatureForm> of_request(const Target& target, std::uint32_t srid, bool is_json_fg);
  /// The word that names the form in a tag.
  std::string name() const;
};

/// The members with which a JSON-FG document begins, with a comma after each.
std::string json_fg_head(PlaceSystem system, std::uint32_t srid);

/// Whether it takes more than a moment to decode a feature.
bool is_large(const StoredFeature& feature);

/// The names of the properties that the service adds to the attributes of a feature begin so.
inline constexpr std::string_view kOwnProperty = "wt_";

/// A stored feature as it is shown, in the storage CRS.
struct ShownFeature {
  std::string id;
  std::string type;
  std::uint32_t srid = 0;
  formats::CityFeature city;
  std::vector<std::pair<std::string, std::string>> properties;  // of the service: name, JSON text
};

/// Writes stored features as GeoJSON; keeps what features of one document share from one feature to
/// the next.
class FeatureWriter {
 public:
  FeatureWriter(FeatureForm form, const Limits& limits) : form_(std::move(form)), limits_(limits) {}

  /// The Feature in one line. A geometry that has no coordinates in the wanted CRS is null, and the
  /// property wt_no_geometry has the reason. Errors: unavailable for a feature that cannot be
  /// decoded.
  Result<std::string> write(StoredFeature stored);
  /// The feature for another form than text. Errors: as for write().
  Result<ShownFeature> read(StoredFeature stored);

 private:
  Result<formats::CityFeature> read_city(const Document& document, const std::string& id);

  FeatureForm form_;
  Limits limits_;
  std::map<std::string, formats::CityFeatureReader, std::less<>> readers_;  // by header
};

}  // namespace watertight::server
