// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/objects.h"

#include <algorithm>
#include <utility>

#include "base/quantity.h"
#include "formats/gml/city/names.h"
#include "formats/gml/elements.h"

namespace watertight::formats {
namespace {

// Geometry with a meaning that CityJSON cannot state.
bool is_beyond_city_json(std::string_view property) {
  return property.ends_with("TerrainIntersection") ||
         property.ends_with("TerrainIntersectionCurve");
}

bool is_group_property(std::string_view name) { return name == "groupMember"; }

}  // namespace

bool holds_geometry(const GmlTree& tree, Index property) {
  const Index value = tree[property].first_child;
  const std::string_view name = tree.name(property);
  if (value == kNone) {
    const bool is_named = is_geometry_property(name) || lod_of(name) != '\0';
    return is_named && !tree.href(property).empty() && !name.ends_with("ImplicitRepresentation");
  }
  if (tree.name(value) == "Geometry3D" || tree.name(value) == "Geometry2D") return true;
  return tree.is_gml(value) && geometry_kind(tree.name(value)).has_value();
}

bool ObjectReader::has_geometry(Index element) const {
  for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
    if (holds_geometry(tree_, i)) return true;
  }
  return false;
}

// Whether an element becomes a city object: one of CityGML, or another that owns geometry.
bool ObjectReader::is_object_here(Index element) const {
  const std::string_view name = tree_.name(element);
  if (tree_.is_gml(element) || !is_object_name(name)) return false;
  if (!city_object_type(name).empty() || name == "ReliefFeature") return true;
  return semantic_surface_type(name).empty() && name != "ImplicitGeometry" && name != "Address" &&
         has_geometry(element);
}

Result<GmlObjects> ObjectReader::read() {
  if (tree_.elements().empty()) return std::move(found_);
  if (auto status = read_root(); !status) return std::move(status).error();
  follow_references();
  note_made_up();
  return std::move(found_);
}

Status ObjectReader::read_root() {
  if (is_object_here(0) || tree_.is_gml(0)) return walk(0, kNone);
  for (const Index property : tree_.children(0)) {
    const std::string_view name = tree_.name(property);
    if (tree_.is_gml(property) && name == "boundedBy") {
      Json extent;
      if (read_extent(property, extent)) {
        append_member(found_.metadata, "geographicalExtent", std::move(extent));
      }
    } else if (tree_.is_gml(property) && name == "name" &&
               find_member(found_.metadata, "title") == nullptr) {
      marks_.mark(property);
      marks_.mark_text(property);
      append_member(found_.metadata, "title", std::string(tree_.text(property)));
    } else if (name == "appearanceMember") {
      for (const Index appearance : tree_.children(property)) {
        found_.appearances.push_back(appearance);
      }
    } else if (auto status = walk(property, kNone); !status) {
      return status;
    }
  }
  return Done{};
}

// Reads the objects at and below an element; `parent` is the object that holds it.
Status ObjectReader::walk(Index element, Index parent) {
  if (tree_.name(element) == "ImplicitGeometry") return Done{};
  if (tree_.is_gml(element) && geometry_kind(tree_.name(element))) return read_alone(element);
  if (!is_object_here(element)) {
    for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
      if (auto status = walk(i, parent); !status) return status;
    }
    return Done{};
  }
  const std::string_view name = tree_.name(element);
  Status status = Done{};
  if (name == "ReliefFeature") {
    status = read_relief(element);
  } else if (city_object_type(name).empty()) {
    ++generic_names_[std::string(name)];
    status = read_object(element, kNone, "GenericCityObject");
  } else {
    const std::string_view type = city_object_type(name);
    status = read_object(element, needs_parent(type) ? parent : kNone, type);
  }
  if (status && parent == kNone) geometry_.end_feature();
  return status;
}

// Writes solids outside of any object as a GenericCityObject.
Status ObjectReader::read_alone(Index element) {
  const GmlKind kind = *geometry_kind(tree_.name(element));
  if (kind != GmlKind::solid && kind != GmlKind::solids && kind != GmlKind::mixed) return Done{};
  ++made_up_lods_;
  auto read = geometry_.read_alone(element, "1");
  if (!read) return std::move(read).error();
  geometry_.end_feature();
  for (const Index own : read->elements) marks_.mark(own);
  for (const Index attribute : read->attributes) marks_.mark_attribute(attribute);
  ++generic_names_[std::string(tree_.name(element))];
  GmlCityObject object;
  object.element = element;
  object.type = "GenericCityObject";
  object.id = new_id(element, object.type);
  object.geometries = std::move(read->geometries);
  object.stated_surface.resize(object.geometries.size());
  found_.objects.push_back(std::move(object));
  return Done{};
}

