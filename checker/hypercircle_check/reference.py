"""Polynomials on the reference triangle (0, 0), (1, 0), (0, 1), split at its centroid.

Subtriangle i has the corners i + 1, i + 2 and the centroid; a polynomial on it is the list of its Bernstein coefficients, for the powers
(a, b, c) of the three barycentric coordinates in the order of `powers`. With B (columns: the edges from the first corner) and J = det B,
stresses are s = B s^ B^T / J: div s^, equal tractions across a segment and symmetry are then those of s, and tractions times
lengths are tau = B tau^. One matrix for each degree therefore serves every triangle.
"""

from functools import cache
from math import comb, isqrt, prod

import numpy as np
from flint import arb_mat, fmpq, fmpq_mat

CORNERS = [(0, 0), (1, 0), (0, 1)]
CENTRE = (fmpq(1, 3), fmpq(1, 3))


def powers(p):
    return [(p - rest, rest - c, c) for rest in range(p + 1) for c in range(rest + 1)]


def raise_power(power, m):
    return tuple(x + (i == m) for i, x in enumerate(power))


@cache
def mass(p, q):
    """The integrals over a triangle whose area is one half of products of Bernstein polynomials of degrees p and q."""
    entry = lambda a, b: fmpq(prod(comb(x + y, x) for x, y in zip(a, b)), comb(p + q, p) * (p + q + 1) * (p + q + 2))
    return arb_mat([[entry(a, b) for b in powers(q)] for a in powers(p)])


