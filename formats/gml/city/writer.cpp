// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/writer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "formats/gml/city/names.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

constexpr double kMostSteps = 9007199254740992;  // 2^53, the most steps that readers tell apart

// The integer nearest to number / 10^exponent; nothing when 64 bits do not hold it.
std::optional<std::int64_t> integer_at(const GridNumber& number, std::int32_t exponent) {
  std::int64_t value = number.mantissa;
  for (std::int32_t i = number.exponent; i > exponent && value != 0; --i) {
    if (__builtin_mul_overflow(value, std::int64_t{10}, &value)) return std::nullopt;
  }
  std::int64_t dropped = 0;  // the digit after the last
  for (std::int32_t i = number.exponent; i < exponent && (value != 0 || dropped != 0); ++i) {
    dropped = value % 10;
    value /= 10;
  }
  return dropped >= 5 ? value + 1 : dropped <= -5 ? value - 1 : value;
}

// Appends a member whose value is JSON text already.
void append_text_member(std::string& out, std::string_view key, std::string_view value) {
  if (out.back() != '{') out += ',';
  append_json_string(out, key);
  out.append(":").append(value);
}

}  // namespace

std::size_t CityWriter::PositionHash::operator()(const Position& position) const {
  std::uint64_t hash = 0;
  for (const GridNumber& number : position) {
    hash = (hash ^ static_cast<std::uint64_t>(number.mantissa)) * 0x9E3779B97F4A7C15ULL;
    hash ^= (hash >> 29) + static_cast<std::uint64_t>(number.exponent);
  }
  return hash;
}

CityWriter::CityWriter(const GmlTree& tree, TreeMarks& marks, GmlObjects& objects,
                       const GeometryReader& geometry, GmlAppearance& appearance)
    : tree_(tree),
      marks_(marks),
      found_(objects),
      geometry_(geometry),
      appearance_(appearance),
      values_(tree, marks) {}

Status CityWriter::prepare(std::uint64_t most_surface_bytes) {
  const auto srid = geometry_.srid();
  if (!srid) return srid.error();
  srid_ = *srid;
  most_surface_bytes_ = most_surface_bytes;
  find_surfaces_of_facets();
  for (GmlCityObject& object : found_.objects) {
    if (!objects_text_.empty()) objects_text_ += ',';
    append_json_string(objects_text_, object.id);
    objects_text_ += ':';
    append_object(objects_text_, object);
    if (surface_bytes_ > most_surface_bytes_) {
      return Error{ErrorCode::limit_exceeded,
                   "geometries share thematic surfaces so often that their texts would be longer "
                   "than a document of this size"};
    }
  }
  for (Index surface = 0; surface < found_.surfaces.size(); ++surface) {
    if (!surface_texts_.contains(surface)) marks_.lose(found_.surfaces[surface].element);
  }
  const Json appearance = appearance_.take();
  if (!appearance.is_null()) appearance_text_ = json_text(appearance);
  return Done{};
}

Result<std::string> CityWriter::text(GridChoice choice) const {
  const Exponents steps = exponents(choice);
  auto vertices = vertices_text(steps);
  if (!vertices) return vertices;
  std::string out = header_text(steps);
  if (!appearance_text_.empty()) append_text_member(out, "appearance", appearance_text_);
  out.append(",\"CityObjects\":{").append(objects_text_).append("},\"vertices\":[");
  return out.append(*vertices).append("]}");
}

void CityWriter::find_surfaces_of_facets() {
  for (Index surface = 0; surface < found_.surfaces.size(); ++surface) {
    for (const CityGeometry& geometry : found_.surfaces[surface].geometries) {
      for (const CityFacet& facet : geometry.facets) surface_of_.emplace(facet.polygon, surface);
    }
  }
}

void CityWriter::append_object(std::string& out, GmlCityObject& object) {
  out += "{\"type\":";
  append_json_string(out, object.type);
  if (!object.extent.is_null()) {
    append_text_member(out, "geographicalExtent", json_text(object.extent));
  }
  if (!object.attributes.is_empty()) {
    append_text_member(out, "attributes", json_text(object.attributes.take()));
  }
  append_addresses(out, object);
  append_ids(out, "parents", object.parents);
  append_ids(out, "children", object.children);
  const auto is_stated = [](const std::string& role) { return !role.empty(); };
  if (std::any_of(object.roles.begin(), object.roles.end(), is_stated) &&
      object.roles.size() == object.children.size()) {
    append_text_member(out, "children_roles", json_text(Json(object.roles)));
  }
  std::string geometries;
  const auto append = [&](const CityGeometry& geometry, std::string_view stated_surface) {
    if (surface_bytes_ > most_surface_bytes_) return;  // prepare() refuses the document
    if (!geometries.empty()) geometries += ',';
    append_geometry(geometries, geometry, stated_surface);
  };
  for (std::size_t i = 0; i < object.geometries.size(); ++i) {
    append(object.geometries[i], object.stated_surface[i]);
  }
  for (const CityGeometry& geometry : geometries_of_surfaces(object)) append(geometry, {});
  if (!geometries.empty()) append_text_member(out, "geometry", "[" + geometries + "]");
  out += '}';
}

