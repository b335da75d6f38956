# SPDX-License-Identifier: GPL-3.0-or-later
"""The path in a JSON text, from docs/format-columns.md, "JSON"."""
from mixer import hash_of, hash_of_bytes
from place import COORDINATE, MOST_LEVELS, NONE, VERTEX_COUNT, VERTEX_INDEX, VERTEX_RUN, Place

ROOT, ARRAY, ID = 1, 2, 3
MEMBERS = {("root", b"CityObjects"): ("ids", NONE), ("root", b"vertices"): ("vertices", NONE),
           ("root", b"boundaries"): ("other", VERTEX_INDEX),
           ("vertices", b"count"): ("other", VERTEX_COUNT),
           ("vertices", b"solids"): ("other", VERTEX_RUN),
           ("vertices", b"others"): ("other", COORDINATE),
           ("other", b"geometry"): ("geometry", NONE),
           ("geometry", b"boundaries"): ("other", VERTEX_INDEX)}


class Level:
    """An object or array."""

    def __init__(self, path, is_object=False, names="other", role=NONE, key=0):
        self.path, self.is_object, self.names, self.role, self.key = (path, is_object, names, role,
                                                                      key)
        self.of_key, self.of_member, self.index = "other", NONE, 0


class JsonPath:
    """Follows marks."""

    def __init__(self):
        self.last_length = {}
        self.restart()

    def restart(self):
        """Starts another text."""
        self.levels, self.beyond, self.is_in_string = [Level(ROOT)], 0, False
        self.levels[0].of_key = "root"

    def open(self, is_object):
        """Enters an object or array."""
        if len(self.levels) == MOST_LEVELS:
            self.beyond += 1
            return
        above = self.levels[-1]
        names = above.of_key if above.is_object or len(self.levels) == 1 else above.names
        self.levels.append(Level(hash_of(above.path, above.key if above.is_object else ARRAY),
                                 is_object, names,
                                 above.of_member if above.is_object else above.role,
                                 ID if names == "ids" else 0))

    def close(self):
        """Leaves an object or array."""
        if self.beyond:
            self.beyond -= 1
        elif len(self.levels) > 1:
            level = self.levels.pop()
            if not level.is_object:
                self.last_length[level.path] = level.index + 1

    def take_key(self, key):
        """Takes a key of the present object."""
        level = self.levels[-1]
        level.key = hash_of_bytes(len(key), key)
        level.of_key, level.of_member = MEMBERS.get((level.names, key), ("other", NONE))

    def follow(self, mark):
        """Follows a mark."""
        i = 1 if self.is_in_string and mark[:1] == b'"' else 0
        self.is_in_string = False
        while i < len(mark):
            c = mark[i:i + 1]
            if c in b"{[":
                self.open(c == b"{")
            elif c in b"}]":
                self.close()
            elif c == b",":
                self.levels[-1].index += 1
            elif c == b'"':
                end = i + 1
                while end < len(mark) and mark[end] != 34:
                    end += 2 if mark[end] == 92 else 1
                if end >= len(mark):
                    self.is_in_string = True
                    return
                if self.levels[-1].is_object:
                    self.take_key(mark[i + 1:end])
                i = end
            i += 1

    def follow_value(self, value):
        """Values change nothing."""

    def place(self):
        """Where the next value or mark is."""
        level = self.levels[-1]
        if level.is_object:
            return Place(level.path, hash_of(level.path, level.key), level.key, level.index,
                         role=level.of_member)
        length = self.last_length.get(level.path, 0)
        column = hash_of(level.path, ARRAY)
        if level.role == COORDINATE:
            column = hash_of(column, level.index % 3)
        elif 1 < length <= 4:
            column = hash_of(column, min(level.index, 4) + 1)
        return Place(level.path, column, 0, level.index, length, 0, True, level.role)
