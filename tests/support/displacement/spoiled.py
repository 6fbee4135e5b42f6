"""Writes fields that are no solutions beside some that are: `spoiled.py problem.json FOLDER SEED COUNT`.

Each is a discrete solution of degree 1, or what somebody makes of it, written with so many digits. `spoiled.json` says of every
file how far it is from the solution in the energy norm, in its supports and in the jumps of its contacts: what no certificate
has to do with.
"""

import copy
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from model import Model  # noqa: E402

import numpy as np  # noqa: E402

# Digits from which on a file of the solution has to be accepted.
ENOUGH = 7


def solution(problem, change=None, **ways):
    problem = copy.deepcopy(problem)
    if change:
        change(problem)
    return Model(problem, 1).solve(**ways)


def turned(angle):
    """The normals of all contacts are turned."""

    def change(problem):
        c, s = np.cos(angle), np.sin(angle)
        for contact in problem["contacts"]:
            for pair in contact["pairs"]:
                x, y = pair["normal"]
                pair["normal"] = [c * x - s * y, s * x + c * y]

    return change


def stiffer(factor):
    def change(problem):
        for body in problem["bodies"]:
            body["young"] *= factor

    return change


def no_contact(problem):
    problem["contacts"] = []


def spoiled(model, u, random):
    """Names and fields."""
    problem, largest = model.problem, np.abs(u).max()
    body = np.zeros(model.count, int)
    for nodes, b in zip(model.cells, problem["body"]):
        body[nodes] = b
    fields = {f"times {f}": f * u for f in (-1.0, 0.0, 0.5, 1.05, 2.0)}
    for size in (1e-1, 1e-2, 1e-3):
        fields[f"noise {size}"] = u + size * largest * random.normal(size=u.shape)
    fields["another scene"] = largest * np.column_stack([np.sin(3 * model.points[:, 1]), model.points[:, 0] ** 2])
    for _ in range(4):
        which, size = random.integers(len(problem["bodies"])), largest * 10 ** random.uniform(-1, 6)
        own = body == which
        way = random.normal(size=2)
        shifted, rotated, alone = u.copy(), u.copy(), 0.0 * u
        shifted[own] += size * way / np.linalg.norm(way)
        from_middle = model.points[own] - model.points[own].mean(axis=0)
        rotated[own] += size * np.column_stack([-from_middle[:, 1], from_middle[:, 0]])
        alone[own] = size * way / np.linalg.norm(way)
        fields |= {f"shifted {size:.2g}": shifted, f"rotated {size:.2g}": rotated, f"shifted alone {size:.2g}": alone}
    changes = {"E 5 % off": stiffer(1.05), "E 5 % low": stiffer(0.95), "E 1e4": stiffer(1e4)}
    if problem["contacts"]:
        changes |= {"normal reversed": turned(np.pi), "normal 6 degrees off": turned(0.1), "no contact": no_contact}
    for name, change in changes.items():
        try:
            fields[name] = solution(problem, change)
        except (RuntimeError, np.linalg.LinAlgError):
            # Contact does not settle: this mistake gives no field.
            continue
    return {name: field for name, field in fields.items() if np.isfinite(field).all()}


def rounded(values, digits):
    return np.array([[float(f"{x:.{digits - 1}e}") for x in row] for row in values])


def main():
    source, folder, seed, count = sys.argv[1:]
    problem = json.loads(pathlib.Path(source).read_text(encoding="utf-8"))
    random = np.random.default_rng(int(seed))
    model = Model(copy.deepcopy(problem), 1)
    u = model.solve()
    stiffness, largest = model.stiffness(), np.abs(u).max()

    def energy(v):
        return max(float(v.ravel() @ (stiffness @ v.ravel())), 0.0) ** 0.5

    rows, held = model.contacts(), model.held()
    jumps, supports = model.matrix([r[0] for r in rows]), model.matrix([r[0] for r in held])
    gaps, prescribed = np.array([r[1] for r in rows]), np.array([r[1] for r in held])

    def off(matrix, v):
        return float(np.abs(matrix @ (v - u).ravel()).max(initial=0.0)) / largest if matrix.shape[0] else 0.0

    assert np.all(jumps @ u.ravel() <= gaps + 1e-9 * largest), "the solution of the test itself penetrates"
    assert off(supports, u) == 0.0 and np.allclose(supports @ u.ravel(), prescribed)
    others = [(name, field, int(random.integers(2, 17))) for name, field in spoiled(model, u, random).items()]
    chosen = [others[i] for i in random.permutation(len(others))[: int(count)]]
    right = [("right", u, digits) for digits in (16, int(random.integers(2, ENOUGH)), ENOUGH)]
    told = {}
    for number, (name, field, digits) in enumerate(right + chosen):
        field = rounded(field, digits)
        pathlib.Path(folder, f"{number}.vtk").write_text(model.vtk(field), encoding="utf-8")
        told[str(number)] = {
            "name": f"{name}, {digits} digits",
            "required": name == "right" and digits >= ENOUGH,
            "energy": energy(field - u) / energy(u),
            "supports": off(supports, field),
            "jumps": off(jumps, field),
        }
    pathlib.Path(folder, "spoiled.json").write_text(json.dumps(told), encoding="utf-8")


main()
