# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode bitmap, from docs/format-plain.md."""
import itertools

from delaunay import minus, orient, whole
from entropy import Malformed, Stream, clamp

BENDS = [(62000, 2), (50000, 1), (40000, 0), (20000, 0), (4000, 2), (1000, 4)]


class Model:
    """A probability of 65536 and the number of observations."""

    def __init__(self, p=32768, c=0):
        self.p, self.c = p, c

    def learn(self, bit):
        """Moves the probability towards the bit."""
        r = 655360 // (10 * self.c + 16)
        self.p += (65536 - self.p) * r // 65536 if bit else -(self.p * r // 65536)
        self.p, self.c = clamp(self.p, 32, 65504), min(self.c + 1, 30)


class Bits:
    """Reads bits that are plain or entropy coded."""

    def __init__(self, data, coded):
        self.data, self.at = data, 0
        self.stream = Stream(data) if coded else None

    def read(self, model):
        """Reads the next bit."""
        if self.stream is None:
            bit = self.data[self.at // 8] >> (self.at % 8) & 1
            self.at += 1
            return bit
        bit = self.stream.bit(model.p)
        model.learn(bit)
        return bit

    def unary(self, model):
        """Reads a number: that many ones, then a zero."""
        n = 0
        while self.read(model):
            n += 1
        return n

    def finish(self):
        """Requires that the bits end here as a writer ends them."""
        if self.stream:
            self.stream.finish()
        elif len(self.data) != (self.at + 7) // 8 or (
                self.at % 8 and self.data[-1] >> (self.at % 8)):
            raise Malformed("another ending of the bits")


def edges_of(face):
    """The three edges of a face whose vertices increase."""
    return (face[0], face[1]), (face[0], face[2]), (face[1], face[2])


def first_model(number):
    """The initial model of a context of the bitmap; the number holds hull, open (2 bits), alone,
    blocked, forced."""
    hull, open_edges = number & 1, number >> 1 & 3
    alone, blocked, forced = number >> 3 & 1, number >> 4 & 1, number >> 5
    bad = alone or blocked
    if forced:
        return Model(32768, 0) if bad else Model(64000, 6)
    return Model(1500, 6) if bad else Model((40000 if hull else 16000) + 6000 * open_edges, 1)


def read_bitmap(bits, tetrahedra):
    """Reads which Delaunay faces belong to the boundary, and returns them."""
    count, marked, left = {}, {}, {}
    for tetrahedron in tetrahedra:
        for face in itertools.combinations(tetrahedron, 3):
            count[face] = count.get(face, 0) + 1
    for face in count:
        for edge in edges_of(face):
            left[edge] = left.get(edge, 0) + 1
    models, result = [first_model(number) for number in range(64)], []
    for face in sorted(count):
        state = [(marked.get(edge, 0), left[edge]) for edge in edges_of(face)]
        number = (int((1, 1) in state) << 5 | int(any(m == 2 for m, _ in state)) << 4
                  | int((0, 1) in state) << 3 | sum(m == 1 for m, _ in state) << 1
                  | int(count[face] == 1))
        bit = bits.read(models[number])
        for edge in edges_of(face):
            left[edge] -= 1
            marked[edge] = marked.get(edge, 0) + bit
        if bit:
            result.append(face)
    bits.finish()
    return result


def bend(points, exact, a, b, p, q):
    """The class of a joint: how far its two triangles are from one plane."""
    def cross(u, v):
        return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])

    def dot(u, v):
        return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]

    x, y, z, w = (tuple(float(c) for c in points[i]) for i in (a, b, p, q))
    n, m = cross(minus(y, x), minus(z, x)), cross(minus(y, x), minus(w, x))
    s = dot(n, m)
    if not s < 0:
        return 5
    if orient(exact[a], exact[b], exact[p], exact[q]) == 0:
        return 0
    for k, t in ((1, 0.999999), (2, 0.9998), (3, 0.98)):
        if s * s > t * (dot(n, n) * dot(m, m)):
            return k
    return 4


