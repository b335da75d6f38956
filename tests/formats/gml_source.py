# SPDX-License-Identifier: GPL-3.0-or-later
"""A GML document read with Python's own parser: its objects, geometries and thematic surfaces, and the
types that CityJSON has for them, from tables of its own."""
import re
import xml.etree.ElementTree as ElementTree
from decimal import Decimal

GML = ("http://www.opengis.net/gml", "http://www.opengis.net/gml/3.2")
HREF = "{http://www.w3.org/1999/xlink}href"

SAME = """Building BuildingPart BuildingInstallation BuildingConstructiveElement BuildingFurniture
BuildingRoom BuildingUnit Bridge BridgePart BridgeInstallation BridgeConstructiveElement BridgeFurniture
BridgeRoom Tunnel TunnelPart TunnelInstallation TunnelConstructiveElement TunnelFurniture
OtherConstruction Road Railway Waterway WaterBody LandUse PlantCover SolitaryVegetationObject TINRelief
CityFurniture GenericCityObject CityObjectGroup""".split()
OBJECTS = {name: name for name in SAME} | {
    "IntBuildingInstallation": "BuildingInstallation", "Room": "BuildingRoom",
    "Storey": "BuildingStorey", "IntBridgeInstallation": "BridgeInstallation",
    "BridgeConstructionElement": "BridgeConstructiveElement",
    "IntTunnelInstallation": "TunnelInstallation", "HollowSpace": "TunnelHollowSpace",
    "Square": "TransportSquare"}
SURFACES = {name: name for name in """RoofSurface GroundSurface WallSurface ClosureSurface
OuterCeilingSurface OuterFloorSurface InteriorWallSurface CeilingSurface FloorSurface Window Door
WaterSurface WaterGroundSurface WaterClosureSurface TrafficArea AuxiliaryTrafficArea
TransportationMarking TransportationHole""".split()} | {"WindowSurface": "Window", "DoorSurface": "Door"}
STATED = {"lod0FootPrint": "GroundSurface", "lod0RoofEdge": "RoofSurface"}
GENERIC = re.compile("^(string|int|double|date|uri|measure)Attribute$")
POLYGONS = ("Polygon", "PolygonPatch", "Triangle", "Rectangle")
SURFACE_SETS = ("MultiSurface", "CompositeSurface", "Surface", "PolyhedralSurface", "Shell",
                "TriangulatedSurface", "Tin", "OrientableSurface")
CURVES = ("LineString", "Curve", "MultiCurve", "CompositeCurve", "MultiLineString")
POINTS = ("Point", "MultiPoint")
SOLIDS = ("Solid", "MultiSolid", "CompositeSolid", "MultiGeometry")
GEOMETRY = POLYGONS + SURFACE_SETS + CURVES + POINTS + SOLIDS
COORDINATES = ("pos", "posList", "coordinates", "lowerCorner", "upperCorner", "textureCoordinates")
SAID_OTHERWISE = ("srsName", "srsDimension", "orientation", "axisLabels", "uomLabels", "decimal", "cs",
                  "ts")


def local(name):
    return name.rsplit("}", 1)[-1]


def space(name):
    return name[1:].split("}")[0] if name.startswith("{") else ""


def is_gml(element):
    return space(element.tag) in GML


def text_of(element):
    return (element.text or "").strip()


def gml_id(element):
    for gml in GML:
        if f"{{{gml}}}id" in element.attrib:
            return element.attrib[f"{{{gml}}}id"]
    return ""


def is_geometry(element):
    return is_gml(element) and local(element.tag) in GEOMETRY


class Document:
    """The XML and what each of its objects has to become."""

    def __init__(self, path):
        self.root = ElementTree.parse(path).getroot()
        self.parent = {child: element for element in self.root.iter() for child in element}
        self.by_id = {}
        for element in self.root.iter():
            if gml_id(element):
                self.by_id.setdefault(gml_id(element), []).append(element)
        self.objects = [element for element in self.root.iter() if self.type_of(element)]

    def type_of(self, element):
        name = local(element.tag)
        if is_gml(element) and name in SOLIDS:
            return "GenericCityObject" if self.is_alone(element) else ""
        if is_gml(element) or not name[0].isupper() or name == "Geometry3D":
            return ""
        if name in OBJECTS:
            return OBJECTS[name]
        if name in SURFACES or name in ("ImplicitGeometry", "Address", "ReliefFeature"):
            return ""
        return "GenericCityObject" if any(self.geometry(child) is not None for child in element) else ""

    def is_alone(self, element):
        """Whether a solid stands in a collection of objects, and in no object."""
        while element in self.parent:
            element = self.parent[element]
            if local(element.tag)[0].isupper() and local(element.tag) != "CityModel":
                return False
        return True

    def geometry(self, prop):
        """The geometry element that a property holds or refers to."""
        if len(prop) and is_geometry(prop[0]):
            return prop[0]
        if len(prop) and local(prop[0].tag) == "Geometry3D" and len(prop[0]):
            return prop[0][0]
        href = prop.attrib.get(HREF, "")
        if not len(prop) and href.startswith("#") and re.match("lod[0-9]|.*[gG]eometry$", local(prop.tag)):
            targets = [e for e in self.by_id.get(href[1:], []) if is_geometry(e)]
            return targets[0] if targets else None
        return None

    def owner(self, element):
        while element in self.parent:
            element = self.parent[element]
            if self.type_of(element):
                return element
        return None

    def members(self, element):
        """The values of an element's properties, with references followed."""
        for prop in element:
            href = prop.attrib.get(HREF, "")
            if href.startswith("#"):
                yield prop, [e for e in self.by_id[href[1:]] if is_geometry(e)][0]
            for value in prop:
                yield prop, value

    def polygons(self, element, reverse=False):
        """(polygon, is it reversed) for each facet, in order."""
        name = local(element.tag)
        if name in POLYGONS:
            yield element, reverse
            return
        if name == "OrientableSurface" and element.attrib.get("orientation") == "-":
            reverse = not reverse
        for prop, value in sorted(self.members(element), key=lambda pair: local(pair[0].tag) == "interior"):
            yield from self.polygons(value, reverse)

    def rings(self, polygon, reverse):
        if isinstance(polygon, Line):
            return [list(polygon)]
        found = []
        for prop, ring in self.members(polygon):
            positions = positions_of(ring)
            if len(positions) > 1 and positions[0] == positions[-1]:
                positions.pop()
            if reverse:
                positions[1:] = positions[:0:-1]
            found.append((local(prop.tag) in ("interior", "innerBoundaryIs"), positions))
        return [positions for _, positions in sorted(found, key=lambda pair: pair[0])]


def positions_of(element):
    numbers = []
    for child in element.iter():
        if local(child.tag) in ("pos", "posList"):
            numbers += [Decimal(word) for word in (child.text or "").split()]
        elif local(child.tag) == "coordinates":
            text = (child.text or "").strip()
            for sign, usual, plain in (("ts", " ", " "), ("cs", ",", " "), ("decimal", ".", ".")):
                text = text.replace(child.attrib.get(sign, usual), plain)
            numbers += [Decimal(word) for word in text.split()]
    return [tuple(numbers[i:i + 3]) for i in range(0, len(numbers), 3)]


class Line(list):
    """A line or points, in place of a polygon."""
    tag = "Line"

    def __hash__(self):
        return id(self)
