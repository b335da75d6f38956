// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/systems.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace watertight::server {
namespace {

using projection::Rectangle;

constexpr std::string_view kCrs84h = "http://www.opengis.net/def/crs/OGC/0/CRS84h";
constexpr std::string_view kCrs84 = "http://www.opengis.net/def/crs/OGC/1.3/CRS84";
constexpr std::string_view kWebMercator = "http://www.opengis.net/def/crs/EPSG/0/3857";

projection::System system_of(PlaceSystem system) {
  return system == PlaceSystem::web_mercator ? projection::System::web_mercator
                                             : projection::System::longitude_latitude;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// A box from 4 or 6 numbers; a box of 4 numbers has no limit in z. A smallest longitude above the
/// largest is a box across the meridian of 180 degrees, which only CRS84 has.
Result<store::StoredBox> parse_box(std::string_view text, bool can_wrap) {
  const Error wrong{ErrorCode::invalid_argument,
                    "bbox needs 4 or 6 comma-separated numbers: minima, then maxima"};
  std::vector<double> numbers;
  while (numbers.size() <= 6) {
    const std::size_t comma = text.find(',');
    const auto number = parse_number(text.substr(0, comma));
    if (!number) return wrong;
    numbers.push_back(*number);
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  if (numbers.size() != 4 && numbers.size() != 6) return wrong;
  const std::size_t axes = numbers.size() / 2;
  store::StoredBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_given = axis < axes;
    box.min[axis] = is_given ? numbers[axis] : std::numeric_limits<double>::lowest();
    box.max[axis] = is_given ? numbers[axes + axis] : std::numeric_limits<double>::max();
    if (box.min[axis] > box.max[axis] && !(can_wrap && axis == 0)) {
      return Error{ErrorCode::invalid_argument, "bbox: a minimum is above its maximum"};
    }
  }
  return box;
}

Rectangle plane_of(const store::StoredBox& box) {
  return {{box.min[0], box.min[1]}, {box.max[0], box.max[1]}};
}

/// The part of `area` that the box covers, all of its parts together if the box wraps around.
std::optional<Rectangle> covered(const Rectangle& area, const store::StoredBox& box) {
  constexpr double kHalfTurn = 180;
  std::vector<std::pair<double, double>> ranges{{box.min[0], box.max[0]}};
  if (box.min[0] > box.max[0]) ranges = {{box.min[0], kHalfTurn}, {-kHalfTurn, box.max[0]}};
  std::optional<Rectangle> part;
  const double low = std::max(area.min[1], box.min[1]);
  const double high = std::min(area.max[1], box.max[1]);
  for (const auto& [first, last] : ranges) {
    const double left = std::max(area.min[0], first);
    const double right = std::min(area.max[0], last);
    if (left > right || low > high) continue;
    part =
        part ? Rectangle{{std::min(part->min[0], left), low}, {std::max(part->max[0], right), high}}
             : Rectangle{{left, low}, {right, high}};
  }
  return part;
}

/// The choice of a box in another system than the storage CRS. The rectangle around its corners and
/// edges in the storage CRS is a little larger than the box, by the turn between the systems.
Result<BoxChoice> choice_in_system(PlaceSystem system, const store::StoredBox& box,
                                   const store::StoredCollection& collection) {
  constexpr double kRoundings = 1e-9;  // of a coordinate, more than its way there and back changes
  if (!collection.box) return BoxChoice{.is_empty = true, .box = {}};
  const auto extent =
      projection::bounds_of(collection.srid, system_of(system), plane_of(*collection.box));
  if (!extent) return extent.error();
  const auto part = covered(*extent, box);
  if (!part) return BoxChoice{.is_empty = true, .box = {}};
  const bool is_all = part->min == extent->min && part->max == extent->max;
  store::StoredBox chosen = *collection.box;
  if (!is_all) {
    const auto inside = projection::bounds_in(collection.srid, system_of(system), *part);
    if (!inside) return inside.error();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double margin =
          kRoundings * std::max(std::abs(inside->min[axis]), std::abs(inside->max[axis]));
      chosen.min[axis] = inside->min[axis] - margin;
      chosen.max[axis] = inside->max[axis] + margin;
    }
  }
  chosen.min[2] = box.min[2];
  chosen.max[2] = box.max[2];
  const bool has_heights = box.min[2] != std::numeric_limits<double>::lowest();
  if (is_all && !has_heights) return BoxChoice{};
  return BoxChoice{.is_empty = false, .box = chosen};
}

}  // namespace

