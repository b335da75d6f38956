// SPDX-License-Identifier: GPL-3.0-or-later
//
// The geometries of a city object by level of detail and kind, as CityGML has them. Internal to
// formats/.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/city_json/sax.h"
#include "formats/gml/written/attribute_writer.h"
#include "formats/text/json.h"

namespace watertight::formats {

/// The vertices of a city model as texts "x y z", and the box around them.
struct VertexTexts {
  std::vector<std::string> texts;  // "" for a vertex that is none
  struct Bound {
    double value = 0;
    std::string text;
  };
  std::array<Bound, 3> least{}, most{};
  bool has_box = false;

  /// Errors: those of geometry::lattice_of_integers().
  static Result<VertexTexts> of(const CityModel& model, const geometry::Transform& transform);
  void join_box(const VertexTexts& other);
};

/// What a facet looks like in a theme.
struct FacetLook {
  std::string theme;
  bool is_texture = false;
  const Json* value = nullptr;  // the number of a material, or the list of a texture for each ring
};

struct WrittenFacet {
  std::vector<std::vector<BoundaryToken>> rings;
  const Json* semantics = nullptr;  // the object in `surfaces` of the geometry
  const Json* surfaces = nullptr;   // the list that it is in
  std::vector<FacetLook> looks;
  std::string id;              // the gml:id of the polygon, "" without one
  bool is_in_surface = false;  // the polygon stands in a thematic surface
};

enum class GeometryClass : std::uint8_t { solids, surfaces, lines, points };

/// All geometries of an object at one level of detail that are of one class.
struct WrittenGeometry {
  std::string level;  // as the model has it
  std::string type;   // of the first
  std::vector<WrittenFacet> facets;
  std::vector<std::vector<std::size_t>> solids;   // the number of facets of each shell
  std::vector<std::vector<BoundaryToken>> lines;  // of points: one line with all
};

/// The highest level of detail in CityGML 2.0.
inline constexpr int kMostLevel = 4;

/// The digit of a level of detail in CityGML, and the class.
using LevelAndClass = std::pair<int, GeometryClass>;

/// The geometries of an object. CityGML has one level for each digit: of 2.0 and 2.2 the latter is
/// written. Cost: linear.
std::map<LevelAndClass, WrittenGeometry> written_geometries(const CityModel& model,
                                                            const Json& object,
                                                            const VertexTexts& vertices,
                                                            GmlLeftOut& left_out);

/// Writes a member of a MultiPoint.
void write_point(XmlText& xml, std::string_view position);

}  // namespace watertight::formats
