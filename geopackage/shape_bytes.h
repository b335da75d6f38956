// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometries as GeoPackages have them: a header with the box, then well-known binary (ISO) with z.
// Internal to geopackage/.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/bytes.h"
#include "formats/geo_json/city_shapes.h"

namespace watertight::geopackage {

/// The geometry types that the rows of a layer can have in common.
enum class ShapeType : std::uint8_t { point, multi_polygon, other };

/// A geometry and the box around it.
struct ShapeBytes {
  Bytes bytes;
  std::array<double, 3> min{};
  std::array<double, 3> max{};
  ShapeType type = ShapeType::other;
};

/// The shapes of a feature: facets as a MultiPolygon, lines and points as a MultiLineString and a
/// MultiPoint, several kinds as a GeometryCollection. Nothing without any. Cost: linear.
std::optional<ShapeBytes> shape_bytes(const formats::CityShapes& shapes, std::uint32_t srid);

/// One point.
ShapeBytes point_bytes(const std::array<double, 3>& position, std::uint32_t srid);

}  // namespace watertight::geopackage
