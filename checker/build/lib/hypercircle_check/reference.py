"""Polynomials on the reference triangle (0, 0), (1, 0), (0, 1), split at its centroid, in exact rational numbers.

Stresses transform by s = B s^ B^T / J (B: the edges from the first corner, J = det B): then div s^ = 0, symmetry and equal tractions across a
segment hold exactly where they hold for s, and scaled tractions (length times traction) by tau = B tau^. One matrix per degree
therefore serves every triangle. Subtriangle i has the corners i + 1, i + 2 and the centroid; a polynomial on it is written in xi, eta,
which are 1, 0 at the first of them and 0, 1 at the second.
"""

from fractions import Fraction as Q
from functools import cache
from math import comb, factorial

import numpy as np
from flint import fmpq, fmpq_mat

from .ball import EPS, Ball, constants

CORNERS = [(Q(0), Q(0)), (Q(1), Q(0)), (Q(0), Q(1))]
CENTRE = (Q(1, 3), Q(1, 3))


def monomials(p):
    return [(d - j, j) for d in range(p + 1) for j in range(d + 1)]


@cache
def legendre(p):
    """Row k: the coefficients of L_k(2 s - 1) in powers of s."""
    return [[Q((-1) ** (k + j) * comb(k, j) * comb(k + j, j)) if j <= k else Q(0) for j in range(p + 1)] for k in range(p + 1)]


@cache
def to_legendre(p):
    """The Legendre coefficients of a polynomial of Bernstein coefficients: 1-d, degree p, entry [k][i]."""
    # int_0^1 B_i s^j ds is a beta function; 2k + 1 is one over the norm of L_k.
    moment = lambda i, j: Q(comb(p, i) * factorial(i + j) * factorial(p - i), factorial(p + j + 1))
    rows = legendre(p)
    return [[(2 * k + 1) * sum(rows[k][j] * moment(i, j) for j in range(k + 1)) for i in range(p + 1)] for k in range(p + 1)]


@cache
def elevation(low, high):
    """Bernstein coefficients of degree `high` from those of degree `low`."""
    d = high - low
    return [[Q(comb(low, i) * comb(d, j - i), comb(high, j)) if 0 <= j - i <= d else Q(0) for i in range(low + 1)] for j in range(high + 1)]


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
    return [[low[i][k] for i in range(n)] for k in range(n)], d


def _gradients(i):
    """d xi/dx, d xi/dy, d eta/dx, d eta/dy on subtriangle i, and its corners."""
    a, b, c = CORNERS[(i + 1) % 3], CORNERS[(i + 2) % 3], CENTRE
    u, v = (a[0] - c[0], a[1] - c[1]), (b[0] - c[0], b[1] - c[1])
    det = u[0] * v[1] - u[1] * v[0]
    return (v[1] / det, -v[0] / det, -u[1] / det, u[0] / det), (a, b, c)


def _normal(a, b):
    return b[1] - a[1], a[0] - b[0]


