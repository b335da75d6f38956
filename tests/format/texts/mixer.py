# SPDX-License-Identifier: GPL-3.0-or-later
"""The decisions of texts, from docs/format-columns.md, "Decisions"."""
from entropy import STRETCH, Malformed, Stream, squash

QUESTIONS = {name: number for number, name in enumerate("""
    is_same_kind kind is_same_form form decimals residual residual_sign list_index is_next_known
    known_distance is_upper_case has_same_affixes is_last_uuid is_known_uuid is_next_uuid uuid_distance
    uuid_version character character_after_match copy_length is_end mark_first mark_second mark_third
    is_new_mark mark_index is_new_vertex is_before_neighbour is_after_neighbour is_recent recent_rank
    is_vertex vertex_distance vertex_sign coordinate_x coordinate_y coordinate_z coordinate_sign
    is_near_guess guess_residual is_known_coordinate known_coordinate is_equal_coordinate counter_step
    counter_sign text_kind""".split())}
STEPS = 8
UNKNOWN = (1 << 21) << 10
SQUASH = [min(max(squash(x), 32), 65504) for x in range(-2047, 2048)]
RATES = [131072 // (2 * n + 3) for n in range(251)]
CONFIDENCE = [2560 * n // (10 * n + 4) for n in range(251)]
AFTER_LENGTH, LONG_LENGTH = 4096, 8192


def hash_of(first, *more):
    """The hash of facts of 32 bits, in order."""
    for fact in more:
        both = (first & 0xFFFFFFFF) << 32 | fact & 0xFFFFFFFF
        first = ((both ^ 0x9E3779B97F4A7C15) * 0xD6E8FEB86659FD93) >> 32 & 0xFFFFFFFF
    return first


def hash_of_bytes(start, text):
    """The hash of a start and the bytes of a text."""
    for byte in text:
        start = hash_of(start, byte)
    return start


class TextStream(Stream):
    """A stream whose plain bits come in chunks."""

    def bit(self, p):
        """Reads one decision that is 1 with the probability p / 65536."""
        split = self.low + ((self.high - self.low) * p >> 16)
        bit = int(self.code <= split)
        if bit:
            self.high = split
        else:
            self.low = split + 1
        self.shift_out()
        return bit

    def shift_out(self):
        """Takes bytes for those in which both ends of the interval agree."""
        while (self.low ^ self.high) >> 24 == 0:
            self.low = self.low << 8 & 0xFFFFFFFF
            self.high = self.high << 8 & 0xFFFFFFFF | 255
            self.shift()

    def plain(self, bits):
        """Reads a number of that many plain bits."""
        value = 0
        while bits:
            size = min(bits, 8)
            bits -= size
            value = value << size | self.chunk(size)
        return value

    def chunk(self, size):
        """Reads at most eight plain bits."""
        if self.high - self.low < 1 << 16:
            value = 0
            for _ in range(size):
                value = 2 * value + self.bit(32768)
            return value
        width, last = (self.high - self.low) >> size, (1 << size) - 1
        value = min((self.code - self.low) // width, last)
        self.low += value * width
        if value != last:
            self.high = self.low + width - 1
        self.shift_out()
        return value


class Mixer:
    """The counters and weights of all decisions."""

    def __init__(self, counter_bits):
        self.shift = 32 - counter_bits
        self.counters = [UNKNOWN] * (1 << counter_bits)
        self.weights = [None] * (len(QUESTIONS) * STEPS)
        self.seen = [0] * len(self.weights)
        self.stream = None

    def soften(self, most_answers, most_mixed):
        """Makes what was learned count as so few answers and decisions at most."""
        self.counters = [c & ~1023 | min(c & 1023, most_answers) for c in self.counters]
        self.seen = [min(m, most_mixed) for m in self.seen]

    def decide(self, question, step, places):
        """Reads the decision of a step of a question, with the counters at places of the table."""
        counters, n = self.counters, len(places)
        at = QUESTIONS[question] * STEPS + min(step, STEPS - 1)
        if self.seen[at] == 0:
            self.weights[at] = [262144 // (3 + n)] * n + [0]
        weights, inputs = self.weights[at], []
        total = weights[n] * 64
        for i, place in enumerate(places):
            counter = counters[place]
            x = STRETCH[counter >> 20] * CONFIDENCE[counter & 1023] >> 8
            inputs.append(x)
            total += weights[i] * x
        x = total >> 16
        p = SQUASH[(-2047 if x < -2047 else 2047 if x > 2047 else x) + 2047]
        bit = self.stream.bit(p)
        error = (65536 if bit else 0) - p
        if abs(error) > 512:
            inputs.append(64)
            move = error * (10 + 1600 // (16 + self.seen[at]))
            for i, x in enumerate(inputs):
                w = weights[i] + (move * x >> 20)
                weights[i] = -524288 if w < -524288 else 524288 if w > 524288 else w
        self.seen[at] = min(self.seen[at] + 1, 1000)
        target = (1 << 22) - 1 if bit else 0
        for i, place in enumerate(places):
            # A counter that is asked twice learns twice: each time from what it then has.
            counter = counters[place]
            chance, count = counter >> 10, counter & 1023
            chance += (target - chance) * RATES[count] >> 16
            counters[place] = chance << 10 | (count + 1 if count < 250 else 250)
        return bit

    def place(self, context):
        """The place of a context's counter."""
        return context >> self.shift

    def group(self, context):
        """The place of the counters of four decisions in a row."""
        return context >> self.shift & ~15

    @staticmethod
    def hashes(question, contexts):
        """The hashes of a question's contexts."""
        number = QUESTIONS[question] * 16
        return [hash_of(context, number + i) for i, context in enumerate(contexts)]

    def flag(self, question, *contexts):
        """Reads a yes or no."""
        return self.decide(question, 0, [h >> self.shift for h in self.hashes(question, contexts)])

    def low_bits(self, question, hashes, first_step, bits):
        """Reads a number of so many bits, high ones first."""
        result, groups, node = 1, [], 1
        for i in range(bits):
            if i % 4 == 0:
                groups = [self.group(hash_of(h, result) if i else h) for h in hashes]
                node = 1
            bit = self.decide(question, first_step + i, [g + node for g in groups])
            node, result = 2 * node + bit, 2 * result + bit
        return result - (1 << bits)

    def symbol(self, question, contexts, bits):
        """Reads a symbol of so many bits."""
        return self.low_bits(question, self.hashes(question, contexts), 0, bits)

    def number(self, question, contexts, modelled):
        """Reads a number: its length, `modelled` bits after the first, and the rest as plain bits."""
        hashes = self.hashes(question, contexts)
        length = self.low_bits(question, hashes, 0, 4)
        if length == 15:
            length = self.low_bits(question, [hash_of(h, LONG_LENGTH) for h in hashes], 7, 6)
        if length <= 1:
            return length
        under = min(length - 1, modelled)
        placed = [hash_of(h, length + AFTER_LENGTH) for h in hashes]
        high = 1 << under | self.low_bits(question, placed, 4, under)
        rest = length - 1 - under
        return high << rest | self.stream.plain(rest)


class Candidates:
    """The value that came last after facts, in a table."""

    def __init__(self, slot_bits):
        self.shift = 32 - slot_bits
        self.slots = [None] * (1 << slot_bits)

    def find(self, facts):
        """The value and its trust, or none."""
        slot = self.slots[facts >> self.shift]
        return slot[1:] if slot and slot[0] == facts & 0xFFFF else None

    def learn(self, facts, value):
        """Takes the value that came after facts."""
        at, check = facts >> self.shift, facts & 0xFFFF
        slot = self.slots[at]
        if slot and slot[0] == check and slot[1] == value:
            self.slots[at] = (check, value, min(slot[2] + 1, 15))
        elif slot and slot[0] == check and slot[2] > 1:
            self.slots[at] = (check, slot[1], slot[2] // 2)
        else:
            self.slots[at] = (check, value, 0)


def require(condition, what):
    """Requires what holds in packed texts."""
    if not condition:
        raise Malformed(what)
