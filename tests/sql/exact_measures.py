#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares measures of SQL with those of exact fractions: exact_measures.py < ROWS

A row of tab-separated columns is a solid: hexadecimal EWKB, the kind of its lattice, then as SQL gave them the volume,
the area, the centre of mass as {x,y,z}, a height and the volume below it. Coordinates and the height count as the shortest decimals
of their doubles on a decimal lattice, and as the doubles on others. A solid is
compared if each of its facets lies in a plane exactly (else the triangles of a facet decide, which are not known
here) and has one ring. Volumes come from fans of triangles; the part below a height from prisms under those, cut by the
height one by one. The area is a sum of square roots, each cut off after 600 binary digits. Prints the number of solids; exit code 1 after a difference.
"""
import math
import struct
import sys
from fractions import Fraction


def facets_of(ewkb, kind_of_lattice):
    """Rings of a POLYHEDRALSURFACE Z by facet, without closing points; None for another geometry."""
    order = "<" if ewkb[0] == 1 else ">"
    kind = struct.unpack_from(order + "I", ewkb, 1)[0]
    place = 5 + (4 if kind & 0x20000000 else 0)
    if kind & 0xFF != 15:
        return None
    count = struct.unpack_from(order + "I", ewkb, place)[0]
    place += 4
    exact = (lambda number: Fraction(repr(number))) if kind_of_lattice == "decimal" else Fraction
    facets = []
    for _ in range(count):
        rings = struct.unpack_from(order + "I", ewkb, place + 5)[0]
        place += 9
        facet = []
        for _ in range(rings):
            size = struct.unpack_from(order + "I", ewkb, place)[0]
            numbers = struct.unpack_from(f"{order}{3 * size}d", ewkb, place + 4)
            points = [tuple(map(exact, numbers[3 * i:3 * i + 3])) for i in range(size)]
            facet.append(points[:-1])
            place += 4 + 24 * size
        facets.append(facet)
    return facets


def minus(p, q):
    return tuple(a - b for a, b in zip(p, q))


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    return sum(a * b for a, b in zip(u, v))


def is_flat(ring):
    """Whether all points of a ring lie in the plane of the first three that are not on a line."""
    normal = None
    for i in range(2, len(ring)):
        normal = cross(minus(ring[i - 1], ring[0]), minus(ring[i], ring[0]))
        if any(normal):
            break
    return all(dot(normal, minus(p, ring[0])) == 0 for p in ring)


def clipped(ring, height):
    """The part of a polygon in space at or below a height."""
    part = []
    for p, q in zip(ring, ring[1:] + ring[:1]):
        if p[2] <= height:
            part.append(p)
        if (p[2] < height) != (q[2] < height) and p[2] != height and q[2] != height:
            t = (height - p[2]) / (q[2] - p[2])
            part.append(tuple(a + t * (b - a) for a, b in zip(p, q)))
    return part


def prism(ring, base):
    """The signed volume between a flat polygon and the height `base`."""
    total = Fraction(0)
    for i in range(2, len(ring)):
        a, b, c = ring[0], ring[i - 1], ring[i]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        total += area * (a[2] + b[2] + c[2] - 3 * base) / 6
    return total


def measures(rings, height):
    volume, moment = Fraction(0), [Fraction(0)] * 3
    base = rings[0][0]
    for ring in rings:
        for i in range(2, len(ring)):
            a, b, c = (minus(p, base) for p in (ring[0], ring[i - 1], ring[i]))
            part = dot(a, cross(b, c)) / 6
            volume += part
            for axis in range(3):
                moment[axis] += part * (a[axis] + b[axis] + c[axis]) / 4
    centre = [base[axis] + moment[axis] / volume for axis in range(3)]
    # Facets that are cut close at the height itself, where prisms under the height have no volume.
    below = sum((prism(clipped(ring, height), height) for ring in rings), Fraction(0))
    return volume, centre, below


def area(rings):
    """Half the sum of the lengths of the rings' normals."""
    rational, digits = Fraction(0), 0
    for ring in rings:
        normal = (Fraction(0),) * 3
        for i in range(2, len(ring)):
            part = cross(minus(ring[i - 1], ring[0]), minus(ring[i], ring[0]))
            normal = tuple(a + b for a, b in zip(normal, part))
        square = dot(normal, normal)
        root = Fraction(math.isqrt(square.numerator), math.isqrt(square.denominator))
        if root * root == square:
            rational += root
        else:
            digits += math.isqrt((square.numerator << 1200) // square.denominator)
    return (rational + Fraction(digits, 1 << 600)) / 2


def main():
    count = left_out = wrong = 0
    for line in sys.stdin:
        ewkb, lattice, volume, surface, centre, height, below = line.rstrip("\n").split("\t")
        facets = facets_of(bytes.fromhex(ewkb), lattice)
        if facets is None or any(len(facet) > 1 or not is_flat(facet[0]) for facet in facets):
            left_out += 1
            continue
        count += 1
        rings = [facet[0] for facet in facets]
        exact = measures(rings, Fraction(height) if lattice == "decimal" else Fraction(float(height)))
        wanted = [float(exact[0]), float(area(rings)), *map(float, exact[1]), float(exact[2])]
        got = [float(volume), float(surface), *map(float, centre.strip("{}").split(",")), float(below)]
        if wanted != got:
            wrong += 1
            print(f"{ewkb[:60]}: {got} instead of {wanted}")
    print(f"{count} solids have the volumes, areas and centres of exact fractions, {left_out} are not flat, {wrong} differ")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
