"""Enclosures of real numbers, whole arrays at a time, and fixed-point numbers for sums that must not round.

A Ball is an array of midpoints and an array of radii; the exact numbers lie between mid - rad and mid + rad. Each operation adds to the
radius what IEEE double precision can lose in it: a result x is off by at most EPS |x| (twice what rounding to nearest allows).
"""

from fractions import Fraction
from math import fsum, isqrt

import numpy as np

EPS = 2.0**-52
TINY = 1e-290  # more than anything that underflows
LONG = np.longdouble if 1e-25 < np.finfo(np.longdouble).eps < EPS else float  # wider, where there is such a type
LONG_EPS = float(np.finfo(LONG).eps)
BITS = 320  # binary places of fixed-point numbers
ONE = 1 << BITS


def _up(radius, live=False):
    """A radius computed in a few operations, rounded upwards; `live` where something may have underflowed. Exact zeros stay exact."""
    return radius * (1 + 16 * EPS) + TINY * ((radius > 0) | live)


class Ball:
    __array_ufunc__ = None

    def __init__(self, mid, rad=None):
        self.mid = np.asarray(mid, float)
        self.rad = np.zeros(self.mid.shape) if rad is None else np.asarray(rad, float)

    @staticmethod
    def of(x):
        return x if isinstance(x, Ball) else Ball(x)

    def __getitem__(self, key):
        return Ball(self.mid[key], self.rad[key])

    def writable(self):
        return Ball(self.mid.copy(), self.rad.copy())

    def put(self, key, other):
        """Overwrites a part of an array."""
        self.mid[key], self.rad[key] = other.mid, other.rad

    def reshape(self, *shape):
        return Ball(self.mid.reshape(*shape), self.rad.reshape(*shape))

    def __add__(self, other):
        other = Ball.of(other)
        mid = self.mid + other.mid
        return Ball(mid, _up(self.rad + other.rad + EPS * abs(mid), mid != 0))

    def __neg__(self):
        return Ball(-self.mid, self.rad)

    def __sub__(self, other):
        return self + -Ball.of(other)

    def __mul__(self, other):
        other = Ball.of(other)
        mid, a, b = self.mid * other.mid, abs(self.mid), abs(other.mid)
        return Ball(mid, _up(a * other.rad + self.rad * (b + other.rad) + EPS * abs(mid), (a + self.rad > 0) & (b + other.rad > 0)))

    __radd__, __rmul__ = __add__, __mul__

    def inverse(self):
        """One over numbers that are not zero."""
        size = abs(self.mid)
        if np.any(size <= 2 * self.rad):
            raise ZeroDivisionError
        mid = 1 / self.mid
        return Ball(mid, _up(self.rad / (size * (size - self.rad)) * (1 + 8 * EPS) + EPS * abs(mid), True))

    def square(self):
        return self * self

    def times(self, matrix, axis=0):
        """matrix @ self along an axis; the matrix is a Ball of constants."""
        n = matrix.mid.shape[1]
        x, r = (np.moveaxis(v, axis, 0).reshape(n, -1) for v in (self.mid, self.rad))
        mid, size = (matrix.mid.astype(LONG) @ x.astype(LONG)).astype(float), abs(matrix.mid) @ abs(x)
        rad = abs(matrix.mid) @ r + matrix.rad @ (abs(x) + r)
        # A sum of n products, in whatever order, is off by at most n times the precision times the sum of their sizes.
        rad = (rad + (n + 2) * LONG_EPS * size + EPS * abs(mid)) * (1 + (4 * n + 16) * EPS) + n * TINY * (abs(x) + r).any(0)
        shape = [matrix.mid.shape[0]] + list(np.moveaxis(self.mid, axis, 0).shape[1:])
        return Ball(*(np.moveaxis(v.reshape(shape), 0, axis) for v in (mid, rad)))

    def sum(self):
        """The sum of all, as [lower, upper]."""
        mid, rad = fsum(self.mid.ravel()), fsum(self.rad.ravel())
        if not self.mid.any() and not rad:
            return [0.0, 0.0]
        rad = rad * (1 + 4 * EPS) + 2 * EPS * abs(mid) + TINY
        return [np.nextafter(mid - rad, -np.inf), np.nextafter(mid + rad, np.inf)]


def stack(balls, axis=0):
    return Ball(np.stack([b.mid for b in balls], axis), np.stack([b.rad for b in balls], axis))


def constants(rows):
    """The Ball of nested lists of fractions."""
    mid = np.array([[float(x) for x in row] for row in rows])
    return Ball(mid, _up(EPS * abs(mid)))


def of_fractions(values, shape=None):
    mid = np.array([float(x) for x in values], float)
    exact = np.array([Fraction(m) == x for m, x in zip(mid, values)], bool)
    ball = Ball(mid, np.where(exact, 0.0, _up(EPS * abs(mid), True)))
    return ball if shape is None else ball.reshape(shape)


def fixed(values):
    """Fixed-point numbers of doubles or fractions: integers in units of 2^-BITS, at most one unit below the exact value."""

    def one(x):
        n, d = x.as_integer_ratio()
        return n * ONE // d

    values = np.asarray(values)
    flat = [one(x) for x in values.ravel().tolist()]
    out = np.empty(len(flat), object)
    out[:] = flat
    return out.reshape(values.shape)


def times(a, b):
    """The product of fixed-point numbers, at most one unit below the exact one."""
    return (a * b) >> BITS


def ball_of(integers, error=0.0):
    """The Ball of fixed-point numbers that are off by at most `error`."""
    integers = np.asarray(integers, object)
    mid = np.array([i / ONE for i in integers.ravel()], float).reshape(integers.shape)
    return Ball(mid, _up(EPS * abs(mid) + error))


def root(x):
    """The square root of a fraction: itself where it is one, or two fractions that enclose it, 2^-BITS apart."""
    n, d = x.numerator, x.denominator
    if isqrt(n) ** 2 == n and isqrt(d) ** 2 == d:
        return Fraction(isqrt(n), isqrt(d)), Fraction(isqrt(n), isqrt(d))
    low = isqrt((n << (2 * BITS)) // d)
    return Fraction(low, ONE), Fraction(low + 1, ONE)
