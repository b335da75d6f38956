# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode polygon, the positions, from docs/format-polygon.md."""
import bisect
import math

from entropy import Malformed, cap

START, BARE, EDGE, CORNER, CLOSING, WALL, WALLS = range(7)
LEVEL, STEEP, STANDING = 1, 2, 3


def rounded(value):
    """The nearest whole number; halves are rounded up."""
    return math.floor(value + 0.5) if abs(value) < 2.0**62 else 0


def length(value):
    """The bit length of the magnitude of a number."""
    return abs(value).bit_length()


def half(value):
    """Half of a whole number, rounded towards 0."""
    return value // 2 if value >= 0 else -(-value // 2)


def cross(a, b):
    """The cross product of two vectors, in doubles."""
    a, b = [float(x) for x in a], [float(x) for x in b]
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def square(v):
    """The squared length of a vector, in doubles."""
    total = float(v[0]) * v[0]
    for x in v[1:]:
        total = total + float(x) * x
    return total


def det2(a, b):
    """The cross product of two plane vectors, in doubles."""
    return float(a[0]) * b[1] - float(a[1]) * b[0]


def dot2(a, b):
    """The scalar product of two plane vectors, in doubles."""
    return float(a[0]) * b[0] + float(a[1]) * b[1]


def minus(a, b):
    """The difference of two points, computed in integers."""
    return tuple(x - y for x, y in zip(a, b))


class Turn:
    """A turn of the whole numbers of the plane that brings a direction near to the x axis."""

    def __init__(self, d):
        x, y = float(d[0]), float(d[1])
        self.quarters, self.b, self.c = 0, 0.0, 0.0
        norm = math.sqrt(x * x + y * y)
        if norm == 0:
            return
        while self.quarters < 3 and not x >= abs(y):
            x, y, self.quarters = y, -x, self.quarters + 1
        self.b, self.c = y / (norm + x), -y / norm

    def forward(self, x, y):
        """The offset after the turn."""
        for _ in range(self.quarters):
            x, y = y, -x
        x += rounded(self.b * y)
        y += rounded(self.c * x)
        return x + rounded(self.b * y), y

    def inverse(self, x, y):
        """The offset before the turn, from the offset after it."""
        x -= rounded(self.b * y)
        y -= rounded(self.c * x)
        x -= rounded(self.b * y)
        for _ in range(self.quarters):
            x, y = -y, x
        return x, y


class Plane:
    """The plane of a facet through three of its vertices that are far from one line."""

    def __init__(self):
        self.points, self.normal, self.origin = [], None, None

    def add(self, q):
        """Takes one more vertex of the facet into account."""
        if len(self.points) < 2:
            self.points.append(q)
            self.origin = self.points[0]
            return
        p = self.points
        n = cross(minus(p[1], p[0]), minus(q, p[0]))
        if len(p) == 2:
            if any(n):
                self.take(p + [q], n, p[0])
            return
        m = cross(minus(p[2], p[0]), minus(q, p[0]))
        k = cross(minus(p[2], p[1]), minus(q, p[1]))
        now = square(self.normal)
        if square(n) > now:
            self.take([p[0], p[1], q], n, p[0])
        elif square(m) > now:
            self.take([p[0], q, p[2]], m, p[0])
        elif square(k) > now:
            self.take([q, p[1], p[2]], k, p[1])

    def take(self, points, normal, origin):
        """Replaces the plane by the given one."""
        self.points, self.normal, self.origin = points, normal, origin

    def kind(self):
        """The kind of the plane: 0 none, 1 level, 2 steep, 3 wall."""
        n = self.normal
        if n is None:
            return 0
        if n[0] == 0 and n[1] == 0:
            return LEVEL
        return STANDING if n[2] * n[2] < 0.0004 * square(n) else STEEP

    def height(self, column):
        """The height of the plane at a column."""
        x, y = (float(c) for c in minus(column, self.origin[:2]))
        n = self.normal
        z = self.origin[2] - rounded((x * n[0] + y * n[1]) / n[2])
        return z if abs(z) < 2**53 else self.origin[2]

    def reach(self, column):
        """The distance by which the plane is continued to a column, in a measure of uncertainty."""
        x, y = (float(c) for c in minus(column, self.origin[:2]))
        return 16 * (x * x + y * y) / abs(self.normal[2])


