// SPDX-License-Identifier: GPL-3.0-or-later
//
// Other solids in the place of those of a feature: lists of semantics, materials and textures
// follow the facets.
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "formats/city_json/model.h"

namespace watertight::formats {
namespace {

constexpr std::string_view kNewSurface = "ClosureSurface";

bool are_rings_equal(const Solid& one, Index facet, const Solid& other, Index other_facet) {
  const IndexRange rings = one.rings_of(facet);
  const IndexRange others = other.rings_of(other_facet);
  if (rings.size() != others.size()) return false;
  for (Index i = 0; i < rings.size(); ++i) {
    if (!std::ranges::equal(one.ring(rings.begin + i), other.ring(others.begin + i))) return false;
  }
  return true;
}

/// Lists by facet for the facets of a solid that replaces another one.
class FacetLists {
 public:
  FacetLists(const Solid& before, const SolidEdit& edit) : before_(before), edit_(edit) {}

  /// The list by shell and facet; `fresh` is the value of new facets. A list of another shape stays
  /// as it is.
  Json edited(const Json& values, const Json& fresh, bool has_rings) const {
    if (!values.is_array() || values.size() != before_.shell_count()) return values;
    Json out = Json::array();
    for (Index shell = 0; shell < edit_.solid.shell_count(); ++shell) {
      const IndexRange facets = edit_.solid.facets_of(shell);
      Json list = Json::array();
      bool is_listed = false;
      for (Index facet = facets.begin; facet < facets.end; ++facet) {
        const Json* value = value_of(values, edit_.facet_source[facet]);
        is_listed = is_listed || value != nullptr;
        if (value == nullptr) {
          list.push_back(has_rings ? untextured(facet) : fresh);
        } else if (has_rings &&
                   !are_rings_equal(edit_.solid, facet, before_, edit_.facet_source[facet])) {
          list.push_back(untextured(facet));
        } else {
          list.push_back(*value);
        }
      }
      if (is_listed) {
        out.push_back(std::move(list));
      } else {
        out.push_back(nullptr);
      }
    }
    return out;
  }

  bool has_new_facets() const {
    return std::ranges::find(edit_.facet_source, kNone) != edit_.facet_source.end();
  }

 private:
  /// The value of a facet of the solid before; null where there is none.
  const Json* value_of(const Json& values, Index facet) const {
    if (facet == kNone) return nullptr;
    const Index shell = before_.shell_of(facet);
    const IndexRange facets = before_.facets_of(shell);
    const Json& list = values[shell];
    if (!list.is_array() || list.size() != facets.size()) return nullptr;
    return &list[facet - facets.begin];
  }
  Json untextured(Index facet) const {
    Json rings = Json::array();
    for (Index i = 0; i < edit_.solid.rings_of(facet).size(); ++i) {
      rings.push_back(Json::array({nullptr}));
    }
    return rings;
  }

  const Solid& before_;
  const SolidEdit& edit_;
};

/// The number of the semantic surface of new facets, which is added where it is missing; null
/// without semantics.
Json new_surface(Json& geometry) {
  Json* semantics = find_member(geometry, "semantics");
  Json* surfaces = semantics == nullptr ? nullptr : find_member(*semantics, "surfaces");
  if (surfaces == nullptr || !surfaces->is_array()) return nullptr;
  for (std::size_t i = 0; i < surfaces->size(); ++i) {
    const Json& surface = (*surfaces)[i];
    if (surface.size() == 1 && string_member(surface, "type") == kNewSurface) return i;
  }
  Json surface = Json::object();
  append_member(surface, "type", kNewSurface);
  surfaces->push_back(std::move(surface));
  return surfaces->size() - 1;
}

void edit_values(Json& geometry, const Feature& feature, std::span<const SolidEdit> edits) {
  visit_facet_values(geometry, [&](std::size_t number, Json& values, FacetValues kind) {
    const auto edit = std::ranges::find(edits, number, &SolidEdit::number);
    if (edit == edits.end()) return;
    const FacetLists lists(feature.solids[number].solid, *edit);
    const bool needs_surface = kind == FacetValues::semantics && lists.has_new_facets();
    const Json fresh = needs_surface ? new_surface(geometry) : Json(nullptr);
    values = lists.edited(values, fresh, kind == FacetValues::texture);
  });
}

/// Lists the vertices that edits add after those that are there.
Status add_vertices(Json& root, const Feature& feature, std::span<const SolidEdit> edits) {
  Json* vertices = find_member(root, "vertices");
  Json* count = vertices == nullptr ? nullptr : find_member(*vertices, "count");
  Json* solids = vertices == nullptr ? nullptr : find_member(*vertices, "solids");
  for (const SolidEdit& edit : edits) {
    const Index before = feature.solids[edit.number].solid.vertex_count();
    const Index added = edit.solid.vertex_count() - before;
    if (added == 0) continue;
    const bool fits = count != nullptr && count->is_number_unsigned() && solids != nullptr &&
                      solids->is_array() && edit.number < solids->size() &&
                      (*solids)[edit.number].is_array();
    if (!fits) return Error{ErrorCode::malformed, "the skeleton has no vertices"};
    const auto first = count->get<std::uint64_t>();
    (*solids)[edit.number].push_back(first);
    (*solids)[edit.number].push_back(added);
    *count = first + added;
  }
  return Done{};
}

}  // namespace

Status replace_solids(Feature& feature, std::vector<SolidEdit> edits) {
  if (!feature.skeleton.empty() && feature.skeleton.starts_with('{')) {
    auto root = parse_json(feature.skeleton, kOwnText);
    if (!root) return std::move(root).error();
    Json* objects = find_member(*root, "CityObjects");
    if (objects != nullptr && objects->is_object()) {
      for (auto& [id, object] : objects->get_ref<Json::object_t&>()) {
        Json* geometries = find_member(object, "geometry");
        if (geometries == nullptr || !geometries->is_array()) continue;
        for (Json& geometry : *geometries) edit_values(geometry, feature, edits);
      }
    }
    if (Status added = add_vertices(*root, feature, edits); !added) return added;
    feature.skeleton = json_text(*root);
  }
  feature.layout = {};
  for (SolidEdit& edit : edits) {
    SubmittedSolid& submitted = feature.solids[edit.number];
    submitted = SubmittedSolid{std::move(edit.solid), std::move(submitted.source), {}};
  }
  return Done{};
}

}  // namespace watertight::formats
