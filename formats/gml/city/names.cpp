// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/city/names.h"

#include <algorithm>
#include <array>

namespace watertight::formats {
namespace {

struct Renamed {
  std::string_view element;
  std::string_view type;
};

constexpr std::array kObjects{
    Renamed{"Building", "Building"},
    Renamed{"BuildingPart", "BuildingPart"},
    Renamed{"BuildingInstallation", "BuildingInstallation"},
    Renamed{"IntBuildingInstallation", "BuildingInstallation"},
    Renamed{"BuildingConstructiveElement", "BuildingConstructiveElement"},
    Renamed{"BuildingFurniture", "BuildingFurniture"},
    Renamed{"BuildingRoom", "BuildingRoom"},
    Renamed{"Room", "BuildingRoom"},
    Renamed{"BuildingUnit", "BuildingUnit"},
    Renamed{"Storey", "BuildingStorey"},
    Renamed{"Bridge", "Bridge"},
    Renamed{"BridgePart", "BridgePart"},
    Renamed{"BridgeInstallation", "BridgeInstallation"},
    Renamed{"IntBridgeInstallation", "BridgeInstallation"},
    Renamed{"BridgeConstructionElement", "BridgeConstructiveElement"},
    Renamed{"BridgeConstructiveElement", "BridgeConstructiveElement"},
    Renamed{"BridgeFurniture", "BridgeFurniture"},
    Renamed{"BridgeRoom", "BridgeRoom"},
    Renamed{"Tunnel", "Tunnel"},
    Renamed{"TunnelPart", "TunnelPart"},
    Renamed{"TunnelInstallation", "TunnelInstallation"},
    Renamed{"IntTunnelInstallation", "TunnelInstallation"},
    Renamed{"TunnelConstructiveElement", "TunnelConstructiveElement"},
    Renamed{"TunnelFurniture", "TunnelFurniture"},
    Renamed{"HollowSpace", "TunnelHollowSpace"},
    Renamed{"OtherConstruction", "OtherConstruction"},
    Renamed{"Road", "Road"},
    Renamed{"Railway", "Railway"},
    Renamed{"Square", "TransportSquare"},
    Renamed{"Waterway", "Waterway"},
    Renamed{"WaterBody", "WaterBody"},
    Renamed{"LandUse", "LandUse"},
    Renamed{"PlantCover", "PlantCover"},
    Renamed{"SolitaryVegetationObject", "SolitaryVegetationObject"},
    Renamed{"TINRelief", "TINRelief"},
    Renamed{"CityFurniture", "CityFurniture"},
    Renamed{"GenericCityObject", "GenericCityObject"},
    Renamed{"CityObjectGroup", "CityObjectGroup"},
};

constexpr std::array kSurfaces{
    Renamed{"RoofSurface", "RoofSurface"},
    Renamed{"GroundSurface", "GroundSurface"},
    Renamed{"WallSurface", "WallSurface"},
    Renamed{"ClosureSurface", "ClosureSurface"},
    Renamed{"OuterCeilingSurface", "OuterCeilingSurface"},
    Renamed{"OuterFloorSurface", "OuterFloorSurface"},
    Renamed{"InteriorWallSurface", "InteriorWallSurface"},
    Renamed{"CeilingSurface", "CeilingSurface"},
    Renamed{"FloorSurface", "FloorSurface"},
    Renamed{"Window", "Window"},
    Renamed{"WindowSurface", "Window"},
    Renamed{"Door", "Door"},
    Renamed{"DoorSurface", "Door"},
    Renamed{"WaterSurface", "WaterSurface"},
    Renamed{"WaterGroundSurface", "WaterGroundSurface"},
    Renamed{"WaterClosureSurface", "WaterClosureSurface"},
    Renamed{"TrafficArea", "TrafficArea"},
    Renamed{"AuxiliaryTrafficArea", "AuxiliaryTrafficArea"},
    Renamed{"TransportationMarking", "TransportationMarking"},
    Renamed{"TransportationHole", "TransportationHole"},
};

template <std::size_t kSize>
std::string_view type_in(const std::array<Renamed, kSize>& list, std::string_view element) {
  const auto* const found = std::find_if(
      list.begin(), list.end(), [&](const Renamed& known) { return known.element == element; });
  return found == list.end() ? std::string_view() : found->type;
}

template <std::size_t kSize>
bool contains(const std::array<std::string_view, kSize>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 11> kNumbers{"measuredHeight",
                                                    "storeysAboveGround",
                                                    "storeysBelowGround",
                                                    "yearOfConstruction",
                                                    "yearOfDemolition",
                                                    "storeyHeightsAboveGround",
                                                    "averageHeight",
                                                    "storeyHeightsBelowGround",
                                                    "trunkDiameter",
                                                    "crownDiameter",
                                                    "lod"};
constexpr std::array<std::string_view, 2> kLists{"storeyHeightsAboveGround",
                                                 "storeyHeightsBelowGround"};
constexpr std::array<std::string_view, 1> kBooleans{"isMovable"};

// The types of CityJSON that stand alone; all others need a parent.
constexpr std::array<std::string_view, 15> kFirstLevel{
    "Building",  "Bridge",        "Tunnel",          "OtherConstruction",
    "Road",      "Railway",       "TransportSquare", "Waterway",
    "WaterBody", "LandUse",       "PlantCover",      "SolitaryVegetationObject",
    "TINRelief", "CityFurniture", "CityObjectGroup"};

}  // namespace

std::string_view city_object_type(std::string_view element) { return type_in(kObjects, element); }

std::string_view semantic_surface_type(std::string_view element) {
  return type_in(kSurfaces, element);
}

std::string_view surface_type_of_property(std::string_view property) {
  if (property == "lod0FootPrint") return "GroundSurface";
  if (property == "lod0RoofEdge") return "RoofSurface";
  return {};
}

bool is_number_property(std::string_view property) { return contains(kNumbers, property); }
bool is_list_property(std::string_view property) { return contains(kLists, property); }
bool is_boolean_property(std::string_view property) { return contains(kBooleans, property); }

bool needs_parent(std::string_view type) {
  return !contains(kFirstLevel, type) && type != "GenericCityObject";
}

}  // namespace watertight::formats