void CityWriter::append_ids(std::string& out, std::string_view member,
                            const std::vector<Index>& objects) {
  if (objects.empty()) return;
  std::string ids = "[";
  for (const Index object : objects) {
    if (ids.size() > 1) ids += ',';
    append_json_string(ids, found_.objects[object].id);
  }
  append_text_member(out, member, ids + "]");
}

void CityWriter::append_addresses(std::string& out, const GmlCityObject& object) {
  if (object.addresses.empty()) return;
  std::string addresses = "[";
  for (const GmlAddress& address : object.addresses) {
    if (addresses.size() > 1) addresses += ',';
    std::string text = json_text(address.members);
    if (!address.location.empty()) {
      text.pop_back();
      append_text_member(
          text, "location",
          R"({"type":"MultiPoint","lod":"0","boundaries":)" + line_text(address.location) + "}");
      text += '}';
    }
    addresses += text;
  }
  append_text_member(out, "address", addresses + "]");
}

// The facets of the object's surfaces that none of its own geometries of the same level of detail
// has: a MultiSurface for each level.
std::vector<CityGeometry> CityWriter::geometries_of_surfaces(const GmlCityObject& object) const {
  std::set<std::pair<std::string_view, Index>> own;
  for (const CityGeometry& geometry : object.geometries) {
    for (const CityFacet& facet : geometry.facets) own.emplace(geometry.lod, facet.polygon);
  }
  std::map<std::string, CityGeometry> by_lod;
  for (const Index surface : object.surfaces) {
    for (const CityGeometry& geometry : found_.surfaces[surface].geometries) {
      for (const CityFacet& facet : geometry.facets) {
        if (own.contains({geometry.lod, facet.polygon})) continue;
        CityGeometry& rest = by_lod[geometry.lod];
        rest.facets.push_back(facet);
      }
    }
  }
  std::vector<CityGeometry> geometries;
  for (auto& [lod, geometry] : by_lod) {
    geometry.type = "MultiSurface";
    geometry.lod = lod;
    geometries.push_back(std::move(geometry));
  }
  return geometries;
}

void CityWriter::append_geometry(std::string& out, const CityGeometry& geometry,
                                 std::string_view stated_surface) {
  out += "{\"type\":";
  append_json_string(out, geometry.type);
  out += ",\"lod\":";
  append_json_string(out, geometry.lod);
  out += ",\"boundaries\":";
  if (geometry.type == "MultiPoint") {
    out += line_text(geometry.lines.front());
  } else if (geometry.type == "MultiLineString") {
    out += '[';
    for (std::size_t i = 0; i < geometry.lines.size(); ++i) {
      if (i > 0) out += ',';
      out += line_text(geometry.lines[i]);
    }
    out += ']';
  } else {
    append_by_facet(out, geometry, [&](const CityFacet& facet) { return facet_text(facet); });
    append_semantics(out, geometry, stated_surface);
    appearance_.append_members(out, geometry);
  }
  out += '}';
}

void CityWriter::append_semantics(std::string& out, const CityGeometry& geometry,
                                  std::string_view stated_surface) {
  std::map<Index, std::size_t> numbers;  // the surfaces of the facets, and those around them
  for (const CityFacet& facet : geometry.facets) {
    const auto found = surface_of_.find(facet.polygon);
    if (found == surface_of_.end()) continue;
    for (Index i = found->second; i != kNone; i = found_.surfaces[i].parent) numbers[i] = 0;
  }
  std::size_t count = 0;
  for (auto& [surface, number] : numbers) number = count++;
  std::map<Index, std::vector<std::size_t>> children;
  for (const auto& [surface, number] : numbers) {
    const Index parent = found_.surfaces[surface].parent;
    if (parent != kNone) children[parent].push_back(number);
  }
  std::string surfaces;
  for (const auto& [surface, number] : numbers) {
    if (!surfaces.empty()) surfaces += ',';
    const std::string members = surface_members(surface);
    surface_bytes_ += members.size();
    surfaces += members;
    const Index parent = found_.surfaces[surface].parent;
    if (parent != kNone) {
      surfaces.append(",\"parent\":").append(std::to_string(numbers[parent]));
    }
    if (const auto own = children.find(surface); own != children.end()) {
      surfaces.append(",\"children\":").append(json_text(Json(own->second)));
    }
    surfaces += '}';
  }
  if (!stated_surface.empty()) {
    if (!surfaces.empty()) surfaces += ',';
    surfaces.append("{\"type\":\"").append(stated_surface).append("\"}");
  }
  if (surfaces.empty()) return;
  out.append(",\"semantics\":{\"surfaces\":[").append(surfaces).append("],\"values\":");
  const std::string other = stated_surface.empty() ? "null" : std::to_string(count);
  append_by_facet(out, geometry, [&](const CityFacet& facet) {
    const auto found = surface_of_.find(facet.polygon);
    return found == surface_of_.end() ? other : std::to_string(numbers[found->second]);
  });
  out += '}';
}

