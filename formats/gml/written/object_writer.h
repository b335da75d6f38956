// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes the city objects of one model as elements of CityGML 2.0. Internal to formats/.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/city_json/sax.h"
#include "formats/gml/written/appearance_writer.h"
#include "formats/gml/written/attribute_writer.h"
#include "formats/gml/written/kinds.h"
#include "formats/gml/written/object_geometry.h"
#include "formats/gml/written/xml_text.h"

namespace watertight::formats {

class ObjectWriter {
 public:
  /// All must outlive this object. `ids`: the gml:ids of the document so far.
  ObjectWriter(const CityModel& model, const VertexTexts& vertices, XmlIds& ids, XmlText& xml,
               GmlLeftOut& left_out);

  /// Writes each object that stands in no other one as a member of the model, then what facets
  /// look like.
  void write_members();

 private:
  /// A semantic surface with the facets that it has at each level.
  struct Surface {
    const Json* semantics = nullptr;
    const Json* list = nullptr;  // that it is in
    const GmlSurfaceKind* kind = nullptr;
    std::map<int, std::vector<const WrittenFacet*>> facets;
    std::vector<std::size_t> openings;  // the surfaces within it
  };
  struct OpenObject {
    std::string id;  // of the model
    const GmlObjectKind* kind = nullptr;
    std::map<LevelAndClass, WrittenGeometry> geometries;
    std::vector<Surface> surfaces;
    std::size_t polygons = 0;  // that have a gml:id
    bool has_level = false;    // an attribute says the level of detail
  };

  const Json* object_of(std::string_view id) const;
  void write_member(const std::string& id);
  void write_object(const std::string& id, std::string_view element, std::size_t depth);
  bool contains_objects(const std::string& id) const;
  void write_group_members(const Json& group);
  void write_children(const Json& object, std::string_view type, bool are_last, std::size_t depth);
  void write_child(const std::string& id, const GmlChildKind& place, std::size_t depth);
  void write_geometries(const OpenObject& open, int first_level, int last_level);
  void write_geometry(const OpenObject& open, const LevelAndClass& place,
                      const WrittenGeometry& found);
  void write_any(const std::string& property, GeometryClass of_class, const WrittenGeometry& found);
  void write_footprints(const OpenObject& open, const WrittenGeometry& found);
  void write_lines(const std::string& property, GeometryClass of_class,
                   const WrittenGeometry& found);
  void write_solids(const std::string& property, std::string_view several,
                    const WrittenGeometry& found);
  void write_solid(const WrittenGeometry& found, const std::vector<std::size_t>& shells,
                   std::size_t& facet);
  void write_multi_surface(const std::string& property, std::string_view element,
                           const std::vector<const WrittenFacet*>& facets, bool may_refer);
  void write_surface_member(const WrittenFacet& facet, bool may_refer);
  void write_triangles(int level, bool has_level, const WrittenGeometry& found);
  void write_ring(std::string_view property, const std::vector<BoundaryToken>& ring,
                  std::string_view id);
  void find_surfaces(OpenObject& open);
  std::size_t thematic_surface_of(OpenObject& open, int level, const WrittenFacet& facet,
                                  std::map<const Json*, std::size_t>& numbers,
                                  std::map<std::string, std::size_t>& by_id);
  std::size_t surface_of(OpenObject& open, const WrittenFacet& facet,
                         std::map<const Json*, std::size_t>& numbers,
                         std::map<std::string, std::size_t>& by_id);
  void link_openings(OpenObject& open, const std::map<const Json*, std::size_t>& numbers);
  void write_surface(const OpenObject& open, const Surface& surface);

  const CityModel& model_;
  const VertexTexts& vertices_;
  XmlIds& ids_;
  XmlText& xml_;
  GmlLeftOut& left_out_;
  AppearanceWriter appearance_;
  const Json& objects_;
  std::unordered_map<std::string_view, const Json*> object_of_;  // by id
  std::set<std::string, std::less<>> written_;
};

}  // namespace watertight::formats
