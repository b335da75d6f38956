// SPDX-License-Identifier: GPL-3.0-or-later
//
// The names of CityGML 1.0, 2.0 and 3.0 and those of CityJSON 2.0 that stand for them. Internal to
// formats/.
#pragma once

#include <string_view>

namespace watertight::formats {

/// The type of city object in CityJSON for an element of CityGML; "" for other elements. A
/// ReliefFeature has none: its components are TINReliefs.
std::string_view city_object_type(std::string_view element);

/// The type of a semantic surface in CityJSON for an element of CityGML; "" for other elements.
std::string_view semantic_surface_type(std::string_view element);

/// The type of the semantic surface that says what geometry of LoD 0 a property holds
/// ("lod0FootPrint": GroundSurface, "lod0RoofEdge": RoofSurface); "" for other properties.
std::string_view surface_type_of_property(std::string_view property);

/// True for the properties whose text is a number, or a list of numbers.
bool is_number_property(std::string_view property);
/// True for the properties whose text is a list of numbers between blanks.
bool is_list_property(std::string_view property);
/// True for the properties whose text is true or false.
bool is_boolean_property(std::string_view property);

/// True for types of CityJSON that must have a parent.
bool needs_parent(std::string_view city_object_type);

}  // namespace watertight::formats
