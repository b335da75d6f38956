# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode polygon, the surface, from docs/format-polygon.md."""
from entropy import Bank, Malformed, cap

FAMILIES = {
    "Size": ([384, 64, 160, 128, 192], 4), "Degree": ([24, 192, 144],), "New": ([216, 216, 108],),
    "OnLoop": ([12],), "Follow": ([8, 4],), "MoreRings": ([9, 48],), "RingStart": ([2],),
    "MoreShells": ([4],), "HasCopies": ([1],), "IsCopy": ([1],), "Upright": ([48, 54, 162, 72], 3),
    "KnownColumn": ([63, 36, 24],), "AcrossSign": ([112, 64],), "AlongSign": ([112, 128, 224],),
    "KnownHeight": ([48, 128, 36], 2)}
NUMBERS = {
    "Long": ([2],), "LoopSteps": ([6, 12],), "GateSteps": ([1],), "FirstPosition": ([3],),
    "FirstOffset": ([3],), "Across": ([56, 12, 32], 7), "Along": ([42, 32, 32], 7),
    "ColumnRank": ([21, 12],), "PlaneResidual": ([12, 4, 16], 2), "HeightResidual": ([32, 2], 2)}


def polygon_bank():
    """The bank of mode polygon."""
    return Bank(FAMILIES, NUMBERS)


class Chain:
    """Known facets around a vertex that follow each other."""

    def __init__(self, into, out):
        self.into, self.out = into, out


class Surface:
    """Reads the surface: rings of half-edges with twins, facets, shells."""

    def __init__(self, models, limits):
        self.m, self.limits = models, limits
        self.origin, self.twin, self.ring_of, self.facet_of = [], [], [], []
        self.remaining, self.degree, self.chains, self.created_in = [], [], [], []
        self.ring_begin, self.ring_end = [], []
        self.facet_level, self.facet_rings, self.facet_exterior = [], [], []
        self.shell_begin = []
        self.last_degree, self.gate, self.turn = 3, None, 0

    def next(self, h):
        """The half-edge after h in its ring."""
        ring = self.ring_of[h]
        return h + 1 if h + 1 < self.ring_end[ring] else self.ring_begin[ring]

    def previous(self, h):
        """The half-edge before h in its ring."""
        ring = self.ring_of[h]
        return h - 1 if h > self.ring_begin[ring] else self.ring_end[ring] - 1

    def end(self, h):
        """The vertex to which h leads."""
        return self.origin[self.next(h)]

    def read(self):
        """Reads all shells."""
        shell = 0
        while True:
            self.limits.shells(shell + 1)
            self.shell_begin.append(len(self.facet_level))
            component = 0
            while True:
                self.component()
                component += 1
                if not self.m.decide("MoreShells", 2 + cap(component - 1, 2)):
                    break
            if not self.m.decide("MoreShells", cap(shell, 2)):
                return
            shell += 1

    def component(self):
        """Reads one component."""
        self.turn = len(self.origin)
        self.facet(None, 0)
        while self.turn < len(self.origin):
            gate = self.turn
            if self.twin[gate] is None:
                self.facet(gate, cap(self.facet_level[self.facet_of[gate]] + 1, 3))
            self.turn += 1

    def facet(self, gate, level):
        """Reads one facet with all its rings."""
        self.gate = gate
        facet = len(self.facet_level)
        self.limits.facets(facet + 1)
        self.facet_level.append(level)
        self.facet_rings.append([])
        Ring(self, facet, 0).read()
        first = self.facet_rings[facet][0]
        size = self.ring_end[first] - self.ring_begin[first]
        r = 1
        while self.m.decide("MoreRings", 3 * cap(r - 1, 3) + level, 16 * cap(r - 1, 3) + cap(size, 16)):
            Ring(self, facet, r).read()
            r += 1
        self.facet_exterior.append(self.m.uniform(r) if r > 1 else 0)

    def new_vertex(self, level, n):
        """Reads the degree of a new vertex and returns the vertex."""
        self.limits.vertices(len(self.degree) + 1)
        d, last = 2, self.last_degree
        while True:
            s = cap(d - 2, 8)
            if d == 24:
                d += self.m.number("Long", 1, bits=28)
                break
            if self.m.decide("Degree", 3 * s + level, 3 * (8 * s + cap(n, 8)) + level,
                             3 * (6 * s + cap(last - 2, 6)) + level):
                break
            d += 1
        self.last_degree = d
        self.remaining.append(d)
        self.degree.append(d)
        self.chains.append([])
        self.created_in.append(None)
        return len(self.degree) - 1


