#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a mesh as SVG: draw_scenes.py MESH.obj OUT.svg [X,Y,Z]

X,Y,Z is the direction from which the mesh is seen. Facets that look away are drawn in red.
"""
import math
import sys

WIDTH = 480
LIGHT = (0.3, -0.2, 0.93)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a):
    length = math.sqrt(dot(a, a)) or 1
    return tuple(x / length for x in a)


def read_obj(path):
    vertices, facets = [], []
    with open(path, encoding="ascii") as file:
        for words in map(str.split, file):
            if words[0] == "v":
                vertices.append(tuple(float(word) for word in words[1:4]))
            elif words[0] == "f":
                facets.append([int(word) - 1 for word in words[1:]])
    return vertices, facets


def draw(path, out, view):
    vertices, facets = read_obj(path)
    toward = unit(view)
    right = unit(cross((0, 0, 1), toward))
    up = cross(toward, right)
    places = [(dot(v, right), dot(v, up), dot(v, toward)) for v in vertices]
    left, low = min(p[0] for p in places), min(p[1] for p in places)
    scale = WIDTH / (max(p[0] for p in places) - left)
    height = round((max(p[1] for p in places) - low) * scale)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}">']
    for facet in sorted(facets, key=lambda corners: sum(places[i][2] for i in corners) / len(corners)):
        a, b, c = (vertices[i] for i in facet[:3])
        normal = unit(cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]))
        grey = int(90 + 140 * max(0, dot(normal, LIGHT)))
        colour = (grey, grey, min(255, grey + 20)) if dot(normal, toward) > 0 else (grey, grey // 2, grey // 2)
        points = " ".join(f"{(places[i][0] - left) * scale:.1f},{height - (places[i][1] - low) * scale:.1f}"
                          for i in facet)
        lines.append(f'<polygon points="{points}" fill="#{"".join(f"{part:02x}" for part in colour)}" '
                     'stroke="#333" stroke-width=".4"/>')
    lines.append("</svg>\n")
    with open(out, "w", encoding="ascii") as file:
        file.write("\n".join(lines))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    draw(sys.argv[1], sys.argv[2],
         [float(part) for part in sys.argv[3].split(",")] if len(sys.argv) > 3 else [0.5, -0.9, 0.8])
