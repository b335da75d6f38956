# SPDX-License-Identifier: GPL-3.0-or-later
"""The path in a table, from docs/format-columns.md, "Tables"."""
from mixer import hash_of, hash_of_bytes
from place import Place


class TablePath:
    """Follows marks."""

    def __init__(self):
        self.restart()

    def restart(self):
        """Starts another table."""
        self.table, self.column = 0, 0

    def follow(self, mark):
        """Follows a mark."""
        if self.table == 0:
            self.table = hash_of_bytes(hash_of(8, len(mark)), mark)
        else:
            self.column = 0 if mark.endswith(b"\n") else self.column + 1

    def follow_value(self, value):
        """Values change nothing."""

    def place(self):
        """Where the next value or mark is."""
        path = hash_of(self.table, self.column)
        return Place(path, path)
