// SPDX-License-Identifier: GPL-3.0-or-later
//
// Coordinates of EPSG systems as longitude and latitude, and back, and in other systems, by PROJ.
// Nothing about a solid is decided by such coordinates; one that was moved to them is a new solid,
// and is judged anew.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"

namespace watertight::projection {

using Position = std::array<double, 3>;

/// A rectangle in the plane; bounds included.
struct Rectangle {
  std::array<double, 2> min{};
  std::array<double, 2> max{};
};

/// The systems to which coordinates can be brought.
enum class System : std::uint8_t {
  longitude_latitude,  // OGC:CRS84, degrees
  web_mercator         // EPSG:3857, metres
};

/// Changes x and y of positions in EPSG system `srid`, easting or longitude first, into the other
/// system. z stays as it is: heights keep their reference surface and unit, since the grids that
/// a change of it needs are not at hand everywhere. PROJ chooses the most exact operation that
/// needs no grid which is not installed. Errors: unsupported for a code that PROJ does not know as
/// a geographic or projected system, and for a position that the systems cannot both hold. The
/// positions are then of no use. Cost: linear; some milliseconds more for the first call of a
/// thread.
Status transform(std::uint32_t srid, System system, std::span<Position> positions);

/// The same between two EPSG systems, longitude first in geographic ones.
Status transform_between(std::uint32_t from, std::uint32_t to, std::span<Position> positions);

/// Changes longitudes, latitudes (degrees) and heights above the ellipsoid of WGS 84 (metres) into
/// the Cartesian coordinates of EPSG:4978: metres from the centre of the Earth. Cost: linear.
void to_earth_centred(std::span<Position> positions);

/// Whether the first axis of EPSG system `srid` points north by the authority's definition, so that
/// its coordinates are written northing (or latitude) first. False for unknown codes. Cost: as
/// transform().
bool is_north_first(std::uint32_t srid);

/// The definition of a reference system in the two versions of well-known text (OGC 12-063).
struct SystemText {
  std::string name;
  std::string first;   // WKT 1, as GDAL writes it; "" for a system that it cannot describe
  std::string second;  // WKT 2:2019
};

/// The definition of EPSG system `srid`. Errors: unsupported for a code that PROJ does not know.
/// Cost: as transform().
Result<SystemText> text_of(std::uint32_t srid);

/// A rectangle around the part of the plane that a rectangle of EPSG system `srid` covers in the
/// other system: its edges are followed. Errors: those of transform().
Result<Rectangle> bounds_of(std::uint32_t srid, System system, const Rectangle& rectangle);

/// A rectangle in EPSG system `srid` around a rectangle of the other system. Errors: those of
/// transform().
Result<Rectangle> bounds_in(std::uint32_t srid, System system, const Rectangle& rectangle);

}  // namespace watertight::projection
