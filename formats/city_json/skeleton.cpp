// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "formats/city_json/model.h"

namespace watertight::formats {
namespace {

void append_geometry(std::string& out, const Json& geometry, const BoundaryPrinter& print) {
  if (!geometry.is_object()) return append_json(out, geometry);
  out += '{';
  bool is_first = true;
  for (const auto& [key, value] : geometry.get_ref<const Json::object_t&>()) {
    if (!is_first) out += ',';
    is_first = false;
    append_json_string(out, key);
    out += ':';
    if (key == "boundaries") {
      print(value, out);
    } else {
      append_json(out, value);
    }
  }
  out += '}';
}

void append_geometries(std::string& out, const Json& geometries, const BoundaryPrinter& print) {
  out += '[';
  bool is_first = true;
  for (const Json& geometry : geometries.get_ref<const Json::array_t&>()) {
    if (!is_first) out += ',';
    is_first = false;
    append_geometry(out, geometry, print);
  }
  out += ']';
}

}  // namespace

std::map<std::string, std::uint64_t> other_geometries(std::string_view skeleton) {
  std::map<std::string, std::uint64_t> counts;
  const auto model = parse_city_model(skeleton, CityText::skeleton, kOwnText);
  const Json* objects = model ? find_member(model->root, "CityObjects") : nullptr;
  if (objects == nullptr || !objects->is_object()) return counts;
  for (const auto& [id, object] : objects->get_ref<const Json::object_t&>()) {
    const Json* geometries = find_member(object, "geometry");
    if (geometries == nullptr || !geometries->is_array()) continue;
    for (const Json& geometry : geometries->get_ref<const Json::array_t&>()) {
      const Json* boundaries = find_member(geometry, "boundaries");
      if (boundaries != nullptr && boundaries->is_object()) continue;
      const std::string type = string_member(geometry, "type");
      ++counts[type.empty() ? "unknown" : type];
    }
  }
  return counts;
}

std::vector<std::string> object_ids(std::string_view skeleton) {
  std::vector<std::string> ids;
  const auto model = parse_city_model(skeleton, CityText::skeleton, kOwnText);
  const Json* objects = model ? find_member(model->root, "CityObjects") : nullptr;
  if (objects == nullptr || !objects->is_object()) return ids;
  for (const auto& [id, object] : objects->get_ref<const Json::object_t&>()) ids.push_back(id);
  return ids;
}

std::string solid_reference(std::string_view geometry_type, std::size_t first, std::size_t count) {
  const std::string number = std::to_string(first);
  if (geometry_type == "Solid") return std::string("{\"solid\":").append(number) + '}';
  if (geometry_type == "MultiSurface" || geometry_type == "CompositeSurface") {
    return std::string("{\"surface\":").append(number) + '}';
  }
  return std::string("{\"solids\":[").append(number) + ',' + std::to_string(count) + "]}";
}

void append_vertex_runs(std::string& out, std::span<const Index> vertices) {
  out += '[';
  for (std::size_t begin = 0; begin < vertices.size();) {
    std::size_t end = begin + 1;
    while (end < vertices.size() && vertices[end] == vertices[end - 1] + 1) ++end;
    if (begin > 0) out += ',';
    append_integer(out, vertices[begin]);
    out += ',';
    append_integer(out, end - begin);
    begin = end;
  }
  out += ']';
}

namespace {

std::string decimal_text(const GridNumber& number) {
  std::string text = std::to_string(number.mantissa);
  if (number.exponent == 0) return text;
  return text + 'e' + std::to_string(number.exponent);
}

}  // namespace

void append_city_object(std::string& out, const Json& object, const BoundaryPrinter& print) {
  if (!object.is_object()) return append_json(out, object);
  out += '{';
  bool is_first = true;
  for (const auto& [key, value] : object.get_ref<const Json::object_t&>()) {
    if (!is_first) out += ',';
    is_first = false;
    append_json_string(out, key);
    out += ':';
    if (key == "geometry" && value.is_array()) {
      append_geometries(out, value, print);
    } else {
      append_json(out, value);
    }
  }
  out += '}';
}

void append_city_objects(std::string& out, const Json& objects, const BoundaryPrinter& print) {
  out += '{';
  bool is_first = true;
  for (const auto& [id, object] : objects.get_ref<const Json::object_t&>()) {
    if (!is_first) out += ',';
    is_first = false;
    append_json_string(out, id);
    out += ':';
    append_city_object(out, object, print);
  }
  out += '}';
}

std::string skeleton_vertices(const CityModel& model, std::size_t count,
                              std::span<const std::vector<Index>> vertex_of,
                              std::span<const Index> others) {
  const VertexList& list = model.vertices;
  std::string out = "{\"count\":" + std::to_string(count) + ",\"kind\":\"";
  out += list.are_integers ? "integers" : "decimals";
  out += "\",\"solids\":[";
  for (std::size_t i = 0; i < vertex_of.size(); ++i) {
    if (i > 0) out += ',';
    append_vertex_runs(out, vertex_of[i]);
  }
  out += "],\"others\":[";
  bool is_first = true;
  for (const Index vertex : others) {
    if (const FaultyVertex* fault = list.fault_of(vertex); fault != nullptr) {
      if (!is_first) out += ',';
      is_first = false;
      out += '[' + json_text(fault->value) + ']';
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!is_first) out += ',';
      is_first = false;
      out += list.are_integers ? std::to_string(list.integers[vertex][axis])
                               : decimal_text(list.decimals[vertex][axis]);
    }
  }
  return out + "]}";
}