def integral(x, y):
    """The matrix of the integrals of x_i y_j over a triangle whose area is one half, for polynomials by rows."""
    degrees = ((isqrt(8 * matrix.ncols() + 1) - 3) // 2 for matrix in (x, y))  # of (p + 1) (p + 2) / 2 columns
    return x * mass(*degrees) * y.transpose()


@cache
def slopes(sub):
    """The gradients of the three barycentric coordinates of a subtriangle."""
    points = [CORNERS[(sub + 1) % 3], CORNERS[(sub + 2) % 3], CENTRE]
    turned = lambda m: (points[m - 2], points[m - 1])  # the other two, in order
    return [(3 * (a[1] - b[1]), 3 * (b[0] - a[0])) for a, b in map(turned, range(3))]


def on_split(corners):
    """Bernstein coefficients of degree 1 on each subtriangle of what is affine on the triangle: lists by component of values at corners."""
    centres = [sum(row) * fmpq(1, 3) for row in corners]
    return [arb_mat([[row[(sub + 1) % 3], row[(sub + 2) % 3], centre] for row, centre in zip(corners, centres)]) for sub in range(3)]


def _equations(p):
    """Rows, as pairs of {unknown: factor} and {datum: factor}, of: equal tractions inside, tractions tau^ on the three sides, div s^ + f^ = 0.
    Unknowns are (subtriangle, xx or yy or xy, powers); data are (side, coefficient, component) and ("force", corner, component)."""
    traction = lambda sub, c, n, power, sign=1: {(sub, c, power): sign * n[c], (sub, 2, power): sign * n[1 - c]}
    for sub, c in ((sub, c) for sub in range(3) for c in range(2)):
        first, second = (sub + 1) % 3, (sub + 2) % 3
        (x, y), (u, v), (w, z) = CORNERS[first], CORNERS[second], CORNERS[sub]
        inner = (CENTRE[1] - z, w - CENTRE[0])  # normal of the segment from corner `sub` to the centroid, between `first` and `second`
        for j in range(p + 1):
            yield traction(sub, c, (v - y, x - u), (p - j, j, 0)), {(sub, j, c): 1}
            yield traction(first, c, inner, (0, p - j, j)) | traction(second, c, inner, (p - j, 0, j), -1), {}
        for power in powers(p - 1):
            div = {(sub, comp, raise_power(power, m)): p * s[d] for m, s in enumerate(slopes(sub)) for comp, d in ((c, c), (2, 1 - c))}
            share = [fmpq(a, p - 1) if p > 1 else CENTRE[0] for a in power]
            corners = {first: share[0], second: share[1], sub: 0}
            yield div, {("force", corner, c): -(w + share[2] / 3) for corner, w in corners.items()}


@cache
def stresses(p):
    """(R, Z, and what the choice of c needs): the coefficients of s^ are R (tau^, f^) + Z c for whatever c, if the data are in equilibrium.
    Rows by subtriangle, component and powers; data by side, coefficient and component, then forces by corner and component."""
    unknowns = [(sub, c, power) for sub in range(3) for c in range(3) for power in powers(p)]
    data = [(i, j, c) for i in range(3) for j in range(p + 1) for c in range(2)] + [("force", i, c) for i in range(3) for c in range(2)]
    n, m = len(unknowns), len(data)
    place = {key: i for i, key in enumerate([*unknowns, *data])}
    rows = []
    for left, right in _equations(p):
        rows.append([fmpq(0)] * (n + m))
        for key, factor in (left | right).items():
            rows[-1][place[key]] += factor
    reduced, rank = fmpq_mat(rows).rref()
    pivots = [next(j for j, x in enumerate(row) if x != 0) for row in reduced.table()[:rank]]
    # Rows without unknowns are what data in equilibrium fulfil: two forces and a moment; of forces of degree 1 only the constant ones count.
    assert sum(pivot >= n for pivot in pivots) == 3, "tractions in equilibrium have a field"
    free = sorted(set(range(n)) - set(pivots))
    special, basis = [[fmpq(0)] * m for _ in range(n)], [[fmpq(int(j == k)) for k in free] for j in range(n)]
    for pivot, row in zip(pivots, reduced.table()):
        if pivot < n:
            special[pivot], basis[pivot] = row[n:], [-row[k] for k in free]
    special, basis = arb_mat(special), arb_mat(n, len(free), [x for row in basis for x in row])
    shaped = lambda matrix: np.array(matrix.entries(), float).reshape(3, 3, n // 9, matrix.ncols())
    gram = np.array(mass(p, p).table(), float)
    weighted = lambda matrix: (np.linalg.cholesky(gram).T @ shaped(matrix)).reshape(n, -1)
    if free:  # Z orthonormal and R across to it, as nearly as floating point has it: then c is well determined in any degree
        for _ in range(2):
            basis *= arb_mat(np.linalg.inv(np.linalg.qr(weighted(basis))[1]).tolist())
        special -= basis * arb_mat((weighted(basis).T @ weighted(special)).tolist())
    forms = [np.einsum("siaf,ab,sjbg->ijfg", shaped(basis), gram, shaped(other), optimize=True) for other in (basis, special)]
    return special, basis, forms


def least(p, form, data):
    """The c that makes sum_ij form_ij int s^_i s^_j small, in floating point: nothing is claimed of it."""
    hessian, gradient = (np.tensordot(form, own, 2) for own in stresses(p)[2])
    try:
        return np.linalg.solve(hessian, -gradient @ data).tolist()
    except np.linalg.LinAlgError:
        return [0.0] * len(hessian)


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
        subs.append([known[power] if power in known else next(inside) for power in powers(k)])
    return subs


@cache
def gradients(k):
    """The matrix from the coefficients on the split triangle to those of the derivatives by xi and eta: rows by subtriangle, derivative, powers."""
    rows = []
    for sub, nodes in enumerate(split_nodes(k)):
        place = dict(zip(powers(k), nodes))
        for d in range(2):
            for power in powers(k - 1):
                row = [fmpq(0)] * (3 * (k * k + k) // 2 + 1)
                for m, slope in enumerate(slopes(sub)):
                    row[place[raise_power(power, m)]] += k * slope[d]
                rows.append(row)
    return arb_mat(rows)
