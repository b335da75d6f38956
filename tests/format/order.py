# SPDX-License-Identifier: GPL-3.0-or-later
"""The order of the source, from docs/format.md, "Order"."""
from entropy import Bank, Malformed


def order_bank():
    """The bank of the source order."""
    return Bank({"straight": ([8],), "candidate": ([216, 150, 576], 6), "scan": ([50, 80, 64],),
                 "start": ([720, 120, 135, 648, 256, 144], 5)}, {})


def sign(u, v):
    """The class of v: 0 below, 1 at, 2 above u."""
    return 0 if v < u else 2 if v > u else 1


class Order:
    """Reads the order in which the source had a canonical solid."""

    def __init__(self, models, solid):
        self.m, self.solid = models, solid
        self.first_facet, self.first_ring = [], []
        facet = ring = 0
        for shell in solid.shells:
            self.first_facet.append(facet)
            facet += len(shell)
        for rings in solid.facets:
            self.first_ring.append(ring)
            ring += len(rings)
        self.facing, self.size = zip(*(self.look(rings[0]) for rings in solid.facets))
        self.facet_of_edge = {}
        for facet, rings in enumerate(solid.facets):
            for ring in rings:
                for a, b in zip(ring, ring[1:] + ring[:1]):
                    self.facet_of_edge.setdefault((a, b), facet)
        self.shells, self.facets, self.rings = [], [], []
        self.starts = [0] * len(solid.rings)
        self.rank, self.known, self.last_seen_facet = {}, 0, None
        self.seen_facets = set()

    def look(self, ring):
        """The facing and the size of a facet."""
        points = [tuple(map(float, self.solid.vertices[v])) for v in ring]
        o, n = points[0], [0.0, 0.0, 0.0]
        for p, q in zip(points, points[1:] + points[:1]):
            for i, (u, v) in enumerate(((1, 2), (2, 0), (0, 1))):
                n[i] += (p[u] - o[u]) * (q[v] - o[v]) - (p[v] - o[v]) * (q[u] - o[u])
        h, t = abs(n[0]) + abs(n[1]), abs(n[2])
        if 16 * h <= t:
            return 0 if n[2] > 0 else 1, h + t
        if 16 * t <= h:
            return 2, h + t
        return 3 if n[2] > 0 else 4, h + t

    def across(self, ring, i):
        """The facet beyond the edge that starts at a position of a ring."""
        a, b = ring[i % len(ring)], ring[(i + 1) % len(ring)]
        return self.facet_of_edge.get((b, a))

    def arrangement(self, m, fixed, context):
        """Reads the order in which the source had m members."""
        result = list(range(m))
        if m < fixed + 2 or self.m.decide("straight", context):
            return result
        for i in range(fixed, m - 1):
            j = i + self.m.uniform(m - i)
            result[i], result[j] = result[j], result[i]
        return result

    def read(self):
        """Reads the source order; returns the five lists over which the checksum runs."""
        self.shells = self.arrangement(len(self.solid.shells), 1, 0)
        for shell in self.shells:
            self.read_shell(shell)
        used = []
        for ring in self.rings:
            corners = self.solid.rings[ring]
            used += corners[self.starts[ring]:] + corners[:self.starts[ring]]
        numbered = list(dict.fromkeys(used + list(range(len(self.solid.vertices)))))
        vertices = [numbered[i] for i in self.arrangement(len(numbered), 0, 2)]
        result = []
        for members in (vertices, self.shells, self.facets, self.rings):
            place = [0] * len(members)
            for i, member in enumerate(members):
                place[member] = i
            result.append(place)
        result.append(self.starts)
        if not any(self.starts) and all(part == sorted(part) for part in result[:4]):
            raise Malformed("the source order equals the canonical order, which the format leaves out")
        return result

    def read_shell(self, shell):
        """Reads the facets of a shell, with their rings."""
        begin = self.first_facet[shell]
        self.left = set(range(begin, begin + len(self.solid.shells[shell])))
        self.count, self.begin = len(self.left), begin
        self.h1 = self.h2 = 5
        self.last, self.reference = None, None
        while self.left:
            if len(self.left) == 1:
                facet = min(self.left)
            else:
                facet = self.read_facet()
            self.left.discard(facet)
            self.last = facet
            self.facets.append(facet)
            self.read_rings(facet)

    def source_ring(self, facet):
        """The exterior ring of a facet, from its start in the source."""
        first = self.first_ring[facet]
        ring, start = self.solid.rings[first], self.starts[first]
        return ring[start:] + ring[:start]

    def candidates(self):
        """The facets that may be next: number, habit, reference."""
        listed = []
        if self.reference:
            facet, k = self.reference
            ring = self.source_ring(facet)
            listed.append((self.across(ring, k + 1), 0, (facet, (k + 1) % len(ring))))
            listed.append((self.across(ring, k - 1), 1, (facet, (k - 1) % len(ring))))
        ring = self.source_ring(self.last)
        for k in range(min(len(ring), 12)):
            listed.append((self.across(ring, k), 2, (self.last, k)))
        after = [facet for facet in sorted(self.left) if facet > self.last]
        if after:
            listed.append((after[0], 3, None))
        listed.append((min(self.left), 4, None))
        result = []
        for facet, habit, reference in listed:
            if facet in self.left and facet not in [other[0] for other in result]:
                result.append((facet, habit, reference))
        return result

    def read_facet(self):
        """Reads the next of several facets."""
        denied = set()
        a = 0 if self.last is None else self.facing[self.last]
        if self.last is not None:
            for i, (facet, h, reference) in enumerate(self.candidates()):
                b = self.facing[facet]
                if self.m.decide("candidate", 36 * self.h1 + 6 * self.h2 + h, 6 * (5 * a + b) + h,
                                 6 * (6 * min(i, 15) + h) + self.h1, selector=h):
                    self.reference = reference
                    self.h1, self.h2 = h, self.h1
                    return facet
                denied.add(facet)
        self.h1, self.h2, self.reference = 5, self.h1, None
        rest = sorted(self.left - denied)
        if not rest:
            raise Malformed("no facet left")
        if len(rest) > 64:
            facet = self.begin + self.m.uniform(self.count)
            if facet not in self.left:
                raise Malformed("a facet twice")
            return facet
        e = int(self.last is None)
        largest = {}
        for facet in rest:
            b = self.facing[facet]
            largest[b] = max(largest.get(b, 0), self.size[facet])
        for i, facet in enumerate(rest[:-1]):
            b, r = self.facing[facet], len(rest) - i
            g = int(self.size[facet] == largest[b])
            if self.m.decide("scan", 2 * (5 * a + b) + g, 8 * (2 * b + g) + 4 * e + min(r // 4, 3),
                             min(r, 63)):
                return facet
        return rest[-1]

    def read_rings(self, facet):
        """Reads the order of the rings of a facet and their starts."""
        for ring in self.arrangement(len(self.solid.facets[facet]), 1, 1):
            self.rings.append(self.first_ring[facet] + ring)
            self.read_start(facet, self.first_ring[facet] + ring)

    def read_start(self, facet, number):
        """Reads the start of a ring."""
        ring, points = self.solid.rings[number], self.solid.vertices
        size, chosen = len(ring), len(ring) - 1
        lowest = min(points[v][2] for v in ring)
        seen_ranks = [self.rank[v] for v in ring if v in self.rank]

        def kind(corner):
            other = self.across(ring, corner)
            if other is None or other == facet or other not in self.seen_facets:
                return 0
            return 1 if other == self.last_seen_facet else 2

        for i in range(size - 1):
            p, here, q = ring[i - 1], ring[i], ring[(i + 1) % size]
            seen = sum(w for w, v in ((4, p), (2, here), (1, q)) if v in self.rank)
            oldest = int(here in self.rank and self.rank[here] == min(seen_ranks))
            known = 3 * kind(i) + kind(i - 1)
            rise, fall = sign(points[here][2], points[q][2]), sign(points[p][2], points[here][2])
            low, f, b = int(points[here][2] == lowest), int(i == 0), self.facing[facet]
            if self.m.decide(
                    "start", ((2 * seen + oldest) * 5 + b) * 9 + known,
                    (((2 * f + low) * 3 + rise) * 5 + b) * 2 + oldest,
                    ((3 * sign(points[here][0], points[q][0]) + sign(points[here][1], points[q][1]))
                     * 3 + rise) * 5 + b,
                    (9 * self.known + known) * 8 + seen, 16 * min(i, 15) + min(size, 15),
                    (((2 * f + low) * 3 + rise) * 3 + fall) * 4 + (seen & 3), selector=b):
                self.known, chosen = known, i
                break
        self.starts[number] = chosen
        for v in ring[chosen:] + ring[:chosen]:
            self.rank.setdefault(v, len(self.rank))
        self.seen_facets.add(facet)
        self.last_seen_facet = facet
