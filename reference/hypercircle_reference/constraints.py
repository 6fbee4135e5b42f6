"""The change of variables u = T w + u0 that makes the jump along the direction of contact an unknown.

Nodes are numbered in the order of the exchange file: the vertices, then for P2 the midpoint of edge e as node
(number of vertices) + e; degree of freedom 2·node + component. Clamped values, rollers and pins are eliminated. Every
remaining unknown is either free or a jump (v' − v'')·n̂ with plain bounds, as PETSc's variational-inequality solvers
need it.

On a P2 contact edge with one direction n̂ the jump is a quadratic with Bernstein coefficients b0 and b2 (its end values) and
b1 = 2 j_mid − ½ (b0 + b2). The jump unknowns are b0, b1, b2, so that bounding them by the Bernstein coefficients of
the linear gap bounds the jump everywhere on the edge, not only at its nodes.

Where n̂ turns from N0 to N1 along the edge, the jump of P2 is a cubic. With J0, J1, J2 the Bernstein coefficients of v' − v''
its coefficients are c0 = J0·N0, c1 = (J0·N1 + 2 J1·N0)/3, c2 = (J2·N0 + 2 J1·N1)/3, c3 = J2·N1. The two in the middle are
unknowns in place of the two components of J1. The jump of P1 is a quadratic there, bounded at the vertices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.csgraph import connected_components

from hypercircle_process import BadExchange

from .exchange import Contact, Problem
from .group import Conflict, eliminate

AXIS = np.arange(2)
"""Offsets of the two components of a node."""


@dataclass(frozen=True)
class JumpRow:
    """One inequality of the model: which unknown carries it, and what its multiplier R ≥ 0 acts on.

    The row is factor · w[column] ≤ …, binding from above for factor > 0 and from below otherwise. ``vertex`` is the
    vertex of the first side, or −1 for coefficient ``inner`` between the ends of pair ``pair``. A translation d of the
    first side changes the row by ``normal`` · d.
    """

    column: int
    factor: float
    contact: int
    normal: np.ndarray
    vertex: int
    pair: int
    inner: int = 0


@dataclass(frozen=True)
class Constraints:
    """u = T w + offset with lower ≤ w ≤ upper; ``rows`` lists the inequalities behind the finite bounds."""

    T: sparse.csr_matrix
    offset: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    rows: list[JumpRow]

    @property
    def bounded(self) -> np.ndarray:
        """Indices of the jump unknowns."""
        return np.flatnonzero(np.isfinite(self.lower) | np.isfinite(self.upper))


class _Builder:
    """Collects entries of T, the offset and the bounds; columns are handed out as they are asked for."""

    def __init__(self, nodes: int):
        self.entries: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        self.offset = np.zeros(2 * nodes)
        self.lower: list[np.ndarray] = []
        self.upper: list[np.ndarray] = []
        self.columns = 0
        self.rows: list[JumpRow] = []

    def new_columns(self, upper, lower=None) -> np.ndarray:
        upper = np.atleast_1d(np.asarray(upper, dtype=float))
        self.upper.append(upper)
        self.lower.append(np.full(len(upper), -np.inf) if lower is None else np.asarray(lower, dtype=float))
        first, self.columns = self.columns, self.columns + len(upper)
        return np.arange(first, self.columns)

    def add(self, rows, columns, values) -> None:
        rows, columns, values = np.broadcast_arrays(rows, columns, values)
        self.entries.append((rows.reshape(-1), columns.reshape(-1), values.reshape(-1)))

    def matrix(self, rows: int) -> sparse.csr_matrix:
        i, j, v = (np.concatenate(parts) for parts in zip(*self.entries))
        return sparse.csr_matrix((v, (i, j)), shape=(rows, self.columns))


def build(problem: Problem, degree: int, nodal_contact: bool = False) -> Constraints:
    """The constraints of the P1 or P2 model; ``nodal_contact`` bounds the jump at the P2 nodes only.

    Raises :class:`BadExchange` where supports and contacts contradict each other.
    """
    vertices = len(problem.points)
    nodes = vertices + (len(problem.edges) if degree == 2 else 0)
    builder = _Builder(nodes)
    done = np.ones(nodes, dtype=bool)
    done[problem.triangles.reshape(-1)] = False
    if degree == 2:
        done[vertices + problem.triangle_edges.reshape(-1)] = False
    _vertex_groups(problem, builder, done)
    if degree == 2:
        _supported_midpoints(problem, builder, done)
        _contact_midpoints(problem, builder, done, nodal_contact)
        if not nodal_contact:
            _turning_midpoints(problem, builder, done)
    free = np.flatnonzero(~done)
    dofs = (2 * free[:, None] + np.arange(2)).reshape(-1)
    builder.add(dofs, builder.new_columns(np.full(len(dofs), np.inf)), 1.0)

    T, offset = builder.matrix(2 * nodes), builder.offset
    if degree == 2 and not nodal_contact:
        # Midpoints of contact edges follow the vertex jumps: j_mid = ½ b1 + ¼ (b0 + b2).
        follow = _quarter_of_vertex_jumps(problem, nodes) + _turning_vertex_jumps(problem, nodes)
        T = (T + follow @ T).tocsr()
        offset = offset + follow @ offset
    return Constraints(T, offset, np.concatenate(builder.lower), np.concatenate(builder.upper), builder.rows)


def _vertex_groups(problem: Problem, builder: _Builder, done: np.ndarray) -> None:
    equalities = _vertex_equalities(problem)
    jumps = _vertex_jumps(problem)
    touched = np.unique(
        np.concatenate([[v for v, _, _ in equalities], [v for jump in jumps for v in jump[0] if v >= 0]]).astype(int)
    )
    if len(touched) == 0:
        return
    slot = {v: i for i, v in enumerate(touched)}
    links = [(slot[a], slot[b]) for (a, b), *_ in jumps if b >= 0]
    graph = sparse.coo_matrix((np.ones(len(links)), tuple(np.array(links).reshape(-1, 2).T)), shape=(len(touched),) * 2)
    count, label = connected_components(graph, directed=False)
    members: list[list[int]] = [[] for _ in range(count)]
    for v, group in zip(touched, label):
        members[group].append(v)
    fixed: list[list] = [[] for _ in range(count)]
    for equality in equalities:
        fixed[label[slot[equality[0]]]].append(equality)
    bounded: list[list] = [[] for _ in range(count)]
    for jump in jumps:
        bounded[label[slot[jump[0][0]]]].append(jump)
    stiffness = _vertex_stiffness(problem)
    for vertices, equal, jump in zip(members, fixed, bounded):
        _one_group(problem, builder, stiffness, vertices, equal, jump)
    done[touched] = True


def _one_group(problem: Problem, builder: _Builder, stiffness, vertices, equalities, jumps) -> None:
    place = {v: 2 * i for i, v in enumerate(vertices)}
    C, d = np.zeros((len(equalities), 2 * len(vertices))), np.zeros(len(equalities))
    for i, (v, direction, value) in enumerate(equalities):
        C[i, place[v] : place[v] + 2] = direction
        d[i] = value
    B, g = np.zeros((len(jumps), 2 * len(vertices))), np.zeros(len(jumps))
    for i, ((a, b), normal, gap, _) in enumerate(jumps):
        B[i, place[a] : place[a] + 2] += normal
        if b >= 0:
            B[i, place[b] : place[b] + 2] -= normal
        g[i] = gap
    try:
        result = eliminate(C, d, B, g, np.repeat(stiffness[vertices], 2))
    except Conflict as conflict:
        x, y = problem.points[vertices[0]]
        raise BadExchange(f"supports and contacts contradict each other at ({x:g}, {y:g}): {conflict}") from conflict
    dofs = np.array([2 * v + c for v in vertices for c in range(2)])
    builder.offset[dofs] = result.offset
    columns = builder.new_columns(
        [np.inf if bound is None else bound.value for bound in result.upper],
        [-np.inf if bound is None else bound.value for bound in result.lower],
    )
    builder.add(dofs[:, None], columns[None, :], result.jumps)
    builder.add(dofs[:, None], builder.new_columns(np.full(result.free.shape[1], np.inf))[None, :], result.free)
    for column, bounds in zip(columns, zip(result.upper, result.lower)):
        for bound in filter(None, bounds):
            (first, _), normal, _, contact = jumps[bound.row]
            builder.rows.append(JumpRow(int(column), bound.factor, contact, normal, first, -1))


def _vertex_stiffness(problem: Problem) -> np.ndarray:
    """Largest Young's modulus around each vertex."""
    young = np.array([body.young for body in problem.bodies])[problem.body]
    stiffness = np.zeros(len(problem.points))
    np.maximum.at(stiffness, problem.triangles, young[:, None])
    return stiffness


