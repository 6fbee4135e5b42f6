"""Contact in the mean and not at nodes: mortar methods, Nitsche's, a penalty and augmented Lagrangians with quadrature."""

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from model import lame, null_space, shape_gradients


def shapes(degree, s):
    """Shape functions of an edge at s in [0, 1]: its two ends, and its middle for degree 2."""
    return np.array([1 - s, s] if degree == 1 else [(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)])


class Points:
    """Quadrature points along all contacts: weights, the jump less the gap, the mean of both normal stresses, multipliers."""

    def __init__(self, model, count, multiplier="hats", gap=None):
        problem, size = model.problem, 2 * model.count
        nodes, weights = np.polynomial.legendre.leggauss(count)
        self.weight, self.gap, self.length = [], [], []
        jumps, stresses, multipliers, known = [], [], [], {}
        for contact in problem["contacts"]:
            for pair in contact["pairs"]:
                n = np.array(pair["normal"])
                ends = np.array([problem["points"][v] for v in pair["first"]])
                length = np.linalg.norm(ends[1] - ends[0])
                for s, w in zip(0.5 * (nodes + 1), 0.5 * weights):
                    x = (1 - s) * ends[0] + s * ends[1]
                    jump, stress = np.zeros(size), np.zeros(size)
                    phi = shapes(model.degree, s)
                    sides = [(pair["edges"][0], pair["first"], 1.0)]
                    if pair["second"] is not None:
                        sides.append((pair["edges"][1], pair["second"], -1.0))
                    for edge, corners, sign in sides:
                        along = list(corners) + ([model.vertices + edge] if model.degree == 2 else [])
                        for node, value in zip(along, phi):
                            jump[2 * node : 2 * node + 2] += sign * value * n
                        stress += normal_stress(model, edge, x, n) / len(sides)
                    if multiplier == "edges":
                        of = {("edge", pair["edges"][0]): 1.0}
                    elif multiplier == "hats":
                        of = dict(zip(pair["first"], [1 - s, s]))
                    else:
                        keys = list(pair["first"]) + [("middle", pair["edges"][0])]
                        of = dict(zip(keys, shapes(2, s)))
                    jumps.append(jump), stresses.append(stress)
                    multipliers.append({known.setdefault(key, len(known)): value for key, value in of.items()})
                    self.weight.append(w * length * problem["thickness"])
                    self.gap.append((1 - s) * pair["gap"][0] + s * pair["gap"][1] if gap is None else gap(x))
                    self.length.append(length)
        self.weight, self.gap, self.length = map(np.array, (self.weight, self.gap, self.length))
        self.jump, self.stress = sp.csr_matrix(np.array(jumps)), sp.csr_matrix(np.array(stresses))
        self.multiplier = sp.lil_matrix((len(jumps), len(known)))
        for q, row in enumerate(multipliers):
            for column, value in row.items():
                self.multiplier[q, column] = value
        self.multiplier = self.multiplier.tocsr()


def normal_stress(model, edge, x, n):
    """n·σ(φ)n of all shape functions at a point of an edge, from its one triangle."""
    problem = model.problem
    t = next(t for t, edges in enumerate(problem["triangle_edges"]) if edge in edges)
    corners = np.array([problem["points"][v] for v in problem["triangles"][t]])
    point = np.linalg.solve(np.vstack([corners.T, np.ones(3)]), [*x, 1.0])
    g, _ = shape_gradients(corners, model.degree, point)
    body = problem["bodies"][problem["body"][t]]
    lam, mu = lame(problem["kinematics"], body["young"], body["poisson"])
    row = np.zeros(2 * model.count)
    for node, d in zip(model.cells[t], g):
        row[2 * node : 2 * node + 2] += lam * d + 2 * mu * (d @ n) * n
    return row


def constrained(model):
    """Stiffness, loads, what supports leave free, and contact at the nodes to begin with: without any, a body may fly."""
    k, f = model.stiffness(), model.loads()
    held = model.held()
    h = model.matrix([r[0] for r in held])
    return k, f, null_space(h), model.solve().ravel()


def newton(residual, tangent, start, free):
    """Semismooth Newton steps on the free directions."""
    u = start.copy()
    for k in range(200):
        step = sla.spsolve((free.T @ tangent(u) @ free).tocsc(), -(free.T @ residual(u)))
        # Full steps may go to and fro between two contact sets.
        u = u + (1.0 if k % 10 < 5 else 0.3) * (free @ step)
        if np.abs(step).max() <= 1e-13 * np.abs(u).max():
            return u.reshape(-1, 2)
    raise RuntimeError("the contact set does not settle")


