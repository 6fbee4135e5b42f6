"""A displacement solver for `hypercircle verify --reference`, written with scikit-fem.

    hypercircle verify cases/two_blocks.toml --reference "python3 examples/scikit_fem_solver.py {problem} {out}"

It reads problem.json, minimises the potential energy over continuous P1 and P2 displacements, contact by an active set, and
writes primal-P1.json and primal-P2.json into the folder. docs/exchange.md describes the files.
"""

import json
import sys
from pathlib import Path

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementTriP2, ElementVector, LinearForm, MeshTri, __version__
from skfem.helpers import ddot, div, dot, sym_grad

SOFT = 1e-9
"""Compliance of a constraint relative to the bodies', taken away by the corrections: constraints may repeat each other."""


class Space:
    """Displacements of one degree; `dof[node]` are the two unknowns of a vertex or, after them, of the midpoint of an edge."""

    def __init__(self, problem, degree):
        self.problem, self.degree = problem, degree
        points, edges = np.array(problem["points"]), np.array(problem["edges"])
        mesh = MeshTri(points.T.copy(), np.array(problem["triangles"]).T.copy())
        element = ElementVector(ElementTriP1() if degree == 1 else ElementTriP2())
        self.basis = Basis(mesh, element, intorder=2)
        self.dof = self.basis.nodal_dofs.T
        if degree == 2:
            place = {pair: facet for facet, pair in enumerate(map(tuple, mesh.facets.T.tolist()))}
            facets = [place[tuple(sorted(edge))] for edge in edges.tolist()]
            self.dof = np.concatenate([self.dof, self.basis.facet_dofs.T[facets]])
        self.length = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)

    def along(self, edge, start):
        """The nodes of an edge from the vertex `start` to the other one."""
        a, b = self.problem["edges"][edge]
        inside = [len(self.problem["points"]) + edge] if self.degree == 2 else []
        return [start, *inside, a + b - start]

    def stiffness_and_load(self):
        """K and f of ½ uᵀK u − fᵀu, thickness included."""
        problem, bodies = self.problem, self.problem["bodies"]
        body = np.array(problem["body"])
        shear = np.array([b["young"] / (2 + 2 * b["poisson"]) for b in bodies])[body]
        poisson = np.array([b["poisson"] for b in bodies])[body]
        stress = problem["kinematics"] == "plane-stress"
        lame = 2 * shear * poisson / (1 - poisson if stress else 1 - 2 * poisson)
        force = np.array([b["body_force"] for b in bodies])[body].T[:, :, None]

        @BilinearForm
        def work(u, v, _):
            return lame[:, None] * div(u) * div(v) + 2 * shear[:, None] * ddot(sym_grad(u), sym_grad(v))

        @LinearForm
        def weight(v, _):
            return dot(force, v)

        load = weight.assemble(self.basis)
        for entry in problem["tractions"]:
            edge, (a, b) = entry["edge"], np.array(entry["values"])
            nodes = self.along(edge, problem["edges"][edge][0])
            shares = [2 * a + b, a + 2 * b] if self.degree == 1 else [a, 2 * (a + b), b]
            for node, share in zip(nodes, shares):
                load[self.dof[node]] += self.length[edge] / 6 * share
        return problem["thickness"] * work.assemble(self.basis), problem["thickness"] * load

    def supports(self):
        """For each held node its independent directions and the displacement along them."""
        problem, held = self.problem, {}
        for entry in problem["clamped"]:
            nodes = self.along(entry["edge"], problem["edges"][entry["edge"]][0])
            first, last = np.broadcast_to(entry["displacement"], (2, 2))
            for node, part in zip(nodes, np.linspace(0, 1, len(nodes))):
                for direction, value in zip(np.eye(2), (1 - part) * first + part * last):
                    held.setdefault(node, []).append((direction, value))
        for entry in problem["roller"]:
            for node in self.along(entry["edge"], problem["edges"][entry["edge"]][0]):
                held.setdefault(node, []).append((np.array(entry["normal"]), entry["displacement"]))
        for entry in problem["pins"]:
            held.setdefault(entry["vertex"], []).append((np.array(entry["direction"]), 0.0))
        for node, conditions in held.items():
            kept = []
            for direction, value in conditions:
                if not kept or (len(kept) == 1 and abs(np.linalg.det([kept[0][0], direction])) > 1e-9):
                    kept.append((direction, value))
            held[node] = kept
        return held

    def jumps(self, pair):
        """Bernstein coefficients of (u_first − u_second) · n̂ along a pair: for each a list of (node, factor), and the gap."""
        start = [pair["first"][0], pair["second"][0]] if pair["second"] else [pair["first"][0]]
        sides = [self.along(edge, first) for edge, first in zip(pair["edges"], start)]
        first, last = np.array(pair["direction"])
        turns, k, (g, h) = np.any(first != last), self.degree, pair["gap"]
        # Coefficient m of u_first − u_second from the values at its nodes.
        of_nodes = np.eye(2) if k == 1 else np.array([[1, 0, 0], [-0.5, 2, -0.5], [0, 0, 1]])
        parts = [[(m, first)] for m in range(k + 1)]
        if turns:
            k += 1
            inner = [[(r, (k - r) / k * first), (r - 1, r / k * last)] for r in range(1, k)]
            parts = [[(0, first)], *inner, [(self.degree, last)]]
        rows = []
        for r, part in enumerate(parts):
            terms = [
                (side[i], sign * of_nodes[m, i] * normal)
                for m, normal in part
                for side, sign in zip(sides, (1, -1))
                for i in np.flatnonzero(of_nodes[m])
            ]
            rows.append((terms, g + (h - g) * r / k))
        # The jump of P1 along a direction that turns is bounded at the vertices.
        return [rows[0], rows[-1]] if self.degree == 1 else rows