def _vertex_equalities(problem: Problem) -> list[tuple[int, np.ndarray, float]]:
    """(vertex, direction, value) of every u(vertex) · direction = value; equal ones once."""
    found: dict[tuple, tuple[int, np.ndarray, float]] = {}
    axes = np.eye(2)

    def add(vertex, direction, value):
        found.setdefault((int(vertex), *direction, value), (int(vertex), direction, float(value)))

    for edge, displacement in zip(problem.clamped_edges, problem.clamped_values):
        for vertex in problem.edges[edge]:
            add(vertex, axes[0], displacement[0])
            add(vertex, axes[1], displacement[1])
    for edge, normal in zip(problem.roller_edges, problem.roller_normals):
        for vertex in problem.edges[edge]:
            add(vertex, normal, 0.0)
    for vertex, direction in zip(problem.pin_vertices, problem.pin_directions):
        add(vertex, direction, 0.0)
    return list(found.values())


def _vertex_jumps(problem: Problem) -> list[tuple[tuple[int, int], np.ndarray, float, int]]:
    """((first, second), normal, gap, contact) of every jump at a vertex; equal ones once."""
    found: dict[tuple, tuple] = {}
    for index, contact in enumerate(problem.contacts):
        for pair in range(len(contact.first)):
            for end in range(2):
                ends = (int(contact.first[pair, end]), int(contact.second[pair, end]))
                normal, gap = contact.direction[pair, end], float(contact.gap[pair, end])
                found.setdefault((index, *ends, *normal, gap), (ends, normal, gap, index))
    return list(found.values())


