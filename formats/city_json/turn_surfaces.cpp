// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces that were read as solids become geometries of type Solid.
#include <utility>

#include "formats/city_json/city_json.h"
#include "formats/text/json.h"

namespace watertight::formats {
namespace {

/// Puts the values of facets into a list of one shell.
void add_shell(Json* owner) {
  Json* values = owner == nullptr ? nullptr : find_member(*owner, "values");
  if (values != nullptr && values->is_array()) *values = Json::array({std::move(*values)});
}

void turn(Json& geometry) {
  Json* boundaries = find_member(geometry, "boundaries");
  const Json* number = boundaries == nullptr ? nullptr : find_member(*boundaries, "surface");
  if (number == nullptr) return;
  Json reference = Json::object();
  append_member(reference, "solid", *number);
  *boundaries = std::move(reference);
  *find_member(geometry, "type") = "Solid";
  add_shell(find_member(geometry, "semantics"));
  for (const char* appearance : {"material", "texture"}) {
    Json* themes = find_member(geometry, appearance);
    if (themes == nullptr || !themes->is_object()) continue;
    for (auto& [name, theme] : themes->get_ref<Json::object_t&>()) add_shell(&theme);
  }
}

}  // namespace

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
    auto root = parse_json(feature.skeleton, Limits{.bytes = ~0ULL, .nesting = 256});
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
