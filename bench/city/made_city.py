#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a city of any size: buildings of the shapes and attributes of 3DBAG, in streets.

    made_city.py FEATURES [--seed N] > city.jsonl      a CityJSONSeq

Each building has a part with the solid, as in 3DBAG, so that it has two ids."""
import argparse
import json
import math
import random
import sys

SPACING = 12_000  # between houses, mm


def header():
    return {"type": "CityJSON", "version": "2.0",
            "transform": {"scale": [0.001] * 3, "translate": [84000.0, 445000.0, 0.0]},
            "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"},
            "CityObjects": {}, "vertices": []}


def gabled(x, y, width, depth, floor, eaves, ridge):
    """Vertices and facets of a house with a gabled roof."""
    half = width // 2
    vertices = [[x, y, floor], [x + width, y, floor], [x + width, y + depth, floor], [x, y + depth, floor],
                [x, y, eaves], [x + width, y, eaves], [x + width, y + depth, eaves], [x, y + depth, eaves],
                [x + half, y, ridge], [x + half, y + depth, ridge]]
    facets = [[0, 3, 2, 1], [0, 1, 5, 8, 4], [1, 2, 6, 5], [2, 3, 7, 9, 6], [3, 0, 4, 7],
              [4, 8, 9, 7], [5, 6, 9, 8]]
    return vertices, facets


def building(number, side, chance):
    name = f"NL.IMBAG.Pand.0503{chance.randrange(10**12):012d}"
    width = 2 * chance.randrange(2200, 4800)
    depth = chance.randrange(5000, 11000)
    floor = chance.randrange(-2000, 1500)
    eaves = floor + chance.randrange(2600, 9000)
    ridge = eaves + chance.randrange(500, 4000)
    vertices, facets = gabled(SPACING * (number % side), SPACING * (number // side), width, depth, floor,
                              eaves, ridge)
    values = [0, 2, 2, 2, 2, 1, 1]
    attributes = {"identificatie": name, "oorspronkelijkbouwjaar": chance.randrange(1850, 2024),
                  "status": "Pand in gebruik", "b3_dak_type": "slanted", "b3_h_maaiveld": floor / 1000,
                  "b3_opp_grond": round(width * depth / 1e6, 2), "b3_volume_lod22": round(
                      width * depth * (eaves - floor) / 1e9, 3), "b3_rmse_lod22": round(chance.random() / 8, 3)}
    solid = {"type": "Solid", "lod": "2.2", "boundaries": [[[facet] for facet in facets]],
             "semantics": {"surfaces": [{"type": "GroundSurface"}, {"type": "RoofSurface"},
                                        {"type": "WallSurface"}], "values": [values]}}
    return {"type": "CityJSONFeature", "id": name, "CityObjects": {
        name: {"type": "Building", "attributes": attributes, "children": [name + "-0"]},
        name + "-0": {"type": "BuildingPart", "parents": [name], "geometry": [solid]}}, "vertices": vertices}


def city(features, seed=1):
    """The lines of the sequence; the order of buildings is not that of their places."""
    chance = random.Random(seed)
    side = math.isqrt(features - 1) + 1
    order = list(range(features))
    chance.shuffle(order)
    yield json.dumps(header(), separators=(",", ":"))
    for number in order:
        yield json.dumps(building(number, side, chance), separators=(",", ":"))


def extent(features):
    """The smallest and largest x and y of the city, metres."""
    side = math.isqrt(features - 1) + 1
    return 84000.0, 445000.0, 84000.0 + side * SPACING / 1000, 445000.0 + side * SPACING / 1000


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("features", type=int)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    for line in city(arguments.features, arguments.seed):
        sys.stdout.write(line + "\n")
