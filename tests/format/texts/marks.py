# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks, from docs/format-columns.md, "Marks"."""
from mixer import Candidates, hash_of, require
from values import Texts

COLUMN = 0x4D41524B
LAST = ord(".")


class Marks:
    """Reads marks."""

    def __init__(self, slot_bits):
        self.marks, self.candidates = Texts(b" "), Candidates(slot_bits)
        self.restart()

    def restart(self):
        """Starts another text."""
        self.last, self.before_last = 0, 0

    def read(self, mixer, strings, place, last_value):
        """Reads a mark, and whether it is the last one."""
        last = self.last
        if place.is_in_array:
            is_end = int(place.index + 1 == place.last_length)
            first, second = hash_of(is_end, min(place.index, 40)), last_value
        else:
            first, second = hash_of(last_value, place.key), place.key
        facts = [hash_of(11, place.path, last, first), hash_of(12, place.path, last, second),
                 hash_of(13, place.path, last, self.before_last)]
        mark = self.read_candidate(mixer, place, facts)
        if mark is None:
            contexts = [place.path, hash_of(place.path, last)]
            if mixer.flag("is_new_mark", *contexts):
                mark = self.marks.add(strings.read(mixer, COLUMN))
            else:
                mark = mixer.number("mark_index", contexts, 14)
                require(mark < len(self.marks.texts), "a mark")
        text = self.marks.texts[mark]
        require(text, "an empty mark")
        for fact in facts:
            self.candidates.learn(fact, mark)
        self.before_last, self.last = last, mark
        return text[1:], text[0] == LAST

    def read_candidate(self, mixer, place, facts):
        """Reads which of the likely marks comes, if one does."""
        found = [self.candidates.find(fact) for fact in facts]
        trust, denied = 0, []
        for candidate in found:
            trust = trust * 17 + (candidate[1] + 1 if candidate else 0)
        for i, candidate in enumerate(found):
            if not candidate or candidate[0] in denied:
                continue
            if mixer.flag(("mark_first", "mark_second", "mark_third")[i], facts[i],
                          hash_of(trust, i), hash_of(place.path, self.last, i),
                          hash_of(place.path, candidate[0], i)):
                return candidate[0]
            denied.append(candidate[0])
        return None
