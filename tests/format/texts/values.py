# SPDX-License-Identifier: GPL-3.0-or-later
"""Values, from docs/format-columns.md, "Values"."""
import re

from mixer import Candidates, hash_of, require
from number_column import NumberColumn
from number_forms import is_decimal, print_number
from uuid_model import Uuids

(AFTER_BOTH, AFTER_OTHERS, AFTER_OWN, LISTED, KNOWN, NUMBER, UUID, STRING, COUNTER) = range(9)
MOST_LISTED = 4096


class Texts:
    """Different texts, numbered in order of their first appearance."""

    def __init__(self, first):
        self.texts, self.number_of = [], {}
        if first is not None:
            self.add(first)

    def add(self, text):
        """The number of a text."""
        if text not in self.number_of:
            self.number_of[text] = len(self.texts)
            self.texts.append(text)
        return self.number_of[text]


class Column:
    """What is known about a column."""

    def __init__(self):
        self.last, self.before_last, self.last_kind, self.news = 0, 0, AFTER_BOTH, 0
        self.values, self.last_distance, self.affixes, self.last_step = [], 0, 0, 0
        self.numbers = NumberColumn()


def with_counter(text, step):
    """The text with its last whole number moved by a step."""
    found = re.search(rb"([1-9][0-9]*|0)([^0-9]*)\Z", text)
    require(found, "a text without a counter")
    digits = found[1]
    require(len(digits) <= 15 and int(digits) + step >= 0, "a counter")
    return text[:found.start()] + str(int(digits) + step).encode() + found[2]


class Values:
    """Reads values."""

    def __init__(self, slot_bits):
        self.values, self.affixes = Texts(b""), Texts(None)
        self.candidates, self.columns, self.uuids = Candidates(slot_bits), {}, Uuids()
        self.numbers, self.origins = {}, {}
        self.last_known = 0
        self.restart()

    def restart(self):
        """Starts another text."""
        self.last, self.before_last, self.last_number = 0, 0, None

    def skip(self, number):
        """Takes note of a value that was read elsewhere."""
        self.before_last, self.last, self.last_number = self.last, 0, number

    def read(self, mixer, strings, place):
        """Reads a value."""
        column = self.columns.setdefault(place.column, Column())
        facts = [hash_of(1, place.column, column.last, self.last),
                 hash_of(2, place.column, self.last, self.before_last),
                 hash_of(3, place.column, column.last, column.before_last)]
        found = []
        for fact in facts:
            candidate = self.candidates.find(fact)
            is_other = candidate and candidate[0] not in [c[0] for c in found if c]
            found.append(candidate if is_other else None)
        kind = self.read_kind(mixer, place.column, column, found)
        if kind <= AFTER_OWN:
            require(found[kind], "a value that followed")
            value = found[kind][0]
        elif kind == LISTED:
            index = mixer.number("list_index", [place.column, hash_of(place.column, column.last),
                                                hash_of(place.column, self.last, 1)], 12)
            require(index < len(column.values), "a listed value")
            value = column.values[index]
        elif kind == KNOWN:
            value = self.read_known(mixer, place.column, column)
        elif kind == NUMBER:
            value = self.read_number(mixer, place, column)
        elif kind == UUID:
            value = self.read_uuid(mixer, strings, place.column, column)
        elif kind == COUNTER:
            value = self.read_counter(mixer, place.column, column)
        else:
            value = self.values.add(strings.read(mixer, place.column))
        self.learn(column, facts, kind, value)
        return self.values.texts[value]

    @staticmethod
    def read_kind(mixer, place, column, found):
        """Reads the kind of the value."""
        last, trust, present = column.last_kind, 0, column.last_kind
        for candidate in found:
            trust = trust * 17 + (candidate[1] + 1 if candidate else 0)
            present = present * 2 + (1 if candidate else 0)
        if mixer.flag("is_same_kind", hash_of(place, last, column.news), hash_of(place, trust),
                      hash_of(present, trust), hash_of(place, present)):
            return last
        kind = mixer.symbol("kind", [hash_of(place, last), hash_of(place, trust),
                                     hash_of(present, trust)], 4)
        require(kind <= COUNTER, "a kind of value")
        return kind

    def next_known(self):
        """The value that first followed the last known one in the column where that came first."""
        if self.last_known not in self.origins:
            return None
        column, index = self.origins[self.last_known]
        return column.values[index + 1] if index + 1 < len(column.values) else None

    def read_known(self, mixer, place, column):
        """Reads a value of another column."""
        last, following = hash_of(place, column.last_distance), self.next_known()
        if following is not None and mixer.flag("is_next_known", place, last):
            column.last_distance, self.last_known = 0, following
            return following
        distance = mixer.number("known_distance", [place, last], 4)
        column.last_distance = distance.bit_length()
        require(distance < len(self.values.texts), "a known value")
        self.last_known = len(self.values.texts) - 1 - distance
        return self.last_known

    def read_number(self, mixer, place, column):
        """Reads a number."""
        form = column.numbers.read_form(mixer, place.column)
        require(form, "a number without a form")
        neighbour = self.last_number if place.is_in_array and is_decimal(form) else None
        number = column.numbers.read(mixer, place.column, self.last, neighbour)
        text = print_number(form, number).encode()
        require(text, "a number that its form does not have")
        count = len(self.values.texts)
        value = self.values.add(text)
        if value == count:
            self.numbers[value] = (form, number)
        return value

    def read_uuid(self, mixer, strings, place, column):
        """Reads a text with a UUID."""
        has_last = column.affixes < len(self.affixes.texts)
        if not has_last or not mixer.flag("has_same_affixes", place):
            column.affixes = self.affixes.add(strings.read(mixer, hash_of(place, 1)))
        affixes = self.affixes.texts[column.affixes]
        uuid = self.uuids.read(mixer, place)
        require(b"\1" in affixes, "a UUID without its place")
        return self.values.add(affixes.replace(b"\1", uuid, 1))

    def read_counter(self, mixer, place, column):
        """Reads the column's last value with another number in it."""
        known = hash_of(place, column.last_step)
        negative = mixer.flag("counter_sign", place, known, column.last_step)
        size = mixer.number("counter_step", [hash_of(place, negative), hash_of(known, negative),
                                             hash_of(column.last_step, negative)], 4)
        column.last_step = 2 * min(size, 15) + negative
        require(size <= 9999, "a step of a counter")
        return self.values.add(with_counter(self.values.texts[column.last],
                                            -size if negative else size))

    def learn(self, column, facts, kind, value):
        """Takes note of a value."""
        is_new = int(kind > LISTED)
        if is_new and len(column.values) < MOST_LISTED:
            self.origins.setdefault(value, (column, len(column.values)))
            column.values.append(value)
        if kind != NUMBER and value in self.numbers:
            column.numbers.see(*self.numbers[value])
        for fact in facts:
            self.candidates.learn(fact, value)
        column.last_kind, column.news = kind, (column.news * 2 + is_new) & 7
        column.before_last, column.last = column.last, value
        self.before_last, self.last = self.last, value
        form = column.numbers.form
        self.last_number = column.numbers.last if form and is_decimal(form) else None
