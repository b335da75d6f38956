# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices of surfaces, from docs/format-columns-geometry.md, "Vertices"."""
from mixer import hash_of, require
from number_column import NumberColumn, best_of, judge, read_signed, wrapped
from number_forms import is_decimal, print_number, quotient, with_decimals

AXES = ("coordinate_x", "coordinate_y", "coordinate_z")
MOST_CORNERS, MOST_EQUAL = 64, 4
MOST_NUMBERS = 2**32


class Vertices:
    """Reads the coordinates of vertices."""

    def __init__(self):
        self.columns = [NumberColumn() for _ in range(3)]
        self.misses = [[0] * 5 for _ in range(3)]
        self.last_residual, self.last_equal = [0] * 3, [0] * 3
        self.last_vertex, self.vertex = [(0, 0)] * 3, [(0, 0)] * 3
        self.restart(0)

    def restart(self, count):
        """Starts another feature."""
        self.count, self.is_started, self.axis, self.next = count, False, 0, 0
        self.vertices, self.place_of, self.runs, self.run = [], {}, [], None
        self.rings, self.corners_of = [], {}
        self.neighbours, self.nearest, self.parallelogram, self.equal = [], None, None, []

    def is_ready(self):
        """Whether a coordinate may come."""
        return self.is_started or self.count > 0

    def take_run(self, number):
        """Takes the first vertex of a run, then its length."""
        if self.run is None:
            self.run = number
            return
        first, self.run = self.run, None
        if 0 <= first < MOST_NUMBERS and 0 < number < MOST_NUMBERS:
            self.runs.append((first, first + number))

    def start(self, rings):
        """Takes the rings, which are complete."""
        self.is_started, self.rings = True, rings
        for number, ring in enumerate(rings):
            for position, vertex in enumerate(ring):
                self.corners_of.setdefault(vertex, []).append((number, position))
        self.runs.sort()

    def value(self, place, axis, decimals):
        """A coordinate of a known vertex."""
        return with_decimals(*self.vertices[place][axis], decimals)

    def look_around(self):
        """Finds the known neighbours of the next vertex."""
        self.neighbours, self.nearest, self.parallelogram = [], None, None
        for corner in self.corners_of.get(self.next, [])[:MOST_CORNERS]:
            ring, position = self.rings[corner[0]], corner[1]
            for step in (len(ring) - 1, 1):
                place = self.place_of.get(ring[(position + step) % len(ring)])
                if place is not None:
                    self.neighbours.append(place)
            self.find_parallelogram(ring, corner)
        self.nearest = max(self.neighbours, default=None)
        self.equal = list(self.neighbours)

    def find_parallelogram(self, ring, corner):
        """Looks for three vertices that make a parallelogram with the next one."""
        turned = ring[corner[1]:] + ring[:corner[1]]
        if len(ring) == 3:
            places = [self.place_of.get(vertex) for vertex in turned[1:]]
            if None not in places:
                self.look_across(corner, turned, places)
        elif len(ring) > 3 and self.parallelogram is None:
            places = [self.place_of.get(turned[i]) for i in (-1, -3, -2)]
            if None not in places:
                self.parallelogram = places

    def look_across(self, corner, turned, places):
        """Looks for the corner across the edge that a triangle has there."""
        for number, position in self.corners_of[turned[1]][:MOST_CORNERS]:
            other = self.rings[number]
            if len(other) != 3 or number == corner[0]:
                continue
            ahead, behind = other[(position + 1) % 3], other[(position + 2) % 3]
            opposite = behind if ahead == turned[2] else ahead if behind == turned[2] else None
            if opposite in (None, self.next) or opposite not in self.place_of:
                continue
            self.parallelogram = [*places, self.place_of[opposite]]

    def predictions(self, axis, decimals):
        """What the next coordinate may be."""
        last = with_decimals(*self.last_vertex[axis], decimals)
        nearest = last if self.nearest is None else self.value(self.nearest, axis, decimals)
        middle = nearest
        if self.neighbours:
            total = sum(self.value(place, axis, decimals) - nearest for place in self.neighbours)
            middle = wrapped(nearest + quotient(wrapped(total), len(self.neighbours)))
        if self.parallelogram is None:
            return [last, nearest, middle, middle, middle]
        first, second, third = (self.value(place, axis, decimals) for place in self.parallelogram)
        corner = wrapped(first + second - third)
        half_way = wrapped(middle + quotient(wrapped(corner - middle), 2))
        return [last, nearest, middle, corner, half_way]

    def read_equal(self, mixer, decimals):
        """Reads whether the coordinate is that of a neighbour; none if it is not."""
        axis = self.axis
        candidates = self.equal + [place for place in self.neighbours
                                   if axis > 0 and place not in self.equal]
        preferred = 0 if axis == 0 else len(self.equal)
        before = hash_of(axis, self.last_equal[0] if axis > 0 else 0,
                         self.last_equal[1] if axis > 1 else 0)
        has_corner = int(self.parallelogram is not None)
        denied, found = [], None
        for i, place in enumerate(candidates):
            guess = self.value(place, axis, decimals)
            if guess in denied:
                continue
            tried, likely = len(denied), int(i < preferred)
            if mixer.flag("is_equal_coordinate", hash_of(before, tried, likely),
                          hash_of(axis, tried, self.last_equal[axis]),
                          hash_of(axis, likely, has_corner), hash_of(before, len(candidates))):
                found = guess
                break
            denied.append(guess)
            if len(denied) == MOST_EQUAL:
                break
        self.last_equal[axis] = 0 if found is None else 1 + len(denied)
        if found is not None:
            self.equal = [place for place in self.equal
                          if self.value(place, axis, decimals) == found]
        elif axis < 2:
            self.equal = []
        return found

    def read(self, mixer, rings):
        """Reads the next coordinate; none if it is no number."""
        if not self.is_started:
            self.start(rings.finish())
        axis = self.axis
        if axis == 0:
            while self.runs and self.runs[0][0] <= self.next:
                self.next = max(self.next, self.runs.pop(0)[1])
            self.look_around()
        form = self.columns[axis].read_form(mixer, hash_of(20, axis))
        if form is None:
            return None
        if is_decimal(form):
            number = self.read_equal(mixer, form[1])
            if number is None:
                number = self.read_number(mixer, form[1])
            self.vertex[axis] = (number, form[1])
        else:
            number = self.columns[axis].read(mixer, hash_of(21, axis), 0, None)
            self.vertex[axis] = (0, 0)
            self.equal = []
        self.axis = (axis + 1) % 3
        if self.axis == 0:
            self.place_of[self.next] = len(self.vertices)
            self.next += 1
            self.vertices.append(list(self.vertex))
            self.last_vertex = list(self.vertex)
        text = print_number(form, number)
        require(text, "a coordinate that its form does not have")
        return text.encode()

    def read_number(self, mixer, decimals):
        """Reads the difference from a prediction."""
        axis = self.axis
        predictions, best = self.predictions(axis, decimals), best_of(self.misses[axis])
        known = (self.nearest is not None) + 2 * (self.parallelogram is not None)
        residuals = self.last_residual
        others = hash_of(residuals[0] if axis > 0 else 0, residuals[1] if axis > 1 else 0)
        residual, residuals[axis] = read_signed(
            mixer, AXES[axis], [hash_of(best, known), hash_of(others, known), residuals[axis], 0], 4,
            "coordinate_sign",
            lambda length: (hash_of(axis, others), hash_of(axis, best), hash_of(axis, length)))
        number = wrapped(predictions[best] + residual)
        judge(self.misses[axis], predictions, number, 4)
        return number
