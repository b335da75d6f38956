# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid whose proof the program does not find alone: Chazelle's polyhedron, sheared and long, as in
tests/sql/sql/helpers.sql. A helper process proves it."""
import json


def chazelle(ridges):
    """Vertices and facets (one ring each): ridges over as many others, two units apart."""
    s, h = 4 * ridges, 128 * ridges * ridges
    steps = range(2 * ridges + 1)
    front = [(2 * k, 0, 2 if k % 2 else h) for k in reversed(steps)]
    back = [(2 * k, s, 2 * k * s + 2 if k % 2 else h) for k in steps]
    left = [(0, 2 * k, 0 if k % 2 else -h) for k in reversed(steps)]
    right = [(s, 2 * k, 2 * k * s if k % 2 else -h) for k in steps]
    facets = []
    for x in range(2, 4 * ridges - 1, 4):
        facets += [[(x - 2, 0, h), (x, 0, 2), (x, s, x * s + 2)], [(x - 2, 0, h), (x, s, x * s + 2), (x - 2, s, h)],
                   [(x, 0, 2), (x + 2, 0, h), (x + 2, s, h)], [(x, 0, 2), (x + 2, s, h), (x, s, x * s + 2)],
                   [(0, x, 0), (s, x, s * x), (s, x - 2, -h)], [(0, x - 2, -h), (0, x, 0), (s, x - 2, -h)],
                   [(0, x + 2, -h), (s, x + 2, -h), (s, x, s * x)], [(0, x, 0), (0, x + 2, -h), (s, x, s * x)]]
    facets += [[(0, 0, -h), (s, 0, -h), *front], [(s, s, -h), (0, s, -h), *back],
               [(0, 0, h), (0, s, h), *left], [(s, s, h), (s, 0, h), *right]]
    numbers = {}
    rings = [[numbers.setdefault((x + 4 * y, y + 4 * z, 4096 * z), len(numbers)) for x, y, z in facet] for facet in facets]
    return [list(place) for place in numbers], rings


def hard_feature(name, number=0):
    """A line of a sequence with this solid, at a place of its own."""
    vertices, rings = chazelle(6)
    shift = 1_000_000 * number
    return json.dumps({"type": "CityJSONFeature", "id": name, "CityObjects": {name: {
        "type": "Building", "geometry": [{"type": "Solid", "lod": "1", "boundaries": [[[ring] for ring in rings]]}]}},
        "vertices": [[x + shift, y, z] for x, y, z in vertices]}, separators=(",", ":"))
