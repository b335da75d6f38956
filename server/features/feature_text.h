// SPDX-License-Identifier: GPL-3.0-or-later
//
// Stored features as GeoJSON, for lists and for one item. Internal to server/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pipeline/shown/shown_feature.h"
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

/// Whether the parameter `profile` of a request for GeoJSON names the profile JSON-FG (OGC API -
/// Common, part 3; JSON-FG, "JSON-FG in Web APIs"). Other profiles are ignored, as the standard
/// wants it.
bool wants_json_fg(const Target& target);

/// The address of the profile of GeoJSON that an answer has.
std::string_view profile_uri(bool is_json_fg);

/// The members with which a JSON-FG document begins, with a comma after each.
std::string json_fg_head(PlaceSystem system, std::uint32_t srid);

/// Whether it takes more than a moment to decode a feature.
bool is_large(const StoredFeature& feature);

/// Writes stored features as GeoJSON.
class FeatureWriter {
 public:
  FeatureWriter(FeatureForm form, const Limits& limits)
      : form_(std::move(form)), reader_(form_.lod, limits) {}

  /// The Feature in one line. A geometry that has no coordinates in the wanted CRS is null, and the
  /// property wt_no_geometry has the reason. Errors: unavailable for a feature that cannot be
  /// decoded.
  Result<std::string> write(StoredFeature stored);

 private:
  FeatureForm form_;
  pipeline::ShownFeatureReader reader_;
};

}  // namespace watertight::server