def _equations(p):
    """Rows (unknowns, data) of: div s^ + f^ = 0, equal tractions inside, tractions tau^ (Legendre coefficients) on the three sides."""
    mono = monomials(p)
    index, n = {m: j for j, m in enumerate(mono)}, len(mono)
    at = lambda sub, comp, m: (3 * sub + comp) * n + index[m]
    rows = []
    for sub in range(3):
        (xx, xy, ex, ey), _ = _gradients(sub)
        for comp in range(2):  # d/dx of (xx, xy)[comp] + d/dy of (xy, yy)[comp]
            for m in monomials(p - 1):
                row = {}
                for which, gx, gy in ((comp if comp == 0 else 2, xx, ex), (2 if comp == 0 else 1, xy, ey)):
                    for g, up in ((gx, (m[0] + 1, m[1])), (gy, (m[0], m[1] + 1))):
                        factor = g * (up[0] if up[0] > m[0] else up[1])
                        row[at(sub, which, up)] = row.get(at(sub, which, up), Q(0)) + factor
                rows.append((row, {6 * (p + 1) + comp: Q(-1)} if m == (0, 0) else {}))
    for k in range(3):  # the segment from the centroid to corner k
        normal = _normal(CENTRE, CORNERS[k])
        for comp in range(2):
            for power in range(p + 1):
                row = {}
                for sub, m, sign in (((k + 2) % 3, (power, 0), 1), ((k + 1) % 3, (0, power), -1)):
                    for which, w in ((comp if comp == 0 else 2, normal[0]), (2 if comp == 0 else 1, normal[1])):
                        row[at(sub, which, m)] = sign * w
                rows.append((row, {}))
    for sub in range(3):  # the side opposite corner sub: xi = 1 - s, eta = s
        _, (a, b, _) = _gradients(sub)
        normal = _normal(a, b)
        for comp in range(2):
            for power in range(p + 1):
                row = {}
                for i, j in mono:
                    if j <= power <= i + j:
                        w = Q((-1) ** (power - j) * comb(i, power - j))
                        for which, g in ((comp if comp == 0 else 2, normal[0]), (2 if comp == 0 else 1, normal[1])):
                            row[at(sub, which, (i, j))] = row.get(at(sub, which, (i, j)), Q(0)) + w * g
                data = {(sub * (p + 1) + k) * 2 + comp: legendre(p)[k][power] for k in range(power, p + 1)}
                rows.append((row, data))
    return rows, 9 * n


def _balances(p):
    """Resultant and moment about (0, 0) of tau^ and f^: zero in equilibrium."""
    rows = [[Q(0)] * (6 * (p + 1) + 2) for _ in range(3)]
    for side in range(3):
        a, b = CORNERS[(side + 1) % 3], CORNERS[(side + 2) % 3]
        mid, d = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), (b[0] - a[0], b[1] - a[1])
        first, second = side * (p + 1) * 2, (side * (p + 1) + 1) * 2
        rows[0][first] = rows[1][first + 1] = Q(1)
        rows[2][first], rows[2][first + 1] = -mid[1], mid[0]
        rows[2][second], rows[2][second + 1] = -d[1] / 6, d[0] / 6
    rows[0][-2] = rows[1][-1] = Q(1, 2)
    rows[2][-2], rows[2][-1] = -CENTRE[1] / 2, CENTRE[0] / 2
    return rows


def _fmpq(x):
    return fmpq(x.numerator, x.denominator)


def _matrix(rows):
    return fmpq_mat(len(rows), len(rows[0]), [_fmpq(x) for row in rows for x in row])


def _floats(matrix):
    return np.array([[int(x.p) / int(x.q) for x in row] for row in matrix.table()])


def _exactly(array):
    return fmpq_mat(*array.shape, [fmpq(*x.as_integer_ratio()) for x in array.ravel().tolist()])