def _supported_midpoints(problem: Problem, builder: _Builder, done: np.ndarray) -> None:
    vertices = len(problem.points)
    clamped = vertices + problem.clamped_edges
    builder.offset[2 * clamped] = problem.clamped_values[:, 0]
    builder.offset[2 * clamped + 1] = problem.clamped_values[:, 1]
    done[clamped] = True
    roller = vertices + problem.roller_edges
    dofs = 2 * roller[:, None] + np.arange(2)
    columns = builder.new_columns(np.full(len(roller), np.inf))
    builder.add(dofs, columns[:, None], _tangent(problem.roller_normals))
    done[roller] = True


def _contact_midpoints(problem: Problem, builder: _Builder, done: np.ndarray, nodal: bool) -> None:
    """The softer side follows the stiffer one: u' = t α + n (n · u'' + j_mid), or u'' = t α + n (n · u' − j_mid).

    Unknowns are α, the displacement of the stiffer side, and b1 (for nodal contact j_mid itself).
    """
    for index, whole in enumerate(problem.contacts):
        pairs = np.arange(len(whole.first)) if nodal else np.flatnonzero(~whole.turns)
        contact = whole.part(pairs)
        normal = contact.direction.mean(axis=1) if nodal else contact.direction[:, 0]
        if nodal:
            normal = normal / np.linalg.norm(normal, axis=1)[:, None]
        follower, leader, sign = _sides(problem, contact)
        moved = 2 * follower[:, None] + AXIS
        jump = builder.new_columns(contact.gap.mean(axis=1))
        builder.add(moved, jump[:, None], sign[:, None] * (normal if nodal else 0.5 * normal))
        builder.add(moved, builder.new_columns(np.full(len(normal), np.inf))[:, None], _tangent(normal))
        bodies = leader >= 0
        columns = builder.new_columns(np.full(2 * int(bodies.sum()), np.inf)).reshape(-1, 2)
        builder.add(2 * leader[bodies][:, None] + AXIS, columns, 1.0)
        projection = normal[bodies][:, :, None] * normal[bodies][:, None, :]
        builder.add(moved[bodies][:, :, None], columns[:, None, :], projection)
        done[follower] = True
        done[leader[bodies]] = True
        builder.rows.extend(
            JumpRow(int(column), 1.0, index, n, -1, int(pair)) for pair, n, column in zip(pairs, normal, jump)
        )


def _turning_midpoints(problem: Problem, builder: _Builder, done: np.ndarray) -> None:
    """Where n̂ turns, u' = u'' + J_mid with J_mid = ½ J1 + ¼ (J0 + J2): unknowns are c1, c2 and the displacement of the
    stiffer side."""
    for index, whole in enumerate(problem.contacts):
        pairs = np.flatnonzero(whole.turns)
        contact = whole.part(pairs)
        follower, leader, sign = _sides(problem, contact)
        moved = 2 * follower[:, None] + AXIS
        bounds = np.stack([(2 * contact.gap[:, k] + contact.gap[:, 1 - k]) / 3 for k in range(2)], axis=1)
        columns = builder.new_columns(bounds.reshape(-1)).reshape(-1, 2)
        # J1 = M⁻¹ (3 c1 − J0·N1, 3 c2 − J2·N0)/2.
        builder.add(moved[:, :, None], columns[:, None, :], 0.75 * sign[:, None, None] * _inverse(contact))
        bodies = leader >= 0
        along = builder.new_columns(np.full(2 * int(bodies.sum()), np.inf)).reshape(-1, 2)
        builder.add(2 * leader[bodies][:, None] + AXIS, along, 1.0)
        builder.add(moved[bodies], along, 1.0)
        done[follower] = True
        done[leader[bodies]] = True
        for pair, two, (first, last) in zip(pairs, columns, contact.direction):
            for inner, normal in enumerate(((2 * first + last) / 3, (first + 2 * last) / 3)):
                builder.rows.append(JumpRow(int(two[inner]), 1.0, index, normal, -1, int(pair), inner))


