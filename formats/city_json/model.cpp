// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "formats/city_json/model.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

std::string geometry_pointer(std::string_view id, std::size_t geometry) {
  return "/CityObjects" + pointer_token(id) + "/geometry" + pointer_token(geometry);
}

Status read_axes(const Json& transform, std::string_view name, std::array<GridNumber, 3>& axes) {
  const std::string pointer = "/transform" + pointer_token(name);
  const Json* values = find_member(transform, name);
  if (values == nullptr || !values->is_array() || values->size() != 3) {
    return malformed_at("a transform needs three numbers for each of scale and translate", pointer);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Json& value = (*values)[axis];
    if (!is_number_value(value)) return malformed_at("not a number", pointer + pointer_token(axis));
    auto exact = exact_number(json_text(value));
    if (!exact) return malformed_at(exact.error().message, pointer + pointer_token(axis));
    axes[axis] = exact->value;
  }
  return Done{};
}

Result<geometry::Transform> read_transform(const Json& value) {
  geometry::Transform transform;
  if (auto status = read_axes(value, "scale", transform.scale); !status) return status.error();
  if (auto status = read_axes(value, "translate", transform.translate); !status) {
    return status.error();
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (transform.scale[axis].mantissa <= 0) {
      return malformed_at("the scale of a transform must be positive",
                          "/transform/scale" + pointer_token(axis));
    }
  }
  return transform;
}

bool is_known_version(std::string_view version) {
  for (const std::string_view known : {"1.0", "1.1", "2.0"}) {
    if (version == known) return true;
    if (version.starts_with(known) && version.size() > 3 && version[3] == '.') return true;
  }
  return false;
}

/// The JSON Pointer, within boundaries that were not captured, to the first value that is no vertex
/// index and no array. Recursive; the reader's limit bounds the depth.
std::optional<std::string> pointer_to_fault(const Json& boundaries) {
  if (!boundaries.is_array()) {
    const bool is_index =
        boundaries.is_number_unsigned() && boundaries.get<std::uint64_t>() < kMostVertices;
    return is_index ? std::nullopt : std::optional<std::string>("");
  }
  for (std::size_t i = 0; i < boundaries.size(); ++i) {
    const auto within = pointer_to_fault(boundaries[i]);
    if (within) return pointer_token(i) + *within;
  }
  return std::nullopt;
}

Error wrong_boundaries(const Json& boundaries, const std::string& pointer) {
  return malformed_at("boundaries are nested arrays of vertex indices",
                      pointer + "/boundaries" + pointer_to_fault(boundaries).value_or(""));
}

Status index_geometry(const Json& geometry, std::string_view id, GeometryRef ref,
                      std::uint64_t template_count, ModelIndex& index) {
  const std::string pointer = geometry_pointer(id, ref.geometry);
  if (!geometry.is_object()) return malformed_at("a geometry must be an object", pointer);
  const Json* type = find_member(geometry, "type");
  if (type == nullptr || !type->is_string())
    return malformed_at("the geometry has no type", pointer);
  ref.type = type->get<std::string>();
  ref.lod = level_of(geometry);
  const Json* boundaries = find_member(geometry, "boundaries");
  if (boundaries != nullptr && !boundaries->is_number_unsigned()) {
    return wrong_boundaries(*boundaries, pointer);
  }
  if (ref.type == "GeometryInstance") {
    auto instance = read_instance(geometry, pointer, template_count);
    if (!instance) return std::move(instance).error();
    instance->object = ref.object;
    instance->geometry = ref.geometry;
    index.instances.push_back(*std::move(instance));
  }
  if (boundaries == nullptr) {
    if (ref.is_of_solids()) return malformed_at("the geometry has no boundaries", pointer);
    return Done{};
  }
  ref.boundary = boundaries->get<std::size_t>();
  index.geometries.push_back(std::move(ref));
  return Done{};
}

void note_unreadable(ModelIndex& index, std::uint32_t object, const GeometryRef& ref, Error error) {
  UnreadablePart part;
  part.source.object_id = index.ids[object];
  part.source.geometry_type = ref.type;
  part.source.lod = ref.lod;
  part.source.geometry = ref.geometry;
  part.source.pointer = error.pointer;
  part.error = std::move(error);
  index.unreadable.push_back({object, std::move(part)});
}

