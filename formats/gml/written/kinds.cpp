// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/kinds.h"

#include <algorithm>
#include <array>

#include "formats/gml/xml.h"

namespace watertight::formats {
namespace {

constexpr std::string_view kOfBuildings =
    "yearOfConstruction yearOfDemolition roofType measuredHeight storeysAboveGround "
    "storeysBelowGround storeyHeightsAboveGround storeyHeightsBelowGround";
constexpr std::string_view kOfBridges = "yearOfConstruction yearOfDemolition isMovable";
constexpr std::string_view kOfTunnels = "yearOfConstruction yearOfDemolition";

using enum GeometryStyle;
constexpr std::array kKinds{
    GmlObjectKind{"GenericCityObject", "gen", "GenericCityObject", any, ""},
    GmlObjectKind{"Building", "bldg", "Building", space, kOfBuildings},
    GmlObjectKind{"BuildingPart", "bldg", "BuildingPart", space, kOfBuildings},
    GmlObjectKind{"BuildingInstallation", "bldg", "BuildingInstallation", any, ""},
    GmlObjectKind{"BuildingFurniture", "bldg", "BuildingFurniture", any, ""},
    GmlObjectKind{"BuildingRoom", "bldg", "Room", space, ""},
    GmlObjectKind{"Bridge", "brid", "Bridge", space, kOfBridges},
    GmlObjectKind{"BridgePart", "brid", "BridgePart", space, kOfBridges},
    GmlObjectKind{"BridgeInstallation", "brid", "BridgeInstallation", any, ""},
    GmlObjectKind{"BridgeConstructiveElement", "brid", "BridgeConstructionElement", any, ""},
    GmlObjectKind{"BridgeFurniture", "brid", "BridgeFurniture", any, ""},
    GmlObjectKind{"BridgeRoom", "brid", "BridgeRoom", space, ""},
    GmlObjectKind{"Tunnel", "tun", "Tunnel", space, kOfTunnels},
    GmlObjectKind{"TunnelPart", "tun", "TunnelPart", space, kOfTunnels},
    GmlObjectKind{"TunnelInstallation", "tun", "TunnelInstallation", any, ""},
    GmlObjectKind{"TunnelFurniture", "tun", "TunnelFurniture", any, ""},
    GmlObjectKind{"TunnelHollowSpace", "tun", "HollowSpace", space, ""},
    GmlObjectKind{"Road", "tran", "Road", surfaces, ""},
    GmlObjectKind{"Railway", "tran", "Railway", surfaces, ""},
    GmlObjectKind{"TransportSquare", "tran", "Square", surfaces, ""},
    GmlObjectKind{"WaterBody", "wtr", "WaterBody", water, ""},
    GmlObjectKind{"LandUse", "luse", "LandUse", surfaces, ""},
    GmlObjectKind{"PlantCover", "veg", "PlantCover", plants, "averageHeight"},
    GmlObjectKind{"SolitaryVegetationObject", "veg", "SolitaryVegetationObject", any,
                  "species height trunkDiameter crownDiameter"},
    GmlObjectKind{"TINRelief", "dem", "TINRelief", triangulation, "lod"},
    GmlObjectKind{"CityFurniture", "frn", "CityFurniture", any, ""},
    GmlObjectKind{"CityObjectGroup", "grp", "CityObjectGroup", group, ""},
};

constexpr std::string_view kBuilt = "bldg brid tun";
constexpr std::array kSurfaceKinds{
    GmlSurfaceKind{kBuilt, "RoofSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "WallSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "GroundSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "ClosureSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "OuterCeilingSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "OuterFloorSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "FloorSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "InteriorWallSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "CeilingSurface", "boundedBy", "MultiSurface", 2},
    GmlSurfaceKind{kBuilt, "Window", "opening", "MultiSurface", 3},
    GmlSurfaceKind{kBuilt, "Door", "opening", "MultiSurface", 3},
    GmlSurfaceKind{"tran", "TrafficArea", "trafficArea", "MultiSurface", 2},
    GmlSurfaceKind{"tran", "AuxiliaryTrafficArea", "auxiliaryTrafficArea", "MultiSurface", 2},
    GmlSurfaceKind{"wtr", "WaterSurface", "boundedBy", "Surface", 2},
    GmlSurfaceKind{"wtr", "WaterGroundSurface", "boundedBy", "Surface", 2},
    GmlSurfaceKind{"wtr", "WaterClosureSurface", "boundedBy", "Surface", 2},
};

constexpr std::array kChildKinds{
    GmlChildKind{"Building BuildingPart", "BuildingInstallation", "", "outerBuildingInstallation",
                 false},
    GmlChildKind{"Building BuildingPart", "BuildingRoom", "", "interiorRoom", true},
    GmlChildKind{"Building BuildingPart", "BuildingPart", "", "consistsOfBuildingPart", true},
    GmlChildKind{"BuildingRoom", "BuildingFurniture", "", "interiorFurniture", true},
    GmlChildKind{"BuildingRoom", "BuildingInstallation", "IntBuildingInstallation",
                 "roomInstallation", true},
    GmlChildKind{"Bridge BridgePart", "BridgeConstructiveElement", "", "outerBridgeConstruction",
                 false},
    GmlChildKind{"Bridge BridgePart", "BridgeInstallation", "", "outerBridgeInstallation", false},
    GmlChildKind{"Bridge BridgePart", "BridgeRoom", "", "interiorBridgeRoom", true},
    GmlChildKind{"Bridge BridgePart", "BridgePart", "", "consistsOfBridgePart", true},
    GmlChildKind{"BridgeRoom", "BridgeFurniture", "", "interiorFurniture", true},
    GmlChildKind{"BridgeRoom", "BridgeInstallation", "IntBridgeInstallation",
                 "bridgeRoomInstallation", true},
    GmlChildKind{"Tunnel TunnelPart", "TunnelInstallation", "", "outerTunnelInstallation", false},
    GmlChildKind{"Tunnel TunnelPart", "TunnelHollowSpace", "", "interiorHollowSpace", true},
    GmlChildKind{"Tunnel TunnelPart", "TunnelPart", "", "consistsOfTunnelPart", true},
    GmlChildKind{"TunnelHollowSpace", "TunnelFurniture", "", "interiorFurniture", true},
    GmlChildKind{"TunnelHollowSpace", "TunnelInstallation", "IntTunnelInstallation",
                 "hollowSpaceInstallation", true},
};

constexpr std::array kNamespaces{
    GmlNamespace{"xmlns:core", "http://www.opengis.net/citygml/2.0"},
    GmlNamespace{"xmlns:bldg", "http://www.opengis.net/citygml/building/2.0"},
    GmlNamespace{"xmlns:brid", "http://www.opengis.net/citygml/bridge/2.0"},
    GmlNamespace{"xmlns:tun", "http://www.opengis.net/citygml/tunnel/2.0"},
    GmlNamespace{"xmlns:tran", "http://www.opengis.net/citygml/transportation/2.0"},
    GmlNamespace{"xmlns:wtr", "http://www.opengis.net/citygml/waterbody/2.0"},
    GmlNamespace{"xmlns:luse", "http://www.opengis.net/citygml/landuse/2.0"},
    GmlNamespace{"xmlns:veg", "http://www.opengis.net/citygml/vegetation/2.0"},
    GmlNamespace{"xmlns:dem", "http://www.opengis.net/citygml/relief/2.0"},
    GmlNamespace{"xmlns:frn", "http://www.opengis.net/citygml/cityfurniture/2.0"},
    GmlNamespace{"xmlns:grp", "http://www.opengis.net/citygml/cityobjectgroup/2.0"},
    GmlNamespace{"xmlns:gen", "http://www.opengis.net/citygml/generics/2.0"},
    GmlNamespace{"xmlns:app", "http://www.opengis.net/citygml/appearance/2.0"},
    GmlNamespace{"xmlns:gml", "http://www.opengis.net/gml"},
    GmlNamespace{"xmlns:xlink", "http://www.w3.org/1999/xlink"},
    GmlNamespace{"xmlns:xAL", "urn:oasis:names:tc:ciq:xsdschema:xAL:2.0"},
};

}  // namespace

bool has_word(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    if (take_word(list) == word) return true;
  }
  return false;
}

const GmlObjectKind& gml_object_kind(std::string_view type) {
  const auto* const found = std::find_if(
      kKinds.begin(), kKinds.end(), [&](const GmlObjectKind& kind) { return kind.type == type; });
  return found == kKinds.end() ? kKinds.front() : *found;
}

const GmlSurfaceKind* gml_surface_kind(std::string_view prefix, std::string_view type) {
  const auto* const found =
      std::find_if(kSurfaceKinds.begin(), kSurfaceKinds.end(), [&](const GmlSurfaceKind& kind) {
        return kind.type == type && has_word(kind.prefixes, prefix);
      });
  return found == kSurfaceKinds.end() ? nullptr : found;
}

std::span<const GmlChildKind> gml_child_kinds() { return kChildKinds; }

std::span<const GmlNamespace> gml_namespaces() { return kNamespaces; }

}  // namespace watertight::formats
