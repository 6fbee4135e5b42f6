"""Writes displacement fields of the scene of a problem.json: `fields.py problem.json FOLDER DEGREE NAME...`.

`right` is the solution of a displacement method; every other name is a mistake made on the way to it.
"""

import copy
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import weak  # noqa: E402
from model import Model  # noqa: E402

import numpy as np  # noqa: E402


def changed(problem, change):
    problem = copy.deepcopy(problem)
    change(problem)
    return problem


def modulus(problem):
    problem["bodies"][0]["young"] *= 1.05


def load(factor):
    def change(problem):
        for entry in problem["tractions"]:
            entry["values"] = [[factor * x for x in value] for value in entry["values"]]

    return change


def plane_stress(problem):
    problem["kinematics"] = "plane-stress"


def poisson_exchanged(problem):
    first, second = problem["bodies"]
    first["poisson"], second["poisson"] = second["poisson"], first["poisson"]


def poisson(problem):
    problem["bodies"][1]["poisson"] = 0.45


def wall_along_x(problem):
    for entry in problem["clamped"]:
        entry["components"] = (0,)
    problem["points_held"] = [(problem["edges"][problem["clamped"][0]["edge"]][0], 1)]


def roller_clamped(problem):
    for entry in problem["roller"]:
        problem["clamped"].append({"edge": entry["edge"], "displacement": [0.0, 0.0]})
    problem["roller"] = []


def weight_missing(problem):
    for body in problem["bodies"]:
        body["body_force"] = [0.0, 0.0]


CHANGES = {
    "modulus": modulus,
    "load_1": load(1.01),
    "load_10": load(1.1),
    "load_unit": load(1e3),
    "plane_stress": plane_stress,
    "poisson_exchanged": poisson_exchanged,
    "poisson": poisson,
    "wall_along_x": wall_along_x,
    "roller_clamped": roller_clamped,
    "weight_missing": weight_missing,
}
WAYS = {
    "right": {},
    "penalty_stiff": {"penalty": 1e4},
    "penalty_soft": {"penalty": 2e1},
    "tied": {"tied": True},
    "contact_row_missing": {"forget": (1,)},
    "lambda_sign": {"spoil": "lambda"},
    "triangle": {"spoil": "triangle"},
}

def changed_model(model, change):
    return Model(changed(model.problem, change), model.degree)


def lumped(model):
    """Half of each edge at its own value for the ends of a linear edge, a third for each node of a quadratic one."""
    f = np.zeros((model.count, 2))
    for entry in model.problem["tractions"]:
        nodes = model.along(entry["edge"])
        values = np.array(entry["values"])
        length = model.problem["thickness"] * np.linalg.norm(model.points[nodes[1]] - model.points[nodes[0]])
        shares = values / 2 if model.degree == 1 else np.array([values.mean(axis=0) / 3] * 3)
        for node, share in zip(nodes, shares):
            f[node] += length * share
    model.loads = f.ravel
    return model.solve()


def single_precision(model):
    """Assembled and solved in it."""
    k, f = model.stiffness(), model.loads()
    held = model.matrix([r[0] for r in model.held()])
    free = weak.null_space(held)
    a = (free.T @ k @ free).toarray().astype(np.float32)
    u = np.linalg.solve(a, (free.T @ f).astype(np.float32)).astype(np.float32)
    return np.asarray(free @ u.astype(float)).reshape(-1, 2)


WEAK = {
    "mortar_hats": lambda model: weak.mortar(model, "hats"),
    "mortar_edges": lambda model: weak.mortar(model, "edges"),
    "mortar_quadratic": lambda model: weak.mortar(model, "quadratic"),
    "nitsche": lambda model: weak.nitsche(model),
    "nitsche_unsymmetric": lambda model: weak.nitsche(model, theta=-1, gamma=0.1),
    "nitsche_incomplete": lambda model: weak.nitsche(model, theta=0, gamma=0.1),
    "nitsche_modulus": lambda model: weak.nitsche(changed_model(model, modulus)),
    "mortar_modulus": lambda model: weak.mortar(changed_model(model, modulus)),
    "penalty_on_a_parabola": lambda model: weak.penalty(model, 1e4, gap=lambda x: x[0] ** 2),
    "penalty_quadrature": lambda model: weak.penalty(model, 50.0),
    "augmented": lambda model: weak.augmented(model, "hats"),
}


def made(model, name):
    """The values at the nodes."""
    if name in WEAK:
        return WEAK[name](model)
    if name in WAYS:
        ways = dict(WAYS[name])
        if ways.get("spoil") == "triangle":
            place = 17
            ways["spoil"] = lambda t, k: 1.3 * k if t == place else k
        elif ways.get("spoil") == "lambda":
            del ways["spoil"]
            model.of_lambda = -1.0
        return model.solve(**ways)
    if name == "lumped":
        return lumped(model)
    if name == "single_precision":
        return single_precision(model)
    u = model.solve()
    largest = np.abs(u).max()
    if name == "value":
        # Inside the first body, away from everything that holds it.
        centre = model.points[: model.vertices][np.array(model.problem["triangles"][0])].mean(axis=0)
        at = int(np.argmin(np.linalg.norm(model.points - centre - 0.2, axis=1)))
        u[at, 0] += 0.01 * largest
    elif name == "sign":
        u[:, 1] = -u[:, 1]
    elif name == "axes":
        u = u[:, ::-1]
    elif name == "shifted":
        u = np.roll(u, 1, axis=0)
    elif name == "order":
        u = np.concatenate([u[:, 0], u[:, 1]]).reshape(-1, 2)
    elif name == "digits":
        u = np.array([[float(f"{x:.8e}") for x in row] for row in u])
    elif name == "coordinates":
        model.points = np.array([[float(f"{x:.5e}") for x in row] for row in model.points * (1 + 1e-6)])
    else:
        raise SystemExit(f"no field {name}")
    return u


def main():
    source, folder, degree, *names = sys.argv[1:]
    problem = json.loads(pathlib.Path(source).read_text(encoding="utf-8"))
    for name in names:
        change = CHANGES.get(name)
        model = Model(changed(problem, change) if change else copy.deepcopy(problem), int(degree))
        values = model.solve() if change else made(model, name)
        pathlib.Path(folder, f"{name}.vtk").write_text(model.vtk(values), encoding="utf-8")


main()
