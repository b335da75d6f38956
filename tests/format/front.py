# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode parallelogram, the front, from docs/format-parallelogram.md, "The front"."""
import heapq

from vectors import HALF_TURN, angle_between, minus


class Gate:
    """A half-edge start -> end of a known triangle whose twin is missing; the corner of the gate is
    at end."""

    def __init__(self, triangle, k, number, side):
        self.start, self.end, self.apex = triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]
        self.number, self.side = number, side
        self.previous = self.next = None
        self.room, self.turn = 0.0, None
        self.is_open, self.is_refused = True, False


class Front:
    """The loops of gates around the triangles known so far."""

    def __init__(self, places):
        self.places = places
        self.triangles, self.beyond_side, self.degree = [], [], {}
        self.gates, self.waiting, self.turns, self.open = [], [], 0, 0

    def angle(self, at, start, end):
        """The angle at a vertex between two other vertices."""
        p = self.places
        return angle_between(minus(p[start], p[at]), minus(p[end], p[at]))

    def beyond(self, side):
        """The third vertex of the triangle beyond a half-edge, if known."""
        other = self.beyond_side[side]
        return None if other is None else self.triangles[other // 3][(other % 3 + 2) % 3]

    def add_triangle(self, triangle):
        """Adds a triangle and returns its first half-edge."""
        self.triangles.append(triangle)
        for v in triangle:
            self.degree[v] = self.degree.get(v, 0) + 1
        self.beyond_side += [None] * 3
        return 3 * len(self.triangles) - 3

    def add_gate(self, side):
        """Adds a gate at a half-edge."""
        gate = Gate(self.triangles[side // 3], side % 3, len(self.gates), side)
        self.gates.append(gate)
        self.open += 1
        return gate

    def pair(self, side, other):
        """Makes two half-edges of one edge twins."""
        self.beyond_side[side], self.beyond_side[other] = other, side

    def drop(self, gate):
        """Removes a gate whose triangle is known now."""
        gate.is_open = False
        self.open -= 1

    def change(self, gate, room):
        """Gives a corner another room, and adds it to the waiting ones again."""
        gate.room, gate.is_refused, gate.turn = room, False, self.turns
        heapq.heappush(self.waiting, (room, self.turns, gate.number))
        self.turns += 1

    def next_corner(self):
        """The corner with the least room; among equals the one that changed first."""
        while self.waiting:
            _, turn, number = self.waiting[0]
            gate = self.gates[number]
            if gate.is_open and gate.turn == turn:
                return gate
            heapq.heappop(self.waiting)
        return None

    def add_seed(self, triangle):
        """Adds the first triangle of a component."""
        side = self.add_triangle(triangle)
        first, second, third = (self.add_gate(side + k) for k in range(3))
        for gate, after in ((first, second), (second, third), (third, first)):
            link(gate, after)
        t = triangle
        self.change(first, 2 * HALF_TURN - self.angle(t[1], t[0], t[2]))
        self.change(second, 2 * HALF_TURN - self.angle(t[2], t[0], t[1]))
        self.change(third, 2 * HALF_TURN - self.angle(t[0], t[1], t[2]))

    def extend(self, gate, w):
        """Adds a triangle (v, u, w) beyond the gate u -> v, with the gates u -> w and w -> v."""
        u, v = gate.start, gate.end
        side = self.add_triangle((v, u, w))
        self.pair(gate.side, side)
        self.drop(gate)
        return self.add_gate(side + 1), self.add_gate(side + 2)

    def add_tip(self, gate, w):
        """Adds a triangle with a new vertex."""
        u, v = gate.start, gate.end
        rise, fall = self.extend(gate, w)
        link(gate.previous, rise)
        link(rise, fall)
        link(fall, gate.next)
        self.change(gate.previous, gate.previous.room - self.angle(u, v, w))
        self.change(rise, 2 * HALF_TURN - self.angle(w, u, v))
        self.change(fall, gate.room - self.angle(v, u, w))

    def close(self, gate):
        """Adds a triangle that fills the corner of a gate."""
        after = gate.next
        u, v, w = gate.start, gate.end, after.end
        side = self.add_triangle((v, u, w))
        self.pair(gate.side, side)
        self.pair(after.side, side + 2)
        self.drop(gate)
        self.drop(after)
        if after.next is gate.previous:
            self.pair(after.next.side, side + 1)
            self.drop(after.next)
            return
        across = self.add_gate(side + 1)
        link(gate.previous, across)
        link(across, after.next)
        self.change(gate.previous, gate.previous.room - self.angle(u, v, w))
        self.change(across, after.room - self.angle(w, u, v))

    def join(self, gate, other):
        """Adds a triangle whose third vertex is at the corner of another gate."""
        u, v, w, after = gate.start, gate.end, other.end, other.next
        rise, fall = self.extend(gate, w)
        link(gate.previous, rise)
        link(rise, after)
        link(other, fall)
        link(fall, gate.next)
        self.change(gate.previous, gate.previous.room - self.angle(u, v, w))
        self.change(rise, self.angle(w, u, after.end))
        self.change(other, self.angle(w, v, other.start))
        self.change(fall, gate.room - self.angle(v, u, w))


def link(gate, after):
    """Makes two gates follow each other."""
    gate.next, after.previous = after, gate