std::string ObjectReader::new_id(Index element, std::string_view type) {
  std::string id(tree_.id(element));
  marks_.mark_attribute(tree_.id_attribute(element));
  if (!id.empty() && ids_.insert(id).second) return id;
  ++made_up_ids_;
  if (id.empty()) id = type;
  std::string unique;
  made_up_number_ = std::max(made_up_number_, found_.objects.size());
  while (true) {
    unique = id;
    unique.append("-").append(std::to_string(++made_up_number_));
    if (ids_.insert(unique).second) return unique;
  }
}

Status ObjectReader::read_object(Index element, Index parent, std::string_view type) {
  const auto number = static_cast<Index>(found_.objects.size());
  GmlCityObject object;
  object.element = element;
  object.type = type;
  object.id = new_id(element, type);
  if (parent != kNone) {
    object.parents.push_back(parent);
    found_.objects[parent].children.push_back(number);
  }
  marks_.mark(element);
  object_of_.emplace(element, number);
  found_.objects.push_back(std::move(object));
  std::vector<Index> plain;
  std::vector<Index> generics;
  for (Index i = tree_[element].first_child; i != kNone; i = tree_[i].next) {
    if (auto status = read_property(i, number, plain, generics); !status) return status;
  }
  values_.add_properties(plain, found_.objects[number].attributes);
  values_.add_generics(generics, found_.objects[number].attributes);
  return Done{};
}

Status ObjectReader::read_property(Index property, Index object, std::vector<Index>& plain,
                                   std::vector<Index>& generics) {
  const std::string_view name = tree_.name(property);
  const Index value = tree_[property].first_child;
  if (name == "boundedBy" && read_extent(property, found_.objects[object].extent)) return Done{};
  if (is_generic_attribute(name)) {
    generics.push_back(property);
    return Done{};
  }
  if (name == "appearance" || name == "appearanceMember") {
    for (const Index child : tree_.children(property)) found_.appearances.push_back(child);
    return Done{};
  }
  if (name == "address" && value != kNone) return read_address(property, object);
  if (is_beyond_city_json(name) || name.ends_with("ImplicitRepresentation")) {
    marks_.lose(property);
    return Done{};
  }
  if (holds_geometry(tree_, property)) return read_geometry(property, object);
  if (is_group_property(name)) {
    read_group_member(property, object);
    return walk(property, object);
  }
  if (value == kNone) {
    if (tree_.href(property).starts_with('#')) {
      references_.push_back({object, property, {}});
    } else {
      plain.push_back(property);
    }
    return Done{};
  }
  bool holds_surfaces = false;
  for (const Index child : tree_.children(property)) {
    if (semantic_surface_type(tree_.name(child)).empty() || tree_.is_gml(child)) continue;
    holds_surfaces = true;
    if (auto status = read_surface(child, object, kNone); !status) return status;
  }
  if (holds_surfaces) return Done{};
  const std::size_t before = found_.objects.size();
  if (auto status = walk(property, object); !status) return status;
  // A property that holds nothing but an object is no attribute.
  const bool holds_object = found_.objects.size() > before && is_object_here(value);
  if (!holds_object) plain.push_back(property);
  return Done{};
}

// Writes each component of a relief as a TINRelief, with what the relief says about them all.
Status ObjectReader::read_relief(Index element) {
  const std::size_t before = found_.objects.size();
  std::vector<Index> plain;
  for (const Index property : tree_.children(element)) {
    const Index value = tree_[property].first_child;
    if (value != kNone && tree_.name(value) == "TINRelief") {
      if (auto status = read_object(value, kNone, "TINRelief"); !status) return status;
    } else if (value == kNone && tree_.name(property) != "boundedBy") {
      plain.push_back(property);
    }
  }
  if (found_.objects.size() == before) return Done{};
  marks_.mark(element);
  ObjectBuilder relief;
  if (!tree_.id(element).empty()) relief.add("id", std::string(tree_.id(element)), "");
  marks_.mark_attribute(tree_.id_attribute(element));
  values_.add_properties(plain, relief);
  // The first component has what the relief says; all have its id.
  found_.objects[before].attributes.add("ReliefFeature", relief.take(), "property:");
  for (std::size_t i = before + 1; i < found_.objects.size(); ++i) {
    Json id = Json::object();
    append_member(id, "id", std::string(tree_.id(element)));
    found_.objects[i].attributes.add("ReliefFeature", std::move(id), "property:");
  }
  return Done{};
}

