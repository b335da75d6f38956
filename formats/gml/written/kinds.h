// SPDX-License-Identifier: GPL-3.0-or-later
//
// The elements of CityGML 2.0 for the types of CityJSON 2.0. Internal to formats/.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace watertight::formats {

/// Which properties of a module hold geometry (N is the level of detail).
enum class GeometryStyle : std::uint8_t {
  space,          // lodNSolid, lodNMultiSurface, lodNMultiCurve; of level 0 lod0FootPrint and
                  // lod0RoofEdge
  water,          // lodNSolid; of levels 0 and 1 lodNMultiSurface and lodNMultiCurve
  surfaces,       // lodNMultiSurface
  any,            // lodNGeometry
  plants,         // lodNMultiSolid, lodNMultiSurface
  triangulation,  // tin
  group           // none
};

/// The element of a city object.
struct GmlObjectKind {
  std::string_view type;     // of CityJSON
  std::string_view prefix;   // of the module
  std::string_view element;  // without prefix
  GeometryStyle style;
  /// The properties of the module, in the order of its schema; before them come class, function and
  /// usage.
  std::string_view properties;
};

/// The kind for a type of CityJSON; that of GenericCityObject for types that CityGML 2.0 does not
/// have, and for those of extensions.
const GmlObjectKind& gml_object_kind(std::string_view type);

/// How a semantic surface is a part of its object.
struct GmlSurfaceKind {
  std::string_view prefixes;  // of the modules that have it, between blanks
  std::string_view type;      // of CityJSON, and the element
  std::string_view property;  // of the object, or "opening" of the surface around it
  std::string_view geometry;  // the end of the property "lodN..."
  int least_level;            // of detail
};

/// The kind of a semantic surface in a module; null where there is none.
const GmlSurfaceKind* gml_surface_kind(std::string_view prefix, std::string_view type);

/// Where an object stands in its parent.
struct GmlChildKind {
  std::string_view parent;   // types of CityJSON, between blanks
  std::string_view child;    // type of CityJSON
  std::string_view element;  // of the child, without prefix; "" for that of its kind
  std::string_view property;
  bool is_last;  // after the geometry and the surfaces of the parent
};

/// All such places, those of one parent in the order of its schema.
std::span<const GmlChildKind> gml_child_kinds();

/// The prefixes and namespaces of CityGML 2.0.
struct GmlNamespace {
  std::string_view declaration;  // "xmlns:bldg"
  std::string_view uri;
};
std::span<const GmlNamespace> gml_namespaces();

/// Whether a list of words between blanks has a word.
bool has_word(std::string_view list, std::string_view word);

}  // namespace watertight::formats
