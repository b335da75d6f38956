# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode parallelogram, the values of an axis, from docs/format-parallelogram.md, "Values of an axis"."""
import bisect

from entropy import Malformed

EVERY, STEPPED, LISTED = range(3)
RANGE = 2**54


class AxisPlaces:
    """The values on an axis: every number, equal steps rounded down, or a list."""

    def __init__(self):
        self.kind, self.step, self.shift, self.offset, self.values = EVERY, 1, 0, 0, []

    @staticmethod
    def read(m, before, limits):
        """Reads the values of one axis; `before` is the kind of the axis before."""
        places = AxisPlaces()
        if m.decide("Places", 2 * before):
            if m.decide("Places", 2 * before + 1):
                places.kind = LISTED
                places.read_list(m, limits)
            else:
                places.kind = STEPPED
                places.read_steps(m)
        return places

    def read_steps(self, m):
        """Reads shift, step and offset."""
        self.shift = m.plain(6)
        if self.shift > 40:
            raise Malformed("a shift")
        whole = m.number("Place", 0, 0, bits=54)
        if whole == 0 or whole >> (61 - self.shift):
            raise Malformed("a step")
        self.step = whole << self.shift
        if self.shift:
            self.step |= m.plain(self.shift)
            self.offset = m.plain(self.shift)

    def read_list(self, m, limits):
        """Reads a list of values: from 0 downward, then upward."""
        halves = []
        for sign in (-1, 1):
            count = m.number("Place", 1, 0, bits=32)
            if count > limits.left["vertices"]:
                raise Malformed("a list that is too long")
            value, before, earlier, half = 0, 0, 0, []
            for _ in range(count):
                gap = m.number("Place", 16 + before, 16 * before + earlier, selector=1, bits=54)
                value += sign * (gap + 1)
                if abs(value) >= RANGE:
                    raise Malformed("a value out of range")
                half.append(value)
                before, earlier = min(gap.bit_length(), 15), before
            halves.append(half)
        self.values = halves[0][::-1] + [0] + halves[1]

    def value(self, place):
        """The value at a place."""
        if self.kind == LISTED:
            if not 0 <= place < len(self.values):
                raise Malformed("no such place")
            return self.values[place]
        value = place if self.kind == EVERY else (place * self.step + self.offset) >> self.shift
        if abs(value) >= RANGE:
            raise Malformed("a value out of range")
        return value

    def place(self, value):
        """The place of a value that is on the axis."""
        if self.kind == EVERY:
            return value
        if self.kind == LISTED:
            return bisect.bisect_left(self.values, value)
        return -((self.offset - (value << self.shift)) // self.step)

    def position(self, coordinate):
        """The place of a coordinate, a fraction between two places."""
        if self.kind == EVERY:
            return coordinate
        if self.kind == STEPPED:
            return ((coordinate + 0.5) * float(1 << self.shift) - float(self.offset)) / float(
                self.step)
        after = bisect.bisect_right(self.values, coordinate)
        if after == 0:
            return 0.0
        place = float(after - 1)
        if after == len(self.values):
            return place
        low, high = float(self.values[after - 1]), float(self.values[after])
        return place + (coordinate - low) / (high - low)

    def spread(self, coordinate, distance):
        """The number of places within a distance of a coordinate."""
        if self.kind == EVERY:
            return distance
        if self.kind == STEPPED:
            return distance * float(1 << self.shift) / float(self.step)
        return 0.5 * (self.position(coordinate + distance) - self.position(coordinate - distance))