def nitsche(model, theta=1, gamma=0.01, count=3, gap=None):
    """(1/γ)[e − γσ_n]₊ against v_n − θγσ_n(v), less θγσ_nσ_n(v), with γ that many edge lengths."""
    k, f, free, start = constrained(model)
    p = Points(model, count, gap=gap)
    g = gamma * p.length

    def terms(u):
        pressed = (p.jump @ u - p.gap) / g - p.stress @ u
        return pressed, pressed > 0

    def residual(u):
        pressed, active = terms(u)
        test = p.jump - sp.diags(theta * g) @ p.stress
        return k @ u - f + test.T @ (p.weight * active * pressed) - theta * p.stress.T @ (p.weight * g * (p.stress @ u))

    def tangent(u):
        _, active = terms(u)
        test = p.jump - sp.diags(theta * g) @ p.stress
        trial = sp.diags(1 / g) @ p.jump - p.stress
        return k + test.T @ sp.diags(p.weight * active) @ trial - theta * p.stress.T @ sp.diags(p.weight * g) @ p.stress

    return newton(residual, tangent, start, free)


def penalty(model, stiffness, count=3, gap=None):
    """A penalty for each unit of area at quadrature points."""
    k, f, free, start = constrained(model)
    p = Points(model, count, gap=gap)
    active = lambda u: sp.diags(stiffness * p.weight * (p.jump @ u > p.gap))
    return newton(
        lambda u: k @ u - f + p.jump.T @ (active(u) @ (p.jump @ u - p.gap)),
        lambda u: k + p.jump.T @ active(u) @ p.jump,
        start,
        free,
    )


def mortar(model, multiplier="hats", count=3, gap=None):
    """∫ψ(j − g) ≤ 0 for every shape function ψ ≥ 0 of the multiplier, which is a sum of them with coefficients ≥ 0."""
    k, f, free, start = constrained(model)
    p = Points(model, count, multiplier, gap)
    b = p.multiplier.T @ sp.diags(p.weight) @ p.jump
    bound = p.multiplier.T @ (p.weight * p.gap)
    closed = np.ones(b.shape[0], bool)
    for _ in range(200):
        rows = b[closed] @ free
        system = sp.bmat([[free.T @ k @ free, rows.T], [rows, None]], format="csc")
        right = np.concatenate([free.T @ (f - k @ start), bound[closed] - b[closed] @ start])
        found = sla.spsolve(system, right)
        u = start + free @ found[: free.shape[1]]
        force = np.zeros(b.shape[0])
        force[closed] = found[free.shape[1] :]
        now = force + 10.0 * (b @ u - bound) > 0
        if (now == closed).all():
            return u.reshape(-1, 2)
        closed = now
    raise RuntimeError("the contact set does not settle")


def augmented(model, multiplier="hats", r=10.0, count=3, gap=None):
    """∫(λ − [λ + r(j − g)]₊)μ = 0 at quadrature points, with [λ + r(j − g)]₊ as the pressure."""
    k, f, free, start = constrained(model)
    p = Points(model, count, multiplier, gap)
    m, w, size = p.multiplier, p.weight, p.multiplier.shape[1]
    u, force = start.copy(), np.zeros(size)
    for _ in range(100):
        pressed = m @ force + r * (p.jump @ u - p.gap)
        active = w * (pressed > 0)
        first = free.T @ (k @ u - f + p.jump.T @ (active * pressed))
        second = m.T @ (active * pressed - w * (m @ force)) / r
        a, d = sp.diags(active), sp.diags(active - w)
        system = sp.bmat(
            [
                [free.T @ (k + r * p.jump.T @ a @ p.jump) @ free, free.T @ (p.jump.T @ a @ m)],
                [m.T @ a @ p.jump @ free, m.T @ d @ m / r],
            ],
            format="csc",
        )
        step = sla.spsolve(system, -np.concatenate([first, second]))
        u, force = u + free @ step[: free.shape[1]], force + step[free.shape[1] :]
        if np.abs(step[: free.shape[1]]).max() <= 1e-13 * np.abs(u).max():
            return u.reshape(-1, 2)
    raise RuntimeError("the contact set does not settle")
