# SPDX-License-Identifier: GPL-3.0-or-later
"""The canonical solid and its checksum, from docs/format.md."""
import struct

from entropy import Malformed, crc32c


class Solid:
    """Vertices on the lattice; shells of facets of rings of vertex numbers, exterior ones first."""

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
        """The shell in canonical form."""
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
        """Requires that each directed edge is met by its reverse exactly as often."""
        if not self.shells or not all(self.shells) or not all(self.facets):
            raise Malformed("a shell or facet of nothing")
        balance = {}
        for ring in self.rings:
            if len(ring) < 3 or len(set(ring)) < len(ring):
                raise Malformed("a ring that is none")
            for a, b in zip(ring, ring[1:] + ring[:1]):
                edge, sign = ((a, b), 1) if a < b else ((b, a), -1)
                balance[edge] = balance.get(edge, 0) + sign
        if any(balance.values()):
            raise Malformed("a boundary that is not closed")

    def checksum(self, frame, origin, arrangement=None):
        """The CRC-32C of the canonical serialization."""
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
