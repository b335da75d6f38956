#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares GML documents with the CityJSON that `watertight convert` makes of them.

    compare_gml_city.py WATERTIGHT FILE...      one line for each file; exit status 1 for a difference
    compare_gml_city.py --self-test WATERTIGHT FILE   damages the CityJSON; every damage must be found

The XML is read with Python's own parser and mapped with the tables of this script. Compared are, for
each city object: type, id, children, attributes (names, values, spelling of numbers, units), addresses,
geometries (type, LoD, every ring with its coordinates as decimals), semantics (surfaces by type, id,
attributes, facets), materials and textures. Each text and each attribute of the XML that is not in the
CityJSON must be in the list "not mapped: ..." of `convert`. The CityJSON itself is checked as cjval
does: indices in range, parents and children agree, semantics have the shape of the boundaries.
"""
import collections
import json
import re
import subprocess
import sys
import tempfile
from decimal import Decimal

from gml_source import (COORDINATES, GENERIC, GML, HREF, OBJECTS, SAID_OTHERWISE, STATED, SURFACES,
                        CURVES, POINTS, Document, Line, gml_id, is_geometry, is_gml, local, positions_of,
                        space, text_of)


class Number(str):
    """A number of the CityJSON with its spelling."""


def leaves(value):
    """The texts in a JSON value, without keys."""
    if isinstance(value, dict):
        return [leaf for member in value.values() for leaf in leaves(member)]
    if isinstance(value, list):
        return [leaf for member in value for leaf in leaves(member)]
    if value is None:
        return []
    if isinstance(value, bool):
        return ["true" if value else "false"]
    return [str(value)]


class Comparison:
    def __init__(self, path, city, messages):
        self.document = Document(path)
        self.city = city
        self.objects = city["CityObjects"]
        self.messages = messages
        self.losses = dict((m.group(1), int(m.group(2))) for m in
                           re.finditer(r"not mapped: (.*) \((\d+) times?\)", messages))
        self.is_swapped = "written as longitude, latitude" in messages
        self.is_rounded = "rounded to the finest grid" in messages
        scale = [Decimal(x) for x in city["transform"]["scale"]]
        shift = [Decimal(x) for x in city["transform"]["translate"]]
        self.vertices = [tuple(Decimal(v[i]) * scale[i] + shift[i] for i in range(3))
                         for v in city["vertices"]]
        self.steps = scale
        self.differences = []
        self.counts = collections.Counter()

    def differ(self, what, *values):
        self.differences.append(what + ": " + " | ".join(str(value)[:200] for value in values))

    def is_listed(self, element):
        """Whether the element, or one around it, is in the list of losses."""
        e = element
        while e is not None:
            path = [local(e.tag)]
            up = self.document.parent.get(e)
            while up is not None:
                path.insert(0, local(up.tag))
                if local(up.tag)[0].isupper():
                    break
                up = self.document.parent.get(up)
            held = [local(child.tag) for child in e]
            if len(held) == 1 and held[0][0].isupper() and not is_gml(e[0]) and path[-1][0].islower():
                path.append(held[0])
            if "/".join(path) in self.losses:
                return True
            e = self.document.parent.get(e)
        return False

    # --- objects ---

    def run(self):
        self.match_objects()
        self.find_surfaces()
        for element, key in self.key_of.items():
            self.compare_object(element, self.objects[key])
        self.compare_every_text()
        self.compare_appearance()
        self.check_city_json()
        return self.differences

    def match_objects(self):
        self.key_of = {}
        used = set()
        nameless = []
        for element in self.document.objects:
            key = gml_id(element)
            if key and key in self.objects and key not in used:
                self.key_of[element] = key
                used.add(key)
            else:
                nameless.append(element)
        rest = [key for key in self.objects if key not in used]
        if nameless and "ids made up" not in self.messages:
            self.differ("objects without their id", [local(e.tag) for e in nameless])
        if len(rest) != len(nameless):
            self.differ("number of objects", len(self.document.objects), len(self.objects))
        for element, key in zip(nameless, rest):
            self.key_of[element] = key
        self.counts["objects"] = len(self.document.objects)

    def compare_object(self, element, city):
        name = f"{local(element.tag)} {gml_id(element)}"
        kind = self.document.type_of(element)
        if city["type"] != kind:
            self.differ("type of " + name, kind, city["type"])
        if local(element.tag) not in OBJECTS and \
                f"written as GenericCityObject: {local(element.tag)}" not in self.messages:
            self.differ("a GenericCityObject that is not listed", name)
        owner = self.document.owner(element)
        is_child = kind not in ("GenericCityObject", "TINRelief") and owner is not None
        if is_child and self.key_of[element] not in self.objects[self.key_of[owner]].get("children", []):
            self.differ("not a child of its parent", name)
        self.counts["children"] += is_child
        self.compare_attributes(element, city.get("attributes", {}), name)
        self.compare_addresses(element, city.get("address", []), name)
        self.compare_geometry(element, city, name)

    # --- attributes ---

    def properties(self, element):
        """The properties that must be attributes: (plain by name, generics)."""
        plain = collections.OrderedDict()
        generics = []
        for prop in ([] if is_geometry(element) else element):
            name = local(prop.tag)
            inner = [local(child.tag) for child in prop]
            if self.document.geometry(prop) is not None or name == "address" and inner:
                continue
            if name == "boundedBy" and inner == ["Envelope"] or name in ("appearance", "groupMember"):
                continue
            if self.is_listed(prop) or any(self.document.type_of(c) or local(c.tag) in SURFACES
                                           for c in prop):
                continue
            if GENERIC.match(name) or name in ("genericAttributeSet", "genericAttribute"):
                generics.append(prop)
                continue
            target = self.document.by_id.get(prop.attrib.get(HREF, "#")[1:], [None])[0]
            if not inner and target is not None and self.document.type_of(target) and \
                    self.document.type_of(target) not in ("GenericCityObject",):
                continue
            plain.setdefault(name, []).append(prop)
        return plain, generics

    def expected_leaves(self, prop):
        """The texts of a property and of what it holds; the names of the objects in it."""
        found = []
        for element in prop.iter():
            if element is not prop and local(element.tag)[0].isupper() and len(element):
                found.append(local(element.tag))
            for key, value in element.attrib.items():
                if "XMLSchema-instance" not in key and (space(key) != space(HREF) or key == HREF):
                    found.append(value)
            if not len(element) and (text_of(element) or HREF not in element.attrib):
                words = text_of(element)
                if local(element.tag).startswith("storeyHeights"):
                    found += words.split()
                else:
                    found.append(words)
        return found

    def compare_attributes(self, element, attributes, name):
        plain, generics = self.properties(element)
        for prop_name, group in plain.items():
            expected = sorted(leaf for prop in group for leaf in self.expected_leaves(prop))
            keys = [prop_name] + sorted({f"{prop_name}_{local(k)}" for p in group for k in p.attrib})
            own = sorted(leaf for key in keys for leaf in leaves(attributes.get(key)))
            if expected != own:
                self.differ(f"attribute {prop_name} of {name}", expected, own)
            if "uom" in group[0].attrib and not isinstance(flat(attributes.get(prop_name)), Number):
                self.differ(f"attribute {prop_name} of {name} is no number", attributes.get(prop_name))
            self.counts["attributes"] += len(group)
        self.compare_generics(generics, attributes, name)
        relief = self.document.parent.get(self.document.parent.get(element))
        if relief is not None and local(relief.tag) == "ReliefFeature":
            own = sorted(leaves(attributes.get("ReliefFeature")))
            expected = sorted([gml_id(relief)] + [text_of(p) for p in relief if not len(p)])
            if own != expected:
                self.differ(f"ReliefFeature of {name}", expected, own)

    def compare_generics(self, generics, attributes, name):
        expected = collections.OrderedDict()
        for prop in generics:
            for generic in (list(prop) if local(prop.tag) == "genericAttribute" else [prop]):
                key, kind, value = self.generic(generic)
                expected.setdefault(key, []).append((kind, value))
                self.counts["generic attributes"] += 1
        for key, values in expected.items():
            own = attributes.get("generic:" + key, attributes.get(key))
            own = own if len(values) > 1 else [own]
            if own is None or len(own) != len(values):
                self.differ(f"generic attribute {key} of {name}", values, own)
                continue
            for (kind, value), json_value in zip(values, own):
                if plain_json(json_value) != plain_json(value) or type(json_value) is not type(value):
                    self.differ(f"generic attribute {key} of {name}", value, json_value)
                if kind in ("date", "uri") and attributes.get(key + "_type") != kind:
                    self.differ(f"type of generic attribute {key} of {name}", kind)

    def generic(self, element):
        child = {local(c.tag): c for c in element}
        key = element.attrib.get("name") or text_of(child["name"])
        kind = local(element.tag).lower().replace("attribute", "")
        if kind == "genericset":
            values = {}
            for member in element:
                for own in (list(member) if local(member.tag) == "genericAttribute" else [member]):
                    if local(own.tag) != "name":
                        values[self.generic(own)[0]] = self.generic(own)[2]
            return key, kind, values
        value = text_of(child["value"])
        is_number = kind in ("int", "double", "measure") and \
            re.fullmatch(r"-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?", value)
        value = Number(value) if is_number else value
        uom = child["value"].attrib.get("uom")
        return key, kind, {"value": value, "uom": uom} if uom is not None else value

    def compare_addresses(self, element, addresses, name):
        elements = [e for prop in element if local(prop.tag) == "address" for e in prop]
        if len(elements) != len(addresses):
            self.differ(f"addresses of {name}", len(elements), len(addresses))
        for own, address in zip(elements, addresses):
            expected = []
            points = 0

            def visit(part):
                nonlocal points
                if local(part.tag) == "multiPoint":
                    points += len(positions_of(part))
                    return
                expected.extend(part.attrib.values())
                if text_of(part):
                    expected.append(text_of(part))
                for child in part:
                    visit(child)
            visit(own)
            location = address.pop("location", {"boundaries": []})
            if sorted(expected) != sorted(leaves(address)):
                self.differ(f"address of {name}", sorted(expected), sorted(leaves(address)))
            if points != len(location["boundaries"]):
                self.differ(f"location of the address of {name}", points, location)
            self.counts["addresses"] += 1

    # --- geometry and semantics ---

    def ring_key(self, positions):
        key = []
        for p in positions:
            p = (p[1], p[0], p[2]) if self.is_swapped else p
            if self.is_rounded:
                p = tuple((p[i] / self.steps[i]).to_integral_value(rounding="ROUND_HALF_UP") for i in range(3))
            else:
                p = tuple(x.normalize() for x in p)
            key.append(p)
        return tuple(key)

    def city_ring(self, indices):
        key = []
        for index in indices:
            v = self.vertices[index]
            key.append(tuple(v[i] / self.steps[i] for i in range(3)) if self.is_rounded
                       else tuple(x.normalize() for x in v))
        return tuple(key)

    def facets_of_city(self, geometry):
        """(rings, semantic surface or None) for each facet."""
        surfaces = geometry.get("semantics", {}).get("surfaces", [])
        depth = {"Solid": 2, "MultiSolid": 3, "CompositeSolid": 3}.get(geometry["type"], 1)

        def flatten(value, levels):
            return [value] if levels == 0 else [leaf for part in value for leaf in flatten(part, levels - 1)]
        facets = flatten(geometry["boundaries"], depth)
        values = flatten(geometry["semantics"]["values"], depth) if surfaces else [None] * len(facets)
        return [(tuple(self.city_ring(ring) for ring in facet), None if value is None else surfaces[int(value)])
                for facet, value in zip(facets, values)]

    def find_surfaces(self):
        """The type and id of the thematic surface of each polygon; the first counts."""
        self.surface_of = {}
        for element in self.document.objects:
            for surface in self.surfaces_of(element):
                for prop in surface:
                    geometry = self.document.geometry(prop)
                    for polygon, _ in [] if geometry is None else self.document.polygons(geometry):
                        self.surface_of.setdefault(
                            polygon, (SURFACES[local(surface.tag)], gml_id(surface)))

    def surfaces_of(self, element):
        """The thematic surfaces of an object with their openings, in order."""
        for prop in element:
            for child in prop:
                if local(child.tag) in SURFACES and not is_gml(child):
                    yield child
                    yield from self.surfaces_of(child)

    def lod_of(self, prop, element):
        found = re.match("lod([0-9])", local(prop.tag))
        if found:
            return found.group(1)
        stated = [text_of(child) for child in element if local(child.tag) == "lod"]
        return stated[0] if stated else "1"

    def compare_geometry(self, element, city, name):
        expected = collections.Counter()   # (type, LoD, facets as rings)
        own_polygons = set()
        semantics = collections.Counter()  # (LoD, type of surface, id, rings)
        stated = collections.Counter()
        for prop in ([element] if is_geometry(element) else element):
            geometry = element if is_geometry(element) else self.document.geometry(prop)
            if geometry is None or self.is_listed(prop):
                continue
            lod = self.lod_of(prop, element)
            for kind, facets in self.geometries(geometry):
                keys = []
                for polygon, reverse in facets:
                    own_polygons.add((lod, polygon))
                    if polygon in self.surface_of:
                        semantics[(lod,) + self.surface_of[polygon]] += 1
                    rings = self.document.rings(polygon, reverse)
                    keys.append(tuple(self.ring_key(r) for r in rings))
                    if local(prop.tag) in STATED:
                        stated[(lod, STATED[local(prop.tag)], "", keys[-1])] += 1
                expected[(kind, lod, tuple(keys))] += 1
                self.counts["geometries"] += 1
        rest = collections.defaultdict(list)
        surfaces = list(self.surfaces_of(element))
        for surface in surfaces:
            for prop in surface:
                geometry = self.document.geometry(prop)
                if geometry is None:
                    continue
                lod = self.lod_of(prop, surface)
                for polygon, reverse in self.document.polygons(geometry):
                    rings = tuple(self.ring_key(r) for r in self.document.rings(polygon, reverse))
                    if (lod, polygon) not in own_polygons:
                        rest[lod].append(rings)
                        semantics[(lod,) + self.surface_of[polygon]] += 1
        for lod, facets in rest.items():
            expected[("MultiSurface", lod, tuple(facets))] += 1
        own = collections.Counter()
        own_semantics = collections.Counter()
        own_stated = collections.Counter()
        seen = {}
        for geometry in city.get("geometry", []):
            if geometry["type"] in ("MultiPoint", "MultiLineString"):
                lines = geometry["boundaries"]
                lines = [lines] if geometry["type"] == "MultiPoint" else lines
                own[(geometry["type"], geometry["lod"], tuple((self.city_ring(line),) for line in lines))] += 1
                continue
            facets = self.facets_of_city(geometry)
            own[(geometry["type"], geometry["lod"], tuple(rings for rings, _ in facets))] += 1
            for rings, surface in facets:
                if surface is None:
                    continue
                if (geometry["lod"], surface["type"], "", rings) in stated:
                    own_stated[(geometry["lod"], surface["type"], "", rings)] += 1
                    continue
                own_semantics[(geometry["lod"], surface["type"], surface.get("id", ""))] += 1
            for surface in geometry.get("semantics", {}).get("surfaces", []):
                seen.setdefault((surface["type"], surface.get("id", "")), []).append((surface, geometry))
        if expected != own:
            self.differ("geometry of " + name,
                        [(k[0], k[1], len(k[2])) for k in (expected - own)],
                        [(k[0], k[1], len(k[2])) for k in (own - expected)])
        if semantics != own_semantics:
            self.differ("semantics of " + name, semantics - own_semantics, own_semantics - semantics)
        if stated != own_stated:
            self.differ("footprint or roof edge of " + name, stated - own_stated)
        self.compare_surfaces(surfaces, seen, name)

    def compare_surfaces(self, surfaces, seen, name):
        for surface in surfaces:
            self.counts["surfaces"] += 1
            key = (SURFACES[local(surface.tag)], gml_id(surface))
            if key not in seen:
                if not self.is_listed(surface) and not self.is_listed(self.document.parent[surface]):
                    self.differ(f"surface of {name} is missing", key)
                continue
            parent = self.document.parent[self.document.parent[surface]]
            if local(parent.tag) in SURFACES:
                for own, geometry in seen[key]:
                    others = geometry["semantics"]["surfaces"]
                    if others[int(own["parent"])].get("id", "") != gml_id(parent):
                        self.differ(f"parent of an opening of {name}", key)
            if not gml_id(surface):
                continue  # attributes of surfaces without id: compare_every_text()
            for own, _ in seen[key]:
                members = {k: v for k, v in own.items() if k not in ("type", "id", "parent", "children")}
                self.compare_attributes(surface, members, f"{key} of {name}")

    def geometries(self, element):
        """(type, facets) for each geometry of CityJSON that an element becomes."""
        name = local(element.tag)
        if name in CURVES or name in POINTS:
            lines = [positions_of(e) for e in element.iter()
                     if local(e.tag) in ("LineString", "LineStringSegment", "Point")]
            kind = "MultiPoint" if name in POINTS else "MultiLineString"
            lines = [[p for line in lines for p in line]] if name in POINTS else lines
            yield kind, [(Line(line), False) for line in lines]
        elif name in ("MultiSolid", "MultiGeometry"):
            nested = [v for _, v in self.document.members(element) if local(v.tag) == "CompositeSolid"]
            plain = [f for _, v in self.document.members(element) if v not in nested
                     for f in self.document.polygons(v)]
            if plain:
                yield "MultiSolid", plain
            for composite in nested:
                yield "CompositeSolid", list(self.document.polygons(composite))
        elif name in ("Solid", "CompositeSolid"):
            yield name, list(self.document.polygons(element))
        else:
            composite = name in ("CompositeSurface", "TriangulatedSurface", "Tin")
            yield "CompositeSurface" if composite else "MultiSurface", list(self.document.polygons(element))

    # --- all texts ---

    def compare_every_text(self):
        """Each text and attribute of the XML is in the CityJSON, or listed."""
        known = collections.Counter(leaves(self.city))
        for key in self.all_keys(self.city):
            known[key] += 1
        for element in self.document.root.iter():
            name = local(element.tag)
            text = text_of(element)
            if text and name not in COORDINATES and not self.is_known(element, text, known) \
                    and f"{name}/text()" not in self.losses and not self.is_listed(element):
                self.differ("text that is neither written nor listed", name, text)
            for key, value in element.attrib.items():
                if "XMLSchema-instance" in key or local(key) in SAID_OTHERWISE and not space(key):
                    continue
                if space(key) == space(HREF) and key != HREF or value in known:
                    continue
                target = value.lstrip("#")
                shape = key == HREF and any(is_geometry(e) for e in self.document.by_id.get(target, []))
                child = key == HREF and target in known
                texture = local(key) in ("ring", "uri") and "Coord" in "".join(
                    local(e.tag) for e in element.iter())
                label = "gml:id" if local(key) == "id" and space(key) in GML else local(key)
                if not (shape or child or texture or f"{name}/@{label}" in self.losses or
                        self.is_listed(element)):
                    self.differ("attribute that is neither written nor listed", name, key, value)

    def is_known(self, element, text, known):
        if text in known or all(word in known for word in text.split()):
            return True
        if local(element.tag) in ("isMovable", "isSmooth"):
            return True
        # Targets and rings of appearance: compare_appearance().
        return text.startswith("#") and local(element.tag) in ("target", "ring") or \
            local(element.tag) in ("mimeType", "isFront")

    def all_keys(self, value):
        if isinstance(value, dict):
            for key, member in value.items():
                yield key
                yield from self.all_keys(member)
        elif isinstance(value, list):
            for member in value:
                yield from self.all_keys(member)

    # --- appearance ---

    def compare_appearance(self):
        expected = collections.Counter()
        for element in self.document.root.iter():
            name = local(element.tag)
            if name == "X3DMaterial":
                for target in element:
                    text = text_of(target)
                    if local(target.tag) == "target" and text[1:] in self.document.by_id:
                        expected["facets with material"] += sum(
                            1 for _ in self.document.polygons(self.document.by_id[text[1:]][0]))
            if name == "textureCoordinates":
                expected["rings with texture"] += 1
        own = collections.Counter()
        facets = set()
        rings = set()
        for object_id, city in self.objects.items():
            for geometry in city.get("geometry", []):
                boundaries = [r for r, _ in self.facets_of_city(geometry)] if \
                    geometry["type"] not in ("MultiPoint", "MultiLineString") else []
                depth = {"Solid": 2, "MultiSolid": 3, "CompositeSolid": 3}.get(geometry["type"], 1)

                def flatten(value, levels):
                    return [value] if levels == 0 else [x for part in value for x in flatten(part, levels - 1)]
                for theme, own_values in geometry.get("material", {}).items():
                    values = flatten(own_values["values"], depth)
                    if len(values) != len(boundaries):
                        self.differ("materials beside boundaries", object_id)
                    facets |= {(theme, object_id, b) for b, v in zip(boundaries, values) if v is not None}
                for theme, own_values in geometry.get("texture", {}).items():
                    values = flatten(own_values["values"], depth)
                    if len(values) != len(boundaries):
                        self.differ("textures beside boundaries", object_id)
                    for facet, value in zip(boundaries, values):
                        for ring, uv in zip(facet, value):
                            if uv[0] is not None:
                                if len(uv) != len(ring) + 1:
                                    self.differ("texture vertices of a ring", object_id)
                                rings.add((theme, object_id, ring))
        own["facets with material"] = len(facets)
        own["rings with texture"] = len(rings)
        lost = {"facets with material": ("X3DMaterial",),
                "rings with texture": ("TexCoordList", "textureCoordinates", "TextureAssociation")}
        for key in own:
            listed = sum(count for path, count in self.losses.items()
                         if any(word in path for word in lost[key]))
            if not expected[key] - listed <= own[key] <= expected[key]:
                self.differ(key, expected[key], own[key])
            self.counts[key] = own[key]

    # --- CityJSON itself ---

    def check_city_json(self):
        used = set()
        for key, city in self.objects.items():
            for child in city.get("children", []):
                if key not in self.objects.get(child, {}).get("parents", []):
                    self.differ("a child does not name its parent", key, child)
            for parent in city.get("parents", []):
                if key not in self.objects.get(parent, {}).get("children", []):
                    self.differ("a parent does not name its child", key, parent)
            for geometry in city.get("geometry", []):
                indices = [int(x) for x in leaves(geometry["boundaries"])]
                used |= set(indices)
                if any(i < 0 or i >= len(self.vertices) for i in indices):
                    self.differ("index out of range", key)
                self.check_semantics(key, geometry)
            if city["type"] in ("BuildingPart", "BuildingInstallation", "BuildingRoom", "BridgePart",
                                "TunnelPart") and not city.get("parents"):
                self.differ("an object that needs a parent has none", key)

    def check_semantics(self, key, geometry):
        semantics = geometry.get("semantics")
        if semantics is None:
            return

        def fits(values, boundaries, depth):
            if depth == 0:
                return values is None or 0 <= int(values) < len(semantics["surfaces"])
            return len(values) == len(boundaries) and \
                all(fits(v, b, depth - 1) for v, b in zip(values, boundaries))
        depth = {"Solid": 2, "MultiSolid": 3, "CompositeSolid": 3}.get(geometry["type"], 1)
        if not fits(semantics["values"], geometry["boundaries"], depth):
            self.differ("semantics have another shape than the boundaries", key)
        for number, surface in enumerate(semantics["surfaces"]):
            for child in surface.get("children", []):
                if int(semantics["surfaces"][int(child)].get("parent", -1)) != number:
                    self.differ("semantic surfaces disagree about parent and child", key)


def flat(value):
    while isinstance(value, list):
        value = value[0] if value else None
    return value


def plain_json(value):
    return json.dumps(value, sort_keys=True)


def convert(program, path):
    with tempfile.NamedTemporaryFile(suffix=".city.json") as output:
        done = subprocess.run([program, "convert", path, "-o", output.name], capture_output=True, text=True)
        if done.returncode != 0:
            return None, done.stderr
        with open(output.name, encoding="utf-8") as file:
            return json.load(file, parse_int=Number, parse_float=Number), done.stderr


def normalize(city):
    """Indices as numbers; other numbers keep their spelling."""
    def to_int(value):
        return [to_int(v) for v in value] if isinstance(value, list) else \
            int(value) if isinstance(value, Number) else value
    for item in city["CityObjects"].values():
        for geometry in item.get("geometry", []):
            geometry["boundaries"] = to_int(geometry["boundaries"])
    return city


def compare(program, path):
    city, messages = convert(program, path)
    if city is None:
        return None, [messages.strip()], collections.Counter()
    comparison = Comparison(path, normalize(city), messages)
    return comparison, comparison.run(), comparison.counts


def self_test(program, path):
    """Every damage to the CityJSON or to the list must be found."""
    def damages(city):
        objects = city["CityObjects"]
        first = next(o for o in objects.values() if o.get("attributes") and o.get("geometry"))
        yield "type", lambda: first.__setitem__("type", "Bridge")
        yield "attribute", lambda: first["attributes"].popitem()
        yield "LoD", lambda: first["geometry"][0].__setitem__("lod", "9")
        yield "geometry", lambda: first["geometry"].pop()
        yield "object", lambda: objects.popitem()
        yield "vertex", lambda: city["vertices"][0].__setitem__(0, Number("1"))
        for item in objects.values():
            for geometry in item.get("geometry", []):
                if "semantics" in geometry:
                    yield "semantics", lambda: geometry.pop("semantics")
                    yield "surface", lambda: geometry["semantics"]["surfaces"][0].__setitem__("type", "Window")
                    return
    number = 0
    while True:
        city, messages = convert(program, path)
        choice = list(damages(normalize(city)))
        if number == len(choice):
            break
        name, damage = choice[number]
        damage()
        try:
            found = Comparison(path, city, messages).run()
        except (IndexError, KeyError, TypeError, ValueError) as error:
            found = [repr(error)]
        print(f"{name}: {'found' if found else 'NOT FOUND'}")
        if not found:
            return 1
        number += 1
    city, _ = convert(program, path)
    silent = Comparison(path, normalize(city), "").run()
    print(f"list of losses: {'needed' if silent else 'not needed'}")
    return 0


def main():
    arguments = sys.argv[1:]
    if arguments and arguments[0] == "--self-test":
        return self_test(arguments[1], arguments[2])
    program, files = arguments[0], arguments[1:]
    failed = 0
    for path in files:
        comparison, differences, counts = compare(program, path)
        if comparison is None:
            print(f"{path}: refused: {differences[0]}")
            continue
        listed = sum(comparison.losses.values())
        said = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
        print(f"{path}: {said}; {listed} listed; {len(differences)} differences")
        for difference in differences[:10]:
            print("    " + difference)
        failed += bool(differences)
    if not files:
        print("no files")
        return 1
    print(f"{len(files)} files, {failed} with differences")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
