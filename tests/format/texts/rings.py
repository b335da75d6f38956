# SPDX-License-Identifier: GPL-3.0-or-later
"""Rings of surfaces, from docs/format-columns-geometry.md, "Rings"."""
from mixer import hash_of, require
from number_column import read_signed

NO_KIND, FRESH, BEFORE, AFTER, RECENT, FAR = range(6)
MOST_NUMBERS = 2**32


class Rings:
    """Reads the vertices of rings."""

    def __init__(self):
        self.before, self.after, self.recent, self.rings, self.ring = {}, {}, [], [], []
        self.largest, self.last_found, self.last_rank = -1, 0, 0
        self.last_kind, self.before_last_kind = NO_KIND, NO_KIND

    def finish(self):
        """Ends a ring; gives all rings."""
        ring = self.ring
        for i, vertex in enumerate(ring):
            following = ring[(i + 1) % len(ring)]
            self.after[vertex], self.before[following] = following, vertex
        if ring:
            self.rings.append(ring)
            self.ring = []
        return self.rings

    def guess(self, position):
        """The vertices that earlier rings suggest, and whether they are one."""
        before = after = None
        if self.ring:
            before = self.before.get(self.ring[-1])
            if position >= 2:
                after = self.after.get(self.ring[0])
        latest = self.ring[-16:]
        before = None if before in latest else before
        after = None if after in latest else after
        agree = before is not None and before == after
        return before, None if agree else after, agree

    def read(self, mixer, position):
        """Reads the vertex at a position of a ring; none if no vertex is there."""
        if position == 0:
            self.finish()
        before, after, agree = self.guess(position)
        where, last = min(position, 5), self.last_kind
        known = ((before is not None) + 2 * (after is not None) + 4 * agree
                 + 8 * bool(self.ring and self.ring[-1] == self.largest))
        all_facts = hash_of(where, last, self.before_last_kind, known)
        most_facts = hash_of(where, known, last)
        if mixer.flag("is_new_vertex", all_facts, most_facts, hash_of(where, known)):
            return self.take(self.largest + 1, FRESH)
        if before is not None and mixer.flag("is_before_neighbour", all_facts, most_facts, known):
            return self.take(before, BEFORE)
        if after is not None and mixer.flag("is_after_neighbour", all_facts, most_facts):
            return self.take(after, AFTER)
        if mixer.flag("is_recent", all_facts, hash_of(where, last)):
            rank = mixer.number("recent_rank", [hash_of(where, last),
                                                hash_of(where, self.last_rank),
                                                hash_of(where, known)], 4)
            self.last_rank = rank.bit_length()
            end = len(self.recent) - min(len(self.recent), len(self.ring), 16)
            ranked = [v for v in reversed(self.recent[:end]) if v not in (before, after)]
            require(rank < len(ranked), "a rank of a vertex")
            return self.take(ranked[rank], RECENT)
        if not mixer.flag("is_vertex", where):
            return None
        contexts = [where, hash_of(where, last)]
        distance, _ = read_signed(mixer, "vertex_distance", contexts, 3, "vertex_sign",
                                  lambda length: contexts)
        vertex = self.last_found + distance
        require(0 <= vertex < MOST_NUMBERS, "a number of a vertex")
        return self.take(vertex, FAR)

    def take(self, vertex, kind):
        """Appends a vertex to the ring."""
        if kind in (FRESH, FAR):
            self.last_found = vertex
        self.largest = max(self.largest, vertex)
        self.before_last_kind, self.last_kind = self.last_kind, kind
        self.ring.append(vertex)
        if kind != FRESH and vertex in self.recent:
            self.recent.remove(vertex)
        self.recent.append(vertex)
        if len(self.recent) > 512:
            del self.recent[:-256]
        return vertex
