# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode walk: the boundary among the Delaunay faces, from docs/format-walk.md, "The walk"."""
import heapq
import itertools
import math

import columns
import flags
from delaunay import delaunay, orient
from entropy import Bank, Malformed
from vectors import cross, dot, minus

CANDIDATE = ([504, 756, 1920, 630, 432, 1260, 3960, 1920], 18)
BENDS = [0.96592582628906828, 0.86602540378443865, 0.70710678118654752, 0.5, 0.25881904510252076,
         0.0, -0.25881904510252076, -0.5, -0.70710678118654752, -0.86602540378443865,
         -0.96592582628906828]


def walk_bank():
    """The bank of mode walk."""
    families = {"Candidate": CANDIDATE, "Distant": CANDIDATE, "Rare": ([7],), "Seed": ([84],),
                "Choice": ([768, 1024, 768], 4), **flags.FAMILIES, **columns.FAMILIES}
    return Bank(families, columns.NUMBERS)


def below(x, bounds):
    """The number of bounds at the start of the list that x is below."""
    return next((k for k, bound in enumerate(bounds) if x >= bound), len(bounds))


def octave(x, zero, classes):
    """The class of floor(log2 x) + zero."""
    if not x > 0:
        return 0
    return max(0, min(classes - 1, math.frexp(x)[1] - 1 + zero))


def circumsphere(b, c, d):
    """Centre and squared radius of the sphere through 0, b, c, d; none if the four points are in
    one plane."""
    cd, db, bc = cross(c, d), cross(d, b), cross(b, c)
    volume = 2 * dot(b, cd)
    if volume == 0:
        return (0.0, 0.0, 0.0), 0.0
    b2, c2, d2 = dot(b, b), dot(c, c), dot(d, d)
    centre = tuple((b2 * cd[i] + c2 * db[i] + d2 * bc[i]) / volume for i in range(3))
    return centre, dot(centre, centre)


def likelihood(p):
    """The class of a probability."""
    q = min(p, 65536 - p)
    if q == 0:
        return 0
    n = q.bit_length()
    place = min(2 * (n - 1) + (q >> (n - 2) & 1 if n > 1 else 0), 31)
    return 63 - place if p > 32768 else place


class Faces:
    """The Delaunay faces, their apexes and shapes, and the neighbours of each vertex."""

    def __init__(self, points):
        self.points = [tuple(float(c) for c in p) for p in points]
        self.apexes, self.at_edge, self.neighbours = {}, {}, [set() for _ in points]
        for tetrahedron in delaunay(points, 24):
            for apex in tetrahedron:
                face = tuple(v for v in tetrahedron if v != apex)
                side = orient(*(points[v] for v in face), points[apex]) < 0
                self.apexes.setdefault(face, [None, None])[side] = apex
            for a, b in itertools.permutations(tetrahedron, 2):
                self.neighbours[a].add(b)
        for face in sorted(self.apexes):
            for a, b in itertools.permutations(face, 2):
                w = sum(face) - a - b
                self.at_edge.setdefault((a, b), []).append((face, w))
        self.shapes = {}

    def shape(self, face):
        """Sphere, ratio and gabriel of a face, computed once."""
        if face not in self.shapes:
            self.shapes[face] = self.find_shape(face)
        return self.shapes[face]

    def find_shape(self, face):
        """Computes sphere, ratio and gabriel of a face from the spheres on its two sides."""
        at = self.points
        b, c = minus(at[face[1]], at[face[0]]), minus(at[face[2]], at[face[0]])
        bc, normal = minus(at[face[2]], at[face[1]]), cross(b, c)
        normal2 = dot(normal, normal)
        radius2 = dot(b, b) * dot(c, c) * (dot(bc, bc) / (4 * normal2)) if normal2 > 0 else 0.0
        spheres = [((0.0, 0.0, 0.0), 0.0) if apex is None
                   else circumsphere(b, c, minus(at[apex], at[face[0]]))
                   for apex in self.apexes[face]]
        (m0, r0), (m1, r1) = spheres
        gabriel = sum(r == 0 or r > 1.69 * radius2 for r in (r0, r1))
        least, most = min(r0, r1), max(r0, r1)
        if least > 0:
            between = minus(m0, m1)
            cosine = (r0 + r1 - dot(between, between)) / (2 * math.sqrt(r0 * r1))
            return below(cosine, BENDS), octave(most / least, 0, 8), gabriel
        share = radius2 / most if most > 0 else 0.0
        return 12 + below(share, [0.64, 0.36, 0.16, 0.04]), 8, gabriel


