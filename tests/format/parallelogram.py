# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode parallelogram, from docs/format-parallelogram.md."""
import math

from axis_places import EVERY, AxisPlaces
from entropy import Bank, Malformed
from front import Front
from tip import Prediction, tamed
from vectors import (HALF_TURN, angle_between, bucket, cosine_bucket, cross, dot, log_bucket, minus,
                     size, times)

GUESSES = 6
FAMILIES = {
    "HasRepeats": ([1],), "More": ([2],), "NewShell": ([1],),
    "Close": ([192, 1024, 1000, 1400, 384, 1024, 320, 576, 256, 4096, 256, 320, 400, 400, 256, 196,
               1728, 256], 3),
    "New": ([32, 32, 64, 512],),
    "Repeat": ([192, 96, 384, 112], 3), "Which": ([80, 120], 5), "Places": ([6],),
    "HasGuesses": ([1],), "Guess": ([216, 216, 216, 96, 96, 384], 5)}
NUMBERS = {"Origin": ([2, 64],), "Seed": ([3, 64],),
           "Residual": ([192, 288, 528, 768, 768, 16], 6), "Rank": ([1],), "Place": ([32, 256], 2)}


def quotient(a, b):
    """The quotient a / b, by IEEE 754 also for b = 0."""
    return a / b if b else math.copysign(math.inf, a) if a else math.nan


def parallelogram_bank():
    """The bank of mode parallelogram."""
    return Bank(FAMILIES, NUMBERS, agile=True)


