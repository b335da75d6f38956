# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a column, from docs/format-columns.md, "Numbers"."""
from mixer import hash_of, require
from number_forms import NO_NUMBER, is_decimal, with_decimals


def wrapped(number):
    """The number of 64 bits with a sign that has these lower 64 bits."""
    return (number + 2**63) % 2**64 - 2**63


def judge(misses, predictions, number, memory):
    """Follows how long the differences from the predictions are."""
    for i, predicted in enumerate(predictions):
        length = abs(wrapped(number - predicted)).bit_length()
        misses[i] += (256 * length - misses[i]) >> memory


def best_of(misses):
    """The first prediction of the shortest differences."""
    return misses.index(min(misses))


def read_signed(mixer, size_of, contexts, modelled, sign_of, sign_contexts):
    """Reads a difference; gives it, and what stands for its length and sign."""
    size = mixer.number(size_of, contexts, modelled)
    length = size.bit_length()
    negative = mixer.flag(sign_of, *sign_contexts(length)) if size else 0
    return -size if negative else size, 2 * length + negative


class NumberColumn:
    """What is known about the numbers of a column."""

    def __init__(self):
        self.form, self.last, self.before_last, self.largest = None, 0, 0, -1
        self.last_residual, self.misses = 0, [0] * 6

    def read_form(self, mixer, column):
        """Reads the form of the next number; none if no number comes."""
        known = hash_of(self.form[0] + 1, self.form[1]) if self.form else 0
        if self.form and mixer.flag("is_same_form", column, known):
            return self.form
        kind = mixer.symbol("form", [column, known], 4)
        if kind == NO_NUMBER:
            return None
        decimals = mixer.symbol("decimals", [hash_of(kind, 1), column], 5)
        require(kind < NO_NUMBER and decimals <= 17, "a form of a number")
        form = (kind, decimals)
        if self.form and is_decimal(self.form) and is_decimal(form):
            self.last, self.before_last, self.largest = (
                with_decimals(number, self.form[1], decimals)
                for number in (self.last, self.before_last, self.largest))
        self.form = form
        return form

    def read(self, mixer, column, sibling, neighbour):
        """Reads a number of the last form."""
        last = self.last
        predictions = [0, last, wrapped(last + wrapped(last - self.before_last)),
                       last if neighbour is None else neighbour, wrapped(self.largest + 1),
                       self.before_last]
        best, before = best_of(self.misses), self.last_residual
        contexts = [hash_of(column, best), hash_of(column, before, best),
                    hash_of(self.form[0], best, before), hash_of(column, sibling)]
        residual, self.last_residual = read_signed(
            mixer, "residual", contexts, 3, "residual_sign",
            lambda length: (hash_of(column, best, before), hash_of(column, length)))
        number = wrapped(predictions[best] + residual)
        judge(self.misses, predictions, number, 3)
        self.take(number)
        return number

    def take(self, number):
        """Takes note of a number."""
        self.before_last, self.last = self.last, number
        self.largest = max(self.largest, number)

    def see(self, form, number):
        """Takes note of a number of a form that was not read here."""
        if self.form and is_decimal(self.form) == is_decimal(form):
            self.take(with_decimals(number, form[1], self.form[1]) if is_decimal(form) else number)
