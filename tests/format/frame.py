# SPDX-License-Identifier: GPL-3.0-or-later
"""The values that the solids of a page share, from docs/format.md, "Frame"."""
import math
import struct

from entropy import Bank, Malformed

IMPLIED_TOLERANCES = (0.01, 20.0, 0.0)
BINARY, FLOAT64 = 1, 2
LARGEST_EXPONENT, LARGEST_POWER = 1200, 2**60


def frame_bank():
    """The bank of the frame's families and numbers."""
    return Bank({"implied": ([1],), "proof": ([1],), "kind": ([3],), "one step": ([1],),
                 "phase": ([1],), "mode": ([64],), "origin": ([8],), "order": ([2],)},
                {"rule set": ([1],), "SRID": ([1],), "mantissa": ([2],), "exponent": ([2],),
                 "offset": ([3],), "section": ([1],)})


class Frame:
    """Reads tolerances, proof, rule set, reference system and grid."""

    def __init__(self, m):
        self.tolerances = IMPLIED_TOLERANCES
        if not m.decide("implied", 0):
            self.tolerances = tuple(struct.unpack("<d", struct.pack("<Q", m.plain(64)))[0]
                                    for _ in range(3))
            if self.tolerances == IMPLIED_TOLERANCES or not all(map(math.isfinite,
                                                                    self.tolerances)):
                raise Malformed("tolerances")
        self.proof = m.decide("proof", 0)
        self.rule_set = m.number("rule set", 0, bits=16)
        self.srid = m.number("SRID", 0, bits=32)
        high = m.decide("kind", 0)
        self.kind = 2 * high + m.decide("kind", 1 + high)
        self.base = 2 if self.kind == BINARY else 10
        self.steps, self.phases = [(1, 0)] * 3, [(0, 0)] * 3
        if self.kind > FLOAT64:
            raise Malformed("lattice kind")
        if self.kind == FLOAT64:
            return
        if m.decide("one step", 0):
            self.steps = [self.read_value(m, 0)] * 3
        else:
            self.steps = [self.read_value(m, 0) for _ in range(3)]
        self.phases = [(0, 0) if m.decide("phase", 0) else self.read_value(m, 1) for _ in range(3)]
        self.lattice_origin((0, 0, 0))

    @staticmethod
    def read_value(m, context):
        """Reads a mantissa and an exponent."""
        mantissa = m.signed("mantissa", context, bits=63)
        return mantissa, m.signed("exponent", context, bits=20)

    def lattice_origin(self, g):
        """The origin of the lattice that begins at grid point g, on each axis."""
        if self.kind == FLOAT64:
            return [(0, 0)] * 3
        for mantissa, exponent in self.steps:
            if mantissa <= 0 or abs(exponent) > LARGEST_EXPONENT:
                raise Malformed("a step")
        return [self.value(step, phase, c) for step, phase, c in zip(self.steps, self.phases, g)]

    def value(self, step, phase, g):
        """The number phase + g * step in its simplest form."""
        exponent = min(step[1], phase[1]) if phase[0] else step[1]
        apart = [step[1] - exponent, phase[1] - exponent if phase[0] else 0]
        if max(apart) > 60 or self.base ** max(apart) > LARGEST_POWER:
            if g:
                raise Malformed("a phase that has no unit in common with its step")
            mantissa, exponent = phase
        else:
            scaled = step[0] * self.base ** apart[0]
            mantissa = g * scaled + phase[0] * self.base ** apart[1]
            if not all(-2**127 <= number < 2**127 for number in (g * scaled, mantissa)):
                raise Malformed("an origin out of range")
            exponent = exponent if mantissa else 0
            while mantissa and mantissa % self.base == 0:
                mantissa, exponent = mantissa // self.base, exponent + 1
        if abs(mantissa) >= 2**63 or abs(exponent) > LARGEST_EXPONENT:
            raise Malformed("an origin out of range")
        return mantissa, exponent
