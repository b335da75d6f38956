# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode walk, the columns of the vertices, from docs/format-walk.md, "Columns"."""
from entropy import Malformed, cap

FAMILIES = {"Place": ([80],), "Height": ([96, 48, 128],), "TopBits": ([24, 744],)}
NUMBERS = {"Position": ([6],), "Size": ([6, 186],), "Gap": ([31],), "Residual": ([16], 2),
           "Rank": ([16],), "Floors": ([6],)}
LIMIT = 2**53


class Columns:
    """Reads the vertices in lexicographic order."""

    def __init__(self, models, last_position, page_columns, limits):
        self.m, self.last_position, self.known = models, last_position, page_columns
        self.limits = limits
        self.columns, self.heights, self.before = [], [], []
        self.was_known = 0

    def read(self):
        """Reads and returns the vertices."""
        self.read_box()
        for i in range(1, self.count):
            place = self.known_place() or self.corner(i) or self.free(i)
            if place <= self.columns[-1] or max(abs(c) for c in place) >= LIMIT:
                raise Malformed("columns that do not ascend")
            self.columns.append(place)
        points = []
        for column in self.columns:
            points += [(*column, z) for z in self.read_heights(len(points))]
        return points

    def top_bits(self, k, n):
        """Reads a number of n bits, the first three with models."""
        node = 1
        for _ in range(min(n, 3)):
            node = 2 * node + self.m.decide("TopBits", 8 * k + node, 8 * (31 * k + n) + node)
        rest = n - min(n, 3)
        return (node - (1 << min(n, 3))) << rest | (self.m.plain(rest) if rest else 0)

    def size(self, kind, before, bits):
        """Reads a length of the box or the number of columns."""
        return self.m.number("Size", kind, 31 * kind + before, bits=bits)

    def read_box(self):
        """Reads the first point, the box and the number of columns."""
        f = int(not self.known)
        first = [self.last_position[a] + self.m.signed("Position", 2 * a + f, bits=54)
                 for a in range(3)]
        if max(abs(c) for c in first) >= LIMIT:
            raise Malformed("a first point that is too far")
        lengths = [0]
        for a in range(3):
            lengths.append(self.size(a, lengths[-1], 5))
            if lengths[-1] > 30:
                raise Malformed("a box that is too large")
        self.lengths = lengths[1:]
        self.count = self.size(3, 0, 40) + 1
        self.limits.vertices(self.count)
        y, z = self.top_bits(0, self.lengths[1]), self.size(4, 0, 30)
        self.low = [first[0], first[1] - y, first[2] - z]
        self.end = [low + (1 << n) for low, n in zip(self.low, self.lengths)]
        self.columns.append(tuple(first[:2]))
        self.first_z = first[2]

    def known_place(self):
        """Reads a column that the page has already, if the next one is such a column."""
        after = [c for c in self.known if c > self.columns[-1]][:4096]
        listed = [c for c in after if self.low[0] <= c[0] < self.end[0]
                  and self.low[1] <= c[1] < self.end[1]][:64]
        if not listed:
            return None
        c = min(len(listed), 7)
        self.was_known = self.m.decide("Place", 2 * c + self.was_known)
        if not self.was_known:
            return None
        return listed[self.m.number("Rank", c, bits=6)]

    def corner(self, i):
        """Reads a column near the fourth corner of a parallelogram, if the next one is."""
        last, listed = range(max(0, i - 5), i), []
        for c in last:
            for a in last:
                for b in last:
                    if b <= a or c in (a, b):
                        continue
                    x, y = (self.columns[a][k] + self.columns[b][k] - self.columns[c][k]
                            for k in (0, 1))
                    if (self.columns[-1][0] - 32 <= x < self.end[0] + 32
                            and self.low[1] - 32 <= y < self.end[1] + 32):
                        listed.append((x, y))
        if not listed:
            return None
        k = min(len(listed), 7)
        if not self.m.decide("Place", 16 + 8 * k + min(i, 7)):
            return None
        x, y = listed[self.m.number("Rank", 8 + k, bits=len(listed).bit_length())]
        dx = self.m.signed("Residual", 0, selector=0, bits=30)
        dy = self.m.signed("Residual", 8 + min(abs(dx).bit_length(), 7), selector=1, bits=30)
        return x + dx, y + dy

    def free(self, i):
        """Reads a column that may be anywhere."""
        x = self.columns[-1][0]
        share = max(self.end[0] - x, 1) // (self.count - i)
        x += self.m.number("Gap", min(share.bit_length(), 30), bits=30)
        return x, self.low[1] + self.top_bits(1, self.lengths[1])

    def read_heights(self, done):
        """Reads the heights of the next column, ascending."""
        count = self.m.number("Floors", min(len(self.before), 5), bits=40) + 1
        self.limits.vertices(done + count)
        floors = []
        for i in range(count):
            if done == 0 and i == 0:
                floors.append(self.first_z)
                self.heights.append([self.first_z, 1])
                continue
            floors.append(self.read_height(floors[-1] if floors else None, i, count))
            if abs(floors[-1]) >= LIMIT or (i and floors[-1] <= floors[-2]):
                raise Malformed("heights that do not ascend")
        self.before = floors
        return floors

    def read_height(self, below, i, count):
        """Reads a height that was used before, or a new one."""
        r, f, g = 0, min(i, 2), min(count, 4) - 1
        for place, (z, uses) in enumerate(self.heights):
            if below is not None and z <= below:
                continue
            s, u = int(i < len(self.before) and self.before[i] == z), min(uses, 4) - 1
            if self.m.decide("Height", (3 * r + f) * 4 + g, 3 * (8 * s + r) + f,
                             (8 * u + r) * 4 + g):
                del self.heights[place]
                self.heights.insert(0, [z, uses + 1])
                return z
            r = cap(r + 1, 8)
        z = self.low[2] + self.top_bits(2, self.lengths[2])
        self.heights = [[z, 1]] + self.heights[:15]
        return z
