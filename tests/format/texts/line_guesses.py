# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines on a grid, from docs/format-columns-geometry.md, "Lines"."""
from number_forms import quotient

FIRST, AGAIN, PARALLELOGRAM, LAST, ROUND_X, ROUND_Y, DIAGONAL, ON_LINE, NO_GUESS = range(9)
SIZES = (1, 2, 5, 10)
LIMIT = 2**60


def next_round(number, step, grid):
    """The next multiple of the grid in the direction of a step."""
    low = number // grid * grid
    if step > 0:
        return low + grid
    return low - grid if low == number else low


def is_on_grid(x, y, grid):
    """Whether x, y or x - y is a multiple of the grid."""
    return x % grid == 0 or y % grid == 0 or (x - y) % grid == 0


def along(number, step, part, whole):
    """number + step * part / whole, rounded."""
    moved, half = step * part, abs(whole) // 2
    half = half if moved >= 0 else -half
    result = quotient(moved + half, abs(whole)) * (1 if whole > 0 else -1)
    return number if abs(result) >= LIMIT else number + result


class Line:
    """Follows a line."""

    def __init__(self):
        self.unit, self.hits, self.start, self.last = 0, [0] * 4, (0, 0), (0, 0)
        self.restart()

    def restart(self):
        """Starts another line."""
        self.has_last, self.has_direction = False, False

    def set_unit(self, unit):
        """Tells how many units are one unit of the coordinates."""
        if unit != self.unit:
            self.unit = unit
            self.restart()

    def grid(self):
        """The grid, 0 for none."""
        most = max(self.hits)
        if self.unit == 0 or most < 1024:
            return 0
        return max(size * self.unit for size, hits in zip(SIZES, self.hits)
                   if hits > most - most // 4)

    def for_x(self):
        """Guesses for x: kind, number, whether it is exact."""
        grid, (x, y) = self.grid(), self.last
        if not self.has_last or grid == 0:
            return []
        if not self.has_direction:
            low = x // grid * grid
            return [(ROUND_X, low - grid if low == x else low, True), (ROUND_X, low + grid, True)]
        dx, dy, crossings = x - self.start[0], y - self.start[1], []
        for kind, number, step in ((ROUND_X, x, dx), (ROUND_Y, y, dy), (DIAGONAL, x - y, dx - dy)):
            if step:
                part = next_round(number, step, grid) - number
                crossed = x + part if kind == ROUND_X else along(x, dx, part, step)
                # Fractions are compared as products; the sort is stable.
                crossings.append((abs(part), abs(step), (kind, crossed, kind == ROUND_X)))
        ordered = []
        for crossing in crossings:
            at = len(ordered)
            while at and crossing[0] * ordered[at - 1][1] < ordered[at - 1][0] * crossing[1]:
                at -= 1
            ordered.insert(at, crossing)
        return [crossing[2] for crossing in ordered]

    def for_y(self, x, kind_of_x):
        """Guesses for y after x."""
        grid, (last_x, y) = self.grid(), self.last
        if not self.has_last or grid == 0:
            return []
        dx, dy, guesses = last_x - self.start[0], y - self.start[1], []
        if self.has_direction and kind_of_x == ROUND_Y and dy:
            guesses.append((ROUND_Y, next_round(y, dy, grid), True))
        elif self.has_direction and kind_of_x == DIAGONAL and dx != dy:
            guesses.append((DIAGONAL, x - next_round(last_x - y, dx - dy, grid), True))
        elif self.has_direction and dx:
            guesses.append((ON_LINE, along(y, dy, x - last_x, dx), False))
        if kind_of_x == NO_GUESS:
            low, difference = y // grid * grid, (last_x - y) // grid * grid
            guesses += [(ROUND_Y, low - grid if low == y else low, True),
                        (DIAGONAL, x - difference, True), (ROUND_Y, low + grid, True),
                        (DIAGONAL, x - difference - grid, True)]
        return guesses

    def take(self, x, y, kind):
        """Takes a position; `kind` is that of the guess for x, or for y if x had none."""
        in_range = max(abs(x), abs(y)) < LIMIT // 4
        if in_range and self.unit:
            for i, size in enumerate(SIZES):
                target = 4096 if is_on_grid(x, y, size * self.unit) else 0
                self.hits[i] += quotient(target - self.hits[i], 16)
        grid = self.grid()
        is_crossing = kind in (ROUND_X, ROUND_Y, DIAGONAL) or (
            kind == AGAIN and in_range and grid > 0 and is_on_grid(x, y, grid))
        if not is_crossing or not self.has_last or not in_range:
            self.start, self.has_direction = (x, y), False
        else:
            self.has_direction = (x, y) != self.start
        self.has_last, self.last = in_range, (x, y)