Status index_object(const Json& object, std::uint32_t number, std::uint64_t template_count,
                    ModelIndex& index) {
  const std::string& id = index.ids[number];
  const std::string pointer = "/CityObjects" + pointer_token(id);
  if (!object.is_object()) return malformed_at("a city object must be an object", pointer);
  const Json* type = find_member(object, "type");
  if (type == nullptr || !type->is_string())
    return malformed_at("the city object has no type", pointer);
  const Json* geometries = find_member(object, "geometry");
  if (geometries == nullptr) return Done{};
  if (!geometries->is_array())
    return malformed_at("geometry must be an array", pointer + "/geometry");
  std::uint32_t position = 0;
  for (const Json& geometry : geometries->get_ref<const Json::array_t&>()) {
    GeometryRef ref{number, position++, 0, {}, {}};
    auto status = index_geometry(geometry, id, ref, template_count, index);
    if (status) continue;
    ref.type = string_member(geometry, "type");
    if (ref.type.empty()) ref.type = "unknown";
    note_unreadable(index, number, ref, std::move(status).error());
  }
  return Done{};
}

// The first of the object's parents that the document holds, or kNone.
Index parent_of(const Json& object, const std::unordered_map<std::string_view, Index>& by_id) {
  const Json* parents = find_member(object, "parents");
  if (parents == nullptr || !parents->is_array()) return kNone;
  for (const Json& parent : parents->get_ref<const Json::array_t&>()) {
    if (!parent.is_string()) continue;
    const auto found = by_id.find(parent.get_ref<const std::string&>());
    if (found != by_id.end()) return found->second;
  }
  return kNone;
}

// Refuses a child that the document does not hold: the child may have a solid, which would be
// missing without notice.
Status check_children(const Json& object, std::string_view id,
                      const std::unordered_map<std::string_view, Index>& by_id) {
  const Json* children = find_member(object, "children");
  if (children == nullptr) return Done{};
  const std::string pointer = "/CityObjects" + pointer_token(id) + "/children";
  if (!children->is_array()) return malformed_at("children must be an array", pointer);
  for (std::size_t i = 0; i < children->size(); ++i) {
    const Json& child = (*children)[i];
    if (!child.is_string() || !by_id.contains(child.get_ref<const std::string&>())) {
      return malformed_at("the child is not the id of a city object in CityObjects",
                          pointer + pointer_token(i));
    }
  }
  return Done{};
}

// Finds the top-level object of each object; follows each chain of parents once.
// A cycle ends at the object where it was found, which becomes a top-level object.
void find_roots(std::vector<Index>& parent, ModelIndex& index) {
  index.root_of.assign(parent.size(), kNone);
  std::vector<Index> chain;
  std::vector<bool> is_in_chain(parent.size(), false);
  for (Index start = 0; start < parent.size(); ++start) {
    Index at = start;
    chain.clear();
    while (index.root_of[at] == kNone && parent[at] != kNone) {
      if (is_in_chain[at]) {
        note_unreadable(index, at, {},
                        malformed_at("the city object is its own ancestor",
                                     "/CityObjects" + pointer_token(index.ids[at]) + "/parents"));
        parent[at] = kNone;
        break;
      }
      is_in_chain[at] = true;
      chain.push_back(at);
      at = parent[at];
    }
    if (index.root_of[at] == kNone) index.root_of[at] = at;
    for (const Index object : chain) {
      index.root_of[object] = index.root_of[at];
      is_in_chain[object] = false;
    }
  }
}

// The Building of each object: of a Building itself, of a BuildingPart the one that is reached
// through parents that are BuildingParts; kNone for others. Requires parents without cycles.
std::vector<std::uint32_t> buildings_of(const std::vector<Index>& parent,
                                        const Json::object_t& objects) {
  std::vector<std::string> types;
  for (const auto& [id, object] : objects) types.push_back(string_member(object, "type"));
  std::vector<std::uint32_t> building(parent.size(), kNone);
  for (Index start = 0; start < parent.size(); ++start) {
    Index at = start;
    std::size_t steps = 0;  // parts nested deeper than 16 levels get no Building
    while (at != kNone && types[at] == "BuildingPart" && ++steps <= 16) at = parent[at];
    if (at != kNone && types[at] == "Building") building[start] = at;
  }
  return building;
}

std::optional<std::int64_t> as_integer(const GridNumber& number) {
  std::int64_t value = number.mantissa;
  if (number.exponent < 0) return std::nullopt;
  for (std::int32_t i = 0; i < number.exponent; ++i) {
    if (__builtin_mul_overflow(value, std::int64_t{10}, &value)) return std::nullopt;
  }
  return value;
}

}  // namespace