class Ring:
    """A ring while it is read: its vertices, and for each edge the twin, if known."""

    def __init__(self, walk, facet, number):
        self.w, self.m, self.facet, self.number = walk, walk.m, facet, number
        self.level = walk.facet_level[facet]
        self.vertices, self.twins, self.new = [], [], []
        self.size, self.closed, self.gate_size = 0, False, 0
        self.backward = 0

    def read(self):
        """Reads the whole ring."""
        self.w.limits.rings(len(self.w.ring_begin) + 1)
        self.begin()
        if not self.closed:
            self.size = self.read_size()
            while not self.closed:
                self.step()
        self.append()

    def begin(self):
        """Reads the start of the ring: at a gate, at a new vertex or at a known one."""
        w = self.w
        if self.number == 0 and w.gate is not None:
            return self.begin_at_gate(w.gate)
        if self.number == 0 or self.m.decide("RingStart", 0):
            return self.add_new()
        if self.m.decide("RingStart", 1):
            steps = self.m.number("GateSteps", 0, bits=9)
            for h in range(w.turn, min(w.turn + 4096, len(w.origin))):
                if w.twin[h] is None:
                    if steps == 0:
                        return self.begin_at_gate(h)
                    steps -= 1
            raise Malformed("no such gate")
        v = self.m.uniform(len(w.degree))
        if w.remaining[v] == 0:
            raise Malformed("a vertex without room")
        self.vertices.append(v)
        return None

    def add_new(self):
        """Appends a new vertex to the ring."""
        v = self.w.new_vertex(self.level, self.size)
        self.new.append(v)
        self.vertices.append(v)

    def begin_at_gate(self, gate):
        """Begins with the edge along a gate, and adds the edges that follow from it at both
        ends."""
        w = self.w
        self.gate_size = w.ring_end[w.ring_of[gate]] - w.ring_begin[w.ring_of[gate]]
        self.vertices, self.twins = [w.end(gate), w.origin[gate]], [gate]
        while not self.closed:
            chains = w.chains[self.vertices[-1]]
            if len(chains) != 1 or w.remaining[self.vertices[-1]] != 1:
                break
            self.follow(chains[0])
        while not self.closed:
            chains = w.chains[self.vertices[0]]
            if len(chains) != 1 or w.remaining[self.vertices[0]] != 1:
                break
            out = chains[0].out
            self.backward += 1
            self.twins.insert(0, out)
            if w.end(out) == self.vertices[-1]:
                self.twins = self.twins[1:] + self.twins[:1]
                self.closed = True
            else:
                self.add(w.end(out), front=True)

    def add(self, vertex, front=False):
        """Adds a known vertex at one of the two ends."""
        if vertex in self.vertices:
            raise Malformed("a vertex twice in a ring")
        self.vertices.insert(0 if front else len(self.vertices), vertex)

    def follow(self, chain):
        """Adds the edge along the half-edge `in` of the chain, backward."""
        vertex = self.w.origin[chain.into]
        self.twins.append(chain.into)
        if vertex == self.vertices[0]:
            self.closed = True
        else:
            self.add(vertex)

    def own(self):
        """The chain along which the ring came to its end, if its last edge has a known twin."""
        if self.twins and self.twins[-1] is not None:
            for chain in self.w.chains[self.vertices[-1]]:
                if chain.out == self.twins[-1]:
                    return chain
            raise Malformed("no chain")
        return None

    def loop(self):
        """The vertices of the front from the end of the ring, and whether they reach its start."""
        w, end = self.w, self.vertices[-1]
        if not w.chains[end]:
            return [], False
        h = (self.own() or w.chains[end][0]).into
        entries = []
        for step in range(64):
            v = w.origin[h]
            if v == self.vertices[0]:
                return entries, True
            if v == end:
                return entries, False
            if step > 0 and w.remaining[v] > len(w.chains[v]) and v not in self.vertices:
                entries.append(v)
            h = next(chain.into for chain in w.chains[v] if chain.out == h)
        return entries, False

    def read_size(self):
        """Reads the number of vertices of the ring."""
        run = len(self.vertices)
        least, d = max(run, 3), self.w.last_degree
        p = 3 if self.number else self.level
        entries, reaches = self.loop()
        for n in range(least, least + 24):
            t = 1 + cap(run + len(entries) + 1 - n, 4) if reaches else 0
            if self.m.decide("Size", 32 * cap(n - least, 12) + 4 * cap(run - 1, 8) + p,
                             4 * cap(n - 3, 16) + p,
                             4 * (5 * cap(run - 1, 8) + t) + cap(n - least, 4),
                             4 * (4 * cap(self.gate_size, 8) + p) + cap(n - least, 4),
                             3 * (4 * cap(n - 3, 16) + cap(d - 2, 4)) + cap(run - 1, 3),
                             selector=p):
                return n
        return least + 24 + self.m.number("Long", 0, bits=28)

    def step(self):
        """Reads one edge from the end of the ring."""
        w, n = self.w, self.size
        e, own = self.vertices[-1], self.own()
        chains = w.chains[e]
        others = [chain for chain in chains if chain is not own]
        possible = len(self.vertices) == 1 or w.remaining[e] > len(chains) + (0 if own else 1)
        chosen = None
        if others:
            follows = not possible or self.m.decide("Follow", cap(n, 8),
                                                    cap(w.remaining[e] - len(chains), 4))
            if follows:
                chosen = others[self.m.uniform(len(others)) if len(others) > 1 else 0]
        elif not possible and own and w.remaining[e] == 1:
            chosen = own
        count = len(self.vertices)
        if chosen:
            self.follow(chosen)
            if self.closed != (count == n):
                raise Malformed("a ring of another size")
        elif count == n:
            self.twins.append(None)
            self.closed = True
        else:
            self.new_edge(count)

    def new_edge(self, count):
        """Reads an edge without a known twin that leads to a vertex other than the start."""
        w, n, level = self.w, self.size, self.level
        entries, reaches = self.loop()
        l = 2 * cap(len(entries), 6) + int(reaches)
        f = cap(n - count - 1, 6)
        self.twins.append(None)
        back, forth = cap(self.backward, 3), cap(count - 1 - self.backward, 3)
        if not w.degree or self.m.decide("New", 3 * (6 * l + f) + level,
                                         3 * (6 * cap(n - 3, 12) + f) + level,
                                         12 * (3 * back + forth) + l):
            self.add_new()
        elif entries and self.m.decide("OnLoop", l):
            step = self.m.number("LoopSteps", f, l, bits=6)
            if step >= len(entries):
                raise Malformed("no such entry")
            self.add(entries[step])
        else:
            self.add(self.m.uniform(len(w.degree)))

    def append(self):
        """Ends the ring: adds its half-edges, twins and chains to the surface."""
        w, n, first = self.w, len(self.vertices), len(self.w.origin)
        ring = len(w.ring_begin)
        w.ring_begin.append(first)
        w.ring_end.append(first + n)
        w.facet_rings[self.facet].append(ring)
        for i, (v, twin) in enumerate(zip(self.vertices, self.twins)):
            w.origin.append(v)
            w.twin.append(twin)
            w.ring_of.append(ring)
            w.facet_of.append(self.facet)
            if twin is not None:
                if w.twin[twin] is not None:
                    raise Malformed("an edge met twice")
                w.twin[twin] = first + i
            if v in self.new:
                w.created_in[v] = first + i
        for i, v in enumerate(self.vertices):
            self.corner(v, first + (i - 1) % n, first + i)

    def corner(self, v, into, out):
        """Adds the corner of the facet at v, between its half-edges into and out of v."""
        w = self.w
        chains = w.chains[v]
        before = next((c for c in chains if w.twin[into] == c.out), None)
        after = next((c for c in chains if w.twin[out] == c.into), None)
        w.remaining[v] -= 1
        if before and after:
            before.out = after.out
            chains.remove(after)
        elif before:
            before.out = out
        elif after:
            after.into = into
        else:
            chains.insert(0, Chain(into, out))
        if w.remaining[v] < len(chains) or (not chains and w.remaining[v]) or len(chains) > 64:
            raise Malformed("a vertex without room")
