"""Hooke's law in the plane, in exact rational numbers.

Stresses are counted as x = (xx + yy, xx - yy, xy), strains as e = ((xx + yy) / 2, (xx - yy) / 2, 2 xy), so that e . x is their work. The law is
e = A x + e0, with x . A x as a sum of squares w (r . x)^2: exact, and no digits are lost where a body is nearly incompressible. e0 is what
temperature and initial stress leave in the plane: along an axis of the body that nothing holds, and across the plane in plane strain.
"""

from fractions import Fraction as Q

from flint import arb, ctx, fmpq

from . import Refused, reference
from .ball import BITS, ONE

PLACES = [0, 1, 5, 2]  # 11, 22, 12, 33 among 11, 22, 33, 23, 13, 12


def apply(matrix, x):
    return [sum(a * b for a, b in zip(row, x)) for row in matrix]


def transpose(matrix):
    return [list(column) for column in zip(*matrix)]


def squares(matrix):
    """[w, *r] of every square, one after the other."""
    out = []
    for _ in matrix:
        i = max(range(len(matrix)), key=lambda k: matrix[k][k])
        w = matrix[i][i]
        if w <= 0:
            raise Refused("the constants of a body are those of no material")
        row = [x / w for x in matrix[i]]
        out += [w, *row]
        matrix = [[x - w * a * b for x, b in zip(line, row)] for line, a in zip(matrix, row)]
    return out


def double_angle(degrees):
    """Cosine and sine of twice an angle that differs by less than 10^-90 from this one: exactly those of an angle, as both are rational."""
    half, ctx.prec = Q(degrees) % 180, 2 * BITS
    steep = 45 < half < 135
    turns = (90 - half if steep else half) / 180
    t = Q(int((arb(fmpq(*turns.as_integer_ratio())).tan_pi() * ONE + 0.5).mid().floor().unique_fmpz()), ONE)
    c, s = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    return (-c if steep else c), s


def constants(body):
    """The compliance for 11, 22, 12, 33 in the axes of a body, or for the first three alone, and the angle from x to axis 1."""
    if "young" in body:
        e, nu = Q(body["young"]), Q(body["poisson"])
        rows, angle = [[1 / e, -nu / e, 0, -nu / e], [-nu / e, 1 / e, 0, -nu / e], [0, 0, 2 * (1 + nu) / e, 0], [-nu / e, -nu / e, 0, 1 / e]], 0
    elif "orthotropic" in body:
        own = body["orthotropic"]
        (e1, e2, e3), (n12, n13, n23), angle = map(Q, own["young"]), map(Q, own["poisson"]), own.get("angle", 0)
        a, b, c = -n12 / e1, -n13 / e1, -n23 / e2
        rows = [[1 / e1, a, 0, b], [a, 1 / e2, 0, c], [0, 0, 1 / Q(own["shear"]), 0], [b, c, 0, 1 / e3]]
    else:
        kind = "stiffness" if "stiffness" in body else "compliance"
        rows, angle = [[Q(x) for x in row] for row in body[kind]], body.get("angle", 0)
        if len(rows) == 6:
            if any(rows[i][j] or rows[j][i] for i in (3, 4) for j in PLACES):
                raise Refused("the constants of a body couple shears out of the plane with what is in it")
            rows = [[rows[i][j] for j in PLACES] for i in PLACES]
        if rows != transpose(rows):
            raise Refused("the matrix of constants of a body is not symmetric")
        rows = reference.inverse(rows) if kind == "stiffness" else rows
    return [[Q(x) for x in row] for row in rows], angle


def law(body, strain):
    """(squares of A, squares of its inverse, e0 of a unit of temperature, e0 of the initial stress) of the table of a body."""
    s, angle = constants(body)
    squares(s)  # refuses what stores no energy
    c, n = double_angle(angle)
    basis = [[Q(1, 2), c / 2, n], [Q(1, 2), -c / 2, -n], [Q(0), -n / 2, c]]  # 11, 22, 12 in the axes of the body from x
    turn = lambda rows: apply(transpose(basis), rows)
    held = [s[i][3] / s[3][3] if strain else Q(0) for i in range(3)]
    plane = [[s[i][j] - held[i] * s[3][j] if strain else s[i][j] for j in range(3)] for i in range(3)]
    matrix = transpose([turn(column) for column in transpose([turn(column) for column in plane])])
    first, second, third = (body["expansion"] if isinstance(body.get("expansion"), list) else [body.get("expansion", 0)] * 3)
    warm = turn([Q(x) - h * Q(third) for x, h in zip((first, second, 0), held)])
    xx, yy, xy, zz = (Q(x) for x in [*body.get("initial_stress", [0, 0, 0]), 0][:4])
    cold = [-x for x in apply(matrix, [xx + yy, xx - yy, xy])]
    if zz and not strain:
        cold = [x - zz * y for x, y in zip(cold, turn([s[i][3] for i in range(3)]))]
    return squares(matrix), squares(reference.inverse(matrix)), warm, cold