std::string ObjectReader::lod_of_property(Index property) {
  const char lod = lod_of(tree_.name(property));
  if (lod != '\0') return std::string(1, lod);
  if (tree_.name(property).starts_with("lod0")) return "0";
  const Index parent = tree_[property].parent;
  auto stated = stated_lods_.find(parent);
  if (stated == stated_lods_.end()) {
    stated = stated_lods_.emplace(parent, tree_.child(parent, "lod")).first;
  }
  if (stated->second != kNone && tree_.text(stated->second).size() == 1) {
    return std::string(tree_.text(stated->second));
  }
  ++made_up_lods_;
  return "1";
}

Status ObjectReader::read_geometry(Index property, Index object) {
  const std::string lod = lod_of_property(property);
  auto read = geometry_.read(property, lod);
  if (!read) {
    ++unread_[read.error().message];
    marks_.lose(property);
    return Done{};
  }
  for (const Index element : read->elements) marks_.mark(element);
  for (const Index attribute : read->attributes) marks_.mark_attribute(attribute);
  GmlCityObject& own = found_.objects[object];
  for (CityGeometry& geometry : read->geometries) {
    own.geometries.push_back(std::move(geometry));
    own.stated_surface.emplace_back(surface_type_of_property(tree_.name(property)));
  }
  return Done{};
}

Status ObjectReader::read_address(Index property, Index object) {
  marks_.mark(property);
  for (const Index element : tree_.children(property)) {
    GmlAddress address;
    address.members = address_members(tree_, marks_, element);
    const Index location = tree_.child(element, "multiPoint");
    if (location != kNone) {
      auto points = geometry_.read(location, "0");
      if (points) {
        for (const Index read : points->elements) marks_.mark(read);
        for (const CityGeometry& geometry : points->geometries) {
          for (const auto& line : geometry.lines) {
            address.location.insert(address.location.end(), line.begin(), line.end());
          }
        }
      }
    }
    found_.objects[object].addresses.push_back(std::move(address));
  }
  return Done{};
}

// Reads a thematic surface and its openings.
Status ObjectReader::read_surface(Index element, Index object, Index parent) {
  const auto number = static_cast<Index>(found_.surfaces.size());
  GmlSurface surface;
  surface.element = element;
  surface.object = object;
  surface.parent = parent;
  surface.type = semantic_surface_type(tree_.name(element));
  surface.elements.push_back(element);
  found_.objects[object].surfaces.push_back(number);
  found_.surfaces.push_back(std::move(surface));
  for (const Index property : tree_.children(element)) {
    if (holds_geometry(tree_, property)) {
      auto read = geometry_.read(property, lod_of_property(property));
      if (!read) {
        ++unread_[read.error().message];
        marks_.lose(property);
        continue;
      }
      const auto has_facets = [](const CityGeometry& own) { return own.lines.empty(); };
      if (!std::all_of(read->geometries.begin(), read->geometries.end(), has_facets)) {
        ++unread_["points and curves of a thematic surface"];
        marks_.lose(property);
        continue;
      }
      GmlSurface& own = found_.surfaces[number];
      own.elements.insert(own.elements.end(), read->elements.begin(), read->elements.end());
      own.attributes_read.insert(own.attributes_read.end(), read->attributes.begin(),
                                 read->attributes.end());
      for (CityGeometry& geometry : read->geometries) {
        own.geometries.push_back(std::move(geometry));
      }
      continue;
    }
    for (const Index child : tree_.children(property)) {
      if (semantic_surface_type(tree_.name(child)).empty() || tree_.is_gml(child)) continue;
      if (auto status = read_surface(child, object, number); !status) return status;
    }
  }
  return Done{};
}

