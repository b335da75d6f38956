// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/object_writer.h"

#include <algorithm>
#include <array>
#include <string>

#include "formats/gml/written/address_writer.h"

namespace watertight::formats {
namespace {

constexpr std::size_t kMostDepth = 16;  // of objects within objects
constexpr int kLastBeforeSurfaces = 2;  // the schemas have levels 3 and 4 after the surfaces

/// The members of a city object that are written, or follow from others.
constexpr std::string_view kKnownMembers =
    "type attributes geometry parents children children_roles address";

bool is_room(const GmlObjectKind& kind) {
  return kind.type == "BuildingRoom" || kind.type == "BridgeRoom" ||
         kind.type == "TunnelHollowSpace";
}

/// Whether the object is a whole construction or a part of one.
bool is_construction(const GmlObjectKind& kind) {
  return kind.style == GeometryStyle::space && !is_room(kind);
}

std::string property_name(const GmlObjectKind& kind, int level, std::string_view end) {
  return std::string(kind.prefix).append(":lod").append(std::to_string(level)).append(end);
}

std::string ring_text(const VertexTexts& vertices, const std::vector<BoundaryToken>& ring) {
  std::string text;
  for (const BoundaryToken vertex : ring) text.append(vertices.texts[vertex]).append(" ");
  return text.append(vertices.texts[ring.front()]);
}

std::vector<const WrittenFacet*> facets_of(const WrittenGeometry& geometry) {
  std::vector<const WrittenFacet*> facets;
  for (const WrittenFacet& facet : geometry.facets) facets.push_back(&facet);
  return facets;
}

/// The members of a semantic surface that are attributes.
Json attributes_of_surface(const Json& semantics) {
  Json attributes = Json::object();
  for (const auto& [key, value] : semantics.items()) {
    if (!has_word("type id parent children", key)) append_member(attributes, key, value);
  }
  return attributes;
}

/// Whether the thematic surfaces say all that a geometry of surfaces has.
bool is_said_by_surfaces(const WrittenGeometry& geometry) {
  return std::ranges::none_of(geometry.facets,
                              [](const WrittenFacet& facet) { return !facet.is_in_surface; });
}

}  // namespace

ObjectWriter::ObjectWriter(const CityModel& model, const VertexTexts& vertices, XmlIds& ids,
                           XmlText& xml, GmlLeftOut& left_out)
    : model_(model),
      vertices_(vertices),
      ids_(ids),
      xml_(xml),
      left_out_(left_out),
      appearance_(model.root, xml, left_out),
      objects_(*find_member(model.root, "CityObjects")) {
  for (const auto& [id, object] : objects_.get_ref<const Json::object_t&>()) {
    object_of_.emplace(id, &object);
  }
}

/// The object with this id; null if the model has none.
const Json* ObjectWriter::object_of(std::string_view id) const {
  const auto found = object_of_.find(id);
  return found == object_of_.end() ? nullptr : found->second;
}

void ObjectWriter::write_members() {
  for (const auto& [id, object] : objects_.items()) {
    const Json* parents = find_member(object, "parents");
    const bool has_parent =
        parents != nullptr && parents->is_array() &&
        std::ranges::any_of(*parents, [&](const Json& parent) {
          return parent.is_string() && contains_objects(parent.get_ref<const std::string&>());
        });
    if (!has_parent) write_member(id);
  }
  for (const auto& [id, object] : objects_.items()) {
    if (written_.contains(id)) continue;
    ++left_out_["places in a parent, of " + string_member(object, "type")];
    write_member(id);
  }
  appearance_.write();
}

void ObjectWriter::write_member(const std::string& id) {
  const GmlObjectKind& kind = gml_object_kind(string_member(*object_of(id), "type"));
  xml_.open("core:cityObjectMember");
  write_object(id, kind.element, 1);
  xml_.close();
}

void ObjectWriter::write_object(const std::string& id, std::string_view element,
                                std::size_t depth) {
  const Json& object = *object_of(id);
  const std::string type = string_member(object, "type");
  OpenObject open;
  open.id = id;
  open.kind = &gml_object_kind(type);
  written_.insert(id);
  if (xml_name(id) != id) ++left_out_["ids that are no names of XML; they are spelled anew"];
  if (open.kind->type != type) ++left_out_["the type of objects: " + type];
  for (const auto& [key, value] : object.items()) {
    if (!has_word(kKnownMembers, key)) ++left_out_["the member " + key + " of objects"];
  }
  open.geometries = written_geometries(model_, object, vertices_, left_out_);
  find_surfaces(open);

  const std::string prefix(open.kind->prefix);
  const std::string name = prefix + ":" + std::string(element);
  xml_.open(name, {{"gml:id", ids_.take(id)}});
  if (const Json* attributes = find_member(object, "attributes")) {
    AttributeWriter(xml_, left_out_).write(*attributes, prefix, open.kind->properties);
    open.has_level = attributes->contains("lod");
  }
  if (open.kind->style == GeometryStyle::group) write_group_members(object);
  const bool are_surfaces_first = open.kind->style == GeometryStyle::surfaces;
  const int last = is_construction(*open.kind) ? kLastBeforeSurfaces : kMostLevel;
  if (!are_surfaces_first) write_geometries(open, 0, last);
  write_children(object, type, false, depth);
  for (const Surface& surface : open.surfaces) {
    if (surface.kind->property == "opening") continue;
    xml_.open(prefix + ":" + std::string(surface.kind->property));
    write_surface(open, surface);
    xml_.close();
  }
  write_geometries(open, are_surfaces_first ? 0 : last + 1, kMostLevel);
  write_children(object, type, true, depth);
  AddressWriter(vertices_, ids_, xml_, left_out_)
      .write(object, is_construction(*open.kind) ? prefix : std::string());
  xml_.close();
}

/// Whether the elements of an object's children stand in its own, which those of a group do not.
bool ObjectWriter::contains_objects(const std::string& id) const {
  const Json* object = object_of(id);
  return object != nullptr && string_member(*object, "type") != "CityObjectGroup";
}

void ObjectWriter::write_group_members(const Json& group) {
  const Json* children = find_member(group, "children");
  const Json* roles = find_member(group, "children_roles");
  if (children == nullptr || !children->is_array()) return;
  for (std::size_t i = 0; i < children->size(); ++i) {
    const Json& child = (*children)[i];
    if (!child.is_string()) continue;
    const bool has_role = roles != nullptr && roles->is_array() && i < roles->size();
    xml_.leaf("grp:groupMember", "",
              {{"role", has_role ? text_of_value((*roles)[i]) : std::string()},
               {"xlink:href", "#" + xml_name(child.get_ref<const std::string&>())}});
  }
}

/// Writes the children that stand before or after the geometry and surfaces of their parent.
void ObjectWriter::write_children(const Json& object, std::string_view type, bool are_last,
                                  std::size_t depth) {
  const Json* children = find_member(object, "children");
  if (children == nullptr || !children->is_array() || depth == kMostDepth) return;
  for (const GmlChildKind& kind : gml_child_kinds()) {
    if (kind.is_last != are_last || !has_word(kind.parent, type)) continue;
    for (const Json& child : *children) {
      if (child.is_string()) write_child(child.get_ref<const std::string&>(), kind, depth);
    }
  }
}

void ObjectWriter::write_child(const std::string& id, const GmlChildKind& place,
                               std::size_t depth) {
  const Json* found = object_of(id);
  if (found == nullptr || written_.contains(id)) return;
  if (string_member(*found, "type") != place.child) return;
  const GmlObjectKind& kind = gml_object_kind(place.child);
  xml_.open(std::string(kind.prefix).append(":").append(place.property));
  write_object(id, place.element.empty() ? kind.element : place.element, depth + 1);
  xml_.close();
}

/// Gives each facet whose semantics CityGML has its thematic surface, and a gml:id to each facet
/// that something refers to.
void ObjectWriter::find_surfaces(OpenObject& open) {
  std::map<const Json*, std::size_t> numbers;
  std::map<std::string, std::size_t> by_id;
  for (auto& [place, geometry] : open.geometries) {
    for (WrittenFacet& facet : geometry.facets) {
      const std::size_t number = thematic_surface_of(open, place.first, facet, numbers, by_id);
      const bool has_surface = number < open.surfaces.size();
      if (!has_surface && facet.looks.empty()) continue;
      facet.id = ids_.take(open.id + "_" + std::to_string(++open.polygons));
      facet.is_in_surface = has_surface && !facet.id.empty();
      if (facet.is_in_surface) open.surfaces[number].facets[place.first].push_back(&facet);
    }
  }
  link_openings(open, numbers);
}

/// The number of the surface of a facet at a level; that of no surface where there is none.
std::size_t ObjectWriter::thematic_surface_of(OpenObject& open, int level,
                                              const WrittenFacet& facet,
                                              std::map<const Json*, std::size_t>& numbers,
                                              std::map<std::string, std::size_t>& by_id) {
  const std::size_t none = open.surfaces.size();
  const bool is_footprint = is_construction(*open.kind) && level == 0;
  if (facet.semantics == nullptr || is_footprint) return none;
  const std::string type = string_member(*facet.semantics, "type");
  const GmlSurfaceKind* kind = gml_surface_kind(open.kind->prefix, type);
  const bool has_surfaces = !open.kind->element.ends_with("Furniture");
  std::size_t number = none;
  if (kind != nullptr && level >= kind->least_level && has_surfaces) {
    number = surface_of(open, facet, numbers, by_id);
  }
  if (number == open.surfaces.size()) ++left_out_["semantics of facets: " + type];
  return number;
}

/// The number of the surface of a facet; that of no surface for an opening in none.
std::size_t ObjectWriter::surface_of(OpenObject& open, const WrittenFacet& facet,
                                     std::map<const Json*, std::size_t>& numbers,
                                     std::map<std::string, std::size_t>& by_id) {
  const auto known = numbers.find(facet.semantics);
  if (known != numbers.end()) return known->second;
  const GmlSurfaceKind* kind =
      gml_surface_kind(open.kind->prefix, string_member(*facet.semantics, "type"));
  if (kind->property == "opening") {
    const Json* parent = find_member(*facet.semantics, "parent");
    if (parent == nullptr || !parent->is_number_unsigned() ||
        parent->get<std::size_t>() >= facet.surfaces->size()) {
      return open.surfaces.size();
    }
    WrittenFacet around;
    around.semantics = &(*facet.surfaces)[parent->get<std::size_t>()];
    around.surfaces = facet.surfaces;
    const GmlSurfaceKind* kind_around =
        gml_surface_kind(open.kind->prefix, string_member(*around.semantics, "type"));
    if (kind_around == nullptr || kind_around->property == "opening") return open.surfaces.size();
    surface_of(open, around, numbers, by_id);
  }
  std::size_t number = open.surfaces.size();
  const std::string id = string_member(*facet.semantics, "id");
  if (!id.empty()) number = by_id.try_emplace(id, number).first->second;
  numbers.emplace(facet.semantics, number);
  if (number == open.surfaces.size()) {
    open.surfaces.push_back({facet.semantics, facet.surfaces, kind, {}, {}});
  }
  return number;
}

void ObjectWriter::link_openings(OpenObject& open,
                                 const std::map<const Json*, std::size_t>& numbers) {
  for (std::size_t i = 0; i < open.surfaces.size(); ++i) {
    const Surface& surface = open.surfaces[i];
    if (surface.kind->property != "opening") continue;
    const auto parent = find_member(*surface.semantics, "parent")->get<std::size_t>();
    open.surfaces[numbers.at(&(*surface.list)[parent])].openings.push_back(i);
  }
}

void ObjectWriter::write_surface(const OpenObject& open, const Surface& surface) {
  const std::string prefix(open.kind->prefix);
  const std::string id = string_member(*surface.semantics, "id");
  xml_.open(prefix + ":" + std::string(surface.kind->type),
            {{"gml:id", id.empty() ? std::string() : ids_.take(id)}});
  const bool is_traffic = prefix == "tran";
  AttributeWriter(xml_, left_out_)
      .write(attributes_of_surface(*surface.semantics), prefix,
             is_traffic ? "surfaceMaterial" : "");
  for (const auto& [level, facets] : surface.facets) {
    const bool is_multi = surface.kind->geometry == "MultiSurface";
    write_multi_surface(property_name(*open.kind, level, surface.kind->geometry),
                        is_multi ? "gml:MultiSurface" : "gml:CompositeSurface", facets, false);
  }
  for (const std::size_t opening : surface.openings) {
    xml_.open(prefix + ":opening");
    write_surface(open, open.surfaces[opening]);
    xml_.close();
  }
  xml_.close();
}

void ObjectWriter::write_geometries(const OpenObject& open, int first_level, int last_level) {
  for (int level = first_level; level <= last_level; ++level) {
    const auto begin = open.geometries.lower_bound({level, GeometryClass::solids});
    const auto end = open.geometries.upper_bound({level, GeometryClass::points});
    const bool is_mixed = open.kind->style == GeometryStyle::any && std::distance(begin, end) > 1;
    if (is_mixed) {
      xml_.open(property_name(*open.kind, level, "Geometry"));
      xml_.open("gml:MultiGeometry");
    }
    for (auto found = begin; found != end; ++found) {
      if (found->second.type.empty()) continue;
      if (is_mixed) {
        write_any("gml:geometryMember", found->first.second, found->second);
      } else {
        write_geometry(open, found->first, found->second);
      }
    }
    if (is_mixed) {
      xml_.close();
      xml_.close();
    }
  }
}

/// Writes a geometry of any class in a property that takes all.
void ObjectWriter::write_any(const std::string& property, GeometryClass of_class,
                             const WrittenGeometry& found) {
  if (of_class == GeometryClass::solids) {
    write_solids(property, found.type == "MultiSolid" ? "gml:MultiSolid" : "gml:CompositeSolid",
                 found);
  } else if (of_class == GeometryClass::surfaces) {
    write_multi_surface(property, "gml:MultiSurface", facets_of(found), true);
  } else {
    write_lines(property, of_class, found);
  }
}

void ObjectWriter::write_geometry(const OpenObject& open, const LevelAndClass& place,
                                  const WrittenGeometry& found) {
  const GmlObjectKind& kind = *open.kind;
  const auto [level, of_class] = place;
  const bool are_solids = of_class == GeometryClass::solids;
  const bool are_surfaces = of_class == GeometryClass::surfaces;
  const auto name = [&, at = level](std::string_view end) { return property_name(kind, at, end); };
  switch (kind.style) {
    case GeometryStyle::any:
      return write_any(name("Geometry"), of_class, found);
    case GeometryStyle::space:
      if (are_solids && level > 0) {
        if (found.type == "MultiSolid") ++left_out_["the type MultiSolid of geometries"];
        return write_solids(name("Solid"), "gml:CompositeSolid", found);
      }
      if (are_surfaces && level == 0) return write_footprints(open, found);
      if (are_surfaces && is_said_by_surfaces(found)) return;
      if (are_surfaces) {
        return write_multi_surface(name("MultiSurface"), "gml:MultiSurface", facets_of(found),
                                   true);
      }
      if (of_class == GeometryClass::lines && level >= 2) {
        return write_lines(name("MultiCurve"), of_class, found);
      }
      break;
    case GeometryStyle::water:
      if (are_solids && level > 0) return write_solids(name("Solid"), "gml:CompositeSolid", found);
      if (are_surfaces && level > 1 && is_said_by_surfaces(found)) return;
      if (are_surfaces && level <= 1) {
        return write_multi_surface(name("MultiSurface"), "gml:MultiSurface", facets_of(found),
                                   true);
      }
      if (of_class == GeometryClass::lines && level <= 1) {
        return write_lines(name("MultiCurve"), of_class, found);
      }
      break;
    case GeometryStyle::surfaces:
      if (are_solids)
        ++left_out_["solids that are written as surfaces, of " + std::string(kind.type)];
      if (are_surfaces && is_said_by_surfaces(found)) return;
      if (are_solids || are_surfaces) {
        return write_multi_surface(name("MultiSurface"), "gml:MultiSurface", facets_of(found),
                                   true);
      }
      break;
    case GeometryStyle::plants:
      if (are_solids) return write_solids(name("MultiSolid"), "gml:MultiSolid", found);
      if (are_surfaces) {
        return write_multi_surface(name("MultiSurface"), "gml:MultiSurface", facets_of(found),
                                   true);
      }
      break;
    case GeometryStyle::triangulation:
      if (are_surfaces) return write_triangles(level, open.has_level, found);
      break;
    case GeometryStyle::group:
      break;
  }
  ++left_out_[found.type + " of level of detail " + found.level + " of " + std::string(kind.type)];
}

void ObjectWriter::write_footprints(const OpenObject& open, const WrittenGeometry& found) {
  std::array<std::vector<const WrittenFacet*>, 2> parts;
  for (const WrittenFacet& facet : found.facets) {
    const bool is_roof =
        facet.semantics != nullptr && string_member(*facet.semantics, "type") == "RoofSurface";
    parts[is_roof ? 1 : 0].push_back(&facet);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    write_multi_surface(property_name(*open.kind, 0, i == 0 ? "FootPrint" : "RoofEdge"),
                        "gml:MultiSurface", parts[i], false);
  }
}

void ObjectWriter::write_lines(const std::string& property, GeometryClass of_class,
                               const WrittenGeometry& found) {
  const bool are_points = of_class == GeometryClass::points;
  xml_.open(property);
  xml_.open(are_points ? "gml:MultiPoint" : "gml:MultiCurve");
  for (const auto& line : found.lines) {
    if (are_points) {
      for (const BoundaryToken vertex : line) write_point(xml_, vertices_.texts[vertex]);
      continue;
    }
    std::string text;
    for (const BoundaryToken vertex : line) {
      text.append(text.empty() ? "" : " ").append(vertices_.texts[vertex]);
    }
    xml_.open("gml:curveMember");
    xml_.open("gml:LineString");
    xml_.leaf("gml:posList", text, {{"srsDimension", "3"}});
    xml_.close();
    xml_.close();
  }
  xml_.close();
  xml_.close();
}

void ObjectWriter::write_solids(const std::string& property, std::string_view several,
                                const WrittenGeometry& found) {
  if (found.solids.empty()) return;
  xml_.open(property);
  std::size_t facet = 0;
  const bool is_one = found.solids.size() == 1 && several != "gml:MultiSolid";
  if (!is_one) xml_.open(several);
  for (const auto& shells : found.solids) {
    if (!is_one) xml_.open("gml:solidMember");
    write_solid(found, shells, facet);
    if (!is_one) xml_.close();
  }
  if (!is_one) xml_.close();
  xml_.close();
}

/// `facet`: the number of the first facet of the solid; receives that of the next one.
void ObjectWriter::write_solid(const WrittenGeometry& found, const std::vector<std::size_t>& shells,
                               std::size_t& facet) {
  xml_.open("gml:Solid");
  for (std::size_t shell = 0; shell < shells.size(); ++shell) {
    xml_.open(shell == 0 ? "gml:exterior" : "gml:interior");
    xml_.open("gml:CompositeSurface");
    for (std::size_t i = 0; i < shells[shell]; ++i) {
      write_surface_member(found.facets[facet++], true);
    }
    xml_.close();
    xml_.close();
  }
  xml_.close();
}

void ObjectWriter::write_multi_surface(const std::string& property, std::string_view element,
                                       const std::vector<const WrittenFacet*>& facets,
                                       bool may_refer) {
  xml_.open(property);
  xml_.open(element);
  for (const WrittenFacet* facet : facets) write_surface_member(*facet, may_refer);
  xml_.close();
  xml_.close();
}

/// A facet, or with `may_refer` a reference to its polygon in a thematic surface.
void ObjectWriter::write_surface_member(const WrittenFacet& facet, bool may_refer) {
  if (may_refer && facet.is_in_surface) {
    return xml_.leaf("gml:surfaceMember", "", {{"xlink:href", "#" + facet.id}});
  }
  const bool has_texture = std::ranges::any_of(facet.looks, &FacetLook::is_texture);
  std::vector<std::string> ring_ids(facet.rings.size());
  xml_.open("gml:surfaceMember");
  xml_.open("gml:Polygon", {{"gml:id", facet.id}});
  for (std::size_t i = 0; i < facet.rings.size(); ++i) {
    if (has_texture) ring_ids[i] = ids_.take(facet.id + "-" + std::to_string(i));
    write_ring(i == 0 ? "gml:exterior" : "gml:interior", facet.rings[i], ring_ids[i]);
  }
  xml_.close();
  xml_.close();
  if (!facet.id.empty()) appearance_.add(facet, ring_ids);
}

void ObjectWriter::write_ring(std::string_view property, const std::vector<BoundaryToken>& ring,
                              std::string_view id) {
  xml_.open(property);
  xml_.open("gml:LinearRing", {{"gml:id", id}});
  xml_.leaf("gml:posList", ring_text(vertices_, ring), {{"srsDimension", "3"}});
  xml_.close();
  xml_.close();
}

void ObjectWriter::write_triangles(int level, bool has_level, const WrittenGeometry& found) {
  if (!has_level) xml_.leaf("dem:lod", std::to_string(level));
  xml_.open("dem:tin");
  xml_.open("gml:TriangulatedSurface");
  xml_.open("gml:trianglePatches");
  for (const WrittenFacet& facet : found.facets) {
    if (facet.rings.size() != 1 || facet.rings.front().size() != 3) {
      ++left_out_["facets of TINRelief that are no triangles"];
      continue;
    }
    xml_.open("gml:Triangle");
    write_ring("gml:exterior", facet.rings.front(), "");
    if (!facet.looks.empty()) ++left_out_["materials and textures of TINRelief"];
    xml_.close();
  }
  for (int i = 0; i < 3; ++i) xml_.close();
}

}  // namespace watertight::formats
