"""P1 on coarse meshes against a dense model of its own: every set of closed nodes is tried.

Assembly from gradients of barycentric coordinates, loads by Gauss quadrature, contact by Lagrange multipliers; nothing
is shared with the package. The only set that satisfies all conditions belongs to the minimiser.
"""

from itertools import product

import numpy as np
import pytest
from scenes import two_blocks


def dense_model(data):
    points, size = np.array(data["points"]), 2 * len(data["points"])
    stiffness, load = np.zeros((size, size)), np.zeros(size)
    for corners, body in zip(data["triangles"], data["body"]):
        young, nu = data["bodies"][body]["young"], data["bodies"][body]["poisson"]
        factor = young / ((1 + nu) * (1 - 2 * nu))
        elastic = factor * np.array([[1 - nu, nu, 0], [nu, 1 - nu, 0], [0, 0, 0.5 - nu]])
        barycentric = np.column_stack([np.ones(3), points[corners]])
        dx, dy = np.linalg.inv(barycentric)[1:]
        strain = np.zeros((3, 6))
        strain[0, 0::2] = strain[2, 1::2] = dx
        strain[1, 1::2] = strain[2, 0::2] = dy
        dofs = [2 * v + c for v in corners for c in range(2)]
        stiffness[np.ix_(dofs, dofs)] += 0.5 * np.linalg.det(barycentric) * strain.T @ elastic @ strain
    nodes, weights = np.polynomial.legendre.leggauss(3)
    for traction in data["tractions"]:
        a, b = data["edges"][traction["edge"]]
        half = 0.5 * np.linalg.norm(points[b] - points[a])
        start, end = np.array(traction["values"])
        for s, w in zip(0.5 * (nodes + 1), weights):
            value = half * w * ((1 - s) * start + s * end)
            load[2 * a : 2 * a + 2] += (1 - s) * value
            load[2 * b : 2 * b + 2] += s * value
    return stiffness, load


def minimum(data):
    stiffness, load = dense_model(data)
    held = []
    for support in data["clamped"]:
        held += [2 * v + c for v in data["edges"][support["edge"]] for c in range(2)]
    for support in data["roller"]:
        held += [2 * v + 1 for v in data["edges"][support["edge"]]]
    pairs = sorted({ends for pair in data["contacts"][0]["pairs"] for ends in zip(pair["first"], pair["second"])})
    jump = np.zeros((len(pairs), len(load)))
    for row, (first, second) in enumerate(pairs):
        jump[row, 2 * first], jump[row, 2 * second] = 1.0, -1.0
    free = np.setdiff1d(np.arange(len(load)), held)
    stiffness, load, jump = stiffness[np.ix_(free, free)], load[free], jump[:, free]
    found = []
    for closed in product((False, True), repeat=len(pairs)):
        rows = jump[np.array(closed)]
        if not len(rows):
            continue  # the loaded block would fly off
        system = np.block([[stiffness, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
        solution = np.linalg.solve(system, np.concatenate([load, np.zeros(len(rows))]))
        u, reaction = solution[: len(load)], solution[len(load) :]
        if reaction.min() > -1e-12 and (jump @ u).max() < 1e-12:
            found.append(0.5 * u @ stiffness @ u - load @ u)
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize("n", (2, 3, 4))
def test_energy_is_the_enumerated_minimum(solve, n):
    data = two_blocks(n)
    assert solve(data, 1)["energy"] == pytest.approx(minimum(data), rel=1e-11)
