# SPDX-License-Identifier: GPL-3.0-or-later
"""Strings, from docs/format-columns.md, "Strings"."""
from mixer import hash_of, require

TAG = 0x53545200
LONG_MATCH, COPIED, MOST_COPIED = 31, 8, 4096


class Strings:
    """Reads strings of columns."""

    def __init__(self):
        self.history, self.last_of_column, self.after_three, self.before = bytearray(), {}, {}, 0
        self.match = (0, 0)

    def take(self, byte):
        """Appends a character."""
        self.history.append(byte)
        self.before = (self.before << 8 | byte) & 0xFFFFFFFF

    def read_character(self, mixer, column, position):
        """Reads a character."""
        at, length = self.match
        matched = length > 0 and at < len(self.history)
        likely = self.history[at] if matched else 0
        b, place = self.before, hash_of(column, TAG)
        contexts = [hash_of(TAG + 1, b & 0xFF), hash_of(TAG + 2, b & 0xFFFF),
                    hash_of(TAG + 3, b & 0xFFFFFF), hash_of(place, b),
                    hash_of(place + 1, min(position, 40)), hash_of(place + 2, b & 0xFF)]
        node, groups = 1, []
        for bit in range(7, -1, -1):
            agrees = matched and (likely | 256) >> (bit + 1) == node
            expected = 1 + (likely >> bit & 1)
            if bit in (7, 3):
                groups = [mixer.group(hash_of(context, node)) for context in contexts]
            before = 3 - bit % 4
            in_group = 1 << before | node & (1 << before) - 1
            last = hash_of(TAG + 4, expected * 64 + min(length, LONG_MATCH) if agrees else 0)
            places = [group + in_group for group in groups] + [mixer.place(last)]
            question = "character_after_match" if agrees else "character"
            step = (min(length, 4) - 1 if agrees else 0) + (4 if bit == 7 else 0)
            node = 2 * node + mixer.decide(question, step, places)
        character = node & 0xFF
        self.match = (at + 1, length + 1) if matched and likely == character else (0, 0)
        return character

    def copy(self, mixer, column):
        """Reads how many characters of the match follow, and copies them."""
        at = self.match[0]
        size = mixer.number("copy_length", [column, 0], 4)
        require(size <= MOST_COPIED, "a copy that is too long")
        for i in range(size):
            self.take(self.history[at + i])
        at += size
        if size == MOST_COPIED:
            self.match = (at, COPIED)
        elif at < len(self.history) and self.history[at] == 0:
            self.match = (at, LONG_MATCH)
        else:
            self.match = (0, 0)
        return size

    def read(self, mixer, column):
        """Reads a string."""
        self.match = (self.last_of_column[column], 1) if column in self.last_of_column else (0, 0)
        begin, self.before, i = len(self.history), 0, 0
        while True:
            while self.match[1] == COPIED and self.match[0] < len(self.history):
                i += self.copy(mixer, column)
            character = self.read_character(mixer, column, i)
            if character == 0 and mixer.flag("is_end", column):
                break
            self.take(character)
            if i >= 2:
                three = self.before & 0xFFFFFF
                if self.match[1] == 0 and three in self.after_three:
                    self.match = (self.after_three[three], 1)
                self.after_three[three] = len(self.history)
            i += 1
        self.history.append(0)
        self.last_of_column[column] = begin
        return bytes(self.history[begin:-1])
