# SPDX-License-Identifier: GPL-3.0-or-later
"""The Delaunay tetrahedralization with the rule for ties of docs/format-delaunay.md, found face by face."""
import itertools
from fractions import Fraction

from entropy import Malformed


def det3(a, b, c):
    """The determinant of a matrix of three rows."""
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


def minus(a, b):
    """The difference of two points."""
    return tuple(x - y for x, y in zip(a, b))


def orient(a, b, c, d):
    """A value that is positive for a tetrahedron of positive orientation."""
    return det3(minus(b, a), minus(c, a), minus(d, a))


def sphere(corners, p):
    """A value that is positive for p inside the sphere through the corners."""
    rows = [minus(q, p) for q in corners]
    total = 0
    for i, row in enumerate(rows):
        rest = rows[:i] + rows[i + 1:]
        total += (-1)**i * sum(c * c for c in row) * det3(*rest)
    return total


def conflicts(corners, p):
    """Whether p is inside the sphere through the corners, with the rule for ties."""
    side = sphere(corners, p)
    if side:
        return side > 0
    for greatest in sorted([*corners, p], reverse=True)[:2]:
        if greatest == p:
            return False
        side = orient(*(p if q == greatest else q for q in corners))
        if side:
            return side > 0
    raise Malformed("two rounds are enough")


def whole(points):
    """The points times the least power of two that makes them integers."""
    scale = max(Fraction(c).denominator for p in points for c in p)
    return [tuple(int(Fraction(c) * scale) for c in p) for p in points]


def positive(points, chosen):
    """The corners of a tetrahedron in an order of positive orientation, or none if the tetrahedron
    is flat."""
    corners = [points[i] for i in chosen]
    turn = orient(*corners)
    if turn < 0:
        corners[0], corners[1] = corners[1], corners[0]
    return corners if turn else None


def first_tetrahedron(points):
    """A tetrahedron at the first point, found by trying all, near points first."""
    near = sorted(range(1, len(points)), key=lambda i: sum(c * c for c in minus(points[i],
                                                                                points[0])))
    for last in range(2, len(near)):
        for pair in itertools.combinations(near[:last], 2):
            chosen = tuple(sorted((0, *pair, near[last])))
            corners = positive(points, chosen)
            if corners and not any(conflicts(corners, p) for i, p in enumerate(points)
                                   if i not in chosen):
                return chosen
    raise Malformed("no tetrahedron")


def apex_beyond(points, face, inside):
    """The fourth corner of the tetrahedron on the other side of a face, or none on the hull."""
    a, b, c = (points[i] for i in face)
    if orient(a, b, c, points[inside]) > 0:
        a, b = b, a
    apex = None
    for i, p in enumerate(points):
        if orient(a, b, c, p) > 0 and (
                apex is None or conflicts([a, b, c, points[apex]], p)):
            apex = i
    return apex


def delaunay(points, most_per_point):
    """The tetrahedra, each of them found across a face of another."""
    most = most_per_point * len(points) + 4096
    points = whole(points)
    found = {first_tetrahedron(points)}
    waiting, done = list(found), set()
    while waiting:
        tetrahedron = waiting.pop()
        for inside in tetrahedron:
            face = tuple(i for i in tetrahedron if i != inside)
            if (face, inside) in done:
                continue
            apex = apex_beyond(points, face, inside)
            done.add((face, inside))
            if apex is not None:
                done.add((face, apex))
                beyond = tuple(sorted((*face, apex)))
                if len(found) > most:
                    raise Malformed("too many tetrahedra")
                if beyond not in found:
                    found.add(beyond)
                    waiting.append(beyond)
    return found
