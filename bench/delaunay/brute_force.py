#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The golden Delaunay digests from the text of docs/format.md alone, by trying every tetrahedron.

    brute_force.py [MOST_POINTS]      checks the sets of tests/golden/delaunay up to that size (30)
"""
import csv
import itertools
import pathlib
import struct
import sys

GOLDEN = pathlib.Path(__file__).parents[2] / "tests/golden/delaunay/digests.csv"


def minus(u, v):
    return tuple(a - b for a, b in zip(u, v))


def det(a, b, c):
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


def orient(a, b, c, d):
    return det(minus(b, a), minus(c, a), minus(d, a))


def sphere(corners, p):
    rows = [minus(q, p) for q in corners]
    return sum((-1) ** i * sum(c * c for c in row) * det(*(rows[:i] + rows[i + 1:]))
               for i, row in enumerate(rows))


def is_conflict(corners, p):
    side = sphere(corners, p)
    if side != 0:
        return side > 0
    for greatest in sorted([*corners, p], reverse=True)[:2]:
        if greatest == p:
            return False
        side = orient(*(p if q == greatest else q for q in corners))
        if side != 0:
            return side > 0
    raise AssertionError("two rounds are enough")


class Numbers:
    def __init__(self, seed):
        self.state = seed

    def below(self, m):
        self.state = (6364136223846793005 * self.state + 1442695040888963407) % 2**64
        return (self.state >> 33) % m


def box(a, b, c):
    return list(itertools.product(range(a), range(b), range(c)))


def integer_sphere(q):
    side = range(-int(q**0.5) - 1, int(q**0.5) + 2)
    return [p for p in itertools.product(side, repeat=3) if sum(c * c for c in p) == q]


def random(n, m, seed):
    numbers = Numbers(seed)
    return [tuple(numbers.below(m) for _ in range(3)) for _ in range(n)]


def circles(q, k, h):
    side = range(-int(q**0.5) - 1, int(q**0.5) + 2)
    return [(x, y, i * h) for x in side for y in side if x * x + y * y == q for i in range(k)]


def houses(n):
    frames = [[(1000 * i, y, z) for y in (0, 800) for z in (0, 500)] + [(1000 * i, 400, 800)]
              for i in range(n + 1)]
    return sum(frames, [])


def near(q, k, seed):
    numbers = Numbers(seed)
    return [tuple(k * c + numbers.below(3) - 1 for c in p) for p in sorted(integer_sphere(q))]


def tower(n, m, seed):
    numbers = Numbers(seed)
    heights = [numbers.below(m), numbers.below(m)]
    points = []
    for _ in range(n):
        x, y = numbers.below(m), numbers.below(m)
        points += [(x, y, 0), (x, y, heights[numbers.below(2)])]
    return points


def lines(n, m, seed):
    numbers = Numbers(seed)
    points = []
    for _ in range(n):
        free = numbers.below(3)
        points.append(tuple(numbers.below(m + 1) if axis == free else m * numbers.below(2)
                            for axis in range(3)))
    return points


KINDS = {
    "grid": lambda a, b, c, k: [tuple(k * v for v in p) for p in box(a, b, c)],
    "sheared": lambda a, b, c: [(5 * i + 2 * j, 3 * j - l, 7 * l + i) for i, j, l in box(a, b, c)],
    "hollow": lambda a: [p for p in box(a, a, a) if any(c in (0, a - 1) for c in p)],
    "sphere": lambda q, k: [tuple(k * c for c in p) for p in integer_sphere(q)],
    "spheres": lambda p, q: integer_sphere(p) + integer_sphere(q),
    "circles": circles,
    "houses": houses,
    "paraboloid": lambda a: [(x, y, (x - a)**2 + (y - a)**2)
                             for x, y, _ in box(2 * a + 1, 2 * a + 1, 1)],
    "skew": lambda n: [(i, 0, 0) for i in range(n)] + [(0, i, n) for i in range(n)],
    "random": random,
    "flat": lambda n, m, d, s: [p if i < d else (p[0], p[1], 0)
                                for i, p in enumerate(random(n, m, s))],
    "extreme": lambda n, s: [tuple((0, 1, 2**29, 2**30 - 2, 2**30 - 1)[c] for c in p)
                             for p in random(n, 5, s)],
    "near": near,
    "tower": tower,
    "lines": lines,
}


def make(name):
    kind, *parameters = name.split()
    return sorted(set(KINDS[kind](*map(int, parameters))))


def tetrahedra(points):
    for chosen in itertools.combinations(range(len(points)), 4):
        corners = [points[i] for i in chosen]
        turn = orient(*corners)
        if turn == 0:
            continue
        if turn < 0:
            corners[0], corners[1] = corners[1], corners[0]
        others = (p for i, p in enumerate(points) if i not in chosen)
        if not any(is_conflict(corners, p) for p in others):
            yield chosen


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def check(row, most):
    """Whether the digest of a set is right; None if the set is too large to try."""
    points = make(row["set"])
    if len(points) != int(row["points"]):
        return False
    if len(points) > most:
        return None
    found = list(tetrahedra(points))
    faces = sorted({face for t in found for face in itertools.combinations(t, 3)})
    digest = crc32c(b"".join(struct.pack("<III", *face) for face in faces))
    return (len(found), len(faces), f"{digest:08x}") == (
        int(row["tetrahedra"]), int(row["faces"]), row["crc32c"])


def main():
    most = int(sys.argv[1]) if len(sys.argv) > 1 else 30
    results = [(row["set"], check(row, most)) for row in csv.DictReader(GOLDEN.open())]
    wrong = [name for name, result in results if result is False]
    tried = sum(result is not None for _, result in results)
    print(f"{len(results)} sets made, {tried} tetrahedralized, wrong: {wrong}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
