"""The numbers of the checker: rationals (fmpq), and balls (arb: a midpoint and a radius, between which lies the exact number).

FLINT adds to the radius of every result what its rounding can lose, so that "some number in this ball" stays true through any formula. A
comparison of balls holds if it holds for all numbers in them. Doubles become rationals and balls without an error, and sums and
products of doubles, of up to PRECISION binary places, have none either.
"""

from functools import cache
from math import comb

import numpy as np
from flint import arb, ctx, fmpq

PRECISION = ctx.prec = 320


def rational(x):
    """The exact value of an int, a float or a rational."""
    return x if isinstance(x, fmpq) else fmpq(*x.as_integer_ratio())


def balls(values):
    """The array of balls of an array of doubles."""
    out = np.empty(values.size, object)
    out[:] = [arb(x) for x in values.ravel().tolist()]
    return out.reshape(values.shape)


def lower(x):
    return arb(x).lower()


def upper(x):
    return arb(x).upper()


def zero(*values):
    """True if all of these numbers are zero for certain."""
    return all(x == 0 for x in values)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def length(n):
    return arb(dot(n, n)).sqrt()


# Polynomials on [0, 1] are lists of their Bernstein coefficients: B_i = C(p, i) s^i (1 - s)^(p - i).


@cache
def _weights(p, q):
    return [[(i, k - i, fmpq(comb(p, i) * comb(q, k - i), comb(p + q, k))) for i in range(max(0, k - q), min(p, k) + 1)] for k in range(p + q + 1)]


def times(b, c):
    """The product of two polynomials."""
    return [sum(w * b[i] * c[j] for i, j, w in row) for row in _weights(len(b) - 1, len(c) - 1)]


def raised(b, degree):
    """The polynomial in a higher degree."""
    return b if len(b) > degree else times([1] * (degree + 2 - len(b)), b)


def halves(b):
    """The polynomial on both halves of the interval, each from 0 to 1 (de Casteljau)."""
    left, right = [], []
    while b:
        left, right, b = [*left, b[0]], [b[-1], *right], [(x + y) / 2 for x, y in zip(b, b[1:])]
    return left, right


def by_component(f, vectors):
    """f of both components of a polynomial whose coefficients are vectors."""
    return list(zip(*(f(list(component)) for component in zip(*vectors))))


def mean(b):
    """The integral over [0, 1]."""
    return sum(b) * fmpq(1, len(b))