class Gate:
    """An open half-edge a -> b of the known triangle (a, b, o)."""

    def __init__(self, points, a, b, o):
        self.points, self.a, self.b, self.o = points, points[a], points[b], points[o]
        self.e = minus(self.b, self.a)
        self.normal = cross(self.e, minus(self.o, self.a))
        self.length2, self.normal2 = dot(self.e, self.e), dot(self.normal, self.normal)

    def continuation(self, w):
        """Bend, side, deviation, radius and parallelogram of a vertex beyond the gate."""
        from_a, from_b = minus(self.points[w], self.a), minus(self.points[w], self.b)
        normal = cross(from_b, self.e)
        normal2 = dot(normal, normal)
        both, height = math.sqrt(self.normal2 * normal2), dot(self.normal, from_a)
        height2 = height * height
        bend = below(dot(self.normal, normal) / both, BENDS) if both > 0 else 11
        if height2 <= 1e-18 * self.normal2:
            side, deviation = 1, 0
        else:
            side = 0 if height < 0 else 2
            deviation = 1 + sum(height2 > d * self.normal2 for d in (1.0, 9.0, 100.0, 2500.0))
        sides = dot(from_a, from_a) * dot(from_b, from_b)
        radius = octave(sides / (4 * normal2), 2, 10) if normal2 > 0 else 9
        off = minus(from_a, minus(self.b, self.o))
        return bend, side, deviation, radius, octave(dot(off, off) / self.length2, 6, 12)


class Candidate:
    """A vertex that may be the third corner of the triangle beyond a gate."""

    def __init__(self, vertex, selector, contexts):
        self.vertex, self.selector, self.contexts, self.probability = vertex, selector, contexts, 0

    def key(self):
        """The key of a sort: the most probable candidate first, among equals the least vertex."""
        return -self.probability, self.vertex


