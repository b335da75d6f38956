#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the saddles of bench/fill/curves: loops (cos t, sin t, 0.25 cos 2t) at the corners of an
octahedron, 2 from its centre, with their axes outwards, each moved at random by at most 0.15 along each axis. One point a
line, loops parted by an empty line.

Usage: make_curves.py FOLDER
"""

import math
import pathlib
import random
import sys

FILES = [(2, 10), (3, 5), (2, 125), (2, 250), (3, 10), (3, 30), (4, 10), (5, 10), (6, 10)]


def at_corner(place, corner):
    """Turns and moves a place on a loop around the z axis to one of the corners."""
    x, y, z = place
    axis, is_opposite = corner % 3, corner >= 3
    if is_opposite:
        x, z = -x, -z
    z += -2 if is_opposite else 2
    return [(z, x, y), (y, z, x), (x, y, z)][axis]


def saddle(corner, count, jitter):
    lines = []
    for i in range(count):
        t = 2 * math.pi * i / count
        place = at_corner((math.cos(t), math.sin(t), 0.25 * math.cos(2 * t)), corner)
        lines.append(" ".join(f"{p + j:.6f}" for p, j in zip(place, jitter)))
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    for loops, count in FILES:
        numbers = random.Random(2013)
        text = [saddle(corner, count, [numbers.uniform(-0.15, 0.15) for _ in range(3)])
                for corner in range(loops)]
        (folder / f"saddles_{loops}x{count}.txt").write_text("\n".join(text))


main()