class Rows:
    """Linear functions of the unknowns, one a row."""

    def __init__(self, size):
        self.size, self.entries, self.values = size, [], []

    def add(self, dofs, factors, value):
        self.entries += [(len(self.values), dof, factor) for dof, factor in zip(dofs, factors)]
        self.values.append(value)
        return len(self.values) - 1

    def matrix(self):
        rows, columns, factors = np.array(self.entries).reshape(-1, 3).T
        shape = (len(self.values), self.size)
        return sparse.csr_matrix((factors, (rows.astype(int), columns.astype(int))), shape=shape), np.array(self.values)


class Contacts:
    """Every contact row, and where its reaction is reported."""

    def __init__(self, space, held):
        self.space, self.rows, self.reported = space, Rows(space.basis.N), []
        for contact in space.problem["contacts"]:
            vertices, known = {}, {}
            edges = []
            for pair in contact["pairs"]:
                first, *inner, last = space.jumps(pair)
                for row, end in ((first, 0), (last, 1)):
                    v = pair["first"][end]
                    key = (v, pair["second"] and pair["second"][end], *pair["direction"][end])
                    if key not in known:
                        known[key] = self.add(row, held)
                        vertices.setdefault(v, []).append(known[key])
                edges.append([self.add(row, held) for row in inner])
            self.reported.append((contact["name"], vertices, edges))

    def add(self, row, held):
        """The number of a row; −1 for one that supports decide alone."""
        terms, gap = row
        free = 0.0
        for node, factor in terms:
            directions = [direction for direction, _ in held.get(node, [])]
            left = factor if not directions else np.zeros(2) if len(directions) == 2 else factor - (factor @ directions[0]) * directions[0]
            free = max(free, np.linalg.norm(left))
        if free < 1e-9:
            return -1
        return self.rows.add(np.concatenate([self.space.dof[n] for n, _ in terms]), np.concatenate([f for _, f in terms]), gap)

    def report(self, matrix, reactions):
        """The entries of `contacts` in the result file."""
        out = []
        force = lambda row: reactions[row] if row >= 0 else 0.0
        for (name, vertices, edges), contact in zip(self.reported, self.space.problem["contacts"]):
            own = {dof: c for pair in contact["pairs"] for n in self.space.along(pair["edges"][0], pair["first"][0]) for c, dof in enumerate(self.space.dof[n])}
            resultant = np.zeros(2)
            for row in {row for rows in [*vertices.values(), *edges] for row in rows if row >= 0}:
                for dof, factor in zip(matrix[row].indices, matrix[row].data):
                    if dof in own:
                        resultant[own[dof]] -= reactions[row] * factor
            out.append(
                {
                    "name": name,
                    "vertices": list(vertices),
                    "vertex_reaction": [sum(map(force, rows)) for rows in vertices.values()],
                    "edge_reaction": [list(map(force, rows)) for rows in edges] if self.space.degree == 2 else None,
                    "resultant": resultant.tolist(),
                }
            )
        return out


def minimise(K, f, C, d, B, g):
    """The u with least ½ uᵀK u − fᵀu, C u = d and B u ≤ g; its multipliers R ≥ 0 of the latter, and the number of steps."""
    closed = np.ones(len(g), dtype=bool)
    scale = abs(K).max()
    for step in range(1, 200):
        A, b = sparse.vstack([C, B[closed]]).tocsr(), np.concatenate([d, g[closed]])
        soft = sparse.identity(len(b)) * (SOFT / scale)
        factors = splu(sparse.bmat([[K, A.T], [A, -soft]]).tocsc())
        u, R = np.zeros(len(f)), np.zeros(len(b))
        for _ in range(6):
            change = factors.solve(np.concatenate([f - K @ u - A.T @ R, b - A @ u]))
            u, R = u + change[: len(u)], R + change[len(u) :]
        reactions = np.zeros(len(g))
        reactions[closed] = R[len(d) :]
        # Closed is what pushes, or would penetrate.
        push, deep = np.abs(R).max(initial=0.0), np.abs(u).max()
        follow = np.where(closed, reactions > -1e-12 * push, B @ u - g > 1e-12 * deep)
        if np.array_equal(follow, closed):
            return u, np.maximum(reactions, 0.0), step
        closed = follow
    print("scikit-fem: the contact has not settled", file=sys.stderr)
    raise SystemExit(3)


def solve(problem, degree):
    """The contents of the result file."""
    space = Space(problem, degree)
    K, f = space.stiffness_and_load()
    held = space.supports()
    supports = Rows(space.basis.N)
    for node, conditions in held.items():
        for direction, value in conditions:
            supports.add(space.dof[node], direction, value)
    for dof in np.setdiff1d(np.arange(space.basis.N), space.basis.element_dofs):
        supports.add([dof], [1.0], 0.0)
    contacts = Contacts(space, held)
    C, d = supports.matrix()
    B, g = contacts.rows.matrix()
    u, reactions, steps = minimise(K, f, C, d, B, g)
    strain = 0.5 * u @ (K @ u)
    values = u[space.dof]
    vertices = len(problem["points"])
    return {
        "format": "hypercircle-primal", "version": 1, "solver": "scikit-fem", "solver_version": __version__,
        "degree": degree, "energy": strain - f @ u, "strain_energy": strain, "iterations": steps, "unknowns": len(u) - len(d),
        "vertex_displacement": values[:vertices].tolist(),
        "edge_displacement": values[vertices:].tolist() if degree == 2 else None,
        "contacts": contacts.report(B, reactions),
    }  # fmt: skip


def main():
    problem, out = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2])
    for degree in (1, 2):
        (out / f"primal-P{degree}.json").write_text(json.dumps(solve(problem, degree)))


if __name__ == "__main__":
    main()