Error malformed_at(std::string message, std::string pointer) {
  return Error{ErrorCode::malformed, std::move(message), {}, std::move(pointer)};
}

void require_integers(VertexList& list) {
  if (list.are_integers) return;
  std::vector<FaultyVertex> faulty;
  auto known = list.faulty.begin();
  list.integers.assign(list.decimals.size(), {});
  for (Index vertex = 0; vertex < list.decimals.size(); ++vertex) {
    if (known != list.faulty.end() && known->vertex == vertex) {
      faulty.push_back(std::move(*known++));
      continue;
    }
    std::array<std::int64_t, 3> integers{};
    std::size_t axis = 0;
    for (; axis < 3; ++axis) {
      const auto value = as_integer(list.decimals[vertex][axis]);
      if (!value) break;
      integers[axis] = *value;
    }
    if (axis == 3) {
      list.integers[vertex] = integers;
    } else {
      faulty.push_back({vertex, json_of(list.decimals[vertex]), pointer_token(axis),
                        "with a transform, coordinates must be integers of at most 64 bits"});
    }
  }
  list.faulty = std::move(faulty);
  list.decimals = {};
  list.are_integers = true;
}

Result<CityHeader> city_header(const Json& root) {
  CityHeader header;
  const Json* version = find_member(root, "version");
  if (version == nullptr || !version->is_string()) {
    return malformed_at("a CityJSON needs a version (\"1.0\", \"1.1\" or \"2.0\")", "/version");
  }
  header.version = version->get<std::string>();
  if (!is_known_version(header.version)) {
    return Error{
        ErrorCode::unsupported, "only CityJSON 1.0, 1.1 and 2.0 are known", {}, "/version"};
  }
  if (const Json* transform = find_member(root, "transform"); transform != nullptr) {
    auto exact = read_transform(*transform);
    if (!exact) return exact.error();
    header.transform = *exact;
  }
  if (const Json* metadata = find_member(root, "metadata"); metadata != nullptr) {
    header.srid = epsg_code(string_member(*metadata, "referenceSystem"));
  }
  if (const Json* section = find_member(root, "geometry-templates"); section != nullptr) {
    const Json* templates = find_member(*section, "templates");
    if (templates == nullptr || !templates->is_array()) {
      return malformed_at("templates is missing or not an array", "/geometry-templates/templates");
    }
    header.template_count = templates->size();
  }
  return header;
}

std::string level_of(const Json& geometry) {
  const Json* lod = find_member(geometry, "lod");
  if (lod == nullptr) return {};
  return lod->is_string() ? lod->get<std::string>() : json_text(*lod);
}

const Json* element_of(const Json* list, std::size_t number) {
  return list != nullptr && list->is_array() && number < list->size() ? &(*list)[number] : nullptr;
}

Result<std::string> feature_id(const Json& root) {
  if (string_member(root, "type") != "CityJSONFeature") {
    return malformed_at("the type is not \"CityJSONFeature\"", "/type");
  }
  std::string id = string_member(root, "id");
  if (id.empty()) return malformed_at("the CityJSONFeature has no id", "/id");
  return id;
}

Result<ModelIndex> index_city_model(const CityModel& model, std::uint64_t template_count) {
  const Json* objects = find_member(model.root, "CityObjects");
  if (objects == nullptr || !objects->is_object()) {
    return malformed_at("CityObjects is missing or not an object", "/CityObjects");
  }
  if (!model.vertices.is_present)
    return malformed_at("vertices is missing or not an array", "/vertices");

  ModelIndex index;
  const auto& members = objects->get_ref<const Json::object_t&>();
  index.ids.reserve(members.size());
  std::unordered_map<std::string_view, Index> by_id;
  for (const auto& [id, object] : members) {
    by_id.emplace(id, static_cast<Index>(index.ids.size()));
    index.ids.push_back(id);
  }
  std::vector<Index> parent;
  std::uint32_t number = 0;
  for (const auto& [id, object] : members) {
    if (auto status = index_object(object, number, template_count, index); !status) {
      note_unreadable(index, number, {}, std::move(status).error());
    }
    if (auto status = check_children(object, id, by_id); !status) {
      note_unreadable(index, number, {}, std::move(status).error());
    }
    parent.push_back(parent_of(object, by_id));
    ++number;
  }
  find_roots(parent, index);
  index.building_of = buildings_of(parent, members);
  return index;
}

}  // namespace watertight::formats
