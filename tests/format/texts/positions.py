# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of positions, from docs/format-columns-geometry.md, "Positions"."""
from line_guesses import AGAIN, FIRST, LAST, NO_GUESS, PARALLELOGRAM, Line
from mixer import hash_of, require
from number_column import NumberColumn, best_of, judge, read_signed, wrapped
from number_forms import is_decimal, print_number, with_decimals

MOST_OFF, MOST_KNOWN, MOST_SEEN, MOST_NEIGHBOURS = 3, 4096, 65536, 4


class Known:
    """The first different coordinates of an axis."""

    def __init__(self):
        self.numbers, self.known, self.last_index = [], set(), 0

    def add(self, number):
        """Takes a coordinate."""
        if len(self.numbers) < MOST_KNOWN and number not in self.known:
            self.known.add(number)
            self.numbers.append(number)


class List:
    """What is known about the lists at a path."""

    def __init__(self):
        self.seen, self.y_of, self.known = {}, {}, [Known() for _ in range(3)]
        self.columns, self.decimals = [NumberColumn() for _ in range(3)], [0] * 3
        self.first, self.last, self.position = [0] * 3, [[0] * 3 for _ in range(3)], [0] * 3
        self.count, self.kinds, self.last_kind = 0, [FIRST] * 3, NO_GUESS
        self.last_size, self.misses = [0] * 3, [[0] * 4 for _ in range(3)]
        self.line = Line()

    def rescale(self, axis, decimals):
        """Goes on in other decimals."""
        before = self.decimals[axis]
        if before == decimals:
            return
        self.decimals[axis] = decimals
        for position in (self.first, *self.last):
            position[axis] = with_decimals(position[axis], before, decimals)
        self.known[axis], self.seen, self.y_of = Known(), {}, {}

    @staticmethod
    def place_of(position):
        """The hash of x and y."""
        facts = [part for number in position[:2] for part in (number, number >> 32)]
        return hash_of(0, *facts)

    def find_seen(self, position):
        """What is known of the place with x and y of a position."""
        seen = self.seen.get(self.place_of(position))
        return seen if seen and seen[0][:2] == position[:2] else None

    def again(self, axis):
        """Guesses from positions that came before."""
        if axis == 2:
            seen = self.find_seen(self.position)
            return [(AGAIN, seen[0][2], True)] if seen else []
        guesses, last = [], None
        if self.count > 0 and (axis == 0 or self.kinds[0] == AGAIN):
            last = self.find_seen(self.last[0])
        for neighbour in last[1] if last else []:
            is_back = self.count > 1 and neighbour == self.last[1]
            if not is_back and (axis == 0 or neighbour[0] == self.position[0]):
                guesses.append((AGAIN, neighbour[axis], True))
        if axis == 1 and self.position[0] in self.y_of:
            guesses.append((AGAIN, self.y_of[self.position[0]], True))
        return guesses

    def guesses(self, axis, axes):
        """Guesses for the next coordinate: kind, number, whether it is exact."""
        if self.count == 0:
            return self.again(axis) if axis > 0 else []
        is_first, guesses = axis > 0 and self.kinds[0] == FIRST, []
        if self.count > 2 and (axis == 0 or is_first):
            guesses.append((FIRST, self.first[axis], True))
        guesses += self.again(axis)
        if axes == 3 and axis == 0:
            guesses += self.line.for_x()
        if axes == 3 and axis == 1 and not is_first and self.kinds[0] != AGAIN:
            guesses += self.line.for_y(self.position[0], self.kinds[0])
        guesses.append((LAST, self.last[0][axis], True))
        if self.count > 2:
            a, b, c = (position[axis] for position in self.last)
            guesses.append((PARALLELOGRAM, wrapped(a + c - b), False))
        return guesses

    def predictions(self, axis):
        """What a coordinate may be that no guess has."""
        a, b, c = (position[axis] for position in self.last)
        return [a, b, wrapped(a + a - b), wrapped(a + c - b)]

    def take(self, axes):
        """Takes a whole position."""
        position = list(self.position)
        if self.count == 0:
            self.first = list(position)
        self.remember(position)
        kind = self.kinds[1] if self.kinds[0] == NO_GUESS else self.kinds[0]
        if axes == 3:
            is_planar = self.decimals[0] == self.decimals[1] <= 4
            self.line.set_unit(10 ** self.decimals[0] if is_planar else 0)
            self.line.take(position[0], position[1], kind)
        self.last = [position, *self.last[:2]]
        self.last_kind, self.kinds = kind, [NO_GUESS] * 3
        self.count += 1

    def remember(self, position):
        """Takes a position, and the one before it as its neighbour."""
        if max(len(self.seen), len(self.y_of)) >= MOST_SEEN:
            return
        self.y_of[position[0]] = position[1]
        if self.count == 0:
            return
        for one, other in ((self.last[0], position), (position, self.last[0])):
            seen = self.seen.setdefault(self.place_of(one), (list(one), []))
            if seen[0] == one and len(seen[1]) < MOST_NEIGHBOURS and other not in seen[1]:
                seen[1].append(list(other))