def _inverse(contact: Contact) -> np.ndarray:
    """M⁻¹ of the rows N0, N1 of every pair (m, 2, 2)."""
    return np.linalg.inv(contact.direction) if len(contact.first) else np.zeros((0, 2, 2))


def _turning_vertex_jumps(problem: Problem, nodes: int) -> sparse.csr_matrix:
    """Maps u to the part of ± J_mid at the midpoints that follow that comes from J0 and J2, where n̂ turns."""
    entries = [(np.zeros(0, int), np.zeros(0, int), np.zeros(0))]
    for whole in problem.contacts:
        contact = whole.part(np.flatnonzero(whole.turns))
        follower, _, direction = _sides(problem, contact)
        rows = 2 * follower[:, None, None] + AXIS[None, :, None]
        inverse = _inverse(contact)
        for end in range(2):
            other = contact.direction[:, 1 - end]
            part = 0.25 * (np.eye(2) - inverse[:, :, end, None] * other[:, None, :])
            for ends, sign in ((contact.first, 1.0), (contact.second, -1.0)):
                there = ends[:, end] >= 0
                columns = 2 * ends[there, end][:, None, None] + AXIS[None, None, :]
                weights = sign * direction[there][:, None, None] * part[there]
                i, j, v = np.broadcast_arrays(rows[there], columns, weights)
                entries.append((i.reshape(-1), j.reshape(-1), v.reshape(-1)))
    i, j, v = (np.concatenate(parts) for parts in zip(*entries))
    return sparse.csr_matrix((v, (i, j)), shape=(2 * nodes, 2 * nodes))


def _sides(problem: Problem, contact: Contact) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Midpoint nodes of the softer and the stiffer side (−1: rigid), and +1 where the softer one is the first side."""
    young = np.zeros(len(problem.edges))
    young[problem.triangle_edges] = np.array([body.young for body in problem.bodies])[problem.body][:, None]
    midpoints = np.where(contact.edges >= 0, len(problem.points) + contact.edges, -1)
    second_softer = (contact.edges[:, 1] >= 0) & (young[contact.edges[:, 1]] < young[contact.edges[:, 0]])
    follower = np.where(second_softer, midpoints[:, 1], midpoints[:, 0])
    leader = np.where(second_softer, midpoints[:, 0], midpoints[:, 1])
    return follower, leader, np.where(second_softer, -1.0, 1.0)


def _quarter_of_vertex_jumps(problem: Problem, nodes: int) -> sparse.csr_matrix:
    """Maps u to ± n ¼ (b0 + b2) at the midpoints that follow where n̂ is constant, and to zero elsewhere."""
    entries = [(np.zeros(0, int), np.zeros(0, int), np.zeros(0))]
    for whole in problem.contacts:
        contact = whole.part(np.flatnonzero(~whole.turns))
        follower, _, direction = _sides(problem, contact)
        rows = 2 * follower[:, None, None] + AXIS[None, :, None]
        normal = contact.direction[:, 0]
        weights = 0.25 * direction[:, None, None] * normal[:, :, None] * normal[:, None, :]
        for ends, sign in ((contact.first, 1.0), (contact.second, -1.0)):
            for end in range(2):
                there = ends[:, end] >= 0
                columns = 2 * ends[there, end][:, None, None] + AXIS[None, None, :]
                i, j, v = np.broadcast_arrays(rows[there], columns, sign * weights[there])
                entries.append((i.reshape(-1), j.reshape(-1), v.reshape(-1)))
    i, j, v = (np.concatenate(parts) for parts in zip(*entries))
    return sparse.csr_matrix((v, (i, j)), shape=(2 * nodes, 2 * nodes))


def _tangent(normals: np.ndarray) -> np.ndarray:
    return np.stack([-normals[:, 1], normals[:, 0]], axis=1)
