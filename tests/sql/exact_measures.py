#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares measures of SQL with those of exact fractions: exact_measures.py < ROWS

A row of tab-separated columns is a solid: hexadecimal EWKB, its lattice as wt_solid_info has it, then as SQL gave them the volume,
the area, the centre of mass as {x,y,z}, a height and the volume below it. Coordinates and the height count as the shortest decimals
of their doubles on a decimal lattice, and as the doubles on others. Volumes come from fans of triangles; the part below a height
from prisms under those, cut by the height one by one. The area is a sum of square roots, each cut off after 2,400 binary digits.
Facets that do not lie in a plane exactly have their canonical triangles (tessellate/facets.h), which are found here in another
way: any triangles between the rings, then flips of edges, in units of the lattice. A solid is left out if a vertex of a ring of such a facet lies in an edge of
another. Prints the number of solids; exit code 1 after a difference.
"""
import json
import math
import struct
import sys
from fractions import Fraction


GEOGRAPHIC = {4258, 4326, 4937, 4979, 6668, 6697}  # EPSG systems whose x and y are degrees
DEGREE = 1 << 17  # units of height


def facets_of(ewkb, kind_of_lattice):
    """Rings of a POLYHEDRALSURFACE Z or SOLID Z by facet, without closing points, and the SRID."""
    order = "<" if ewkb[0] == 1 else ">"
    kind = struct.unpack_from(order + "I", ewkb, 1)[0]
    srid = struct.unpack_from(order + "I", ewkb, 5)[0] if kind & 0x20000000 else 0
    place = 5 + (4 if kind & 0x20000000 else 0)
    shells = 1
    if kind & 0xFF != 15:
        shells = struct.unpack_from(order + "I", ewkb, place)[0]
        place += 9
    facets = []
    for shell in range(shells):
        place = read_shell(ewkb, place, order, kind_of_lattice, facets) + 5
    return facets, srid


def read_shell(ewkb, place, order, kind_of_lattice, facets):
    count = struct.unpack_from(order + "I", ewkb, place)[0]
    place += 4
    exact = (lambda number: Fraction(repr(number))) if kind_of_lattice == "decimal" else Fraction
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
    return place


def minus(p, q):
    return tuple(a - b for a, b in zip(p, q))


def cross(u, v):
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    return sum(a * b for a, b in zip(u, v))


def area_vector(ring):
    """Twice the area of a ring in space, as a vector."""
    total = (Fraction(0),) * 3
    for i in range(2, len(ring)):
        total = tuple(a + b for a, b in zip(total, cross(minus(ring[i - 1], ring[0]), minus(ring[i], ring[0]))))
    return total


def is_flat(facet):
    """Whether all points of a facet lie in the plane of three points of the exterior ring that are not on a line."""
    ring = facet[0]
    normal = None
    for i in range(2, len(ring)):
        normal = cross(minus(ring[i - 1], ring[0]), minus(ring[i], ring[0]))
        if any(normal):
            break
    return all(dot(normal, minus(p, ring[0])) == 0 for other in facet for p in other)


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def in_circle(a, b, c, d):
    """Positive if d is inside the circle through a, b, c, which turn left."""
    (ax, ay), (bx, by), (cx, cy) = ((p[0] - d[0], p[1] - d[1]) for p in (a, b, c))
    return ((ax * ax + ay * ay) * (bx * cy - cx * by) - (bx * bx + by * by) * (ax * cy - cx * ay)
            + (cx * cx + cy * cy) * (ax * by - bx * ay))


def is_between(a, b, p):
    """Whether p is inside the edge from a to b."""
    return turn(a, b, p) == 0 and (p[0] - a[0]) * (p[0] - b[0]) + (p[1] - a[1]) * (p[1] - b[1]) < 0


def do_cross(a, b, c, d):
    """Whether two edges without a common end have a point inside both in common."""
    if a in (c, d) or b in (c, d):
        return False
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def any_triangles(rings):
    """Triangles between rings in the plane, of which the exterior one turns left and the others right. None where
    a vertex lies in an edge."""
    points = [p for ring in rings for p in ring]
    edges = {(ring[i - 1], ring[i]) for ring in rings for i in range(len(ring))}
    if any(is_between(a, b, p) for a, b in edges for p in points):
        return None
    front = set(edges)  # edges with the region on their left that no triangle has yet
    walls = set(edges)
    triangles = []
    while front:
        a, b = min(front)
        for c in points:
            if turn(a, b, c) <= 0 or any(is_between(p, c, q) for p in (a, b) for q in points):
                continue
            if any(turn(a, b, q) > 0 and turn(b, c, q) > 0 and turn(c, a, q) > 0 for q in points):
                continue
            if all(not do_cross(p, c, *wall) for p in (a, b) for wall in walls) and all(
                    new in front or (new not in walls and new[::-1] not in walls) for new in ((b, c), (c, a))):
                break
        else:
            return None
        front.discard((a, b))
        for new in ((b, c), (c, a)):
            if new in front:
                front.discard(new)
            else:
                front.add(new[::-1])
            walls.add(new)
        triangles.append((a, b, c))
    return triangles


def flipped(triangles, rings):
    """The constrained Delaunay triangulation; of four points on a circle the lexicographically largest counts as outside."""
    fixed = {frozenset((ring[i - 1], ring[i])) for ring in rings for i in range(len(ring))}
    behind = {}
    for triangle in triangles:
        for i in range(3):
            behind[(triangle[i - 1], triangle[i])] = triangle[i - 2]
    open_edges = list(behind)
    while open_edges:
        a, b = open_edges.pop()
        if frozenset((a, b)) in fixed or (a, b) not in behind or (b, a) not in behind:
            continue
        c, d = behind[(a, b)], behind[(b, a)]
        side = in_circle(a, b, c, d)
        if side < 0 or (side == 0 and max(a, b, c, d) in (c, d)) or turn(c, d, b) <= 0 or turn(d, c, a) <= 0:
            continue
        del behind[(a, b)], behind[(b, a)]
        for p, q, r in ((c, d, b), (d, c, a)):
            behind[(p, q)], behind[(q, r)], behind[(r, p)] = r, p, q
        open_edges += [(a, d), (d, b), (b, c), (c, a)]
    return {min((a, b, c), (b, c, a), (c, a, b)) for (a, b), c in behind.items()}


def canonical_triangles(facet, srid, step):
    """The canonical triangles of a facet that is not flat, in space; None where a vertex of a ring lies in an edge."""
    area = list(map(abs, area_vector(facet[0])))
    if srid in GEOGRAPHIC and all(abs(p[axis]) <= 360 for p in facet[0] for axis in (0, 1)):
        area[2] *= DEGREE
    axis = area.index(max(area))
    is_mirrored = area_vector(facet[0])[axis] < 0
    u, v = (axis + 1) % 3, (axis + 2) % 3
    rings = [[(p[u] / step[u], p[v] / step[v]) for p in (reversed(ring) if is_mirrored else ring)] for ring in facet]
    place = {(p[u] / step[u], p[v] / step[v]): p for ring in facet for p in ring}
    ring = rings[0]
    if len(rings) == 1 and len(ring) == 4 and all(turn(ring[i - 2], ring[i - 1], ring[i]) > 0 for i in range(4)) and in_circle(*ring) == 0:
        space = [tuple(number / unit for number, unit in zip(place[p], step)) for p in ring]
        even, odd = (dot(minus(p, q), minus(p, q)) for p, q in ((space[0], space[2]), (space[1], space[3])))
        is_even = even < odd if even != odd else ring.index(max(ring)) % 2 == 1
        plane = {(ring[0], ring[1], ring[2]), (ring[0], ring[2], ring[3])} if is_even else {(ring[0], ring[1], ring[3]), (ring[1], ring[2], ring[3])}
    else:
        found = any_triangles(rings)
        if found is None:
            return None
        plane = flipped(found, rings)
    return [[place[p] for p in (reversed(triangle) if is_mirrored else triangle)] for triangle in plane]


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


def area(pieces):
    """Half the sum of the lengths of the area vectors of flat pieces, each a list of rings."""
    rational, digits = Fraction(0), 0
    for piece in pieces:
        normal = tuple(map(sum, zip(*map(area_vector, piece))))
        square = dot(normal, normal)
        root = Fraction(math.isqrt(square.numerator), math.isqrt(square.denominator))
        if root * root == square:
            rational += root
        else:
            digits += math.isqrt((square.numerator << 4800) // square.denominator)
    return (rational + Fraction(digits, 1 << 2400)) / 2


def flat_pieces(facets, srid, step):
    """The facets, or their triangles where they are not flat; None where those are not known."""
    pieces = []
    for facet in facets:
        if is_flat(facet):
            pieces.append(facet)
            continue
        triangles = canonical_triangles(facet, srid, step)
        if triangles is None:
            return None
        pieces += [[triangle] for triangle in triangles]
    return pieces


def main():
    count = left_out = wrong = bent = 0
    for line in sys.stdin:
        ewkb, lattice_json, volume, surface, centre, height, below = line.rstrip("\n").split("\t")
        lattice_facts = json.loads(lattice_json, parse_float=Fraction, parse_int=Fraction)
        lattice = lattice_facts["kind"]
        facets, srid = facets_of(bytes.fromhex(ewkb), lattice)
        pieces = flat_pieces(facets, srid, [step or 1 for step in lattice_facts["step"]])
        if pieces is None:
            left_out += 1
            continue
        count += 1
        bent += len(pieces) > len(facets)
        exact = measures([ring for piece in pieces for ring in piece], Fraction(height) if lattice == "decimal" else Fraction(float(height)))
        wanted = [float(exact[0]), float(area(pieces)), *map(float, exact[1]), float(exact[2])]
        got = [float(volume), float(surface), *map(float, centre.strip("{}").split(",")), float(below)]
        if wanted != got:
            wrong += 1
            print(f"{ewkb[:60]}: {got} instead of {wanted}")
    print(f"{count} solids, {bent} of them with facets that are not flat, have the volumes, areas and centres of exact fractions,"
          f" {left_out} have a vertex in an edge, {wrong} differ")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
