"""Writes displacement fields of a scene with friction: `friction.py problem.json FOLDER DEGREE [MU] NAME...`.

`right` is the solution of a displacement method with its law at the nodes, `integrated` one whose law is under the integral; every other
name is a mistake, or a method that only comes near to the law. With MU the limits at nodes are MU times the contact forces there.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from model import Model, null_space, particular  # noqa: E402

import numpy as np  # noqa: E402
import scipy.sparse as sp  # noqa: E402
import scipy.sparse.linalg as sla  # noqa: E402

PENALTY, EPSILON = 30.0, 2e-3


class Rubbing(Model):
    """The method with friction; places of contact are matched nodes."""

    def __init__(self, problem, degree):
        super().__init__(problem, degree)
        self.places, self.sides = {}, []
        for contact in problem["contacts"]:
            for pair in contact["pairs"]:
                self._pair(pair)
        keys = list(self.places)
        self.normal = self.matrix([self._row(key, 0) for key in keys])
        self.tangent = self.matrix([self._row(key, 1) for key in keys])
        self.limit = np.array([self.places[key][2] for key in keys])
        self.size = np.array([self.places[key][3] for key in keys])

    def _pair(self, pair):
        friction = pair.get("friction") or {"bound": [0.0, 0.0], "tangent": [[0.0, 0.0]] * 2}
        (a, b), (s, t) = pair["first"], friction["bound"]
        c, d = pair["second"] or (None, None)
        whole = np.linalg.norm(self.points[b] - self.points[a]) * self.problem["thickness"]
        keys, parts, bounds = [(a, c), (b, d)], [1 / 2, 1 / 2], self.shares(s, t)
        if self.degree == 2:
            keys.append(tuple(None if e is None else self.vertices + e for e in pair["edges"]))
            parts = [1 / 6, 1 / 6, 4 / 6]
        self.sides.append((keys, whole, (s, t)))
        # Where contact turns, its direction is linear between vertices, and has its mean at midpoints.
        normals, tangents = ([*ends, np.mean(ends, axis=0)] for ends in np.array([pair["direction"], friction["tangent"]]))
        for key, part, bound, normal, tangent in zip(keys, parts, bounds, normals, tangents):
            place = self.places.setdefault(key, [normal, tangent, 0.0, 0.0])
            place[2] += whole * bound
            place[3] += whole * part

    def shares(self, s, t):
        """What the nodes of a side of length one resist, with a bound that is s and t at its ends."""
        return [(2 * s + t) / 6, (s + 2 * t) / 6] if self.degree == 1 else [s / 6, t / 6, (s + t) / 3]

    def with_limits(self, bounds, shares):
        """Values where the sides have these bounds at their ends, shared by their nodes as ``shares`` says."""
        limit, places = np.zeros(len(self.places)), {key: i for i, key in enumerate(self.places)}
        for (keys, whole, _), ends in zip(self.sides, bounds):
            for key, share in zip(keys, shares(*ends)):
                limit[places[key]] += whole * share
        return self.rubbed(limit=limit)

    def _row(self, key, which):
        row = {}
        for node, sign in zip(key, (1.0, -1.0)):
            if node is not None:
                x, y = sign * self.places[key][which]
                row.update({2 * node: x, 2 * node + 1: y})
        return row

    def rubbed(self, law="exact", times=1.0, limit=None):
        """Values at the nodes: the closed places do not penetrate, the others are free, and what rubs has the law."""
        held = self.held()
        supports = self.matrix([row for row, _ in held])
        self.free, self.start = null_space(supports), particular(supports, np.array([value for _, value in held]))
        self.k, self.f = self.stiffness(), self.loads()
        scale = self.k.diagonal().max()
        limit = times * (self.limit if limit is None else limit)
        count = len(limit)
        closed, state = np.ones(count, bool), np.zeros(count, int)
        if law == "none":
            limit = 0.0 * limit
        if callable(law):
            return self._smooth(law, closed, scale)
        if law == "along":
            state = -np.sign(self.tangent @ self.rubbed("none").ravel()).astype(int)
        for step in range(300):
            # What goes round in circles settles with smaller steps.
            if step % 60 == 59:
                scale *= 0.1
            sticks = np.ones(count, bool) if law == "sticks" else state == 0
            rows = sp.vstack([self.normal[closed], self.tangent[sticks]])
            pull = np.where(sticks, 0.0, limit * state)
            u, force = self._solve(self.k, self.f - self.tangent.T @ pull, rows)
            pressure, along = np.zeros(count), pull.copy()
            pressure[closed], along[sticks] = np.split(force, [closed.sum()])
            now = pressure + scale * (self.normal @ u) > 0
            self.pressure = pressure
            z = along + scale * (self.tangent @ u)
            if law == "along":
                then = -np.sign(self.tangent @ u).astype(int)
            else:
                then = np.where(np.abs(z) <= limit, 0, np.sign(z)).astype(int)
            if (now == closed).all() and (law == "sticks" or (then == state).all()):
                return u.reshape(-1, 2)
            closed, state = now, then
        raise RuntimeError("the state of the contact does not settle")

    def _solve(self, k, f, rows):
        a, b = self.free.T @ k @ self.free, rows @ self.free
        right = np.concatenate([self.free.T @ (f - k @ self.start), -rows @ self.start])
        # Rows that supports have taken say nothing.
        nothing = np.asarray(abs(b).sum(axis=1)).ravel() < 1e-12
        system = sp.bmat([[a, b.T], [b, sp.diags(nothing.astype(float))]], format="csc")
        found = sla.splu(system).solve(right)
        return self.start + self.free @ found[: a.shape[0]], found[a.shape[0] :]

    def _smooth(self, law, closed, scale):
        """Newton's method on nodal forces c g(j), which ``law(j, limit, size)`` gives with their slopes; softer laws of the smooth ones first."""
        u = None
        for softer in [1.0] if law is penalty else 2.0 ** np.arange(14, -1, -1):
            for _ in range(100):
                jump = np.zeros(len(closed)) if u is None else self.tangent @ u
                force, slope = law(jump / softer, self.limit, self.size)
                stiff = self.k + self.tangent.T @ sp.diags(slope / softer) @ self.tangent
                load = self.f - self.tangent.T @ (force - slope / softer * jump)
                new, pressure = self._solve(stiff, load, self.normal[closed])
                if law is not penalty and u is not None and np.abs(new - u).max() > 0.5 * np.abs(u).max() + 1e-300:
                    new = 0.5 * (new + u)
                all_of_it = np.zeros(len(closed))
                all_of_it[closed] = pressure
                now = all_of_it + scale * (self.normal @ new) > 0
                done = u is not None and np.abs(new - u).max() < 1e-12 * np.abs(new).max() and (now == closed).all()
                u, closed, self.pressure = new, now, all_of_it
                if done:
                    break
        if not done:
            raise RuntimeError("Newton's method does not settle")
        return u.reshape(-1, 2)


