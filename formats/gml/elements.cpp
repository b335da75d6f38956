// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/elements.h"

#include <algorithm>
#include <array>

namespace watertight::formats {
namespace {

struct KnownGeometry {
  std::string_view name;
  GmlKind kind;
};
constexpr std::array kGeometries{
    KnownGeometry{"LinearRing", GmlKind::ring},
    KnownGeometry{"Polygon", GmlKind::polygon},
    KnownGeometry{"PolygonPatch", GmlKind::polygon},
    KnownGeometry{"Triangle", GmlKind::polygon},
    KnownGeometry{"Rectangle", GmlKind::polygon},
    KnownGeometry{"Shell", GmlKind::surfaces},
    KnownGeometry{"CompositeSurface", GmlKind::surfaces},
    KnownGeometry{"MultiSurface", GmlKind::surfaces},
    KnownGeometry{"Surface", GmlKind::surfaces},
    KnownGeometry{"PolyhedralSurface", GmlKind::surfaces},
    KnownGeometry{"TriangulatedSurface", GmlKind::surfaces},
    KnownGeometry{"Tin", GmlKind::surfaces},
    KnownGeometry{"OrientableSurface", GmlKind::orientable},
    KnownGeometry{"Solid", GmlKind::solid},
    KnownGeometry{"MultiSolid", GmlKind::solids},
    KnownGeometry{"CompositeSolid", GmlKind::solids},
    KnownGeometry{"MultiGeometry", GmlKind::mixed},
    KnownGeometry{"GeometricComplex", GmlKind::mixed},
    KnownGeometry{"Point", GmlKind::unread},
    KnownGeometry{"MultiPoint", GmlKind::unread},
    KnownGeometry{"LineString", GmlKind::unread},
    KnownGeometry{"Curve", GmlKind::unread},
    KnownGeometry{"OrientableCurve", GmlKind::unread},
    KnownGeometry{"CompositeCurve", GmlKind::unread},
    KnownGeometry{"MultiCurve", GmlKind::unread},
    KnownGeometry{"MultiLineString", GmlKind::unread},
    KnownGeometry{"MultiPolygon", GmlKind::unread},
    KnownGeometry{"Ring", GmlKind::unread},
};

template <std::size_t kSize>
bool contains(const std::array<std::string_view, kSize>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 6> kSurfaceProperties{
    "surfaceMember", "surfaceMembers", "patches", "polygonPatches", "trianglePatches", "patch"};
constexpr std::array<std::string_view, 2> kSolidProperties{"solidMember", "solidMembers"};
constexpr std::array<std::string_view, 3> kMixedProperties{"geometryMember", "geometryMembers",
                                                           "element"};
constexpr std::array<std::string_view, 11> kRemarks{
    "metaDataProperty", "description", "descriptionReference", "name",      "identifier",
    "boundedBy",        "stopLines",   "breakLines",           "maxLength", "controlPoint",
    "location"};
constexpr std::array<std::string_view, 6> kContainers{
    "CityModel",         "IndoorFeatures", "PrimalSpaceFeatures",
    "MultiLayeredGraph", "Tuple",          "PrimalSpaceLayer"};

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

}  // namespace

bool is_gml_space(std::string_view space) {
  return space == "http://www.opengis.net/gml" || space == "http://www.opengis.net/gml/3.2";
}

std::optional<GmlKind> geometry_kind(std::string_view name) {
  for (const KnownGeometry& known : kGeometries) {
    if (known.name == name) return known.kind;
  }
  return std::nullopt;
}

bool is_surface(GmlKind kind) {
  return kind == GmlKind::polygon || kind == GmlKind::surfaces || kind == GmlKind::orientable;
}

std::optional<GmlRole> role_of(GmlKind kind, std::string_view property) {
  switch (kind) {
    case GmlKind::polygon:
    case GmlKind::solid:
      if (property == "exterior" || property == "outerBoundaryIs") return GmlRole::exterior;
      if (property == "interior" || property == "innerBoundaryIs") return GmlRole::interior;
      return std::nullopt;
    case GmlKind::surfaces:
      if (contains(kSurfaceProperties, property)) return GmlRole::member;
      return std::nullopt;
    case GmlKind::orientable:
      if (property == "baseSurface") return GmlRole::member;
      return std::nullopt;
    case GmlKind::solids:
      if (contains(kSolidProperties, property)) return GmlRole::member;
      return std::nullopt;
    case GmlKind::mixed:
      if (contains(kMixedProperties, property)) return GmlRole::member;
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

bool is_remark(std::string_view property) { return contains(kRemarks, property); }

bool is_container(std::string_view name) {
  return contains(kContainers, name) || name.ends_with("FeatureCollection");
}

bool is_geometry_property(std::string_view name) {
  if (name == "Geometry3D") return true;
  if (name.empty() || !is_lower(name.front())) return false;
  return name == "geometry" || name == "solid" || name.ends_with("Solid") ||
         name.ends_with("Geometry") || name.ends_with("olidProperty") ||
         name.ends_with("eometryProperty");
}

char lod_of(std::string_view property) {
  const bool is_lod = property.size() > 4 && property.starts_with("lod") && property[3] >= '0' &&
                      property[3] <= '9';
  return is_lod ? property[3] : '\0';
}

}  // namespace watertight::formats
