#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes solids that are hard or large for the CDT step, as CityJSON files: worst_cases.py FOLDER

plate-N: a plate with N square holes from top to bottom (two facets with N interior rings)
cavities-N: a box with N cubic cavities
sphere-N: a triangulated sphere of about N vertices, radii rounded to millimetres
chazelle-N: Chazelle's polyhedron with N notches from above and N from below
"""
import json
import math
import pathlib
import sys


class Model:
    def __init__(self):
        self.vertices = []
        self.index = {}

    def vertex(self, *point):
        if point not in self.index:
            self.index[point] = len(self.vertices)
            self.vertices.append(list(point))
        return self.index[point]

    def ring(self, points, is_turned=False):
        ring = [self.vertex(*p) for p in points]
        return ring[::-1] if is_turned else ring

    def write(self, path, shells):
        solid = {"type": "Solid", "lod": "2", "boundaries": shells}
        document = {
            "type": "CityJSON", "version": "2.0",
            "transform": {"scale": [0.001] * 3, "translate": [0, 0, 0]},
            "CityObjects": {path.stem: {"type": "Building", "geometry": [solid]}},
            "vertices": self.vertices,
        }
        path.write_text(json.dumps(document), encoding="utf-8")


def square(x, y, size, z):
    return [(x, y, z), (x + size, y, z), (x + size, y + size, z), (x, y + size, z)]


def walls(model, low, high, is_turned):
    """The facets of the walls between two squares, outward unless turned."""
    facets = []
    for i in range(4):
        j = (i + 1) % 4
        facets.append([model.ring([low[i], low[j], high[j], high[i]], is_turned)])
    return facets


def plate(count):
    model, side = Model(), math.isqrt(count)
    size = 3000 * side + 1000
    low, high = square(0, 0, size, 0), square(0, 0, size, 5000)
    bottom, top = [model.ring(low, True)], [model.ring(high)]
    shell = walls(model, low, high, False)
    for k in range(count):
        x, y = 1000 + 3000 * (k % side), 1000 + 3000 * (k // side)
        hole_low, hole_high = square(x, y, 2000, 0), square(x, y, 2000, 5000)
        bottom.append(model.ring(hole_low))
        top.append(model.ring(hole_high, True))
        shell += walls(model, hole_low, hole_high, True)
    return model, [[bottom, top] + shell]


def box(model, low, high, is_turned):
    facets = walls(model, low, high, is_turned)
    return [[model.ring(low, not is_turned)], [model.ring(high, is_turned)]] + facets


def cavities(count):
    model, side = Model(), round(count ** (1 / 3))
    size = 3000 * side + 1000
    shells = [box(model, square(0, 0, size, 0), square(0, 0, size, size), False)]
    for k in range(count):
        x, y, z = (1000 + 3000 * (k // side ** i % side) for i in range(3))
        shells.append(box(model, square(x, y, 2000, z), square(x, y, 2000, z + 2000), True))
    return model, shells


def sphere(count):
    model = Model()
    across = round(math.sqrt(count / 2))
    around = 2 * across

    def at(i, j):
        u, v = 2 * math.pi * (i % around) / around, math.pi * ((j + 1) / (across + 1) - 0.5)
        radius = 1e6 + 3e4 * math.sin(7 * u) * math.cos(5 * v)
        return (round(radius * math.cos(u) * math.cos(v)),
                round(radius * math.sin(u) * math.cos(v)), round(radius * math.sin(v)))

    low, high = (0, 0, -1020000), (0, 0, 1020000)
    shell = []
    for i in range(around):
        for j in range(across - 1):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            shell += [[model.ring([a, b, c])], [model.ring([a, c, d])]]
        shell.append([model.ring([at(i + 1, 0), at(i, 0), low])])
        shell.append([model.ring([at(i, across - 1), at(i + 1, across - 1), high])])
    return model, [shell]


def chazelle(n):
    """Chazelle's polyhedron, after B. Chazelle, Convex partitions of polyhedra, 1984: of triangles,
    with ridges two units apart."""
    model, size = Model(), 4 * n
    height = 8 * size * size
    shell, front, back, left, right = [], [], [], [], []

    def add(*points):
        shell.append([model.ring(points)])

    for i in range(n):
        x = 4 * i + 2
        near, far = (x, 0, 2), (x, size, x * size + 2)
        a, b = (x - 2, 0, height), (x - 2, size, height)
        c, d = (x + 2, 0, height), (x + 2, size, height)
        add(a, near, far)
        add(a, far, b)
        add(near, c, d)
        add(near, d, far)
        front += [a, near]
        back += [b, far]
    front.append((size, 0, height))
    back.append((size, size, height))
    for j in range(n):
        y = 4 * j + 2
        near, far = (0, y, 0), (size, y, size * y)
        a, b = (0, y - 2, -height), (size, y - 2, -height)
        c, d = (0, y + 2, -height), (size, y + 2, -height)
        add(near, far, b)
        add(a, near, b)
        add(c, d, far)
        add(near, c, far)
        left += [a, near]
        right += [b, far]
    left.append((0, size, -height))
    right.append((size, size, -height))
    add((0, 0, -height), (size, 0, -height), *front[::-1])
    add((size, size, -height), (0, size, -height), *back)
    add((0, 0, height), (0, size, height), *left[::-1])
    add((size, size, height), (size, 0, height), *right)
    return model, [shell]


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make, counts in (("plate", plate, (100, 2500, 10000)),
                               ("cavities", cavities, (27, 1000)),
                               ("sphere", sphere, (6000, 25000, 100000)),
                               ("chazelle", chazelle, (2, 5, 20))):
        for count in counts:
            model, shells = make(count)
            model.write(folder / f"{name}-{count}.city.json", shells)


if __name__ == "__main__":
    main()
