#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the inputs of measure_speed.py: make_inputs.py FOLDER [HAGUE.city.json VIENNA.city.json...]

sphere-N.obj     bumpy sphere, N triangles or a few less
plate.city.json  a plate with 10,000 square holes: two facets of 10,001 rings
cavities.city.json  a box with 1,000 box-shaped cavities
towns.city.json  the city models given, each a few times, shifted, as one document
long.city.jsonl  the first city model as a sequence of some 500 MB
"""
import json
import math
import os
import sys

SEQUENCE_BYTES = 500_000_000


def sphere(path, triangles):
    rows = int(math.sqrt(triangles / 4))
    columns = 2 * rows
    with open(path, "w") as out:
        out.write("v 0 0 1000\n")
        for row in range(1, rows):
            polar = math.pi * row / rows
            for column in range(columns):
                around = 2 * math.pi * column / columns
                r = 1000 * (1 + 0.05 * math.sin(9 * polar) * math.sin(7 * around))
                out.write("v %.3f %.3f %.3f\n" % (r * math.sin(polar) * math.cos(around),
                                                r * math.sin(polar) * math.sin(around), r * math.cos(polar)))
        out.write("v 0 0 -1000\n")
        last = 2 + (rows - 1) * columns
        at = lambda row, column: 2 + (row - 1) * columns + column % columns
        for column in range(columns):
            out.write(f"f 1 {at(1, column)} {at(1, column + 1)}\n")
            out.write(f"f {last} {at(rows - 1, column + 1)} {at(rows - 1, column)}\n")
        for row in range(1, rows - 1):
            for column in range(columns):
                a, b = at(row, column), at(row, column + 1)
                c, d = at(row + 1, column + 1), at(row + 1, column)
                out.write(f"f {a} {d} {c}\nf {a} {c} {b}\n")


class Model:
    """A CityJSON document of one solid."""

    def __init__(self):
        self.vertices = []
        self.shells = []

    def box(self, low, high):
        """Adds the eight vertices of a box and returns its six facets, outward."""
        first = len(self.vertices)
        for z in (low[2], high[2]):
            for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])):
                self.vertices.append([x, y, z])
        quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
        return [[[first + i for i in quad]] for quad in quads]

    def write(self, path):
        geometry = {"type": "Solid", "lod": "2", "boundaries": self.shells}
        with open(path, "w") as out:
            json.dump({"type": "CityJSON", "version": "2.0",
                       "transform": {"scale": [0.001] * 3, "translate": [0, 0, 0]},
                       "CityObjects": {"a": {"type": "Building", "geometry": [geometry]}},
                       "vertices": self.vertices}, out)


def plate(path, side):
    model = Model()
    shell = model.box([0, 0, 0], [side * 1000 + 500, side * 1000 + 500, 300])
    for i in range(side):
        for j in range(side):
            x, y = 500 + i * 1000, 500 + j * 1000
            hole = model.box([x, y, 0], [x + 500, y + 500, 300])
            shell[0].append(hole[0][0][::-1])
            shell[1].append(hole[1][0][::-1])
            shell += [[quad[0][::-1]] for quad in hole[2:]]
    model.shells = [shell]
    model.write(path)


def cavities(path, side):
    model = Model()
    model.shells = [model.box([0, 0, 0], [side * 1000 + 500] * 3)]
    for i in range(side):
        for j in range(side):
            for k in range(side):
                low = [500 + i * 1000, 500 + j * 1000, 500 + k * 1000]
                box = model.box(low, [c + 500 for c in low])
                model.shells.append([[quad[0][::-1]] for quad in box])
    model.write(path)


def shift_indices(value, by):
    if isinstance(value, list):
        return [shift_indices(v, by) for v in value]
    return value + by


def towns(path, models, copies):
    merged = {"type": "CityJSON", "version": "1.1", "CityObjects": {}, "vertices": [],
              "transform": {"scale": [0.001] * 3, "translate": [0, 0, 0]}}
    for number, model in enumerate(models):
        transform = model.get("transform", {"scale": [1] * 3, "translate": [0] * 3})
        for copy in range(copies):
            first = len(merged["vertices"])
            for vertex in model["vertices"]:
                world = [vertex[i] * transform["scale"][i] + transform["translate"][i] for i in range(3)]
                world[0] += 10000 * copy
                merged["vertices"].append([round(c * 1000) for c in world])
            for key, thing in model["CityObjects"].items():
                thing = json.loads(json.dumps(thing))
                name = lambda id: f"{number}-{copy}-{id}"
                for relation in ("parents", "children"):
                    if relation in thing:
                        thing[relation] = [name(id) for id in thing[relation]]
                for geometry in thing.get("geometry", []):
                    geometry.pop("texture", None)
                    geometry.pop("material", None)
                    if "boundaries" in geometry:
                        geometry["boundaries"] = shift_indices(geometry["boundaries"], first)
                merged["CityObjects"][name(key)] = thing
    with open(path, "w") as out:
        json.dump(merged, out)


def indices_of(value, found):
    if isinstance(value, list):
        for v in value:
            indices_of(v, found)
    else:
        found[value] = None


def renumber(value, number):
    if isinstance(value, list):
        return [renumber(v, number) for v in value]
    return number[value]


def sequence(path, model, size):
    objects = model["CityObjects"]
    lines = []
    for key, thing in objects.items():
        if "parents" in thing:
            continue
        members = {key: thing}
        for child in thing.get("children", []):
            members[child] = objects[child]
        used = {}
        for member in members.values():
            for geometry in member.get("geometry", []):
                indices_of(geometry["boundaries"], used)
        number = {old: new for new, old in enumerate(used)}
        members = json.loads(json.dumps(members))
        for member in members.values():
            for geometry in member.get("geometry", []):
                geometry["boundaries"] = renumber(geometry["boundaries"], number)
                geometry.pop("texture", None)
                geometry.pop("material", None)
        lines.append(json.dumps({"type": "CityJSONFeature", "id": key, "CityObjects": members,
                                 "vertices": [model["vertices"][i] for i in used]}))
    block = "\n".join(lines) + "\n"
    header = {k: model[k] for k in ("type", "version", "transform", "metadata") if k in model}
    header.update({"CityObjects": {}, "vertices": []})
    with open(path, "w") as out:
        out.write(json.dumps(header) + "\n")
        for _ in range(max(1, size // len(block))):
            out.write(block)


def main():
    folder, models = sys.argv[1], [json.load(open(path)) for path in sys.argv[2:]]
    os.makedirs(folder, exist_ok=True)
    sphere(f"{folder}/sphere-100000.obj", 100_000)
    sphere(f"{folder}/sphere-1000000.obj", 1_000_000)
    plate(f"{folder}/plate.city.json", 100)
    cavities(f"{folder}/cavities.city.json", 10)
    if models:
        towns(f"{folder}/towns.city.json", models, 4)
        sequence(f"{folder}/long.city.jsonl", models[0], SEQUENCE_BYTES)


if __name__ == "__main__":
    main()