// The members of a semantic surface, without the closing brace. Marks the surface.
std::string CityWriter::surface_members(Index number) {
  const auto found = surface_texts_.find(number);
  if (found != surface_texts_.end()) return found->second;
  const GmlSurface& surface = found_.surfaces[number];
  for (const Index element : surface.elements) marks_.mark(element);
  for (const Index attribute : surface.attributes_read) marks_.mark_attribute(attribute);
  ObjectBuilder members;
  members.add("type", surface.type, "");
  if (!tree_.id(surface.element).empty()) {
    members.add("id", std::string(tree_.id(surface.element)), "");
    marks_.mark_attribute(tree_.id_attribute(surface.element));
  }
  // "parent" and "children" mean other surfaces.
  for (const char* reserved : {"parent", "children"}) members.add(reserved, nullptr, "");
  std::vector<Index> plain;
  std::vector<Index> generics;
  for (const Index property : tree_.children(surface.element)) {
    const Index value = tree_[property].first_child;
    const bool is_surface = value != kNone && !semantic_surface_type(tree_.name(value)).empty();
    const std::string_view name = tree_.name(property);
    if (holds_geometry(tree_, property) || is_surface || name == "appearance" ||
        name == "boundedBy" || name.ends_with("ImplicitRepresentation")) {
      continue;
    }
    (is_generic_attribute(name) ? generics : plain).push_back(property);
  }
  values_.add_properties(plain, members);
  values_.add_generics(generics, members);
  Json json = members.take();
  json.erase("parent");
  json.erase("children");
  std::string text = json_text(json);
  text.pop_back();
  surface_texts_.emplace(number, text);
  return text;
}

std::string CityWriter::facet_text(const CityFacet& facet) {
  std::string text = "[";
  for (const CityRing& ring : facet.rings) {
    if (text.size() > 1) text += ',';
    text += line_text(ring.positions);
  }
  return text + ']';
}

std::string CityWriter::line_text(const std::vector<Index>& positions) {
  std::string text = "[";
  for (const Index position : positions) {
    if (text.size() > 1) text += ',';
    text += std::to_string(vertex_of(position));
  }
  return text + ']';
}

// Equal positions are one vertex; vertices have the order of their first use.
Index CityWriter::vertex_of(Index position) {
  const auto [place, is_new] = vertex_numbers_.emplace(geometry_.positions()[position],
                                                       static_cast<Index>(vertices_.size()));
  if (is_new) vertices_.push_back(position);
  return place->second;
}

CityWriter::Exponents CityWriter::exponents(GridChoice choice) const {
  Exponents finest{0, 0, 0};
  std::array<double, 3> least{};
  std::array<double, 3> most{};
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const GridNumber& number = geometry_.positions()[vertices_[i]][axis];
      finest[axis] = std::min(finest[axis], number.exponent);
      const double value = static_cast<double>(number.mantissa) * std::pow(10, number.exponent);
      least[axis] = i == 0 ? value : std::min(least[axis], value);
      most[axis] = i == 0 ? value : std::max(most[axis], value);
    }
  }
  if (choice == GridChoice::by_axis) return finest;
  if (choice == GridChoice::common) {
    const std::int32_t all = *std::min_element(finest.begin(), finest.end());
    return {all, all, all};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double size = std::max(std::abs(least[axis]), std::abs(most[axis])) / 512;
    const double span = std::max(most[axis] - least[axis], size);
    while (span / std::pow(10, finest[axis]) > kMostSteps) ++finest[axis];
  }
  return finest;
}

std::uint64_t CityWriter::count_rounded(GridChoice choice) const {
  const Exponents steps = exponents(choice);
  std::uint64_t count = 0;
  for (const Index position : vertices_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (geometry_.positions()[position][axis].exponent < steps[axis]) ++count;
    }
  }
  return count;
}

std::string CityWriter::header_text(const Exponents& exponents) const {
  std::string out = R"({"type":"CityJSON","version":"2.0","transform":{"scale":[)";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) out += ',';
    out += plain_text(GridNumber{1, exponents[axis]});
  }
  out += R"(],"translate":[0,0,0]})";
  Json metadata = found_.metadata;
  if (srid_ != 0) {
    append_member(
        metadata, "referenceSystem",
        std::string("https://www.opengis.net/def/crs/EPSG/0/").append(std::to_string(srid_)));
  }
  if (!metadata.empty()) append_text_member(out, "metadata", json_text(metadata));
  return out;
}

Result<std::string> CityWriter::vertices_text(const Exponents& exponents) const {
  std::string out;
  for (const Index position : vertices_) {
    if (!out.empty()) out += ',';
    out += '[';
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = integer_at(geometry_.positions()[position][axis], exponents[axis]);
      if (!value) {
        return Error{ErrorCode::unsupported,
                     "a city model needs one decimal grid for all coordinates: they have more "
                     "digits than 64 bits hold"};
      }
      if (axis > 0) out += ',';
      out += std::to_string(*value);
    }
    out += ']';
  }
  return out;
}

}  // namespace watertight::formats