class Walk:
    """Reads the triangles of the boundary, component by component."""

    def __init__(self, models, points):
        low = [min(p[axis] for p in points) for axis in range(3)]
        points = [tuple(c - l for c, l in zip(p, low)) for p in points]
        if max(c for p in points for c in p) >= 2**30:
            raise Malformed("a solid that is too large")
        self.m, self.n = models, len(points)
        self.faces = Faces(points)
        self.triangles, self.twin, self.component_first = [], [], []
        self.in_any = [False] * self.n
        self.steps_left = 256 * self.n + 2**20

    def read(self):
        """Reads all components."""
        self.manifold = self.m.decide("Rare", 0)
        while True:
            if not all(self.in_any):
                seed = self.in_any.index(False)
            elif self.m.decide("Rare", 5):
                seed = self.m.uniform(self.n)
            else:
                break
            self.component_first.append(len(self.triangles))
            self.component(seed)
        self.component_first.append(len(self.triangles))

    def tail(self, h):
        """The vertex where a half-edge begins."""
        return self.triangles[h // 3][h % 3]

    def head(self, h):
        """The vertex where a half-edge ends."""
        return self.triangles[h // 3][(h + 1 - h // 3 * 3) % 3]

    def previous(self, h):
        """The half-edge before h in its triangle."""
        return h + 2 if h % 3 == 0 else h - 1

    def is_open(self, h):
        """Whether no triangle is known beyond a half-edge."""
        return self.twin[h] is None

    def component(self, seed):
        """Reads one component."""
        self.leaving = [[] for _ in range(self.n)]
        self.by_ends, self.put, self.queue, self.open = {}, {}, [], 0
        self.read_seed(seed)
        while self.open:
            if not self.queue or self.steps_left <= 0:
                raise Malformed("a walk without an end")
            p, h = heapq.heappop(self.queue)
            p = -p
            if not self.is_open(h) or p != self.put[h]:
                continue
            self.list_candidates(h)
            now = self.greatest()
            if now + 1024 < p and self.queue and now < -self.queue[0][0]:
                self.put[h] = now
                heapq.heappush(self.queue, (-now, h))
                continue
            self.read_gate(h)
            if len(self.triangles) > 4 * self.n + 64:
                raise Malformed("too many triangles")

    def add(self, triangle):
        """Adds a triangle, and puts the half-edges that it changes into the queue."""
        t = len(self.triangles)
        self.triangles.append(triangle)
        for k in range(3):
            a, b = triangle[k], triangle[(k + 1) % 3]
            h, beyond = 3 * t + k, self.by_ends.get((b, a))
            self.twin.append(beyond)
            if beyond is None:
                self.open += 1
            else:
                self.twin[beyond] = h
                self.open -= 1
            self.in_any[a] = True
        for k in range(3):
            a, b = triangle[k], triangle[(k + 1) % 3]
            self.by_ends[a, b] = 3 * t + k
            self.leaving[a].insert(0, 3 * t + k)
        for h in range(3 * t, 3 * t + 3):
            if self.is_open(h):
                self.push(h)
        for v in triangle:
            for h in self.leaving[v]:
                if h // 3 == t:
                    continue
                for other in (h, self.previous(h)):
                    if self.is_open(other) and self.put.get(other, 0) < 32768:
                        self.push(other)

    def push(self, h):
        """Scores an open half-edge and puts it into the queue."""
        self.list_candidates(h)
        now = self.greatest()
        if now == 0 or now > self.put.get(h, 0):
            self.put[h] = now
            heapq.heappush(self.queue, (-now, h))

    def greatest(self):
        """The probability of the most probable candidate, 0 without candidates."""
        return max((c.probability for c in self.candidates), default=0)

    def is_possible(self, w):
        """Whether the triangle beyond the gate may end at w."""
        return (w not in self.ends and (self.a, w) not in self.by_ends
                and (w, self.b) not in self.by_ends
                and not (self.manifold and self.is_closed(w)))

    def is_closed(self, v):
        """Whether v has triangles but no open half-edge."""
        return bool(self.leaving[v]) and not any(
            self.is_open(h) or self.is_open(self.previous(h)) for h in self.leaving[v])

    def state(self, w):
        """The class of a vertex w at the front: unused, used, closing, or closed."""
        left = self.by_ends.get((w, self.a))
        right = self.by_ends.get((self.b, w))
        closing = int(left is not None and self.is_open(left))
        closing += 2 * int(right is not None and self.is_open(right))
        if closing:
            return 1 + closing
        if self.is_closed(w):
            return 5
        return int(bool(self.leaving[w]))

    def describe(self, w, face, count):
        """A candidate with its contexts."""
        if face:
            sphere, ratio, gabriel = self.faces.shape(face)
        else:
            sphere = 17 + ((self.a, w) in self.faces.at_edge) + 2 * ((self.b, w) in self.faces.at_edge)
            ratio, gabriel = 9, 3
        bend, side, deviation, radius, parallelogram = self.gate.continuation(w)
        state = self.state(w)
        closes = state - 1 if 2 <= state <= 4 else 0
        kind = 2 if not face else 1 if count == 1 else 0
        count = min(count, 6)
        return Candidate(w, 3 * state + kind, [
            (6 * bend + state) * 7 + count,
            (6 * sphere + bend // 2) * 6 + state,
            ((12 * radius + parallelogram) * 4 + closes) * 4 + gabriel,
            (10 * sphere + radius) * 3 + side,
            ((4 * state + gabriel) * 6 + deviation) * 3 + side,
            (21 * ratio + sphere) * 6 + state,
            ((11 * parallelogram + sphere // 2) * 6 + state) * 5 + min(count, 4),
            ((12 * radius + bend) * 4 + closes) * 4 + gabriel])

    def score(self, family, listed):
        """Computes the probability of each candidate."""
        for c in listed:
            c.probability = self.m.bank[family].mixed(c.contexts, c.selector)[1]

    def list_candidates(self, h):
        """Lists the candidates of a gate: the vertices of its faces, then those that close."""
        a, b, o = self.tail(h), self.head(h), self.tail(self.previous(h))
        self.a, self.b, self.ends = a, b, (a, b, o)
        self.gate = Gate(self.faces.points, a, b, o)
        faces = self.faces.at_edge.get((a, b), [])
        self.steps_left -= 1 + len(self.leaving[a]) + len(self.leaving[b]) + len(faces)
        possible = [(face, w) for face, w in faces if self.is_possible(w)]
        self.candidates = [self.describe(w, face, len(possible)) for face, w in possible]
        listed = {w for _, w in possible}
        closing = {self.tail(self.previous(g)) for g in self.leaving[a]
                   if self.is_open(self.previous(g))}
        closing |= {self.head(g) for g in self.leaving[b] if self.is_open(g)}
        for w in sorted(closing - listed):
            if self.is_possible(w):
                self.candidates.append(self.describe(w, None, len(possible)))
                listed.add(w)
        self.listed = listed
        self.score("Candidate", self.candidates)

    def read_gate(self, h):
        """Reads the triangle beyond a gate whose candidates are listed."""
        self.candidates.sort(key=Candidate.key)
        for i, c in enumerate(self.candidates):
            following = self.candidates[i + 1].probability if i + 1 < len(self.candidates) else 0
            own, then, r = likelihood(c.probability), likelihood(following), min(i, 3)
            state, kind = divmod(c.selector, 3)
            bit = self.m.decide("Choice", (4 * own + r) * 3 + kind, 32 * (own // 2) + then // 2,
                                (own // 2 * 6 + state) * 4 + r, selector=r)
            family = self.m.bank["Candidate"]
            inputs, p = family.mixed(c.contexts, c.selector)
            family.learn(c.contexts, c.selector, inputs, p, bit)
            if bit:
                return self.add((self.b, self.a, c.vertex))
        return self.add((self.b, self.a, self.read_distant()))

    def read_distant(self):
        """Reads a distant candidate."""
        self.steps_left -= len(self.faces.neighbours[self.a]) + len(self.faces.neighbours[self.b])
        near = self.faces.neighbours[self.a] | self.faces.neighbours[self.b]
        distant = [self.describe(w, None, 0) for w in near - self.listed if self.is_possible(w)]
        self.score("Distant", distant)
        distant.sort(key=Candidate.key)
        if distant and self.m.decide("Rare", 1 + min(len(distant) // 4, 3)):
            for c in distant[:-1]:
                if self.m.decide("Distant", *c.contexts, selector=c.selector):
                    return c.vertex
            return distant[-1].vertex
        w = self.m.uniform(self.n)
        if not self.is_possible(w):
            raise Malformed("an impossible vertex")
        return w

    def read_seed(self, s):
        """Reads the first triangle of a component."""
        outward, inward, inner = [], [], []
        for face in sorted(face for face in self.faces.apexes if s in face):
            i, j, k = face
            sphere = self.faces.shape(face)[0]
            above, under = self.faces.apexes[face]
            first, second = (i, j, k), (i, k, j)
            if under is None:
                first, second = second, first
            if above is None or under is None:
                outward.append((first, sphere))
                inward.append((second, 21 + sphere))
            else:
                inner += [(first, 42 + sphere), (second, 63 + sphere)]
        seeds = outward + inward + inner
        self.steps_left -= len(seeds)
        for triangle, context in seeds:
            if self.m.decide("Seed", context):
                return self.add(triangle)
        triangle = s, self.m.uniform(self.n), self.m.uniform(self.n)
        if len(set(triangle)) < 3:
            raise Malformed("a triangle with two corners")
        return self.add(triangle)
