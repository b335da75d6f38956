# SPDX-License-Identifier: GPL-3.0-or-later
"""The canonical solid and its checksum, from docs/format.md."""
import struct
from fractions import Fraction

from entropy import Malformed, crc32c


def is_matched(rings):
    """Whether each directed edge is met by its reverse exactly as often as it occurs."""
    balance = {}
    for ring in rings:
        for a, b in zip(ring, ring[1:] + ring[:1]):
            edge, sign = ((a, b), 1) if a < b else ((b, a), -1)
            balance[edge] = balance.get(edge, 0) + sign
    return not any(balance.values())


class Solid:
    """A solid: vertices on the lattice; shells of facets of rings of vertex numbers, the exterior
    shell and rings first."""

    def __init__(self, vertices, shells, limits):
        limits.vertices(len(vertices))
        limits.shells(len(shells))
        limits.facets(sum(map(len, shells)))
        limits.rings(sum(len(facet) for shell in shells for facet in shell))
        order = sorted(range(len(vertices)), key=lambda v: vertices[v])
        number = {v: i for i, v in enumerate(order)}
        self.vertices = [tuple(vertices[v]) for v in order]
        if len(set(self.vertices)) != len(self.vertices):
            raise Malformed("two vertices at one place")
        self.shells = [self.canonical_shell(shell, number) for shell in shells]
        self.shells[1:] = sorted(self.shells[1:])
        self.facets = [facet for shell in self.shells for facet in shell]
        self.rings = [ring for facet in self.facets for ring in facet]
        self.check_closed()

    @staticmethod
    def canonical_shell(shell, number):
        """A shell in canonical form."""
        facets = []
        for facet in shell:
            rings = []
            for ring in facet:
                ring = [number[v] for v in ring]
                least = ring.index(min(ring))
                rings.append(ring[least:] + ring[:least])
            facets.append(rings[:1] + sorted(rings[1:]))
        return sorted(facets)

    def check_closed(self):
        """Requires that each directed edge is met by its reverse exactly as often as it occurs, in
        the rings as given or in the divided rings."""
        if not self.shells or not all(self.shells) or not all(self.facets):
            raise Malformed("a shell or facet of nothing")
        if any(len(ring) < 3 or len(set(ring)) < len(ring) for ring in self.rings):
            raise Malformed("a ring that is none")
        if not is_matched(self.rings) and not is_matched(self.divided_rings()):
            raise Malformed("a boundary that is not closed")

    def divided_rings(self):
        """The rings, each with the vertices of other rings of its facet that split its edges."""
        for facet in self.facets:
            for ring in facet:
                others = {v for other in facet for v in other} - set(ring)
                divided = []
                for a, b in zip(ring, ring[1:] + ring[:1]):
                    inside = [v for v in others if self.is_between(a, b, v)]
                    divided += [a] + sorted(inside, reverse=a > b)
                yield divided

    def is_between(self, a, b, v):
        """Whether vertex v lies exactly inside the edge from a to b."""
        a, b, v = ([Fraction(c) for c in self.vertices[i]] for i in (a, b, v))
        along, offset = ([q - p for p, q in zip(a, end)] for end in (b, v))
        return (all(min(p, q) <= c <= max(p, q) for p, q, c in zip(a, b, v))
                and all(along[i] * offset[j] == along[j] * offset[i]
                        for i, j in ((0, 1), (1, 2), (2, 0))))

    def checksum(self, frame, origin, arrangement=None):
        """The CRC-32C of the solid in canonical form, serialized."""
        data = struct.pack("<3dBHIB", *frame.tolerances, frame.proof, frame.rule_set, frame.srid,
                           frame.kind)
        for mantissa, exponent in frame.steps + origin:
            data += struct.pack("<qi", mantissa, exponent)
        data += struct.pack("<I", len(self.vertices))
        for vertex in self.vertices:
            data += struct.pack("<3d", *vertex)

        def numbers(values):
            return struct.pack(f"<{len(values) + 1}I", len(values), *values)

        def offsets(lists):
            result = [0]
            for part in lists:
                result.append(result[-1] + len(part))
            return result

        data += numbers([v for ring in self.rings for v in ring])
        data += numbers(offsets(self.rings)) + numbers(offsets(self.facets))
        data += numbers(offsets(self.shells))
        if arrangement:
            for part in arrangement:
                data += numbers(part)
        return crc32c(data)
