# SPDX-License-Identifier: GPL-3.0-or-later
"""Mode parallelogram, the prediction of a tip, from docs/format-parallelogram.md, "Prediction"."""
import math

from vectors import cosine_bucket, cross, dot, minus, plus, size, times, unit

MEMORY = 0.995


def tamed(x):
    """x limited to +-9e15, the range of coordinates; NaN becomes -9e15."""
    return min(x, 9e15) if x > -9e15 else -9e15


class LeastSquares:
    """A linear prediction whose coefficients learn from samples."""

    def __init__(self, first, confidence):
        n = len(first)
        self.coefficients = list(first)
        self.m = [[confidence if i == j else 0.0 for j in range(n)] for i in range(n)]
        self.y = [confidence * c for c in first]

    def predict(self, features):
        """The sum of the features times their coefficients."""
        total = 0.0
        for c, f in zip(self.coefficients, features):
            total += c * f
        return total

    def learn(self, features, target, weight):
        """Adds one sample."""
        for i, f in enumerate(features):
            weighted = weight * f
            for j in range(i + 1):
                self.m[i][j] += weighted * features[j]
            self.y[i] += weighted * target

    def solve(self):
        """Computes the coefficients again; then reduces the weight of the past."""
        n = len(self.y)
        lower = [[0.0] * n for _ in range(n)]
        for i in range(n):
            for j in range(i + 1):
                total = self.m[i][j]
                if i == j:
                    total += 1e-6 * self.m[i][i] + 1e-12
                for k in range(j):
                    total -= lower[i][k] * lower[j][k]
                if i != j:
                    lower[i][j] = total / lower[j][j]
                elif total > 0:
                    lower[i][i] = math.sqrt(total)
                else:
                    return
        x = [0.0] * n
        for i in range(n):
            total = self.y[i]
            for k in range(i):
                total -= lower[i][k] * x[k]
            x[i] = total / lower[i][i]
        for i in reversed(range(n)):
            total = x[i]
            for k in range(i + 1, n):
                total -= lower[k][i] * x[k]
            x[i] = total / lower[i][i]
        self.coefficients = x
        self.m = [[value * MEMORY for value in row] for row in self.m]
        self.y = [value * MEMORY for value in self.y]


def span(room):
    """The class of how far a corner of a gate is open."""
    return 0 if room < 1.7 else 1 if room < 2.7 else 2 if room < 3.8 else 3


class Prediction:
    """Predicts the tip of a gate, and learns from the true one."""

    def __init__(self):
        self.predictors = [LeastSquares([1.0] + [0.0] * 8, 3.0) for _ in range(16)]
        self.shift_predictors = [LeastSquares([0.5], 4.0) for _ in range(64)]

    def predict(self, front, gate):
        """Computes guesses, normal, size and spans at a gate."""
        at, after, before = front.places, gate.next, gate.previous
        u, v, o = at[gate.start], at[gate.end], at[gate.apex]
        middle, along = times(plus(u, v), 0.5), minus(v, u)
        self.size = size(along)
        self.normal = unit(cross(along, minus(o, u)))

        def bend(other):
            start = at[other.start]
            normal = cross(minus(at[other.end], start), minus(at[other.apex], start))
            return cosine_bucket(self.normal, normal)

        self.bends = 8 * bend(after) + bend(before)
        outward = unit(cross(along, self.normal))
        side = gate.side
        right = front.beyond(side - 2 if side % 3 == 2 else side + 1)
        left = front.beyond(side + 2 if side % 3 == 0 else side - 1)

        def offset(a, b, c):
            return minus(minus(plus(a, b), c), middle)

        offsets = [offset(u, v, o), offset(u, at[after.end], v), offset(v, at[before.start], u),
                   times(outward, self.size), times(self.normal, self.size),
                   offset(v, at[after.end], at[after.apex]),
                   offset(u, at[before.start], at[before.apex]),
                   (0.0, 0.0, 0.0) if left is None else plus(minus(minus(at[left], u), o), v),
                   (0.0, 0.0, 0.0) if right is None else plus(minus(minus(at[right], v), o), u)]
        self.spans = 4 * span(gate.room) + span(before.room)
        self.middle = middle
        self.features = [[offset[k] for offset in offsets] for k in range(3)]
        predictor = self.predictors[self.spans]
        position = tuple(middle[k] + predictor.predict(self.features[k]) for k in range(3))
        square = dot(along, along)
        foot = plus(u, times(along, dot(minus(o, u), along) / square)) if square > 0 else u
        guesses = [position, plus(offsets[0], middle), plus(offsets[1], middle),
                   minus(times(foot, 2), o), plus(offsets[5], middle),
                   minus(times(u, 2), at[before.start])]
        self.guesses = [tuple(map(tamed, guess)) for guess in guesses]

    def shift_along(self, axis, slope):
        """The predicted shift of the tip along the last axis."""
        self.shift = self.predicted_shift = 0.0
        if self.normal[axis] == 0:
            return 0.0
        self.shift = max(-self.size - 1, min(self.size + 1, -slope / self.normal[axis]))
        self.predicted_shift = self.shift_predictors[self.bends].predict([self.shift])
        return self.predicted_shift

    def learn_shift(self, missed, expected):
        """Learns the shift that would have been right."""
        rest = missed - self.predicted_shift
        weight = 1 / (rest * rest + expected * expected + 1)
        self.shift_predictors[self.bends].learn([self.shift], missed, weight)

    def learn(self, place, expected):
        """Learns from the true tip."""
        missed = size(minus(place, self.guesses[0]))
        weight = 1 / (missed * missed + expected * expected + 1)
        predictor = self.predictors[self.spans]
        for k in range(3):
            predictor.learn(self.features[k], place[k] - self.middle[k], weight)
        predictor.solve()
        self.shift_predictors[self.bends].solve()
