# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors of doubles, from docs/format.md, "Conventions", and the classes of quantities in the
texts of the modes."""
import math

HALF_TURN = 3.141592653589793


def minus(p, q):
    """The difference of two points."""
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def plus(p, q):
    """The sum of two points."""
    return p[0] + q[0], p[1] + q[1], p[2] + q[2]


def times(p, s):
    """A vector multiplied by a number."""
    return p[0] * s, p[1] * s, p[2] * s


def cross(u, v):
    """The cross product of two vectors."""
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    """The scalar product of two vectors."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def size(u):
    """The length of a vector."""
    return math.sqrt(dot(u, u))


def unit(u):
    """A vector divided by its length, or 0 for length 0."""
    length = size(u)
    return times(u, 1 / length) if length > 0 else (0.0, 0.0, 0.0)


def angle_between(a, b):
    """An approximation of the angle between two vectors."""
    along, across = dot(a, b), size(cross(a, b))
    least = abs(along)
    if not least + across > 0:
        return 0.0
    steep = across > least
    t = least / across if steep else across / least
    angle = t * (HALF_TURN / 4 + 0.273 * (1 - t))
    if steep:
        angle = HALF_TURN / 2 - angle
    return HALF_TURN - angle if along < 0 else angle


def bucket(x, n):
    """The floor of x, limited to 0..n - 1."""
    if not x > 0:
        return 0
    return n - 1 if x >= n else int(x)


def log_bucket(x, zero, n):
    """floor(2 log2 x) + zero, limited to 0..n - 1; 0 if x is not positive."""
    if not x > 0:
        return 0
    fraction, exponent = math.frexp(x)
    return bucket(2 * (exponent - 1) + (fraction >= 0.7071067811865476) + zero, n)


def cosine_bucket(a, b):
    """The class of the cosine between two vectors."""
    sizes = math.sqrt(dot(a, a) * dot(b, b))
    if not sizes > 0:
        return 0
    cosine, at = dot(a, b) / sizes, 0
    for bound in (-0.5, 0.0, 0.5, 0.8, 0.92, 0.98, 0.995):
        if not cosine >= bound:
            break
        at += 1
    return at