def penalty(j, limit, size):
    k = PENALTY * size
    inside = np.abs(k * j) < limit
    return np.clip(k * j, -limit, limit), np.where(inside, k, 0.0)


def tanh(j, limit, _):
    return limit * np.tanh(j / EPSILON), limit / EPSILON / np.cosh(np.clip(j / EPSILON, -300, 300)) ** 2


def root(j, limit, _):
    size = np.sqrt(j**2 + EPSILON**2)
    return limit * j / size, limit * EPSILON**2 / size**3


def turned(model):
    """The bound as if it were counted from the other end."""
    return model.with_limits([(t, s) for _, _, (s, t) in model.sides[::-1]], model.shares)


def thirds(model):
    """What a side of degree 2 may resist in three equal shares, in place of 1/6, 1/6 and 4/6: a sum that is right of parts that are not."""
    return model.with_limits([ends for _, _, ends in model.sides], lambda s, t: 3 * [(s + t) / 6])


def at_one_place(model):
    """Half as much again as the bound allows at the middle of the contact, and nowhere else."""
    places = list(model.places)
    heights = model.points[[key[0] for key in places], 1]
    limit = model.limit.copy()
    limit[np.argmin(abs(heights - heights.mean()))] *= 1.5
    return model.rubbed(limit=limit)


def coulomb(model, mu, law="exact", times=1.0, solutions=200):
    """Limits ``times`` ``mu`` as large as contact forces, from solution to solution; with few of them they lag behind."""
    model.limit = np.zeros(len(model.places))
    for _ in range(solutions):
        u = model.rubbed(law)
        limit = times * mu * np.maximum(model.pressure, 0.0)
        if np.abs(limit - model.limit).max() <= 1e-13 * limit.max():
            return u
        model.limit = limit
    if solutions > 100:
        raise RuntimeError("the limits of friction do not settle")
    return u


COULOMB = {
    "right": {},
    "frictionless": {"law": "none"},
    "sticks": {"law": "sticks"},
    "along": {"law": "along"},
    "half": {"times": 0.5},
    "more": {"times": 1.3},
    "lags": {"solutions": 2},
    "penalty": {"law": penalty},
    "tanh": {"law": tanh},
}

WAYS = {
    "right": lambda model: model.rubbed(),
    "frictionless": lambda model: model.rubbed("none"),
    "sticks": lambda model: model.rubbed("sticks"),
    "along": lambda model: model.rubbed("along"),
    "bound_unit": lambda model: model.rubbed(times=1e-3),
    "bound_half": lambda model: model.rubbed(times=0.5),
    "bound_more": lambda model: model.rubbed(times=1.3),
    "bound_slightly": lambda model: model.rubbed(times=1.0001),
    "at_one_place": at_one_place,
    "turned": turned,
    "thirds": thirds,
    "penalty": lambda model: model.rubbed(penalty),
    "tanh": lambda model: model.rubbed(tanh),
    "root": lambda model: model.rubbed(root),
}


def main():
    problem, folder, degree = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    names, mu = sys.argv[4:], None
    if names and names[0] not in WAYS:
        mu = float(names.pop(0))
    for name in names:
        model = Rubbing(problem, degree)
        u = WAYS[name](model) if mu is None else coulomb(model, mu, **COULOMB[name])
        (folder / f"{name}.vtk").write_text(model.vtk(u))


main()