class Vertices:
    """Reads the positions of vertices, as places on the axes."""

    def __init__(self, models, last_position, is_first, limits):
        self.m, self.limits = models, limits
        self.last_position, self.is_first = last_position, is_first
        self.cells, self.places, self.misses = [], [], []
        self.repeats, self.guesses = [], []
        self.axes, self.prediction = [AxisPlaces() for _ in range(3)], Prediction()
        self.last_guesses, self.history, self.now = 0, [0, 0, 0], []
        self.has_repeats = models.decide("HasRepeats", 0)
        self.has_guesses = models.decide("HasGuesses", 0)

    def add(self, cell, miss):
        """Appends a vertex with the miss of its prediction."""
        if max(map(abs, cell)) >= 2**54:
            raise Malformed("a coordinate out of range")
        self.limits.vertices(len(self.cells) + 1)
        self.cells.append(tuple(cell))
        self.places.append(tuple(map(float, cell)))
        self.misses.append(miss)
        self.repeats.append([0, 0, 0])
        self.guesses.append(0)

    def read_cell(self, near, name, context):
        """Reads a position by its difference from another one."""
        before, cell = 0, []
        for k in range(3):
            offset = self.m.signed(name, context, before, bits=54)
            cell.append(self.axes[k].value(self.axes[k].place(near[k]) + offset))
            before = abs(offset).bit_length()
        return cell

    def read_seed(self, number):
        """Reads a vertex of a first triangle."""
        if self.cells:
            self.add(self.read_cell(self.cells[-1], "Seed", number), 0.0)
        else:
            self.origin = self.read_cell(self.last_position, "Origin", 0 if self.is_first else 1)
            before = EVERY
            for k in range(3):
                self.axes[k] = AxisPlaces.read(self.m, before, self.limits)
                before = self.axes[k].kind
            self.add((0, 0, 0), 0.0)
        if number == 2:
            miss = 0.5 * size(minus(self.places[-2], self.places[-3]))
            self.misses[-3:] = [miss] * 3

    def read_tip(self, gate):
        """Reads the vertex beyond a gate, for which the prediction was made."""
        tip, misses = self.prediction, self.misses
        axes = sorted(range(3), key=lambda k: abs(tip.normal[k]))
        expected = 0.5 * (misses[gate.start] + misses[gate.end])
        scale = log_bucket(expected, 4, 16)
        guess = self.read_guess(gate, scale) if self.has_guesses else 0
        predicted = tip.guesses[guess]
        apart = size(minus(tip.guesses[0], tip.guesses[1]))
        spread = log_bucket(apart / (0.3 * expected + 1), 3, 8)
        least = log_bucket(min(misses[gate.start], misses[gate.end]), 4, 16)
        apexes = log_bucket(misses[gate.apex] + misses[gate.next.end], 2, 16)
        length = log_bucket(tip.size, 1, 16)
        cell, place, slope, missed, self.now = [0] * 3, [0.0] * 3, 0.0, 0, []
        third = 16 + guess if self.has_guesses else tip.spans
        for rank, k in enumerate(axes):
            expectation = predicted[k]
            if rank == 2:
                expectation = tamed(expectation + tip.shift_along(k, slope))
            if self.has_repeats and self.read_repeat(gate, rank, k, cell):
                place[k] = float(cell[k])
                slope += tip.normal[k] * (place[k] - predicted[k])
                continue
            where = self.axes[k].position(expectation)
            nearest = math.floor(where + 0.5)
            part = where - float(nearest)
            miss = log_bucket(self.axes[k].spread(expectation, expected), 4, 16)
            parts = bucket(abs(part) * 2 * 4, 4)
            offset = self.m.signed(
                "Residual", (4 * miss + parts) * 3 + rank, (6 * length + missed) * 3 + rank,
                (6 * third + missed) * 4 + parts, (8 * miss + spread) * 6 + missed,
                (16 * least + apexes) * 3 + rank, miss,
                selector=3 * int(self.has_guesses) + rank, bits=54)
            cell[k] = self.axes[k].value(nearest + (-offset if part < 0 else offset))
            place[k] = float(cell[k])
            slope += tip.normal[k] * (place[k] - predicted[k])
            if rank == 2:
                tip.learn_shift(place[k] - predicted[k], expected)
            missed = max(missed, log_bucket(abs(place[k] - predicted[k]), 2, 6))
        tip.learn(tuple(place), expected)
        self.add(cell, size(minus(place, predicted)))
        self.guesses[-1] = guess
        for rank, repeated in enumerate(self.now):
            self.repeats[-1][axes[rank]] = repeated

    def read_guess(self, gate, scale):
        """Reads which guess the residuals belong to."""
        tip, before = self.prediction, self.guesses
        x, p = gate.next.end, gate.previous.start
        pairs = [self.last_guesses, 6 * before[gate.start] + before[gate.end],
                 6 * before[gate.apex] + max(before[x], before[p])]
        unit = 0.1 * (self.misses[gate.start] + self.misses[gate.end]) + 1

        def far(a, b):
            return log_bucket(size(minus(tip.guesses[a], tip.guesses[b])) / unit, 1, 16) // 2

        guess = 0
        while guess < GUESSES - 1:
            i = guess
            if self.m.decide("Guess", *(6 * pair + i for pair in pairs), 6 * tip.spans + i,
                             6 * scale + i, (8 * far(i, 0 if i else 1) + far(i, i + 1)) * 6 + i,
                             selector=i):
                break
            guess += 1
        self.last_guesses = self.last_guesses % 6 * 6 + guess
        return guess

    def read_repeat(self, gate, rank, k, cell):
        """Reads whether a coordinate equals that of a vertex beside the gate."""
        u, v, o, x, p = (self.cells[w][k] for w in (gate.start, gate.end, gate.apex, gate.next.end,
                                                   gate.previous.start))
        mask = self.repeats[gate.start][k] + 2 * self.repeats[gate.end][k]
        pattern = (u == v) + 2 * (v == o) + 4 * (u == o) + 8 * (u == p or v == x)
        now = sum(bit << i for i, bit in enumerate(reversed(self.now)))
        flat = bucket(abs(self.prediction.normal[k]) * 7.999, 8)
        repeats = self.m.decide(
            "Repeat", (3 * pattern + rank) * 4 + mask, (3 * self.history[k] + rank) * 4 + mask,
            24 * pattern + 3 * flat + rank, 7 * pattern + (1 << rank) - 1 + now, selector=rank)
        self.history[k] = (2 * self.history[k] + repeats) & 7
        self.now.append(repeats)
        if not repeats:
            return False
        around = [u, v, o, x, p]
        for i, value in enumerate(around):
            if value in around[:i]:
                continue
            cell[k] = value
            if self.m.decide("Which", 16 * i + pattern, (3 * i + rank) * 8 + self.history[k],
                             selector=i):
                break
        return True


