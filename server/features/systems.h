// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coordinate reference systems (CRS) in which clients get and name places (OGC API Features,
// parts 1 and 2). Internal to server/.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "projection/projection.h"
#include "server/handlers.h"

namespace watertight::server {

enum class PlaceSystem : std::uint8_t {
  crs84h,        // longitude, latitude and height, the default
  crs84,         // the same numbers under the name of the system without heights
  web_mercator,  // EPSG:3857
  storage        // that of the collection, its axes in the authority's order
};

/// The URIs of the systems that a collection has, the first one the default. A collection without a
/// CRS has "unknown" alone.
std::vector<std::string> system_uris(std::uint32_t srid);
std::string system_uri(PlaceSystem system, std::uint32_t srid);

/// system_uri() in the form of the value of a Content-Crs field.
std::string content_crs(PlaceSystem system, std::uint32_t srid);

/// The system that the parameter `name` of a request names; the default without it. Errors:
/// invalid_argument, which lists the systems.
Result<PlaceSystem> system_of_request(const Target& target, std::string_view name,
                                      std::uint32_t srid);

/// Changes positions in the storage CRS into another system; heights stay as they are. Errors:
/// unsupported.
Status change_system(PlaceSystem system, std::uint32_t srid,
                     std::span<projection::Position> positions);

/// The box around a box in the storage CRS in CRS84h; nothing where there is no way to it.
std::optional<store::StoredBox> box_in_crs84(std::uint32_t srid, const store::StoredBox& box);

/// The part of a collection that a request's `bbox` and `bbox-crs` select.
struct BoxChoice {
  bool is_empty = false;                // no feature can match
  std::optional<store::StoredBox> box;  // in the storage CRS as stored; nothing: all features match
};

/// The part of a collection that a box in another system selects. Errors: invalid_argument for a
/// collection without CRS; unsupported for a box that is not in the area of the storage CRS.
Result<BoxChoice> choice_of_box(PlaceSystem system, const store::StoredBox& box,
                                const store::StoredCollection& collection);

/// Errors: invalid_argument; those of choice_of_box().
Result<BoxChoice> box_of_request(const Target& target, const store::StoredCollection& collection);

}  // namespace watertight::server
