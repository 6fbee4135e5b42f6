"""Hooke's law in the plane, e = A s + e0, for stresses (xx, yy, xy) and strains (xx, yy, 2 xy). e0 is what temperature and initial
stress leave in the plane: along an axis of the body that nothing holds, and across the plane in plane strain."""

from flint import arb, arb_mat, fmpq_mat

from . import Refused
from .exact import rational

PLACES = [0, 1, 5, 2]  # 11, 22, 12, 33 among 11, 22, 33, 23, 13, 12


def compliance(body):
    """The compliance for 11, 22, 12, 33 in the axes of a body, or for the first three alone, and the angle from x to axis 1 in degrees."""
    if "young" in body or "orthotropic" in body:
        own = body.get("orthotropic") or {"young": [body["young"]] * 3, "poisson": [body["poisson"]] * 3}
        (e1, e2, e3), (n12, n13, n23) = map(rational, own["young"]), map(rational, own["poisson"])
        shear = 1 / rational(own["shear"]) if "shear" in own else 2 * (1 + n12) / e1
        a, b, c = -n12 / e1, -n13 / e1, -n23 / e2
        return fmpq_mat([[1 / e1, a, 0, b], [a, 1 / e2, 0, c], [0, 0, shear, 0], [b, c, 0, 1 / e3]]), own.get("angle", 0)
    kind = "stiffness" if "stiffness" in body else "compliance"
    rows = [[rational(x) for x in row] for row in body[kind]]
    if len(rows) == 6:
        if any(rows[i][j] or rows[j][i] for i in (3, 4) for j in PLACES):
            raise Refused("the constants of a body couple shears out of the plane with what is in it")
        rows = [[rows[i][j] for j in PLACES] for i in PLACES]
    given = fmpq_mat(rows)
    if given != given.transpose():
        raise Refused("the matrix of constants of a body is not symmetric")
    return given.inv() if kind == "stiffness" else given, body.get("angle", 0)


def law(body, strain):
    """(A, its inverse, e0 of a unit of temperature, e0 of the initial stress) of the table of a body; `strain`: in plane strain."""
    given, angle = compliance(body)
    s = given.table()
    if any(fmpq_mat([row[:k] for row in s[:k]]).det() <= 0 for k in range(1, len(s) + 1)):
        raise Refused("the constants of a body are those of no material")
    turn = arb(rational(angle)) / 180
    c, n = turn.cos_pi(), turn.sin_pi()
    # Stresses in the axes of the body from those in x and y; the transpose brings strains back.
    axes = arb_mat([[c * c, n * n, 2 * c * n], [n * n, c * c, -2 * c * n], [-c * n, c * n, c * c - n * n]])
    back = lambda column: axes.transpose() * arb_mat([[x] for x in column])
    held = [s[i][3] / s[3][3] if strain else 0 for i in range(3)]
    plane = arb_mat([[s[i][j] - held[i] * s[3][j] if strain else s[i][j] for j in range(3)] for i in range(3)])
    matrix = axes.transpose() * plane * axes
    first, second, third = map(rational, body["expansion"] if isinstance(body.get("expansion"), list) else [body.get("expansion", 0)] * 3)
    warm = back([x - h * third for x, h in zip((first, second, 0), held)])
    *stress, zz = map(rational, [*body.get("initial_stress", [0, 0, 0]), 0][:4])
    cold = -(matrix * arb_mat([[x] for x in stress]))
    if zz and not strain:
        cold -= back([zz * s[i][3] for i in range(3)])
    return matrix, matrix.inv(), warm.entries(), cold.entries()
