#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares city models exactly: coordinates as decimals of the source, everything else as JSON.

An independent reading of CityJSON and EWKB for the integration tests: it shares no code with the
program under test.
    city_models.py --self-test
"""
import json
import struct
import sys
from decimal import Decimal, getcontext

getcontext().prec = 60


def parse(text):
    """The parsed JSON text, with every number as the decimal that was written."""
    return json.loads(text, parse_float=Decimal, parse_int=Decimal)


def world(vertices, transform):
    """The exact world coordinates of vertices; they are that already without a transform."""
    if transform is None:
        return [tuple(Decimal(x).normalize() for x in v) for v in vertices]
    scale, translate = transform["scale"], transform["translate"]
    return [tuple((v[k] * scale[k] + translate[k]).normalize() for k in range(3)) for v in vertices]


def resolve(boundaries, points):
    """The nested boundaries, with each vertex index replaced by its point."""
    if isinstance(boundaries, list):
        return [resolve(part, points) for part in boundaries]
    return points[int(boundaries)]


def resolved_objects(document, header):
    """The city objects of a feature (or document), which do not depend on the numbers of its
    vertices."""
    transform = document.get("transform") or header.get("transform")
    points = world(document["vertices"], transform)
    objects = {}
    for name, value in document["CityObjects"].items():
        value = dict(value)
        value["geometry"] = [dict(geometry, boundaries=resolve(geometry["boundaries"], points))
                             for geometry in value.get("geometry", [])]
        objects[name] = value
    return objects


def difference(expected, actual, path=""):
    """The first place where two JSON values differ, or None. Numbers are compared by value."""
    if isinstance(expected, dict) and isinstance(actual, dict):
        for key in sorted(set(expected) | set(actual)):
            if key not in expected or key not in actual:
                return f"{path}/{key}: only in the {'answer' if key in actual else 'source'}"
            found = difference(expected[key], actual[key], f"{path}/{key}")
            if found:
                return found
        return None
    if isinstance(expected, (list, tuple)) and isinstance(actual, (list, tuple)):
        if len(expected) != len(actual):
            return f"{path}: {len(expected)} entries became {len(actual)}"
        for index, (a, b) in enumerate(zip(expected, actual)):
            found = difference(a, b, f"{path}/{index}")
            if found:
                return found
        return None
    if isinstance(expected, bool) != isinstance(actual, bool) or expected != actual:
        return f"{path}: {expected!r} became {actual!r}"
    return None


def solids_of(document, header):
    """For each (object, geometry index, ordinal) of a solid, its shells as sets of rings of
    doubles."""
    solids = {}
    for name, value in resolved_objects(document, header).items():
        for index, geometry in enumerate(value["geometry"]):
            if geometry["type"] == "Solid":
                members = [geometry["boundaries"]]
            elif geometry["type"] in ("MultiSolid", "CompositeSolid"):
                members = geometry["boundaries"]
            else:
                continue
            for ordinal, shells in enumerate(members):
                solids[(name, index, ordinal)] = canonical(
                    [facet for shell in shells for facet in shell])
    return solids


def canonical(facets):
    """The facets as a sorted list of rings that start at their smallest vertex."""
    result = []
    for rings in facets:
        turned = []
        for ring in rings:
            points = [tuple(float(x) + 0.0 for x in point) for point in ring]
            start = points.index(min(points))
            turned.append(tuple(points[start:] + points[:start]))
        result.append((turned[0], tuple(sorted(turned[1:]))))
    return sorted(result)


def read_ewkb(data):
    """Returns (facets, srid) of a POLYHEDRALSURFACE Z in (E)WKB."""
    position = 0

    def take(form):
        nonlocal position
        values = struct.unpack_from(form, data, position)
        position += struct.calcsize(form)
        return values

    def header():
        order = "<" if take("<B")[0] == 1 else ">"
        kind = take(order + "I")[0]
        srid = take(order + "I")[0] if kind & 0x20000000 else 0
        return order, (kind & 0x0FFFFFFF) % 1000, srid

    order, kind, srid = header()
    if kind != 15:
        raise ValueError(f"not a polyhedral surface but type {kind}")
    facets = []
    for _ in range(take(order + "I")[0]):
        order, kind, _ = header()
        if kind != 3:
            raise ValueError(f"not a polygon but type {kind}")
        rings = []
        for _ in range(take(order + "I")[0]):
            count = take(order + "I")[0]
            points = [take(order + "3d") for _ in range(count)]
            if points[0] != points[-1]:
                raise ValueError("a ring is not closed")
            rings.append(points[:-1])
        facets.append(rings)
    if position != len(data):
        raise ValueError("bytes after the end")
    return facets, srid


def self_test():
    header = parse('{"transform":{"scale":[0.001,0.001,0.001],"translate":[85000,0,0.5]}}')
    text = ('{"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","geometry":[{"type":'
            '"Solid","boundaries":[[[[0,1,2]],[[0,2,1]]]]}]}},"vertices":[[1,2,3],[4,5,6],[7,8,9]]}')
    renumbered = (text.replace("[[[[0,1,2]],[[0,2,1]]]]", "[[[[2,1,0]],[[2,0,1]]]]")
                  .replace("[[1,2,3],[4,5,6],[7,8,9]]", "[[7,8,9],[4,5,6],[1,2,3]]"))
    one = resolved_objects(parse(text), header)
    assert difference(one, resolved_objects(parse(renumbered), header)) is None
    moved = text.replace("[7,8,9]", "[7,8,10]")
    assert difference(one, resolved_objects(parse(moved), header)) is not None
    assert difference(one, resolved_objects(parse(text.replace("Building", "Bridge")), header)) is not None
    turned = text.replace("[[0,1,2]]", "[[1,2,0]]")
    solids = solids_of(parse(text), header)
    assert solids == solids_of(parse(turned), header) != solids_of(parse(moved), header)
    points = [(85000.001, 0.002, 0.503), (85000.004, 0.005, 0.506), (85000.007, 0.008, 0.509)]
    assert solids[("a", 0, 0)][0][0] == tuple(points)

    def polygon(ring):
        return struct.pack("<BIII", 1, 0x80000003, 1, 4) + b"".join(
            struct.pack("<3d", *points[i]) for i in ring)
    ewkb = struct.pack("<BIII", 1, 0xA000000F, 7415, 2) + polygon([1, 2, 0, 1]) + polygon([0, 2, 1, 0])
    facets, srid = read_ewkb(ewkb)
    assert srid == 7415 and canonical(facets) == solids[("a", 0, 0)]
    print("city_models: self-test passed")


if __name__ == "__main__" and sys.argv[1:] == ["--self-test"]:
    self_test()
