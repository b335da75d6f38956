// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/city_json/appearance.h"

#include <optional>
#include <utility>

namespace watertight::formats {
namespace {

const Json* list_of(const Json* appearance, std::string_view name) {
  if (appearance == nullptr) return nullptr;
  const Json* list = find_member(*appearance, name);
  return list != nullptr && list->is_array() ? list : nullptr;
}

// Turns indices into a list into indices into `values`. Looks each value up once.
class Renumbering {
 public:
  Renumbering(const Json* list, DistinctValues& values, std::string_view what,
              std::optional<Error>& fault)
      : list_(list), values_(values), what_(what), fault_(fault) {}

  void apply(Json& index) {
    if (index.is_null()) return;
    if (!index.is_number_unsigned() || list_ == nullptr ||
        index.get<std::uint64_t>() >= list_->size()) {
      if (!fault_) {
        fault_ = Error{ErrorCode::malformed,
                       "the index of a " + std::string(what_) + " is out of range"};
      }
      index = kDangling;
      return;
    }
    const auto [place, is_new] = position_.try_emplace(index.get<std::size_t>());
    if (is_new) place->second = values_.position_of((*list_)[place->first]);
    index = place->second;
  }

 private:
  const Json* list_;
  DistinctValues& values_;
  std::string_view what_;
  std::optional<Error>& fault_;
  std::unordered_map<std::size_t, std::size_t> position_;  // index in values_, by index in the list
};

bool is_flat(const Json& array) {
  for (const Json& element : array) {
    if (element.is_array()) return false;
  }
  return true;
}

// Calls `visit` with each array that holds no arrays. A stack of the arrays still to open replaces
// recursion.
template <class Visit>
void for_each_flat_array(Json& nested, Visit visit) {
  std::vector<Json*> open{&nested};
  while (!open.empty()) {
    Json& array = *open.back();
    open.pop_back();
    if (!array.is_array()) continue;
    if (is_flat(array)) {
      visit(array);
      continue;
    }
    for (std::size_t i = array.size(); i > 0; --i) open.push_back(&array[i - 1]);
  }
}

}  // namespace

std::size_t DistinctValues::position_of(const Json& value) {
  const auto [found, is_new] = position_.emplace(json_text(value), values_.size());
  if (is_new) values_.push_back(value);
  return found->second;
}

void AppearanceCollector::include(const Json* appearance) {
  const auto include_list = [&](std::string_view name, DistinctValues& values) {
    const Json* list = list_of(appearance, name);
    if (list == nullptr) return;
    for (const Json& value : *list) values.position_of(value);
  };
  include_list("materials", materials_);
  include_list("textures", textures_);
  include_list("vertices-texture", texture_vertices_);
}

Status AppearanceCollector::adopt(Json& geometry, const Json* source) {
  std::optional<Error> fault;
  Renumbering materials(list_of(source, "materials"), materials_, "material", fault);
  Renumbering textures(list_of(source, "textures"), textures_, "texture", fault);
  Renumbering texture_vertices(list_of(source, "vertices-texture"), texture_vertices_,
                               "texture vertex", fault);
  const auto each_material = [&](Json& array) {
    for (Json& index : array) materials.apply(index);
  };
  // The array of a ring has the index of a texture, then the index of a texture vertex for each
  // vertex; [null] means no texture.
  const auto each_texture_ring = [&](Json& array) {
    for (std::size_t i = 0; i < array.size(); ++i) {
      i == 0 ? textures.apply(array[i]) : texture_vertices.apply(array[i]);
    }
  };
  if (Json* themes = find_member(geometry, "material"); themes != nullptr && themes->is_object()) {
    for (auto& [name, theme] : themes->get_ref<Json::object_t&>()) {
      if (Json* value = find_member(theme, "value"); value != nullptr) materials.apply(*value);
      if (Json* values = find_member(theme, "values"); values != nullptr) {
        for_each_flat_array(*values, each_material);
      }
    }
  }
  if (Json* themes = find_member(geometry, "texture"); themes != nullptr && themes->is_object()) {
    for (auto& [name, theme] : themes->get_ref<Json::object_t&>()) {
      Json* values = find_member(theme, "values");
      if (values != nullptr) for_each_flat_array(*values, each_texture_ring);
    }
  }
  if (fault) return *std::move(fault);
  return Done{};
}

Json AppearanceCollector::take(const Json* themes) {
  Json appearance = Json::object();
  if (themes != nullptr && themes->is_object()) {
    for (const auto& [key, value] : themes->get_ref<const Json::object_t&>()) {
      if (key == "materials" || key == "textures" || key == "vertices-texture") continue;
      append_member(appearance, key, value);
    }
  }
  if (!materials_.is_empty()) append_member(appearance, "materials", materials_.take());
  if (!textures_.is_empty()) append_member(appearance, "textures", textures_.take());
  if (!texture_vertices_.is_empty()) {
    append_member(appearance, "vertices-texture", texture_vertices_.take());
  }
  return appearance.empty() ? Json(nullptr) : appearance;
}

}  // namespace watertight::formats