@cache
def stresses(p):
    """(R, Z, d): the orthogonal coefficients of s^ are R (tau^, f^) + Z c for whatever c; rows by subtriangle, component (xx, yy, xy) and phi_k.

    R is right for data in equilibrium. Which of the fields with the same tractions it gives, and the basis Z of those without, are chosen in
    floating point and then taken exactly.
    """
    rows, unknowns = _equations(p)
    data = 6 * (p + 1) + 2
    balance = _matrix(_balances(p))
    transposed = balance.transpose()
    identity = fmpq_mat(data, data, [int(i == j) for i in range(data) for j in range(data)])
    project = identity - transposed * (balance * transposed).inv() * balance
    left = fmpq_mat(len(rows), unknowns, [_fmpq(row.get(j, Q(0))) for row, _ in rows for j in range(unknowns)])
    right = fmpq_mat(len(rows), data, [_fmpq(w.get(j, Q(0))) for _, w in rows for j in range(data)]) * project
    joined = fmpq_mat(len(rows), unknowns + data, [x for a, b in zip(left.table(), right.table()) for x in a + b])
    reduced, rank = joined.rref()
    table = reduced.table()[:rank]
    pivots = [next(j for j, x in enumerate(row) if x != 0) for row in table]
    assert pivots[-1] < unknowns, "equilibrated tractions have a field"
    free = [j for j in range(unknowns) if j not in set(pivots)]
    particular, null = [[fmpq(0)] * data for _ in range(unknowns)], [[fmpq(0)] * len(free) for _ in range(unknowns)]
    for row, pivot in zip(table, pivots):
        particular[pivot] = row[unknowns:]
        null[pivot] = [-row[j] for j in free]
    for k, j in enumerate(free):
        null[j][k] = fmpq(1)
    transform, d = orthogonal(p)
    n = len(d)
    change = _matrix(transform)
    blocks = lambda t: [x for b in range(9) for x in (change * fmpq_mat(n, len(t[0]), [y for r in t[b * n : b * n + n] for y in r])).table()]
    weight = np.sqrt(np.array([float(x) * (2 if c == 2 else 1) for _ in range(3) for c in range(3) for x in d]))
    special = fmpq_mat(unknowns, data, [x for r in blocks(particular) for x in r])
    if not free:
        return _enclosed(special), None, d
    basis = fmpq_mat(unknowns, len(free), [x for r in blocks(null) for x in r])
    for _ in range(2):
        triangular = np.linalg.qr(_floats(basis) * weight[:, None])[1]
        basis = basis * _exactly(np.linalg.inv(triangular))
    least = -(_floats(basis) * weight[:, None]).T @ (_floats(special) * weight[:, None])
    return _enclosed(special + basis * _exactly(least)), _enclosed(basis), d


def _enclosed(matrix):
    mid = _floats(matrix)
    return Ball(mid, abs(mid) * EPS + 1e-300)


@cache
def derivatives(k):
    """(X, Y, d): orthogonal coefficients of degree k - 1 of the derivatives by xi and eta of a polynomial of Bernstein coefficients of degree k."""
    transform, d = orthogonal(k - 1)
    mono = {m: j for j, m in enumerate(monomials(k - 1))}
    columns = [[], []]
    for a, b, c in bernstein_indices(k):
        power = {}
        for i in range(c + 1):
            for j in range(c - i + 1):
                w = Q(factorial(k), factorial(a) * factorial(b) * factorial(c)) * (-1) ** (i + j) * Q(factorial(c), factorial(i) * factorial(j) * factorial(c - i - j))
                power[a + i, b + j] = power.get((a + i, b + j), Q(0)) + w
        for which in range(2):
            column = [Q(0)] * len(mono)
            for (i, j), w in power.items():
                if (i, j)[which]:
                    column[mono[(i - 1, j) if which == 0 else (i, j - 1)]] += w * (i, j)[which]
            columns[which].append([sum(t * x for t, x in zip(row, column)) for row in transform])
    return *(constants(list(zip(*c))) for c in columns), d


def bernstein_indices(k):
    return [(k - rest, rest - l, l) for rest in range(k + 1) for l in range(rest + 1)]


@cache
def split_nodes(k):
    """The place of every Bernstein coefficient of each subtriangle among those of the split triangle: see docs/proof.md."""
    centre, subs = 3 * k, []
    for sub in range(3):
        first, second = (sub + 1) % 3, (sub + 2) % 3
        inside = centre + 1 + 3 * (k - 1) + sub * ((k - 1) * k // 2 - (k - 1))
        nodes = []
        for a, b, c in bernstein_indices(k):
            if c == k:
                nodes.append(centre)
            elif a == k:
                nodes.append(first)
            elif b == k:
                nodes.append(second)
            elif c == 0:
                nodes.append(3 + sub * (k - 1) + b - 1)
            elif b == 0:
                nodes.append(centre + 1 + first * (k - 1) + c - 1)
            elif a == 0:
                nodes.append(centre + 1 + second * (k - 1) + c - 1)
            else:
                nodes.append(inside)
                inside += 1
        subs.append(nodes)
    return subs


@cache
def product(p, i, q, j):
    """int_0^1 of the product of two Bernstein polynomials."""
    return Q(comb(p, i) * comb(q, j), comb(p + q, i + j) * (p + q + 1))