namespace {

/// The solids of a geometry of a skeleton.
struct SolidRange {
  std::size_t first = 0;
  std::size_t count = 0;    // 0: the geometry has none
  bool is_surface = false;  // one closed surface, whose lists have no level of shells
  bool is_single = false;   // lists have no level of solids
};

SolidRange solids_of(const Json& geometry) {
  SolidRange range;
  const Json* boundaries = find_member(geometry, "boundaries");
  if (boundaries == nullptr || !boundaries->is_object()) return range;
  const Json* surface = find_member(*boundaries, "surface");
  const Json* single = surface != nullptr ? surface : find_member(*boundaries, "solid");
  if (single != nullptr && single->is_number_unsigned()) {
    return {single->get<std::size_t>(), 1, surface != nullptr, true};
  }
  const Json* several = find_member(*boundaries, "solids");
  if (several == nullptr || !several->is_array() || several->size() != 2) return range;
  const Json& first = (*several)[0];
  const Json& count = (*several)[1];
  if (!first.is_number_unsigned() || !count.is_number_unsigned()) return range;
  return {first.get<std::size_t>(), count.get<std::size_t>(), false, false};
}

/// Calls visit(owner of "values", kind) for the semantics, materials and textures of a geometry.
template <class Visit>
void visit_owners(Json& geometry, const Visit& visit) {
  if (Json* semantics = find_member(geometry, "semantics"); semantics != nullptr) {
    visit(*semantics, FacetValues::semantics);
  }
  for (const FacetValues kind : {FacetValues::material, FacetValues::texture}) {
    Json* themes = find_member(geometry, kind == FacetValues::material ? "material" : "texture");
    if (themes == nullptr || !themes->is_object()) continue;
    for (auto& [name, theme] : themes->get_ref<Json::object_t&>()) visit(theme, kind);
  }
}

void turn(Json& geometry) {
  Json* boundaries = find_member(geometry, "boundaries");
  const Json* number = boundaries == nullptr ? nullptr : find_member(*boundaries, "surface");
  if (number == nullptr) return;
  Json reference = Json::object();
  append_member(reference, "solid", *number);
  *boundaries = std::move(reference);
  *find_member(geometry, "type") = "Solid";
  visit_owners(geometry, [](Json& owner, FacetValues) {
    Json* values = find_member(owner, "values");
    if (values != nullptr && values->is_array()) *values = Json::array({std::move(*values)});
  });
}

}  // namespace

void visit_facet_values(Json& geometry, const FacetValuesVisit& visit) {
  const SolidRange range = solids_of(geometry);
  if (range.count == 0) return;
  visit_owners(geometry, [&](Json& owner, FacetValues kind) {
    Json* values = find_member(owner, "values");
    if (values == nullptr) return;
    if (range.is_surface) {
      Json shells = Json::array({std::move(*values)});
      visit(range.first, shells, kind);
      *values = std::move(shells.front());
    } else if (range.is_single) {
      visit(range.first, *values, kind);
    } else if (values->is_array() && values->size() == range.count) {
      for (std::size_t i = 0; i < range.count; ++i) visit(range.first + i, (*values)[i], kind);
    }
  });
}

Result<std::uint64_t> turn_surfaces_into_solids(Document& document) {
  std::uint64_t turned = 0;
  for (Feature& feature : document.features) {
    bool has_surfaces = false;
    for (SubmittedSolid& solid : feature.solids) {
      if (!is_surface(solid.source)) continue;
      solid.source.geometry_type = "Solid";
      has_surfaces = true;
      ++turned;
    }
    if (!has_surfaces || feature.skeleton.empty()) continue;
    auto root = parse_json(feature.skeleton, kOwnText);
    if (!root) return std::move(root).error();
    Json* objects = find_member(*root, "CityObjects");
    if (objects == nullptr || !objects->is_object()) continue;
    for (auto& [id, object] : objects->get_ref<Json::object_t&>()) {
      Json* geometries = find_member(object, "geometry");
      if (geometries == nullptr || !geometries->is_array()) continue;
      for (Json& geometry : *geometries) turn(geometry);
    }
    feature.skeleton = json_text(*root);
    feature.layout = {};
  }
  return turned;
}

}  // namespace watertight::formats
