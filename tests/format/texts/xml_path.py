# SPDX-License-Identifier: GPL-3.0-or-later
"""The path in an XML text, from docs/format-columns.md, "XML"."""
from mixer import hash_of, hash_of_bytes
from place import MOST_LEVELS, NONE, POSITION, Place

ROOT, CONTENT = 5, 6
ENDS_OF_NAMES = b" \t\r\n>/=\"'<"
ATTRIBUTE, ELEMENT = hash_of_bytes(0, b"name"), hash_of_bytes(0, b"gen:name")


class Level:
    """An element."""

    def __init__(self, path, name=0):
        self.path, self.name, self.child, self.title, self.index = path, name, 0, 0, 0


class Lists:
    """The lists at a path."""

    def __init__(self):
        self.last_length, self.are_long, self.are_triples, self.are_pairs = 0, False, True, True


class XmlPath:
    """Follows marks and values."""

    def __init__(self):
        self.lists = {}
        self.restart()

    def restart(self):
        """Starts another text."""
        self.levels, self.beyond = [Level(ROOT)], 0
        self.is_in_tag, self.is_in_quotes, self.is_element, self.attribute = False, False, False, 0

    def open(self, name):
        """Enters an element."""
        if len(self.levels) == MOST_LEVELS:
            self.beyond += 1
            return
        self.levels[-1].child = name
        self.levels.append(Level(hash_of(self.levels[-1].path, name), name))

    def close(self):
        """Leaves an element."""
        if self.beyond:
            self.beyond -= 1
        elif len(self.levels) > 1:
            level = self.levels.pop()
            if level.index > 0:
                lists = self.lists.setdefault(level.path, Lists())
                lists.last_length = level.index
                if level.index > 1:
                    lists.are_long = True
                    lists.are_triples &= level.index % 3 == 0
                    lists.are_pairs &= level.index % 2 == 0

    def follow(self, mark):
        """Follows a mark."""
        i = 0
        if self.is_in_quotes:
            self.is_in_quotes, i = False, 1
        elif not self.is_in_tag and len(self.levels) > 1:
            self.levels[-1].index += 1
        while i < len(mark):
            c, i = mark[i], i + 1
            if not self.is_in_tag:
                if c == ord("<"):
                    i = self.begin_tag(mark, i)
            elif c == ord(">"):
                self.is_in_tag = False
            elif c == ord("/"):
                if self.is_element and mark[i:i + 1] == b">":
                    self.close()
            elif c in b"\"'":
                self.is_in_quotes = True
                return
            elif c not in ENDS_OF_NAMES:
                self.attribute, i = self.name_at(mark, i - 1)

    def begin_tag(self, mark, i):
        """Enters a tag."""
        self.is_in_tag, self.attribute = True, 0
        following = mark[i:i + 1]
        self.is_element = following not in (b"/", b"?", b"!")
        if following == b"/":
            self.close()
        if self.is_element:
            name, i = self.name_at(mark, i)
            self.open(name)
        return i

    @staticmethod
    def name_at(mark, i):
        """The hash of a name, and its end."""
        end = i
        while end < len(mark) and mark[end] not in ENDS_OF_NAMES:
            end += 1
        return hash_of_bytes(0, mark[i:end]), end

    def follow_value(self, value):
        """Follows a value."""
        if self.is_in_tag:
            if self.attribute == ATTRIBUTE:
                self.levels[-1].title = hash_of_bytes(0, value)
        elif len(self.levels) > 1 and self.levels[-1].name == ELEMENT:
            self.levels[-2].title = hash_of_bytes(0, value)

    def place(self):
        """Where the next value or mark is."""
        level = self.levels[-1]
        if self.is_in_tag:
            return Place(level.path, hash_of(level.path, self.attribute), self.attribute)
        lists = self.lists.get(level.path, Lists())
        length = lists.last_length
        column = hash_of(level.path, CONTENT)
        if len(self.levels) > 1 and self.levels[-2].title:
            column = hash_of(column, self.levels[-2].title)
        axes = (3 if lists.are_triples else 2 if lists.are_pairs else 0) if lists.are_long else 0
        if axes:
            column = hash_of(column, level.index % axes)
        elif length > 4:
            column = hash_of(column, 4)
        elif length > 1:
            column = hash_of(column, min(level.index, 4))
        return Place(level.path, column, level.child, level.index, length, axes,
                     level.index > 0 or length > 1, POSITION if axes else NONE)