class Triangles:
    """Reads the surface, triangle by triangle."""

    def __init__(self, models, last_position, is_first, limits):
        self.m, self.limits = models, limits
        self.vertices = Vertices(models, last_position, is_first, limits)
        self.front, self.mean_edge = Front(self.vertices.places), 1.0
        self.closings = self.news = 0

    def read(self):
        """Reads the surface; returns vertices and shells of triangles."""
        starts, component = [], 0
        while True:
            if component == 0 or self.m.decide("NewShell", 0):
                starts.append(len(self.front.triangles))
            self.component()
            if not self.m.decide("More", min(component, 1)):
                break
            component += 1
        self.limits.shells(len(starts))
        origin = self.vertices.origin
        places = [tuple(c + o for c, o in zip(cell, origin)) for cell in self.vertices.cells]
        points = list(dict.fromkeys(places))
        number = {place: i for i, place in enumerate(points)}
        triangles = [[[number[places[v]] for v in triangle]] for triangle in self.front.triangles]
        bounds = starts + [len(triangles)]
        return points, [triangles[begin:end] for begin, end in zip(bounds, bounds[1:])]

    def component(self):
        """Reads one component."""
        for number in range(3):
            self.vertices.read_seed(number)
        n = len(self.vertices.cells)
        self.front.add_seed((n - 3, n - 2, n - 1))
        while True:
            gate = self.front.next_corner()
            if gate is None:
                break
            self.limits.facets(len(self.front.triangles) + 1)
            if not gate.is_refused and self.close(gate):
                continue
            if not gate.previous.is_refused and self.close(gate.previous):
                continue
            self.extend(gate)
        if self.front.open:
            raise Malformed("a surface that is not closed")

    def close(self, gate):
        """Reads whether a triangle fills the corner of a gate."""
        before = gate.previous
        selector = 2 if gate.next.next is before else 1 if before.is_refused else 0
        closes = self.m.decide("Close", *self.corner(gate), selector=selector)
        self.closings = (2 * self.closings + closes) & 255
        if closes:
            self.front.close(gate)
        else:
            gate.is_refused = True
            if selector == 2:
                gate.next.is_refused = before.is_refused = True
        return closes

    def corner(self, gate):
        """The contexts of the triangle that would fill the corner of a gate."""
        at, front, prediction = self.vertices.places, self.front, self.vertices.prediction
        after, before, room = gate.next, gate.previous, gate.room
        u, v, w = at[gate.start], at[gate.end], at[after.end]
        o, o2, p, x = at[gate.apex], at[after.apex], at[before.start], at[after.next.end]
        prediction.predict(front, gate)
        tip = prediction.guesses[0]
        prediction.predict(front, after)
        next_tip = prediction.guesses[0]

        def angle(vertex, a, b):
            return angle_between(minus(a, vertex), minus(b, vertex))

        def length(a, b):
            return size(minus(b, a))

        angle_u, angle_v, angle_w = angle(u, v, w), angle(v, u, w), angle(w, u, v)
        room_u, room_w = before.room - angle_u, after.room - angle_w
        normal = cross(minus(w, v), minus(u, v))
        span, area = length(u, w), size(normal)
        sides, edge = 0.5 * (length(v, u) + length(v, w)) + 1e-3, self.mean_edge + 1e-3
        near = (length(v, u) + length(v, w) + length(u, o) + length(v, o) + length(v, o2)
                + length(w, o2)) / 6 + 1e-3
        n1 = cross(minus(o, u), minus(v, u))
        n2 = cross(minus(o2, v), minus(w, v))
        b1, b2 = (cosine_bucket(normal, times(n, -1.0)) for n in (n1, n2))
        near_area = 0.5 * (size(n1) + size(n2)) + 1
        opposite = angle(o, u, v) + angle_w, angle(o2, v, w) + angle_u
        shorter, longer = sorted((length(v, u), length(v, w)))
        over = angle_v + max(angle(p, u, w), angle(x, u, w))
        miss = length(w, tip) / sides, length(u, next_tip) / sides
        d_v, d_u, d_w = (min(front.degree[y], 9) for y in (gate.end, gate.start, after.end))
        missing = quotient(room * front.degree[gate.end], 2 * HALF_TURN - room + 0.01)
        rooms, least = bucket(room * 8, 32), bucket(min(room_u, room_w) * 4 + 2, 14)
        spans = bucket(span / edge * 12, 32)
        overs = bucket((over - 2.2) * 10, 20)
        turn = bucket(quotient(angle(v, u, tip), room + 0.01) * 12, 16)
        next_turn = bucket(quotient(angle(v, w, next_tip), room + 0.01) * 12, 16)
        wide = bucket(angle_v * 5, 16)
        return (wide * 12 + log_bucket(span / sides, 6, 12), (8 * b1 + b2) * 16 + rooms // 2,
                (10 * d_v + min(d_u, d_w)) * 10 + max(d_u, d_w),
                (10 * least + (d_u if room_u < room_w else d_w)) * 10 + d_v,
                12 * rooms + log_bucket(span / edge, 6, 12),
                32 * bucket(span / near * 12, 32) + rooms, 10 * spans + d_v,
                24 * bucket(shorter / edge * 8, 24) + bucket(longer / edge * 8, 24),
                spans // 2 * 16 + bucket((max(opposite) - 1.2) * 5, 16),
                (spans // 2 * 16 + wide) * 16 + bucket(missing * 4, 16),
                16 * log_bucket(area / near_area, 8, 16) + rooms // 2,
                16 * log_bucket(area / (edge * edge), 10, 20) + rooms // 2,
                20 * bucket((max(opposite) - 2.2) * 10, 20) + overs,
                20 * bucket((min(opposite) - 1.2) * 10, 20) + overs,
                16 * turn + next_turn,
                14 * log_bucket(min(miss), 8, 14) + log_bucket(max(miss), 8, 14),
                (bucket(missing * 4, 12) * 12 + bucket(min(miss) * 8, 12)) * 12
                + bucket((max(opposite) - 2) * 5, 12),
                self.closings)

    def extend(self, gate):
        """Reads the triangle beyond a gate: with a new vertex, or with one of the front."""
        front, vertices = self.front, self.vertices
        is_new = self.m.decide("New", bucket(gate.room * 4, 32), bucket(gate.previous.room * 4, 32),
                               self.news, (self.news & 7) * 64 + (self.closings & 63))
        self.news = (2 * self.news + is_new) & 63
        vertices.prediction.predict(front, gate)
        if not is_new:
            self.join(gate)
            return
        vertices.read_tip(gate)
        w = len(vertices.cells) - 1
        length = size(minus(vertices.places[w], vertices.places[gate.start]))
        self.mean_edge += (length - self.mean_edge) / (1.0 + min(w, 1000))
        front.add_tip(gate, w)

    def join(self, gate):
        """Reads the corner of the front at which the triangle ends."""
        predicted, at = self.vertices.prediction.guesses[0], self.vertices.places
        listed = set()
        last, ahead = gate.previous.previous.previous, gate.next.next
        for _ in range(256):
            if ahead is last or ahead is gate:
                break
            listed.add(ahead)
            ahead = ahead.next
        behind = last
        for _ in range(256):
            if ahead is gate or behind is ahead:
                break
            listed.add(behind)
            behind = behind.previous
        if ahead is last and ahead is not gate:
            listed.add(ahead)

        def distance(other):
            offset = minus(at[other.end], predicted)
            return dot(offset, offset), other.number

        candidates = sorted(listed, key=distance)
        rank = self.m.number("Rank", 0, bits=32)
        if rank > len(candidates):
            raise Malformed("no such corner")
        if rank:
            other = candidates[rank - 1]
        else:
            other = self.front.gates[self.m.uniform(len(self.front.gates))]
        if not other.is_open or other in (gate, gate.previous, gate.next, gate.previous.previous):
            raise Malformed("a corner that cannot be joined")
        self.front.join(gate, other)
