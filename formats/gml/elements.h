// SPDX-License-Identifier: GPL-3.0-or-later
//
// The names of GML that the reader knows. Internal to formats/.
#pragma once

#include <optional>
#include <string_view>

#include "formats/gml/model.h"

namespace watertight::formats {

inline constexpr std::string_view kXlinkSpace = "http://www.w3.org/1999/xlink";

/// True for the XML namespace of GML 3.1.1, which GML 2 has too, and for that of GML 3.2.
bool is_gml_space(std::string_view space);

/// The kind of a geometry element of GML; nothing for an element that is no geometry.
std::optional<GmlKind> geometry_kind(std::string_view name);

/// True for a geometry of polygons that bounds no solid by itself.
bool is_surface(GmlKind kind);

/// The role of a property of a geometry of `kind`; nothing when it has no such property.
std::optional<GmlRole> role_of(GmlKind kind, std::string_view property);

/// True for the properties of a geometry that say nothing about its shape as a solid's boundary.
bool is_remark(std::string_view property);

/// True for the objects that only hold top-level objects: CityModel, FeatureCollection, ...
bool is_container(std::string_view name);

/// True for the properties of an object that may refer to a geometry of that object.
bool is_geometry_property(std::string_view name);

/// Returns the character n of a property that is named "lodn...", and '\0' for other properties.
char lod_of(std::string_view property);

}  // namespace watertight::formats
