// SPDX-License-Identifier: GPL-3.0-or-later
//
// Features as GeoJSON (RFC 7946).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/geo_json/city_shapes.h"

namespace watertight::formats {

/// A GeoJSON Feature, in one line. Facets are the polygons of a MultiPolygon with z; lines and
/// points are a MultiLineString and a MultiPoint, several kinds a GeometryCollection; without any
/// the geometry is null. Numbers have the decimals of the shapes, zeros at their ends left out, or
/// as many as a double needs. `bbox` is around the positions. The properties are the attributes of
/// the feature, then `further` ones (name and JSON text), which win over attributes of their name.
/// Cost: linear.
std::string geo_json_feature(std::string_view id, const CityFeature& feature,
                             const std::vector<std::pair<std::string, std::string>>& further);

}  // namespace watertight::formats