class LongEdges:
    """The list of directions of edges that may come back."""

    def __init__(self):
        self.list = []

    @staticmethod
    def along(e, v):
        """Whether e is nearly parallel to v."""
        d = det2(e, v)
        return d * d <= square(v) * max(0.000009 * square(e), 4.0)

    def take(self, e):
        """Learns the direction of an edge."""
        if e == (0, 0):
            return
        for i, v in enumerate(self.list):
            if self.along(e, v) or self.along(e, (-v[1], v[0])):
                if square(e) > square(v):
                    self.list[i] = e
                return
        if len(self.list) == 8:
            self.list.pop()
        self.list.append(e)

    def follow(self, d):
        """The direction of the list that d stands for, and whether the list has it; else d
        itself."""
        if d == (0, 0):
            return (self.list[0], True) if self.list else (d, False)
        found, longest = None, square(d)
        for v in self.list:
            if square(v) > longest:
                for turned in (v, (-v[1], v[0])):
                    if self.along(d, turned):
                        found, longest = turned, square(v)
                        break
        if found is None:
            return d, False
        return (found if dot2(found, d) >= 0 else (-found[0], -found[1])), True


class Positions:
    """Reads the positions of the vertices of a walk."""

    def __init__(self, walk, last_position, columns):
        self.w, self.m = walk, walk.m
        self.last_position, self.columns = last_position, columns
        count = len(walk.degree)
        self.place = [None] * count
        self.joined = list(range(count))
        self.known_column, self.how_turned = [False] * count, [0] * count
        self.columns_used, self.last_upright = 0, None
        facets = len(walk.facet_level)
        self.planes = [Plane() for _ in range(facets)]
        self.facet_upright, self.vertex_upright = [0] * facets, [0] * count
        self.heights, self.edges = [], LongEdges()

    def read(self):
        """Reads all positions; a vertex that is a copy is joined to an earlier one."""
        copies = self.m.decide("HasCopies", 0)
        for v in range(len(self.place)):
            self.look_around(v)
            if copies and v and self.m.decide("IsCopy", 0):
                self.joined[v] = self.m.uniform(v)
                self.place[v] = self.place[self.joined[v]]
                self.joined[v] = self.joined[self.joined[v]]
            else:
                self.read_place(v)
            self.remember(v)

    def look_around(self, v):
        """Finds the neighbours and corners of a vertex."""
        w = self.w
        self.v, h = v, w.created_in[v]
        self.first = int(w.facet_of[h] == 0)
        ring = w.ring_of[h]
        self.n = w.ring_end[ring] - w.ring_begin[ring]
        back, forth = w.previous(h), w.next(h)
        self.before, self.before2 = self.known_pair(w.origin[back], w.origin[w.previous(back)])
        self.after, self.after2 = self.known_pair(w.origin[forth], w.origin[w.next(forth)])
        self.fan, corner = [h], w.twin[w.previous(h)]
        while corner != h:
            self.fan.append(corner)
            corner = w.twin[w.previous(corner)]
        self.corners = self.fan[:12]

    def known_pair(self, near, far):
        """The two neighbours, each if known; the farther one only if the nearer one is known."""
        if near >= self.v:
            return None, None
        return near, far if far < self.v else None

    def read_place(self, v):
        """Reads the position of one vertex."""
        below = self.read_upright()
        self.upright = below is not None
        if self.upright:
            column = self.place[below][:2]
        else:
            column = self.read_column()
        self.column = column
        z = self.read_height(below)
        self.place[v] = (*column, z)
        if max(abs(c) for c in self.place[v]) >= 2**53:
            raise Malformed("a coordinate that is too large")
        if self.upright:
            self.last_upright = v
        elif self.before is not None:
            self.learn_edge()

    def remember(self, v):
        """Keeps the values of this vertex that later vertices use."""
        place, w = self.place[v], self.w
        if place[2] in self.heights:
            self.heights.remove(place[2])
        self.heights = [place[2]] + self.heights[:11]
        for h in self.fan:
            self.planes[w.facet_of[h]].add(place)
            u = w.end(h)
            if u < v and self.place[u][:2] == place[:2]:
                self.facet_upright[w.facet_of[h]] += 1
                self.facet_upright[w.facet_of[w.twin[h]]] += 1
                self.vertex_upright[u] += 1
                self.vertex_upright[v] += 1

    def read_upright(self):
        """Reads the neighbour in whose column the vertex is, if there is one."""
        w, n = self.w, self.n
        known = [h for h in self.corners if w.end(h) < self.v]
        m = len(known)
        for j, h in enumerate(known):
            u = w.end(h)
            f, g = w.facet_of[h], w.facet_of[w.twin[h]]
            a, b = self.planes[f].kind(), self.planes[g].kind()
            q = 3 * min(self.facet_upright[f], 2) + min(self.facet_upright[g], 2)
            s = min(self.vertex_upright[u], 2)
            i = 0 if u == self.before else 1 if u == self.after else 2
            if self.m.decide("Upright", 3 * (4 * a + b) + s, 2 * (3 * q + s) + self.first,
                             9 * (3 * cap(n - 3, 6) + i) + q,
                             6 * (4 * cap(j, 3) + cap(m, 4)) + 2 * s + self.first, selector=i):
                return u
        return None

    def predict(self):
        """The frame, the base and the direction of a prediction, and whether it is steady."""
        frame, base, d, steady = self.predict_any()
        if max(abs(c) for c in base) >= 2**53:
            base = self.place[0][:2]
        return frame, base, d, steady

    def predict_any(self):
        """The prediction as `predict` returns it, with a base that may be out of range."""
        if self.v == 0:
            return START, self.last_position[:2], (0, 0), False
        walls = []
        for h in self.corners:
            plane = self.planes[self.w.facet_of[h]]
            if plane.kind() == STANDING:
                walls.append(plane)
        if walls:
            return self.predict_by_walls(walls)
        at = self.place
        if self.before is None:
            near = next((self.w.end(h) for h in self.corners if self.w.end(h) < self.v), self.v - 1)
            return BARE, at[near][:2], (0, 0), False
        a = at[self.before][:2]
        if None not in (self.before2, self.after, self.after2):
            p, b, q = at[self.before2][:2], at[self.after][:2], at[self.after2][:2]
            d = minus(a, p)
            if self.n == 4:
                return CLOSING, (a[0] + b[0] - p[0], a[1] + b[1] - p[1]), d, False
            t = minus(b, q)
            det = det2(d, t)
            if det * det > 0.25 * square(d) * square(t):
                s = dot2(t, minus(b, a)) / det
                return (CLOSING, (a[0] + rounded(-d[1] * s), a[1] + rounded(d[0] * s)), d, False)
            return CORNER, a, d, False
        if self.before2 is None:
            d, frame = (0, 0), EDGE
        else:
            d, frame = minus(a, at[self.before2][:2]), CORNER
        d, steady = self.edges.follow(d)
        return frame, a, d, steady

    def predict_by_walls(self, walls):
        """The prediction from one wall or two."""
        first = walls[0]
        n, origin, at = first.normal[:2], first.origin[:2], self.place
        d = (-n[1], n[0])
        for other in walls[1:]:
            m = other.normal[:2]
            det = det2(n, m)
            if det * det >= 0.03 * square(n) * square(m):
                s = dot2(m, minus(other.origin[:2], origin))
                base = (origin[0] + rounded(-n[1] * s / det), origin[1] + rounded(n[0] * s / det))
                return WALLS, base, d, False
        near = origin
        if self.before is not None:
            near = at[self.before][:2]
            if self.after is not None:
                step = minus(at[self.after][:2], near)
                near = (near[0] + half(step[0]), near[1] + half(step[1]))
        s = dot2(minus(near, origin), d) / square(d)
        return WALL, (origin[0] + rounded(d[0] * s), origin[1] + rounded(d[1] * s)), d, False

    def read_column(self):
        """Reads x and y of a vertex."""
        frame, base, d, steady = self.predict()
        turn = Turn(d)
        if self.columns:
            column = self.read_known_column(frame, base, turn)
            if column:
                return column
        if frame == START:
            family = "FirstOffset" if self.columns else "FirstPosition"
            return tuple(base[axis] + self.m.signed(family, axis, bits=55) for axis in (0, 1))
        k = t = 0
        if self.before is not None:
            k, t = cap(self.w.degree[self.before] - 1, 4), self.how_turned[self.before]
        s, m, n, first = int(steady), cap(self.n - 3, 4), self.n, self.first
        size = max(abs(rounded(float(d[0]))), abs(rounded(float(d[1]))))
        one = self.m.number("Across", 2 * (7 * m + frame) + s, cap(length(size), 24) // 2,
                            2 * (4 * t + k) + first, selector=frame, bits=55)
        l = cap(length(one), 16)
        if one and self.m.decide("AcrossSign", 7 * l + frame, 4 * l + t):
            one = -one
        two = self.m.number("Along", 6 * frame + cap(length(one), 6), 4 * (2 * m + first) + t,
                            2 * l + s, selector=frame, bits=55)
        if two and self.m.decide("AlongSign", 7 * cap(length(two), 16) + frame,
                                 2 * (4 * l + t) + first, 4 * (7 * cap(n - 3, 8) + frame) + t):
            two = -two
        self.how_turned[self.v] = 3 if length(two) + 2 < length(one) else 2 if two < 0 else 1
        x, y = turn.inverse(*((two, one) if frame == WALL else (one, two)))
        return base[0] + x, base[1] + y

    def read_known_column(self, frame, base, turn):
        """Reads a column of the page, if the vertex is in one."""
        at = bisect.bisect_left(self.columns, tuple(base))
        around, most = (2048, 2048) if frame == START else (64, 16)
        k = 4 if frame == CORNER else 1
        ranked = []
        for column in self.columns[max(at - around, 0):at + around]:
            x, y = turn.forward(*minus(column, base))
            ranked.append((k * abs(x) + abs(y), column))
        ranked = sorted(ranked)[:most]
        c = 0 if self.before is None else 1 + int(self.known_column[self.before])
        e = cap(length(ranked[0][0]) // 2, 12)
        if not self.m.decide("KnownColumn", 3 * (3 * frame + c) + cap(self.columns_used, 3),
                             3 * e + c, 3 * cap(self.v, 8) + c):
            return None
        rank = self.m.number("ColumnRank", 3 * frame + c, e, bits=12)
        if rank >= len(ranked):
            raise Malformed("no such column")
        self.known_column[self.v] = True
        self.columns_used += 1
        return ranked[rank][1]

    def learn_edge(self):
        """Learns the edge from the vertex before, as far back as it is straight."""
        w, at = self.w, self.place
        e = minus(at[self.v][:2], at[self.before][:2])
        h = w.previous(w.created_in[self.v])
        for _ in range(8):
            h = w.previous(h)
            o = w.origin[h]
            if o >= self.v:
                break
            f = minus(at[self.v][:2], at[o][:2])
            d = det2(f, minus(at[self.before][:2], at[o][:2]))
            if not (d * d <= 4 * square(f) and square(f) > square(e)):
                break
            e = f
        self.edges.take(e)

    def read_height(self, below):
        """Reads z of a vertex."""
        u, v, at = int(self.upright), self.v, self.place
        if v == 0:
            family = "FirstOffset" if self.columns else "FirstPosition"
            return self.last_position[2] + self.m.signed(family, 2, bits=55)
        planes = [self.planes[self.w.facet_of[h]] for h in self.corners]
        planes = [plane for plane in planes if plane.kind() in (LEVEL, STEEP)]
        if planes:
            best = min(planes, key=lambda plane: plane.reach(self.column))
            z = best.height(self.column)
            level = int(best.kind() == LEVEL)
            same = int(all(plane.height(self.column) == z for plane in planes))
            reach = rounded(best.reach(self.column))
            return z + self.m.signed(
                "PlaneResidual", 2 * (3 * level + cap(len(planes) - 1, 3)) + same,
                2 * u + self.first, 2 * cap(length(reach) // 2, 8) + level, selector=level, bits=55)
        candidates = self.height_candidates(below)
        k, known = len(candidates), len(self.heights)
        for i, (z, source) in enumerate(candidates):
            if self.m.decide("KnownHeight", 2 * (4 * i + source) + u,
                             8 * (2 * (2 * source + u) + self.first) + cap(self.n, 8),
                             6 * cap(k - i, 6) + cap(known, 6), selector=u):
                return z
        z, f = self.height_base(below)
        return z + self.m.signed("HeightResidual", 4 * (4 * u + f) + cap(known, 4), self.first,
                                 selector=u, bits=55)

    def height_candidates(self, below):
        """The heights that the vertex may share, each with its source."""
        at, result = self.place, []
        listed = [(w, 0) for w in [self.before] if w is not None]
        listed += [(w, 1) for w in [self.after] if w is not None]
        listed += [(self.w.end(h), 2) for h in self.corners if self.w.end(h) < self.v]
        listed = [(at[w][2], source) for w, source in listed] + [(z, 3) for z in self.heights]
        for z, source in listed:
            if below is not None and z == at[below][2]:
                continue
            if len(result) < 6 and z not in [other for other, _ in result]:
                result.append((z, source))
        return result

    def height_base(self, below):
        """The height from which that of the vertex is counted, and its class."""
        for f, u in enumerate((self.before, self.after)):
            if u is not None and (below is None or self.place[u][:2] != self.column):
                return self.place[u][2], f
        if below is None:
            return self.place[self.v - 1][2], 3
        if self.last_upright is not None:
            return self.place[self.last_upright][2], 2
        return self.place[below][2], 3
