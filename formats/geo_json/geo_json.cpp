// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/geo_json/geo_json.h"

#include <algorithm>
#include <charconv>
#include <span>

#include "formats/text/json.h"

namespace watertight::formats {
namespace {

using Decimals = std::optional<std::array<int, 3>>;

constexpr std::size_t kLongestNumber = 400;  // digits of the largest double with 20 decimals
constexpr int kMostDecimals = 20;

/// Appends a number with at most so many decimals.
void append_number(std::string& out, double value, const Decimals& decimals, std::size_t axis) {
  std::array<char, kLongestNumber> digits;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  char* const begin = digits.data();
  char* const limit = begin + digits.size();
  if (!decimals) {
    out.append(begin, std::to_chars(begin, limit, value).ptr);
    return;
  }
  const int count = std::min((*decimals)[axis], kMostDecimals);
  std::string_view text(
      begin, static_cast<std::size_t>(
                 std::to_chars(begin, limit, value, std::chars_format::fixed, count).ptr - begin));
  if (text.find('.') != std::string_view::npos) {
    text = text.substr(0, text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.remove_suffix(1);
  }
  out += text == "-0" ? std::string_view("0") : text;
}

void append_position(std::string& out, const CityShapes& shapes, std::size_t index) {
  out += '[';
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) out += ',';
    append_number(out, shapes.positions[index][axis], shapes.decimals, axis);
  }
  out += ']';
}

/// Appends an array of what `append` appends for each item.
template <class Items, class Append>
void append_array(std::string& out, const Items& items, Append append) {
  out += '[';
  bool is_first = true;
  for (const auto& item : items) {
    if (!is_first) out += ',';
    is_first = false;
    append(item);
  }
  out += ']';
}

void append_polygon(std::string& out, const CityShapes& shapes,
                    const CityShapes::Polygon& polygon) {
  append_array(out, polygon, [&](const CityShapes::Ring& ring) {
    CityShapes::Ring closed = ring;
    closed.push_back(ring.front());
    append_array(out, closed, [&](std::size_t index) { append_position(out, shapes, index); });
  });
}

void append_polygons(std::string& out, const CityShapes& shapes) {
  out += R"({"type":"MultiPolygon","coordinates":)";
  append_array(out, shapes.polygons,
               [&](const CityShapes::Polygon& polygon) { append_polygon(out, shapes, polygon); });
  out += '}';
}

void append_polyhedron(std::string& out, const CityShapes& shapes,
                       const std::vector<CityShapes::Shell>& solid) {
  append_array(out, solid, [&](const CityShapes::Shell& shell) {
    append_array(out, std::span(shapes.polygons).subspan(shell.first, shell.count),
                 [&](const CityShapes::Polygon& polygon) { append_polygon(out, shapes, polygon); });
  });
}

void append_lines(std::string& out, const CityShapes& shapes) {
  out += R"({"type":"MultiLineString","coordinates":)";
  append_array(out, shapes.lines, [&](const CityShapes::Ring& line) {
    append_array(out, line, [&](std::size_t index) { append_position(out, shapes, index); });
  });
  out += '}';
}

void append_points(std::string& out, const CityShapes& shapes) {
  out += R"({"type":"MultiPoint","coordinates":)";
  append_array(out, shapes.points, [&](std::size_t index) { append_position(out, shapes, index); });
  out += '}';
}

void append_geometry(std::string& out, const CityShapes& shapes) {
  std::vector<void (*)(std::string&, const CityShapes&)> parts;
  if (!shapes.polygons.empty()) parts.push_back(append_polygons);
  if (!shapes.lines.empty()) parts.push_back(append_lines);
  if (!shapes.points.empty()) parts.push_back(append_points);
  if (parts.empty()) {
    out += "null";
  } else if (parts.size() == 1) {
    parts.front()(out, shapes);
  } else {
    out += R"({"type":"GeometryCollection","geometries":)";
    append_array(out, parts, [&](const auto& append) { append(out, shapes); });
    out += '}';
  }
}

/// Appends the solids; without any, all geometry.
void append_place(std::string& out, const CityShapes& shapes) {
  if (shapes.solids.empty()) return append_geometry(out, shapes);
  const bool is_one = shapes.solids.size() == 1;
  out.append(R"({"type":")").append(is_one ? "Polyhedron" : "MultiPolyhedron");
  out += R"(","coordinates":)";
  if (is_one) {
    append_polyhedron(out, shapes, shapes.solids.front());
  } else {
    append_array(out, shapes.solids,
                 [&](const auto& solid) { append_polyhedron(out, shapes, solid); });
  }
  out += '}';
}

/// Appends the minima, then the maxima, of all positions.
void append_bbox(std::string& out, const CityShapes& shapes) {
  std::array<double, 3> min = shapes.positions.front();
  std::array<double, 3> max = min;
  for (const auto& position : shapes.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], position[axis]);
      max[axis] = std::max(max[axis], position[axis]);
    }
  }
  CityShapes corners;
  corners.positions = {min, max};
  corners.decimals = shapes.decimals;
  std::string minima;
  append_position(minima, corners, 0);
  std::string maxima;
  append_position(maxima, corners, 1);
  minima.back() = ',';
  out.append(R"("bbox":)").append(minima).append(maxima, 1).append(",");
}

/// Appends the member "properties", the last one of a feature, and its end.
void append_properties(std::string& out, const CityFeature& feature,
                       const std::vector<std::pair<std::string, std::string>>& further) {
  out += R"(,"properties":{)";
  bool is_first = true;
  const auto append = [&](const auto& property) {
    if (!is_first) out += ',';
    is_first = false;
    append_json_string(out, property.first);
    out.append(":").append(property.second);
  };
  for (const auto& property : feature.attributes) {
    const bool is_hidden = std::any_of(further.begin(), further.end(), [&](const auto& other) {
      return other.first == property.first;
    });
    if (!is_hidden) append(property);
  }
  for (const auto& property : further) append(property);
  out += "}}";
}

}  // namespace

std::string geo_json_feature(std::string_view id, const CityFeature& feature,
                             const std::vector<std::pair<std::string, std::string>>& further) {
  std::string out = R"({"type":"Feature","id":)";
  append_json_string(out, id);
  out += ',';
  if (!feature.shapes.positions.empty()) append_bbox(out, feature.shapes);
  out += R"("geometry":)";
  append_geometry(out, feature.shapes);
  append_properties(out, feature, further);
  return out;
}

std::string json_fg_feature(std::string_view id, std::string_view type, const CityFeature& feature,
                            const std::vector<std::pair<std::string, std::string>>& further) {
  std::string out = R"({"type":"Feature","id":)";
  append_json_string(out, id);
  out += R"(,"featureType":)";
  append_json_string(out, type);
  out += R"(,"time":null,"geometry":null,"place":)";
  append_place(out, feature.shapes);
  append_properties(out, feature, further);
  return out;
}

}  // namespace watertight::formats
