# SPDX-License-Identifier: GPL-3.0-or-later
"""The entropy coder and the models of a blob, from docs/format.md, "Entropy coding"."""


class Malformed(Exception):
    """The error for a blob that no encoder writes."""


class Unsupported(Exception):
    """The error for an unknown version, model set or mode."""


class LimitExceeded(Exception):
    """The error for more of something than the length of the stream or the caller allows."""


class Limits:
    """The largest numbers that a stream of a given length allows, by "Limits"; no caller sets
    others here."""

    def __init__(self, size):
        most = 4096 + 64 * size
        self.left = {"vertices": most, "facets": 2 * most, "rings": 2 * most, "shells": most}

    def check(self, what, count):
        """Requires that a number of the present solid is within the rest of its limit."""
        if count > self.left[what]:
            raise LimitExceeded(f"{count} {what}, {self.left[what]} are left")

    def vertices(self, count):
        """Checks the number of vertices of the present solid."""
        self.check("vertices", count)

    def facets(self, count):
        """Checks the number of facets of the present solid."""
        self.check("facets", count)

    def rings(self, count):
        """Checks the number of rings of the present solid."""
        self.check("rings", count)

    def shells(self, count):
        """Checks the number of shells of the present solid."""
        self.check("shells", count)

    def take(self, vertices, shells):
        """Subtracts a finished solid from the limits, for the solids that follow."""
        facets = [facet for shell in shells for facet in shell]
        self.left["vertices"] -= len(vertices)
        self.left["facets"] -= len(facets)
        self.left["rings"] -= sum(map(len, facets))
        self.left["shells"] -= len(shells)