std::string system_uri(PlaceSystem system, std::uint32_t srid) {
  switch (system) {
    case PlaceSystem::crs84h:
      return std::string(kCrs84h);
    case PlaceSystem::crs84:
      return std::string(kCrs84);
    case PlaceSystem::web_mercator:
      return std::string(kWebMercator);
    case PlaceSystem::storage:
      break;
  }
  return crs_uri(srid);
}

std::string content_crs(PlaceSystem system, std::uint32_t srid) {
  return std::string("<").append(system_uri(system, srid)).append(">");
}

std::vector<std::string> system_uris(std::uint32_t srid) {
  std::vector<std::string> uris;
  if (srid != 0) uris = {std::string(kCrs84h), std::string(kCrs84), std::string(kWebMercator)};
  if (crs_uri(srid) != kWebMercator) uris.push_back(crs_uri(srid));
  return uris;
}

Result<PlaceSystem> system_of_request(const Target& target, std::string_view name,
                                      std::uint32_t srid) {
  const std::string* wanted = target.parameter(name);
  if (wanted == nullptr) return PlaceSystem::crs84h;
  std::string uri = *wanted;
  if (uri.starts_with("https://")) uri.erase(4, 1);  // both schemes name the same systems
  if (uri == crs_uri(srid)) return PlaceSystem::storage;
  if (srid != 0) {
    for (const auto system : {PlaceSystem::crs84h, PlaceSystem::crs84, PlaceSystem::web_mercator}) {
      if (uri == system_uri(system, srid)) return system;
    }
  }
  std::string known;
  for (const std::string& each : system_uris(srid)) known += (known.empty() ? "" : ", ") + each;
  return Error{ErrorCode::invalid_argument,
               std::string(name) + " can be one of the CRS of the collection: " + known};
}

Status change_system(PlaceSystem system, std::uint32_t srid,
                     std::span<projection::Position> positions) {
  if (system != PlaceSystem::storage) {
    if (srid == 0) return Error{ErrorCode::unsupported, "the collection states no CRS"};
    return projection::transform(srid, system_of(system), positions);
  }
  if (projection::is_north_first(srid)) {
    for (projection::Position& position : positions) std::swap(position[0], position[1]);
  }
  return Done{};
}

std::optional<store::StoredBox> box_in_crs84(std::uint32_t srid, const store::StoredBox& box) {
  if (srid == 0) return std::nullopt;
  const auto bounds =
      projection::bounds_of(srid, projection::System::longitude_latitude, plane_of(box));
  if (!bounds) return std::nullopt;
  return store::StoredBox{{bounds->min[0], bounds->min[1], box.min[2]},
                          {bounds->max[0], bounds->max[1], box.max[2]}};
}

Result<BoxChoice> choice_of_box(PlaceSystem system, const store::StoredBox& box,
                                const store::StoredCollection& collection) {
  if (system != PlaceSystem::storage && collection.srid == 0) {
    return Error{ErrorCode::invalid_argument, "the collection states no CRS: a box needs the CRS " +
                                                  crs_uri(0) + " (bbox-crs, filter-crs)"};
  }
  if (system != PlaceSystem::storage) return choice_in_system(system, box, collection);
  store::StoredBox turned = box;
  if (projection::is_north_first(collection.srid)) {
    std::swap(turned.min[0], turned.min[1]);
    std::swap(turned.max[0], turned.max[1]);
  }
  return BoxChoice{.is_empty = false, .box = turned};
}

Result<BoxChoice> box_of_request(const Target& target, const store::StoredCollection& collection) {
  const auto system = system_of_request(target, "bbox-crs", collection.srid);
  if (!system) return system.error();
  const std::string* text = target.parameter("bbox");
  if (text == nullptr) return BoxChoice{};
  const bool can_wrap = *system == PlaceSystem::crs84 || *system == PlaceSystem::crs84h;
  auto box = parse_box(*text, can_wrap);
  if (!box) return std::move(box).error();
  return choice_of_box(*system, *box, collection);
}

}  // namespace watertight::server
