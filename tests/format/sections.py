# SPDX-License-Identifier: GPL-3.0-or-later
"""The sections of modes raw and bitmap, from docs/format-plain.md."""
import math
import struct

from entropy import Malformed, varint

LARGEST = 2**53


def is_whole(value):
    """Whether a coordinate is written as an integer."""
    return abs(value) <= LARGEST and value == math.floor(value)


class Section:
    """The bytes of one section, read front to back."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def byte(self):
        """Reads the next byte."""
        self.at += 1
        return self.data[self.at - 1]

    def varint(self):
        """Reads an unsigned number."""
        value, self.at = varint(self.data, self.at)
        return value

    def count(self, least_bytes):
        """Reads the number of elements that take at least so many bytes each."""
        value = self.varint()
        if value * least_bytes > len(self.data) - self.at:
            raise Malformed("a section that is too short for its count")
        return value

    def zigzag(self):
        """Reads a signed number."""
        value = self.varint()
        return -(value + 1) // 2 if value & 1 else value // 2

    def double(self):
        """Reads a coordinate that is not an integer."""
        value = struct.unpack_from("<d", self.data, self.at)[0]
        self.at += 8
        if not math.isfinite(value) or (value == 0 and math.copysign(1, value) < 0):
            raise Malformed("no coordinate")
        return value

    def finish(self, points=()):
        """Requires that the section ends here, and that the points ascend."""
        if self.at != len(self.data):
            raise Malformed("a section that is longer than its contents")
        if any(p >= q for p, q in zip(points, points[1:])):
            raise Malformed("points that do not ascend")
        return points

    def vertices(self, limits):
        """Reads the section of vertices."""
        kind, count = self.byte(), self.varint()
        limits.vertices(count)
        if kind > 1 or 3 * count > len(self.data) - self.at:
            raise Malformed("vertices")
        result = []
        if kind == 1:
            result = [(self.double(), self.double(), self.double()) for _ in range(count)]
            if all(is_whole(c) for p in result for c in p):
                raise Malformed("integers written as doubles")
            return self.finish(result)
        for i in range(count):
            x, y, z = result[-1] if i else (0, 0, 0)
            x += self.varint() if i else self.zigzag()
            result.append((x, y + self.zigzag(), z + self.zigzag()))
            if max(abs(c) for c in result[-1]) > LARGEST:
                raise Malformed("a coordinate that is too large")
        return self.finish(result)

    def steiner(self):
        """Reads the section of Steiner vertices."""
        result = []
        for _ in range(self.count(3)):
            whole, point = self.byte(), []
            for axis in range(3):
                point.append(self.zigzag() if whole >> axis & 1 else self.double())
                if is_whole(point[-1]) != bool(whole >> axis & 1):
                    raise Malformed("a coordinate of another kind")
            if whole > 7:
                raise Malformed("flags of a Steiner vertex")
            result.append(tuple(point))
        if not result:
            raise Malformed("an empty section")
        return self.finish(result)

    def unrecovered(self, nodes):
        """Reads the section of unrecovered faces."""
        result, a = [], 0
        for _ in range(self.count(3)):
            a += self.varint()
            b = a + 1 + self.varint()
            result.append((a, b, b + 1 + self.varint()))
            if result[-1][2] >= nodes:
                raise Malformed("a face of other vertices")
        if not result:
            raise Malformed("an empty section")
        return self.finish(result)

    def facets(self, vertices, limits):
        """Reads the section of listed facets."""
        shells, facets = [], 0
        count = self.count(1)
        limits.shells(count)
        for _ in range(count):
            size = self.count(1)
            facets += size
            limits.facets(facets)
            shells.append([self.facet(vertices) for _ in range(size)])
        limits.rings(sum(len(facet) for shell in shells for facet in shell))
        self.finish()
        return shells

    def facet(self, vertices):
        """Reads one listed facet."""
        head = self.varint()
        sizes = [head // 2]
        if head & 1:
            interior = self.count(1)
            if interior == 0:
                raise Malformed("no interior ring")
            sizes += [self.varint() for _ in range(interior)]
        if sum(sizes) > len(self.data) - self.at:
            raise Malformed("a facet that is too long")
        rings = [[self.varint() for _ in range(size)] for size in sizes]
        if any(v >= vertices for ring in rings for v in ring):
            raise Malformed("no such vertex")
        return rings
