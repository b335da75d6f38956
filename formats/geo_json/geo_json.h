// SPDX-License-Identifier: GPL-3.0-or-later
//
// Features as GeoJSON (RFC 7946) and JSON-FG (OGC 21-045r1).
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

/// A JSON-FG Feature in the CRS that its collection names, in one line: the solids are a Polyhedron
/// or MultiPolyhedron as `place`, with cavities as shells, and `geometry` is null; a feature
/// without solids has what geo_json_feature() writes as `place`. `type` is its feature type.
/// Properties and cost as there.
std::string json_fg_feature(std::string_view id, std::string_view type, const CityFeature& feature,
                            const std::vector<std::pair<std::string, std::string>>& further);

}  // namespace watertight::formats