// The box of a gml:boundedBy; false when the property holds none.
bool ObjectReader::read_extent(Index property, Json& extent) {
  const Index envelope = tree_.child(property, "Envelope");
  if (envelope == kNone || !tree_.is_gml(envelope)) return false;
  Json corners = Json::array();
  for (const std::string_view name : {"lowerCorner", "upperCorner"}) {
    const Index corner = tree_.child(envelope, name);
    if (corner == kNone) return true;
    std::string_view text = tree_.text(corner);
    std::vector<Json> numbers;
    while (!(text = without_blanks(text)).empty()) {
      const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
      text.remove_prefix(word.size());
      numbers.push_back(ValueReader::number_of(word));
    }
    const bool are_numbers = std::all_of(numbers.begin(), numbers.end(),
                                         [](const Json& value) { return value.is_binary(); });
    if (numbers.size() != 3 || !are_numbers) return true;
    if (geometry_.is_latitude_first(envelope)) std::swap(numbers[0], numbers[1]);
    for (Json& number : numbers) corners.push_back(std::move(number));
  }
  for (const Index read : {property, envelope, tree_.child(envelope, "lowerCorner"),
                           tree_.child(envelope, "upperCorner")}) {
    marks_.mark(read);
  }
  extent = std::move(corners);
  return true;
}

// Keeps the members of a group for follow_references().
void ObjectReader::read_group_member(Index property, Index object) {
  const Index role = tree_.child(property, "Role");
  Reference reference{object, property, std::string(tree_.attribute(property, "", "role"))};
  marks_.mark_attribute(tree_.find_attribute(property, "", "role"));
  if (role != kNone) {
    marks_.mark(property);
    marks_.mark(role);
    const Index name = tree_.child(role, "role");
    if (name != kNone) {
      reference.role = tree_.text(name);
      marks_.mark(name);
    }
    reference.property = tree_.child(role, "groupMember");
    if (reference.property == kNone) return;
  }
  references_.push_back(std::move(reference));
}

// Makes objects the children of those that refer to them, once all objects are known. Other
// references stay attributes.
void ObjectReader::follow_references() {
  std::unordered_map<std::string_view, Index> by_id;
  for (Index i = 0; i < found_.objects.size(); ++i) {
    const std::string_view id = tree_.id(found_.objects[i].element);
    if (!id.empty()) by_id.emplace(id, i);
  }
  std::set<std::pair<Index, Index>> linked;  // parents and children
  for (Index i = 0; i < found_.objects.size(); ++i) {
    for (const Index child : found_.objects[i].children) linked.emplace(i, child);
  }
  std::map<Index, std::vector<Index>> others;  // the properties that stay attributes, by object
  for (const Reference& reference : references_) {
    const std::string_view href = tree_.href(reference.property);
    Index target = kNone;
    if (const auto found = by_id.find(href.substr(href.empty() ? 0 : 1)); found != by_id.end()) {
      target = found->second;
    }
    const Index inlined = tree_[reference.property].first_child;
    if (inlined != kNone && object_of_.contains(inlined)) target = object_of_[inlined];
    GmlCityObject& own = found_.objects[reference.object];
    const bool is_member = is_group_property(tree_.name(reference.property));
    if (is_member && members_ == GroupMembers::alone) continue;
    const bool is_child = target != kNone && target != reference.object &&
                          (is_member || (needs_parent(found_.objects[target].type) &&
                                         found_.objects[target].parents.empty()));
    if (!is_child) {
      others[reference.object].push_back(reference.property);
      continue;
    }
    marks_.mark(reference.property);
    marks_.mark_attribute(tree_.href_attribute(reference.property));
    if (!linked.emplace(reference.object, target).second) continue;
    own.children.push_back(target);
    if (is_member) own.roles.push_back(reference.role);
    found_.objects[target].parents.push_back(reference.object);
  }
  for (const auto& [object, properties] : others) {
    values_.add_properties(properties, found_.objects[object].attributes);
  }
}

void ObjectReader::note_made_up() {
  if (made_up_ids_ > 0) {
    found_.notes.push_back(
        quantity(made_up_ids_, "city object").append(" without a gml:id of its own: ids made up"));
  }
  if (made_up_lods_ > 0) {
    found_.notes.push_back(quantity(made_up_lods_, "geometry", "geometries")
                               .append(" without level of detail: written as LoD 1"));
  }
  for (const auto& [name, count] : generic_names_) {
    std::string text = "written as GenericCityObject: ";
    found_.notes.push_back(text.append(name).append(" (").append(quantity(count, "time")) + ")");
  }
  for (const auto& [reason, count] : unread_) {
    std::string text = "geometry left out: ";
    found_.notes.push_back(text.append(reason).append(" (").append(quantity(count, "time")) + ")");
  }
}

}  // namespace watertight::formats