def crc32c(data):
    """The CRC-32C (Castagnoli, reflected) of bytes."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc = CRC_TABLE[(crc ^ byte) & 255] ^ (crc >> 8)
    return crc ^ 0xFFFFFFFF


def crc_table():
    """The CRC remainder of each of the 256 values of a byte."""
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = (byte >> 1) ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


CRC_TABLE = crc_table()
SQUASH_POINTS = [int(word) for word in """
    22 28 36 47 60 77 98 126 162 208 267 342 439 562 720 922 1179 1506 1921 2446 3108 3938 4971 6249 7812 9702 11955
    14595 17625 21025 24743 28693 32768 36843 40793 44511 47911 50941 53581 55834 57724 59287 60565 61598 62428 63090
    63615 64030 64357 64614 64816 64974 65097 65194 65269 65328 65374 65410 65438 65459 65476 65489 65500 65508 65514
    """.split()]


def squash(x):
    """The probability, in 1/65536, at x in the logistic domain."""
    i, r = (x + 2048) >> 6, (x + 2048) & 63
    return (SQUASH_POINTS[i] * (64 - r) + SQUASH_POINTS[i + 1] * r) >> 6


def stretch_table():
    """The inverse of squash at 4096 probabilities."""
    table, x = [], -2047
    for k in range(4096):
        while x < 2047 and squash(x) < 16 * k + 8:
            x += 1
        table.append(x)
    return table


STRETCH = stretch_table()


def clamp(value, low, high):
    """The value, limited to low..high."""
    return max(low, min(high, value))


def cap(x, m):
    """x limited to the classes 0..m - 1."""
    return min(max(x, 0), m - 1)


class Stream:
    """Reads decisions from the bytes of a stream."""

    def __init__(self, data):
        self.data, self.at, self.low, self.high, self.code = data, 0, 0, 0xFFFFFFFF, 0
        self.bits, self.trace = [], []
        for _ in range(4):
            self.shift()

    def shift(self):
        """Takes one more byte into the window; after the end of the data at most four zeros."""
        if self.at >= len(self.data) + 4:
            raise Malformed("truncated stream")
        byte = self.data[self.at] if self.at < len(self.data) else 0
        self.code, self.at = (self.code << 8 | byte) & 0xFFFFFFFF, self.at + 1

    def bit(self, p):
        """Reads one decision that is 1 with the probability p / 65536."""
        split = self.low + ((self.high - self.low) * p >> 16)
        bit = int(self.code <= split)
        self.bits.append((bit, p))
        if bit:
            self.high = split
        else:
            self.low = split + 1
        while (self.low ^ self.high) >> 24 == 0:
            self.low = self.low << 8 & 0xFFFFFFFF
            self.high = self.high << 8 & 0xFFFFFFFF | 255
            self.shift()
        return bit

    def note(self, what, value):
        """Adds an item to the trace, with the decisions since the last one."""
        self.trace.append((what, value, self.bits))
        self.bits = []
        return value

    def plain(self, bits):
        """Reads a number of that many plain bits, high bits first."""
        value = 0
        for _ in range(bits):
            value = 2 * value + self.bit(32768)
        return value

    def uniform(self, n):
        """Reads a number below n; all are equally likely."""
        if n < 1:
            raise Malformed("a choice among nothing")
        width = n.bit_length() - 1
        short = (2 << width) - n
        value = self.plain(width)
        return value if value < short else 2 * value + self.plain(1) - short

    def finish(self):
        """Requires that the stream ends here as a writer ends it."""
        done = self.at - 4
        for size in range(5):
            unit = 1 << (32 - 8 * size)
            value = -(-self.low // unit) * unit
            if value <= self.high:
                tail = value.to_bytes(4, "big")[:size]
                if self.data[done:] != tail or len(self.data) != done + size:
                    raise Malformed("another ending of the stream")
                return


class Family:
    """A family: decisions that share tables of counters and sets of weights."""

    def __init__(self, inputs, selectors=1, agile=False):
        self.agile = agile
        self.chances = [[1 << 21] * size for size in inputs]
        self.counts = [[0] * size for size in inputs]
        first = 65536 // len(inputs) if agile else 262144 // (3 + len(inputs))
        self.weights = [[first] * len(inputs) + [0] for _ in range(selectors)]
        self.seen = [0] * selectors

    def mixed(self, contexts, selector):
        """The inputs from the counters, and the probability, in 1/65536, that they give
        together."""
        if len(contexts) != len(self.counts) or min(contexts) < 0:
            raise IndexError("contexts")
        inputs = []
        for chances, counts, context in zip(self.chances, self.counts, contexts):
            n = counts[context]
            inputs.append(STRETCH[chances[context] >> 10] * (2560 * n // (10 * n + 4)) >> 8)
        inputs.append(64)
        total = sum(w * x for w, x in zip(self.weights[selector], inputs))
        x = clamp(total >> 16, -2047, 2047)
        return inputs, clamp(squash(x), 32, 65504)

    def learn(self, contexts, selector, inputs, p, bit):
        """Moves the weights and counters towards the bit."""
        error = (65536 if bit else 0) - p
        rate = (10 + 1600 // (16 + self.seen[selector])) * (2 if self.agile else 1)
        self.seen[selector] = min(self.seen[selector] + 1, 1000)
        self.weights[selector] = [clamp(w + (error * rate * x >> 20), -524288, 524288)
                                  for w, x in zip(self.weights[selector], inputs)]
        target = (1 << 22) - 1 if bit else 0
        for chances, counts, context in zip(self.chances, self.counts, contexts):
            n = counts[context]
            chances[context] += (target - chances[context]) * (131072 // (2 * n + 3)) >> 16
            counts[context] = min(n + 1, 250)

    def read(self, stream, contexts, selector=0):
        """Reads the next decision."""
        inputs, p = self.mixed(contexts, selector)
        bit = stream.bit(p)
        self.learn(contexts, selector, inputs, p, bit)
        return bit


class Number:
    """A number: the three families for length, bits and sign."""

    def __init__(self, inputs, selectors=1, agile=False):
        self.length = Family([48 * size for size in inputs], selectors, agile)
        self.mantissa = Family([48 * 7] + [16 * 7 * size for size in inputs], 3, agile)
        self.sign = Family(inputs, selectors, agile)
        self.families = [self.length, self.mantissa, self.sign]

    def read(self, stream, contexts, selector=0, bits=62):
        """Reads the next number, which has at most that many bits."""
        length = 0
        while not self.length.read(stream, [48 * c + min(length, 47) for c in contexts], selector):
            length += 1
            if length > bits:
                raise Malformed("a number that is too long")
        if length <= 1:
            return length
        value = 1
        for j in range(min(length - 1, 3)):
            chosen = [7 * min(length, 47) + value - 1]
            chosen += [7 * (16 * c + min(length, 15)) + value - 1 for c in contexts]
            value = 2 * value + self.mantissa.read(stream, chosen, j)
        rest = length - value.bit_length()
        return value << rest | stream.plain(rest)

    def read_signed(self, stream, contexts, selector=0, bits=62):
        """Reads the next number with a sign."""
        value = self.read(stream, contexts, selector, bits)
        return -value if value and self.sign.read(stream, contexts, selector) else value


def varint(data, at):
    """The LEB128 number at a position of the data, and the position after it."""
    value, shift = 0, 0
    while True:
        if at >= len(data):
            raise Malformed("truncated varint")
        byte = data[at]
        at += 1
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            if byte == 0 and shift > 7:
                raise Malformed("overlong varint")
            return value, at


def bank_bytes(data, number):
    """The states of the banks in a model file."""
    if data[:4] != b"WTM" + bytes([number]):
        raise Malformed("model file")
    at, states = 4, {}
    for name in ("frame", "order", "polygon", "walk", "parallelogram"):
        size, at = varint(data, at)
        states[name] = data[at:at + size]
        at += size
    if at != len(data):
        raise Malformed("model file")
    return states


class Bank:
    """The families and numbers of a part of the format, by name, in the order of the format."""

    def __init__(self, families, numbers, agile=False):
        self.named = {name: Family(*shape, agile=agile) for name, shape in families.items()}
        self.named.update({name: Number(*shape, agile=agile) for name, shape in numbers.items()})
        self.families = []
        for model in self.named.values():
            self.families += model.families if isinstance(model, Number) else [model]

    def load(self, state):
        """Starts from a prior, which is the saved state of a bank."""
        at, unobserved = 0, 0
        for chances, counts in ((chances, counts) for family in self.families
                                for chances, counts in zip(family.chances, family.counts)):
            i = 0
            while i < len(counts):
                if unobserved:
                    skipped = min(unobserved, len(counts) - i)
                    i, unobserved = i + skipped, unobserved - skipped
                elif state[at]:
                    chances[i] = int.from_bytes(state[at + 1:at + 3], "little") << 6
                    counts[i] = state[at]
                    i, at = i + 1, at + 3
                else:
                    unobserved, at = varint(state, at + 1)
                    if unobserved == 0:
                        raise Malformed("a run of no counters")
        for family in self.families:
            for weights in family.weights:
                for i in range(len(weights)):
                    weights[i] = 16 * int.from_bytes(state[at:at + 2], "little", signed=True)
                    at += 2
        for family in self.families:
            for i in range(len(family.seen)):
                family.seen[i] = state[at]
                at += 1
        if unobserved or at != len(state):
            raise Malformed("a prior of another shape")


class Models:
    """A bank bound to a stream: the decisions and numbers that a mode reads."""

    def __init__(self, stream, bank):
        self.stream, self.bank = stream, bank.named

    def decide(self, name, *contexts, selector=0):
        """Reads a decision of a family."""
        bit = self.bank[name].read(self.stream, contexts, selector)
        return self.stream.note(self.label("decision", name, contexts, selector), bit)

    def number(self, name, *contexts, selector=0, bits=62):
        """Reads a number."""
        value = self.bank[name].read(self.stream, contexts, selector, bits)
        return self.stream.note(self.label("number", name, contexts, selector), value)

    def signed(self, name, *contexts, selector=0, bits=62):
        """Reads a number with a sign."""
        value = self.bank[name].read_signed(self.stream, contexts, selector, bits)
        return self.stream.note(self.label("signed", name, contexts, selector), value)

    def uniform(self, n):
        """Reads a number below n, all equally likely."""
        return self.stream.note(f"uniform below {n}", self.stream.uniform(n))

    def plain(self, bits):
        """Reads a number of that many plain bits."""
        return self.stream.note(f"{bits} plain bits", self.stream.plain(bits))

    @staticmethod
    def label(kind, name, contexts, selector):
        """The name of an item, as the specification writes it."""
        return f"{kind} {name}{{{', '.join(map(str, contexts))}}}" + (f"/{selector}" if selector
                                                                      else "")
