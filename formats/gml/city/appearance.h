// SPDX-License-Identifier: GPL-3.0-or-later
//
// Materials and textures of CityGML for facets and rings. Internal to formats/.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "formats/gml/city/geometry.h"
#include "formats/gml/city/tree.h"
#include "formats/text/json.h"

namespace watertight::formats {

class GmlAppearance {
 public:
  /// All must outlive this object.
  GmlAppearance(const GmlTree& tree, TreeMarks& marks, const GeometryReader& geometry)
      : tree_(tree), marks_(marks), geometry_(geometry) {}

  /// Reads an Appearance. Other elements, and surface data of other kinds than X3DMaterial and
  /// ParameterizedTexture with TexCoordLists, are not marked.
  void read(Index appearance);

  /// Appends the members "material" and "texture" of a geometry, each with a comma before it, where
  /// a facet has any. Marks the targets.
  void append_members(std::string& out, const CityGeometry& geometry);

  /// The member "appearance" of the document; null without materials and textures.
  Json take();

 private:
  struct Material {
    std::size_t number = 0;
    Index target = kNone;  // the element to mark
  };
  struct Texture {
    std::size_t number = 0;
    std::vector<std::size_t> vertices;
    Index target = kNone;       // the property of the texture that holds the coordinates
    Index coordinates = kNone;  // their element
    Index ring = kNone;         // the element that names the ring, in CityGML 3
  };
  struct Theme {
    std::unordered_map<Index, Material> materials;  // by polygon, or the surfaces around it
    std::unordered_map<Index, Texture> textures;    // by ring
  };

  void read_material(Index element, Theme& theme);
  void read_texture(Index element, Theme& theme);
  void read_coordinates(Index list, Index target, std::size_t number, Theme& theme);
  bool read_pairs(Index coordinates, Texture& texture);
  void mark_texture(const Texture& texture);
  const Material* material_of(const Theme& theme, Index polygon) const;
  std::string texture_text(const Theme& theme, const CityFacet& facet, bool& is_any);
  Json colour(Index element);

  const GmlTree& tree_;
  TreeMarks& marks_;
  const GeometryReader& geometry_;
  std::map<std::string, Theme> themes_;
  Json materials_ = Json::array();
  Json textures_ = Json::array();
  Json vertices_ = Json::array();
  std::map<std::pair<std::string_view, std::string_view>, std::size_t> vertex_numbers_;
};

/// Appends the text of each facet in nested arrays, as deep as the shells and solids of a geometry.
template <class FacetText>
void append_by_facet(std::string& out, const CityGeometry& geometry, FacetText facet_text) {
  std::size_t facet = 0;
  const auto append_facets = [&](std::size_t count) {
    out += '[';
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) out += ',';
      out += facet_text(geometry.facets[facet++]);
    }
    out += ']';
  };
  if (geometry.solids.empty()) return append_facets(geometry.facets.size());
  const bool is_single = geometry.type == "Solid";
  if (!is_single) out += '[';
  bool is_first = true;
  for (const std::vector<std::size_t>& shells : geometry.solids) {
    if (!is_first) out += ',';
    is_first = false;
    out += '[';
    for (std::size_t i = 0; i < shells.size(); ++i) {
      if (i > 0) out += ',';
      append_facets(shells[i]);
    }
    out += ']';
  }
  if (!is_single) out += ']';
}

}  // namespace watertight::formats
