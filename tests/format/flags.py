# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode walk, the facets of its triangles, from docs/format-walk.md, "Facets of triangles"."""
import math

from delaunay import orient
from entropy import Malformed
from vectors import cross, dot, minus

FAMILIES = {"Interior": ([16128, 162, 126, 567, 432, 288], 9), "Exterior": ([3],)}


class Flags:
    """Reads which edges lie inside facets, then the rings and shells."""

    def __init__(self, models, walk):
        self.m, self.w, self.points = models, walk, walk.faces.points
        self.inner = [False] * len(walk.twin)
        self.part = list(range(len(walk.triangles)))
        self.known, self.history = [0] * len(walk.triangles), 0

    def read(self):
        """Reads the shells and returns them, the exterior one first."""
        if not self.m.decide("Exterior", 0):
            for h, twin in enumerate(self.w.twin):
                if twin < h:
                    self.read_flag(h, twin)
        rings = {part: [] for part in self.part}
        done = set()
        for h, inner in enumerate(self.inner):
            if not inner and h not in done:
                rings[self.part[h // 3]] += self.rings_from(h, done)
        facets = {}
        for part in sorted(rings):
            if not rings[part]:
                raise Malformed("a facet without a ring")
            facets[part] = self.exterior_first(rings[part], 2)
        shells = []
        for begin, end in zip(self.w.component_first, self.w.component_first[1:]):
            corners = {v for t in self.w.triangles[begin:end] for v in t}
            shells.append((corners, [facets[t] for t in range(begin, end) if t in facets]))
        sizes = [self.size(corners) for corners, _ in shells]
        order = sorted(range(len(shells)), key=lambda i: -sizes[i])
        return [shells[i][1] for i in self.choose(order, 1)]

    def read_flag(self, h, twin):
        """Reads whether an edge, given by its two half-edges, lies inside a facet."""
        w, at = self.w, self.points
        t, u = h // 3, twin // 3
        a, b = at[w.tail(twin)], at[w.head(twin)]
        o, q = at[w.tail(w.previous(twin))], at[w.tail(w.previous(h))]
        along = minus(b, a)
        n1, n2 = cross(along, minus(o, a)), cross(minus(q, a), along)
        s1, s2 = dot(n1, n1), dot(n2, n2)
        offset = 0
        if orient(*(tuple(int(c) for c in p) for p in (a, b, o, q))):
            volume = dot(n1, minus(q, a))
            offset = 1 + sum(volume * volume > d * max(s1, s2)
                             for d in (0.36, 1.44, 6.25, 25.0, 100.0, 900.0, 10000.0))
        angle, product, both = 0, dot(n1, n2), math.sqrt(s1 * s2)
        cosines = (0.9999999, 0.99999, 0.999, 0.99, 0.9, 0.0)
        while angle < 6 and not product > cosines[angle] * both:
            angle += 1
        slope = 0 if n1[0] == n1[1] == 0 else 1 if n1[2] == 0 else 2
        course = 0 if along[0] == along[1] == 0 else 1 if along[2] == 0 else 2
        length = min(int(dot(along, along)).bit_length() // 2, 15)
        linked = int(self.part[t] == self.part[u])
        bit = self.m.decide(
            "Interior", ((7 * offset + angle) * 16 + self.known[t]) * 16 + self.known[u],
            ((3 * offset + slope) * 3 + course) * 2 + linked,
            ((3 * angle + slope) * 3 + course) * 2 + linked,
            ((7 * offset + angle) * 3 + slope) * 3 + course,
            (16 * offset + length) * 3 + course, (16 * offset + self.history) * 2 + linked,
            selector=offset)
        if offset < 3:
            self.history = (2 * self.history + bit) & 15
        for triangle in (t, u):
            self.known[triangle] += 1 if bit else 4
        if bit:
            self.inner[h] = self.inner[twin] = True
            old, new = max(self.part[t], self.part[u]), min(self.part[t], self.part[u])
            self.part = [new if part == old else part for part in self.part]

    def rings_from(self, start, done):
        """The rings of a closed walk along the boundary of a facet, split where the walk meets
        itself."""
        w, h, stack, rings = self.w, start, [], []
        while True:
            done.add(h)
            v = w.tail(h)
            if v in stack:
                place = stack.index(v)
                rings.append(stack[place:])
                stack = stack[:place]
            stack.append(v)
            h = self.following(h)
            while self.inner[h]:
                h = self.following(w.twin[h])
            if h == start:
                break
        return rings + [stack]

    def following(self, h):
        """The half-edge after h in its triangle."""
        return h - 2 if h % 3 == 2 else h + 1

    def size(self, vertices):
        """The squared diagonal of the box of the vertices."""
        x, y, z = (max(self.points[v][i] for v in vertices) - min(self.points[v][i] for v in vertices)
                   for i in range(3))
        return x * x + y * y + z * z

    def exterior_first(self, rings, context):
        """The rings, the greatest first, then the chosen exterior ring moved to the front."""
        return self.choose(sorted(rings, key=lambda ring: -self.size(ring)), context)

    def choose(self, listed, context):
        """Reads which element is chosen, and returns the list with it first."""
        for i in range(len(listed) - 1):
            if not self.m.decide("Exterior", context):
                return [listed[i]] + listed[:i] + listed[i + 1:]
        return [listed[-1]] + listed[:-1]
