"""Polynomials on the reference triangle (0, 0), (1, 0), (0, 1), split at its centroid, in exact rational numbers.

Stresses transform by s = B s^ B^T / J (B: the edges from the first corner, J = det B): then div s^ = 0, symmetry and equal tractions across a
segment hold exactly where they hold for s, and scaled tractions (length times traction) by tau = B tau^. One matrix per degree
therefore serves every triangle. Subtriangle i has the corners i + 1, i + 2 and the centroid; a polynomial on it is written in xi, eta,
which are 1, 0 at the first of them and 0, 1 at the second.
"""

from fractions import Fraction as Q
from functools import cache
from math import comb, factorial, prod

import numpy as np
from flint import fmpq, fmpq_mat

from .ball import EPS, Ball, constants, stack

CORNERS = [(Q(0), Q(0)), (Q(1), Q(0)), (Q(0), Q(1))]
CENTRE = (Q(1, 3), Q(1, 3))


def monomials(p):
    return [(d - j, j) for d in range(p + 1) for j in range(d + 1)]


def legendre(k, s):
    return sum((-1) ** (k + j) * comb(k, j) * comb(k + j, j) * s**j for j in range(k + 1))


@cache
def to_legendre(p):
    """Row k: what the Bernstein coefficients of degree p give to the Legendre coefficient k, (2 k + 1) int L_k B_i."""
    moment = lambda i, j: Q(comb(p, i) * factorial(i + j) * factorial(p - i), factorial(p + j + 1))  # int B_i s^j
    power = lambda k, j: (-1) ** (k + j) * comb(k, j) * comb(k + j, j)
    return [[(2 * k + 1) * sum(power(k, j) * moment(i, j) for j in range(k + 1)) for i in range(p + 1)] for k in range(p + 1)]


@cache
def elevation(low, high):
    """Bernstein coefficients of degree `high` from those of degree `low`."""
    d = high - low
    return [[Q(comb(low, i) * comb(d, j - i), comb(high, j)) if 0 <= j - i <= d else Q(0) for i in range(low + 1)] for j in range(high + 1)]


@cache
def product(p, i, q, j):
    """int_0^1 of the product of two Bernstein polynomials."""
    return Q(comb(p, i) * comb(q, j), comb(p + q, i + j) * (p + q + 1))


@cache
def orthogonal(p):
    """(T, d): f = sum_j m_j mono_j = sum_k (T m)_k phi_k with orthogonal phi_k on the unit triangle, d_k = int phi_k^2."""
    mono, n = monomials(p), (p + 1) * (p + 2) // 2
    gram = [[Q(factorial(a + c) * factorial(b + d), factorial(a + b + c + d + 2)) for c, d in mono] for a, b in mono]
    low, d = [[Q(int(i == j)) for j in range(n)] for i in range(n)], [Q(0)] * n
    for j in range(n):
        d[j] = gram[j][j] - sum(low[j][k] ** 2 * d[k] for k in range(j))
        for i in range(j + 1, n):
            low[i][j] = (gram[i][j] - sum(low[i][k] * low[j][k] * d[k] for k in range(j))) / d[j]
    return [list(column) for column in zip(*low)], d


def _forces(p):
    """How many values the body force has: that of a constant for p = 1, else those of an affine one at the three corners."""
    return 2 if p == 1 else 6


