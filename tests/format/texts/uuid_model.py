# SPDX-License-Identifier: GPL-3.0-or-later
"""UUIDs, from docs/format-columns.md, "UUIDs"."""
from mixer import hash_of, require


class Uuids:
    """Reads UUIDs."""

    def __init__(self):
        self.known, self.last = [], 0

    def read_known(self, mixer, column):
        """Reads which of the earlier UUIDs comes; none for a new one."""
        if not self.known:
            return None
        if mixer.flag("is_last_uuid", column):
            return self.last
        if not mixer.flag("is_known_uuid", column):
            return None
        if self.last + 1 < len(self.known) and mixer.flag("is_next_uuid", column):
            return self.last + 1
        distance = mixer.number("uuid_distance", [column], 4)
        require(distance < len(self.known), "an earlier UUID")
        return len(self.known) - 1 - distance

    def read_digits(self, mixer, column):
        """Reads the digits of a new UUID."""
        digits = f"{mixer.stream.plain(48):012x}"
        digits += f"{self.digit(mixer, column, 12):x}"
        digits += f"{mixer.stream.plain(12):03x}"
        digits += f"{self.digit(mixer, column, 16):x}"
        return digits + f"{mixer.stream.plain(60):015x}"

    @staticmethod
    def digit(mixer, column, place):
        """Reads the digit of the version or of the variant."""
        return mixer.symbol("uuid_version", [hash_of(column, place), place], 4)

    def read(self, mixer, column):
        """Reads a UUID, as text."""
        known = self.read_known(mixer, column)
        if known is None:
            known = len(self.known)
            digits = self.read_digits(mixer, column)
            require(digits not in self.known, "a new UUID that is known")
            self.known.append(digits)
        self.last = known
        d = self.known[known]
        text = "-".join((d[:8], d[8:12], d[12:16], d[16:20], d[20:]))
        return (text.upper() if mixer.flag("is_upper_case", column) else text).encode()