class Positions:
    """Reads the coordinates of lists of positions."""

    def __init__(self):
        self.lists = {}

    def read(self, mixer, place):
        """Reads a coordinate; none if it is no decimal."""
        known = self.lists.setdefault(place.path, List())
        axis = place.index % place.axes
        # A list of one position goes on with the positions of the element before it.
        if place.index == 0 and place.last_length != place.axes:
            known.count = 0
            known.line.restart()
        if not mixer.flag("text_kind", hash_of(place.column, 1)):
            known.count = 0
            return None
        form = known.columns[axis].read_form(mixer, hash_of(place.column, 2))
        require(form and is_decimal(form), "a coordinate that is no decimal")
        known.rescale(axis, form[1])
        number = self.read_number(mixer, known, place, axis)
        text = print_number(form, number)
        require(text, "a coordinate that its form does not have")
        if known.count > 0:
            judge(known.misses[axis], known.predictions(axis), number, 4)
        known.position[axis] = number
        known.known[axis].add(number)
        if axis + 1 == place.axes:
            known.take(place.axes)
        return text.encode()

    def read_number(self, mixer, known, place, axis):
        """Reads a coordinate as a guess, a known one or a difference."""
        column = hash_of(place.column, axis)
        others = known.kinds[axis - 1] if axis else known.last_kind + 16
        where = min(known.count, 6)
        is_last = int(place.index + place.axes >= place.last_length + axis)
        denied, tried = 0, []
        for kind, guess, is_exact in known.guesses(axis, place.axes):
            if guess in tried:
                continue
            tried.append(guess)
            if not mixer.flag("is_near_guess", hash_of(column, kind, denied, others),
                              hash_of(column, kind, where, is_last), hash_of(kind, others, axis),
                              hash_of(kind, denied, where)):
                denied = denied * 8 + kind + 1 & 0xFFFFFFFF
                continue
            known.kinds[axis] = kind
            if is_exact:
                return guess
            contexts = [hash_of(column, kind), hash_of(kind, known.last_size[axis])]
            return wrapped(guess + mixer.symbol("guess_residual", contexts, 3) - MOST_OFF)
        known.kinds[axis] = NO_GUESS
        number = self.read_known(mixer, known.known[axis], column, others)
        if number is not None:
            return number
        best, last = best_of(known.misses[axis]), known.last_size[axis]
        contexts = [hash_of(column, best, where), hash_of(column, last, others),
                    hash_of(best, last, axis),
                    hash_of(column, denied, known.last_size[0] if axis else 0)]
        residual, known.last_size[axis] = read_signed(
            mixer, "coordinate_x", contexts, 4, "coordinate_sign",
            lambda length: (hash_of(column, last), hash_of(column, best, others),
                            hash_of(column, length)))
        return wrapped(known.predictions(axis)[best] + residual)

    @staticmethod
    def read_known(mixer, known, column, others):
        """Reads a coordinate that the axis had before; none if it had not."""
        if not known.numbers:
            return None
        if not mixer.flag("is_known_coordinate", hash_of(column, others),
                          hash_of(column, known.last_index), column):
            known.last_index = 0
            return None
        index = mixer.number("known_coordinate", [column, hash_of(column, others),
                                                  hash_of(column, known.last_index)], 12)
        require(index < len(known.numbers), "a known coordinate")
        known.last_index = index + 1
        return known.numbers[index]