class Facets:
    """Reads the facets that the boundary faces form."""

    def __init__(self, bits, points, steiner_from, triangles):
        self.bits, self.steiner_from = bits, steiner_from
        self.triangles = sorted(triangles)
        at_edge = {}
        for t, face in enumerate(self.triangles):
            for edge in edges_of(face):
                at_edge.setdefault(edge, []).append(t)
        self.joints = {edge: pair for edge, pair in sorted(at_edge.items()) if len(pair) == 2}
        exact, models = whole(points), [Model(*start) for start in BENDS]
        self.inner = set()
        for (a, b), pair in self.joints.items():
            p, q = (sum(self.triangles[t]) - a - b for t in pair)
            if bits.read(models[bend(points, exact, a, b, p, q)]):
                self.inner.add((a, b))

    def parts(self, edges):
        """For each triangle, the smallest one connected to it through the given joints."""
        part = [None] * len(self.triangles)
        for first in range(len(part)):
            stack = [first] if part[first] is None else []
            while stack:
                t = stack.pop()
                if part[t] is None:
                    part[t] = first
                    for edge in edges_of(self.triangles[t]):
                        if edge in edges:
                            stack += [u for u in self.joints[edge] if part[u] is None]
        return part

    def read(self):
        """Reads the shells, the exterior one first."""
        component, facet = self.parts(self.joints), self.parts(self.inner)
        firsts, turn = sorted(set(component)), Model()
        self.turned = [None] * len(self.triangles)
        for first in firsts:
            self.orient(first, self.bits.read(turn))
        exterior = self.bits.unary(Model(20000, 0)) if len(firsts) > 1 else 0
        self.follower = {}
        for t in range(len(self.triangles)):
            a, b, c = self.corners(t)
            for u, v, w in ((a, b, c), (b, c, a), (c, a, b)):
                self.follower[t, u, v] = w
        several, shells = Model(8000, 0), {first: [] for first in firsts}
        for first in sorted(set(facet)):
            members = [t for t in range(len(facet)) if facet[t] == first]
            shells[component[first]].append(self.rings(members, several))
        self.bits.finish()
        order = [firsts[exterior]] + [first for i, first in enumerate(firsts) if i != exterior]
        return [shells[first] for first in order]

    def corners(self, t):
        """The corners of a triangle in its direction."""
        a, b, c = self.triangles[t]
        return (a, c, b) if self.turned[t] else (a, b, c)

    def directed(self, t):
        """The edges of a triangle in its direction."""
        a, b, c = self.corners(t)
        return (a, b), (b, c), (c, a)

    def orient(self, first, turned):
        """Turns every triangle of a component so that it agrees with the smallest one."""
        self.turned[first], stack = turned, [first]
        while stack:
            t = stack.pop()
            for a, b in self.directed(t):
                for u in self.joints.get((min(a, b), max(a, b)), []):
                    if self.turned[u] is None:
                        self.turned[u] = 0
                        if (a, b) in self.directed(u):
                            self.turned[u] = 1
                        stack.append(u)
                    if u != t and (a, b) in self.directed(u):
                        raise Malformed("a component that cannot be oriented")

    def next(self, t, a, b):
        """The edge that follows a -> b on the boundary of a facet."""
        while True:
            c = self.follower[t, a, b]
            edge = min(b, c), max(b, c)
            if edge not in self.inner:
                return t, b, c
            t = next(u for u in self.joints[edge] if u != t)
            a = c

    def rings(self, members, several):
        """The rings of a facet, the exterior one first."""
        walked, rings = set(), []
        for t in members:
            for a, b in self.directed(t):
                if (min(a, b), max(a, b)) in self.inner or (t, a, b) in walked:
                    continue
                here, stack = (t, a, b), []
                while here not in walked:
                    walked.add(here)
                    if here[1] in stack:
                        place = stack.index(here[1])
                        rings.append(stack[place:])
                        stack = stack[:place]
                    stack.append(here[1])
                    here = self.next(*here)
                rings.append(stack)
        dropped = []
        for ring in rings:
            ring = [v for v in ring if v < self.steiner_from]
            least = ring.index(min(ring))
            dropped.append(ring[least:] + ring[:least])
        dropped.sort()
        exterior = self.bits.unary(several) if len(dropped) > 1 else 0
        return [dropped.pop(exterior)] + dropped
