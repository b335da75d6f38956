// SPDX-License-Identifier: GPL-3.0-or-later
//
// Divides the text of a city model by geometries: some go to a text of their own, the rest stays.
#include <utility>

#include "formats/city_json/city_json.h"
#include "formats/city_json/model.h"
#include "formats/text/json.h"

namespace watertight::formats {
namespace {

/// Numbers the vertices that are used in order of their first use.
class UsedVertices {
 public:
  explicit UsedVertices(Json& root) : list_(find_member(root, "vertices")) {
    if (list_ != nullptr && list_->is_array()) number_of_.assign(list_->size(), kNone);
  }
  /// Replaces an index by its new number. One that is out of range stays: the new list is not
  /// longer.
  void renumber(Json& index) {
    if (!index.is_number_unsigned()) return;
    const auto vertex = index.get<std::uint64_t>();
    if (vertex >= number_of_.size()) return;
    if (number_of_[vertex] == kNone) {
      number_of_[vertex] = static_cast<Index>(used_.size());
      used_.push_back(vertex);
    }
    index = number_of_[vertex];
  }
  /// Replaces the list of vertices by the used ones.
  void finish() {
    if (list_ == nullptr || !list_->is_array()) return;
    Json used = Json::array();
    for (const std::uint64_t vertex : used_) used.push_back(std::move((*list_)[vertex]));
    *list_ = std::move(used);
  }

 private:
  Json* list_;
  std::vector<Index> number_of_;
  std::vector<std::uint64_t> used_;
};

/// Renumbers nested arrays of vertex indices; the reader's limit bounds the depth.
void renumber_all(Json& boundaries, UsedVertices& used) {
  if (!boundaries.is_array()) return used.renumber(boundaries);
  for (Json& element : boundaries) renumber_all(element, used);
}

void keep_used_vertices(Json& root) {
  UsedVertices used(root);
  Json* objects = find_member(root, "CityObjects");
  for (auto& [id, object] : objects->get_ref<Json::object_t&>()) {
    Json* geometries = find_member(object, "geometry");
    if (geometries != nullptr && geometries->is_array()) {
      for (Json& geometry : *geometries) {
        Json* boundaries = find_member(geometry, "boundaries");
        if (boundaries != nullptr) renumber_all(*boundaries, used);
      }
    }
    const auto renumber = [&used](Json& vertex) -> Status {
      used.renumber(vertex);
      return Done{};
    };
    static_cast<void>(for_each_address_vertex(object, renumber));
  }
  used.finish();
}

/// Leaves those geometries of an object for which `is_kept` is true. Returns how many are left.
template <class IsKept>
std::size_t keep_geometries(const std::string& id, Json& object, IsKept is_kept) {
  Json* geometries = find_member(object, "geometry");
  if (geometries == nullptr || !geometries->is_array()) return 0;
  Json left = Json::array();
  std::uint32_t number = 0;
  for (Json& geometry : *geometries) {
    if (is_kept(GeometryPlace{id, number++})) left.push_back(std::move(geometry));
  }
  *geometries = std::move(left);
  return geometries->size();
}

/// Leaves the objects that have geometries and those that they are parts of.
void keep_objects_with_geometries(Json& objects) {
  std::set<std::string> wanted;
  std::vector<std::string> open;
  for (const auto& [id, object] : objects.get_ref<Json::object_t&>()) {
    const Json* geometries = find_member(object, "geometry");
    if (geometries != nullptr && !geometries->empty()) open.push_back(id);
  }
  while (!open.empty()) {
    const std::string id = std::move(open.back());
    open.pop_back();
    const Json* object = find_member(std::as_const(objects), id);
    if (object == nullptr || !wanted.insert(id).second) continue;
    const Json* parents = find_member(*object, "parents");
    if (parents == nullptr || !parents->is_array()) continue;
    for (const Json& parent : *parents) {
      if (parent.is_string()) open.push_back(parent.get<std::string>());
    }
  }
  Json left = Json::object();
  for (auto& [id, object] : objects.get_ref<Json::object_t&>()) {
    if (!wanted.contains(id)) continue;
    Json* children = find_member(object, "children");
    if (children != nullptr && children->is_array()) {
      Json own = Json::array();
      for (Json& child : *children) {
        if (child.is_string() && wanted.contains(child.get<std::string>())) own.push_back(child);
      }
      *children = std::move(own);
    }
    append_member(left, id, std::move(object));
  }
  objects = std::move(left);
}

}  // namespace

Result<DividedText> divide_city_model(std::string_view text, const std::set<GeometryPlace>& chosen,
                                      const Limits& limits) {
  auto root = parse_json(text, limits);
  if (!root) return std::move(root).error();
  Json part = *root;
  DividedText divided;
  Json* objects = find_member(*root, "CityObjects");
  if (objects == nullptr || !objects->is_object()) {
    return Error{ErrorCode::malformed, "there are no city objects", {}, "/CityObjects"};
  }
  for (auto& [id, object] : objects->get_ref<Json::object_t&>()) {
    divided.geometries_left += keep_geometries(
        id, object, [&](const GeometryPlace& place) { return !chosen.contains(place); });
  }
  Json& other = *find_member(part, "CityObjects");
  for (auto& [id, object] : other.get_ref<Json::object_t&>()) {
    keep_geometries(id, object, [&](const GeometryPlace& place) { return chosen.contains(place); });
  }
  keep_objects_with_geometries(other);
  for (Json* half : {&*root, &part}) keep_used_vertices(*half);
  divided.rest = json_text(*root);
  divided.chosen = json_text(part);
  return divided;
}

}  // namespace watertight::formats
