"""Springs and elastic layers: ½ ∫ k j² of the jump j of an edge along its normal and its tangent, times the thickness.

The jump is the displacement of the edge less that of the edge opposite, or that of the edge itself where there is none. Traces are
polynomials, and their products are integrated exactly.
"""

from __future__ import annotations

from math import comb

import numpy as np
import scipy.sparse as sp

from .exchange import Problem, Springs
from .lattice import Lattice, bernstein


def mass(degree: int) -> np.ndarray:
    """∫ φ_i φ_j ds (k + 1, k + 1) over an edge of length one, for the shape functions φ_i of its nodes."""
    k = degree
    gram = [[comb(k, i) * comb(k, j) / (comb(2 * k, i + j) * (2 * k + 1)) for j in range(k + 1)] for i in range(k + 1)]
    back = np.linalg.inv(bernstein(k))
    return back.T @ np.array(gram) @ back


def weighted_mass(degree: int) -> np.ndarray:
    """As :func:`mass`, (2, k + 1, k + 1), with the weights 1 − s and s, s from 0 to 1 along the edge."""
    k = degree
    of = lambda i, j, m: comb(k, i) * comb(k, j) / (comb(2 * k + 1, i + j + m) * (2 * k + 2))
    gram = np.array([[[of(i, j, m) for j in range(k + 1)] for i in range(k + 1)] for m in range(2)])
    back = np.linalg.inv(bernstein(k))
    return back.T @ gram @ back


def sides(problem: Problem, springs: Springs, degree: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The nodes (m, k + 1) of each edge and of the one opposite it, both along the first, and the lengths (m,)."""
    lattice = Lattice.of(problem, degree)
    edges, opposite = springs.edges, springs.opposite
    ends = problem.edges[edges]
    first = np.concatenate([ends[:, :1], lattice.inside_edges(edges), ends[:, 1:]], axis=1)
    # An edge and the one opposite it run against each other.
    across = problem.edges[opposite]
    second = np.concatenate([across[:, :1], lattice.inside_edges(opposite), across[:, 1:]], axis=1)[:, ::-1]
    return first, second, np.linalg.norm(problem.points[ends[:, 1]] - problem.points[ends[:, 0]], axis=1)


def stiffness(problem: Problem, degree: int) -> sp.csr_matrix:
    """The matrix (2n, 2n) of the springs for the two components of every node; of no entries where there are none."""
    count = len(problem.springs.edges)
    weights = np.broadcast_to(mass(degree), (count, degree + 1, degree + 1))
    if problem.revolution is not None:
        ends = problem.points[problem.edges[problem.springs.edges]]
        weights = np.einsum("me,eab->mab", ends[:, :, 0] - problem.revolution.axis, weighted_mass(degree))
    return assembled(problem, problem.springs, degree, weights)


def assembled(problem: Problem, springs: Springs, degree: int, weights: np.ndarray) -> sp.csr_matrix:
    """The matrix of springs with the integrals ``weights`` (m, k + 1, k + 1) of products of shape functions over edges of length one."""
    size = 2 * Lattice.of(problem, degree).ends[2]
    edges, opposite, axes = springs.edges, springs.opposite, springs.axes
    first, second, length = sides(problem, springs, degree)
    # (m, 2, 2): Σ k d dᵀ over both directions.
    law = np.einsum("mk,mki,mkj->mij", springs.stiffness, axes, axes)
    local = problem.thickness * length[:, None, None, None, None] * np.einsum("mab,mij->maibj", weights, law)
    rows, columns, values = [], [], []
    for own, sign in ((first, 1.0), (second, -1.0)):
        for other, with_sign in ((first, 1.0), (second, -1.0)):
            there = np.ones(len(edges), dtype=bool)
            if own is second or other is second:
                there = opposite >= 0
            dofs = [2 * nodes[there][:, :, None] + np.arange(2) for nodes in (own, other)]
            shape = local[there].shape
            rows.append(np.broadcast_to(dofs[0][:, :, :, None, None], shape).reshape(-1))
            columns.append(np.broadcast_to(dofs[1][:, None, None, :, :], shape).reshape(-1))
            values.append(sign * with_sign * local[there].reshape(-1))
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return sp.coo_matrix(entries, shape=(size, size)).tocsr()
