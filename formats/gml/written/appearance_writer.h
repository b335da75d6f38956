// SPDX-License-Identifier: GPL-3.0-or-later
//
// Materials and textures of facets as Appearances of CityGML 2.0. Internal to formats/.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/gml/written/attribute_writer.h"
#include "formats/gml/written/object_geometry.h"
#include "formats/gml/written/xml_text.h"

namespace watertight::formats {

class AppearanceWriter {
 public:
  /// All must outlive this object. `model`: the member "appearance" is in it.
  AppearanceWriter(const Json& model, XmlText& xml, GmlLeftOut& left_out);

  /// Notes the looks of a polygon that was written with a gml:id, and rings with those of
  /// `ring_ids`, "" for none.
  void add(const WrittenFacet& facet, const std::vector<std::string>& ring_ids);

  /// Writes what was noted, a member of the city model for each theme.
  void write();

 private:
  struct TexturedRing {
    std::string ring;  // its gml:id
    std::string coordinates;
  };
  using Targets = std::map<std::string, std::vector<TexturedRing>>;  // by the id of the polygon
  struct Theme {
    std::map<std::size_t, std::vector<std::string>> materials;  // ids of polygons
    std::map<std::size_t, Targets> textures;
  };

  void add_texture(const FacetLook& look, const WrittenFacet& facet,
                   const std::vector<std::string>& ring_ids);
  void write_material(std::size_t number, const std::vector<std::string>& polygons);
  void write_texture(std::size_t number, const Targets& targets);
  std::string coordinates_of(const Json& ring) const;

  XmlText& xml_;
  GmlLeftOut& left_out_;
  const Json* materials_ = nullptr;
  const Json* textures_ = nullptr;
  const Json* vertices_ = nullptr;
  std::map<std::string, Theme, std::less<>> themes_;
};

}  // namespace watertight::formats