def _equations(p):
    """Rows (unknowns, data) of: div s^ + f^ = 0, equal tractions inside, tractions tau^ (Legendre coefficients) on the three sides. Polynomials
    agree where they agree at enough points."""
    mono, rows = monomials(p), []
    value = lambda x, y: [x**i * y**j for i, j in mono]
    by_xi = lambda x, y: [i * x ** max(i - 1, 0) * y**j for i, j in mono]
    by_eta = lambda x, y: [j * x**i * y ** max(j - 1, 0) for i, j in mono]

    def row(parts, data):
        out = [Q(0)] * (9 * len(mono))
        for sub, comp, weight, values in parts:
            begin = (3 * sub + comp) * len(mono)
            out[begin : begin + len(mono)] = [o + weight * v for o, v in zip(out[begin:], values)]
        rows.append((out, data))

    def traction(sub, c, a, b, at, sign=1):  # component c of s^ times the normal of the segment from a to b
        return [(sub, (0, 2)[c], sign * (b[1] - a[1]), value(*at)), (sub, (2, 1)[c], sign * (a[0] - b[0]), value(*at))]

    for i in range(3):
        a, b = CORNERS[(i + 1) % 3], CORNERS[(i + 2) % 3]
        (ux, uy), (vx, vy) = ([x - c for x, c in zip(corner, CENTRE)] for corner in (a, b))
        det = ux * vy - uy * vx
        for c in range(2):
            for x, y in [(Q(j, p), Q(k, p)) for j, k in monomials(p - 1)]:
                slopes = by_xi(x, y), by_eta(x, y)
                dx = [(vy * s - uy * t) / det for s, t in zip(*slopes)]
                dy = [(ux * t - vx * s) / det for s, t in zip(*slopes)]
                rest = (1 - x - y) / 3
                share = {(i + 1) % 3: x + rest, (i + 2) % 3: y + rest, i: rest} if p > 1 else {0: Q(1)}
                row([(i, (0, 2)[c], 1, dx), (i, (2, 1)[c], 1, dy)], {6 * (p + 1) + 2 * k + c: -w for k, w in share.items()})
            for s in [Q(j, p) for j in range(p + 1)]:
                inner = traction((i + 2) % 3, c, CENTRE, CORNERS[i], (s, 0)) + traction((i + 1) % 3, c, CENTRE, CORNERS[i], (0, s), -1)
                row(inner, {})
                row(traction(i, c, a, b, (1 - s, s)), {(i * (p + 1) + k) * 2 + c: legendre(k, s) for k in range(p + 1)})
    return rows


def rational(rows):
    return fmpq_mat(len(rows), len(rows[0]), [fmpq(*x.as_integer_ratio()) for row in rows for x in row])


def inverse(rows):
    return [[Q(int(x.p), int(x.q)) for x in row] for row in rational(rows).inv().table()]


def floats(matrix):
    return np.array([[int(x.p) / int(x.q) for x in row] for row in matrix.table()])


def _enclosed(matrix):
    mid = floats(matrix)
    return Ball(mid, abs(mid) * EPS + 1e-300)


@cache
def stresses(p):
    """(R, Z, d): the orthogonal coefficients of s^ are R (tau^, f^) + Z c for whatever c; rows by subtriangle, component (xx, yy, xy) and phi_k.

    R is right for data in equilibrium. Which of the fields with the same tractions it gives, and the basis Z of those without, are chosen in
    floating point and then taken exactly.
    """
    rows, data = _equations(p), 6 * (p + 1) + _forces(p)
    unknowns = len(rows[0][0])
    reduced, rank = rational([row + [w.get(j, Q(0)) for j in range(data)] for row, w in rows]).rref()
    pivots = [(next(j for j, x in enumerate(row) if x != 0), row) for row in reduced.table()[:rank]]
    # Rows without unknowns are what data in equilibrium fulfil: two forces and a moment.
    assert sum(pivot >= unknowns for pivot, _ in pivots) == 3, "tractions in equilibrium have a field"
    table, pivots = zip(*((row, pivot) for pivot, row in pivots if pivot < unknowns))
    free = sorted(set(range(unknowns)) - set(pivots))
    # One column for each datum, then one for each free coefficient.
    fields = {pivot: row[unknowns:] + [-row[j] for j in free] for row, pivot in zip(table, pivots)}
    fields |= {j: [fmpq(int(k == data + i)) for k in range(data + len(free))] for i, j in enumerate(free)}
    transform, d = orthogonal(p)
    n, change = len(d), rational(transform)
    block = lambda b: change * fmpq_mat(n, data + len(free), [x for j in range(b * n, b * n + n) for x in fields[j]])
    columns = list(zip(*(row for b in range(9) for row in block(b).table())))
    matrix = lambda these: fmpq_mat(len(these), unknowns, [x for column in these for x in column]).transpose()
    special = matrix(columns[:data])
    if not free:
        return _enclosed(special), None, d
    weight = np.sqrt(np.array([float(x) * (1, 1, 2)[c] for _ in range(3) for c in range(3) for x in d]))[:, None]
    basis = matrix(columns[data:])
    for _ in range(2):
        basis = basis * rational(np.linalg.inv(np.linalg.qr(floats(basis) * weight)[1]).tolist())
    least = -(floats(basis) * weight).T @ (floats(special) * weight)
    return _enclosed(special + basis * rational(least.tolist())), _enclosed(basis), d


