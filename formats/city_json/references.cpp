// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds references of materials, textures and addresses that refer to nothing.
#include <utility>

#include "formats/city_json/appearance.h"
#include "formats/city_json/model.h"

namespace watertight::formats {
namespace {

constexpr std::size_t kMostNotes = 100;

/// Notes up to kMostNotes faults, and the number of the others.
class Notes {
 public:
  explicit Notes(std::vector<std::string>& notes) : notes_(notes) {}
  void add(const Error& error, const std::string& pointer) {
    if (count_++ < kMostNotes) notes_.push_back(error.message + " at " + pointer);
  }
  void finish() {
    if (count_ <= kMostNotes) return;
    notes_.push_back(std::to_string(count_ - kMostNotes) + " more indices out of range");
  }

 private:
  std::vector<std::string>& notes_;
  std::size_t count_ = 0;
};

/// The members of a geometry that refer to the appearance, null without any.
Json appearance_of(const Json& geometry) {
  Json copy = Json::object();
  for (const char* name : {"material", "texture"}) {
    const Json* member = find_member(geometry, name);
    if (member != nullptr) append_member(copy, name, *member);
  }
  return copy.empty() ? Json(nullptr) : copy;
}

}  // namespace

void note_dangling_references(const CityModel& model, ModelIndex& index) {
  const Json* source = find_member(model.root, "appearance");
  const Json* objects = find_member(model.root, "CityObjects");
  Notes notes(index.notes);
  AppearanceCollector collector;
  for (const auto& [id, object] : objects->get_ref<const Json::object_t&>()) {
    const std::string pointer = "/CityObjects" + pointer_token(id);
    const Json* geometries = find_member(object, "geometry");
    if (geometries != nullptr && geometries->is_array()) {
      for (std::size_t i = 0; i < geometries->size(); ++i) {
        Json references = appearance_of((*geometries)[i]);
        if (references.is_null()) continue;
        const Status adopted = collector.adopt(references, source);
        if (!adopted) notes.add(adopted.error(), pointer + "/geometry" + pointer_token(i));
      }
    }
    if (find_member(object, "address") == nullptr) continue;
    Json copy = object;
    const auto check = [&](Json& vertex) -> Status {
      const bool exists =
          vertex.is_number_unsigned() && vertex.get<std::uint64_t>() < model.vertices.size();
      if (exists) return Done{};
      return Error{ErrorCode::malformed, "vertex index is out of range"};
    };
    const Status checked = for_each_address_vertex(copy, check);
    if (!checked) notes.add(checked.error(), pointer + "/address");
  }
  notes.finish();
}

}  // namespace watertight::formats