@cache
def derivatives(k, affine=False):
    """(X, Y, d): orthogonal coefficients of degree k - 1, at least 1 where they are to hold something affine too, of the derivatives by xi and
    eta of a polynomial of Bernstein coefficients of degree k."""
    low = max(k - 1, int(affine))
    transform, d = orthogonal(low)
    place, columns = {m: j for j, m in enumerate(monomials(low))}, ([], [])
    for a, b, c in bernstein_indices(k):
        slopes = [[Q(0)] * len(place) for _ in range(2)]
        for i, j in monomials(c):  # (1 - xi - eta)^c
            w = Q((-1) ** (i + j) * factorial(k), prod(map(factorial, (a, b, i, j, c - i - j))))
            for slope, power, down in ((slopes[0], a + i, (a + i - 1, b + j)), (slopes[1], b + j, (a + i, b + j - 1))):
                if power:
                    slope[place[down]] += w * power
        for column, slope in zip(columns, slopes):
            column.append([sum(t * x for t, x in zip(row, slope)) for row in transform])
    return *(constants(list(zip(*column))) for column in columns), d


def on_split(corners):
    """Orthogonal coefficients of degree 1, on each subtriangle, of a function that is affine on a triangle, by its values at the corners."""
    centre = (corners[0] + corners[1] + corners[2]) * constants([[Q(1, 3)]])[0, 0]
    change, _ = orthogonal(1)
    for sub in range(3):
        first, second = corners[(sub + 1) % 3], corners[(sub + 2) % 3]
        yield stack([centre, first - centre, second - centre]).times(constants(change))


@cache
def shares(k):
    """Integrals over the unit triangle of Bernstein polynomials times the barycentric coordinates, by rows."""
    return [[Q(m[i] + 1, (k + 1) * (k + 2) * (k + 3)) for m in bernstein_indices(k)] for i in range(3)]


def bernstein_indices(k):
    return [(k - rest, rest - l, l) for rest in range(k + 1) for l in range(rest + 1)]


@cache
def split_nodes(k):
    """The place of every Bernstein coefficient of each subtriangle among those of the split triangle: see docs/proof.md."""
    centre, subs = 3 * k, []
    for sub in range(3):
        first, second = (sub + 1) % 3, (sub + 2) % 3
        inside = iter(range(centre + 1 + 3 * (k - 1) + sub * (k - 1) * (k - 2) // 2, 10**6))
        known = {(k, 0, 0): first, (0, k, 0): second, (0, 0, k): centre}
        known |= {(k - j, j, 0): 2 + sub * (k - 1) + j for j in range(1, k)}
        known |= {(k - j, 0, j): centre + first * (k - 1) + j for j in range(1, k)}
        known |= {(0, k - j, j): centre + second * (k - 1) + j for j in range(1, k)}
        subs.append([known[m] if m in known else next(inside) for m in bernstein_indices(k)])
    return subs
