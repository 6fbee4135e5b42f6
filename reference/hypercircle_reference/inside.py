"""The unknowns inside edges on supports and contacts; :mod:`constraints` says what they are."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

from .builder import AXIS, Builder, JumpRow, SlipRow
from .exchange import Contact, Problem
from .friction import weights as friction_weights
from .lattice import Lattice, bernstein


def inside_supports(problem: Problem, lattice: Lattice, builder: Builder, done: np.ndarray) -> None:
    clamped = lattice.inside_edges(problem.clamped_edges)
    steps = (np.arange(1, lattice.degree) / lattice.degree)[:, None]
    first, last = problem.clamped_values[:, None, 0], problem.clamped_values[:, None, 1]
    builder.offset[2 * clamped[..., None] + AXIS] = first + steps * (last - first)
    done[clamped] = True
    roller = lattice.inside_edges(problem.roller_edges)
    columns = builder.new_columns(np.full(roller.size, np.inf)).reshape(roller.shape)
    builder.add(2 * roller[..., None] + AXIS, columns[..., None], _tangent(problem.roller_directions)[:, None])
    along = problem.roller_values[:, None] * problem.roller_directions
    builder.offset[2 * roller[..., None] + AXIS] = along[:, None]
    done[roller] = True


def inside_contacts(problem: Problem, lattice: Lattice, builder: Builder, done: np.ndarray, nodal: bool) -> None:
    """The softer side follows the stiffer one: u' = t α + n (n · u'' + j), or u'' = t α + n (n · u' − j).

    Unknowns are α and the displacement of the stiffer side at each node, and the b_1, …, b_(k−1) that make j there (for
    nodal contact j itself).
    """
    k = lattice.degree
    steps = np.arange(1, k)
    for index, whole in enumerate(problem.contacts):
        pairs = np.arange(len(whole.first)) if nodal else np.flatnonzero(~whole.turns & ~whole.rubs)
        contact = whole.part(pairs)
        first, last = contact.direction[:, None, 0], contact.direction[:, None, 1]
        normal = first + (last - first) * (steps / k)[:, None]
        if nodal:
            normal = normal / np.linalg.norm(normal, axis=2)[..., None]
        shape = np.eye(k - 1) if nodal else bernstein(k)[1:-1, 1:-1]
        follower, leader, sign = _sides(problem, lattice, contact)
        moved = 2 * follower[..., None] + AXIS
        bounds = contact.gap_at(steps / k) if nodal else contact.gap_coefficients(k)[:, 1:-1]
        jump = builder.new_columns(bounds.reshape(-1)).reshape(bounds.shape)
        amount = sign[:, None, None, None] * shape[None, :, :, None] * normal[:, :, None]
        builder.add(moved[:, :, None], jump[:, None, :, None], amount)
        along = builder.new_columns(np.full(follower.size, np.inf)).reshape(follower.shape)
        builder.add(moved, along[..., None], _tangent(normal))
        bodies = leader[:, 0] >= 0
        columns = builder.new_columns(np.full(2 * leader[bodies].size, np.inf)).reshape(-1, k - 1, 2)
        builder.add(2 * leader[bodies][..., None] + AXIS, columns, 1.0)
        projection = normal[bodies][..., :, None] * normal[bodies][..., None, :]
        builder.add(moved[bodies][..., :, None], columns[..., None, :], projection)
        done[follower] = True
        done[leader[bodies]] = True
        for pair, own, normals in zip(pairs, jump, normal):
            rows = enumerate(zip(own, normals))
            builder.rows.extend(JumpRow(int(c), 1.0, index, n, -1, int(pair), inner) for inner, (c, n) in rows)


def inside_friction(problem: Problem, lattice: Lattice, builder: Builder, done: np.ndarray) -> None:
    """Where there is friction, u' = u'' + n j + t j_t: unknowns are the coefficients of j and of j_t between the ends, and the
    displacement of the stiffer side."""
    k = lattice.degree
    shape = bernstein(k)[1:-1, 1:-1]
    for index, whole in enumerate(problem.contacts):
        pairs = np.flatnonzero(whole.rubs & ~whole.turns)
        contact = whole.part(pairs)
        follower, leader, sign = _sides(problem, lattice, contact)
        moved = 2 * follower[..., None] + AXIS
        bounds = contact.gap_coefficients(k)[:, 1:-1]
        share = friction_weights(problem, contact, k)[:, 1:-1]
        jump = builder.new_columns(bounds.reshape(-1)).reshape(bounds.shape)
        slip = builder.new_columns(np.full(bounds.size, np.inf)).reshape(bounds.shape)
        for columns, direction in ((jump, contact.direction[:, 0]), (slip, contact.tangent[:, 0])):
            amount = sign[:, None, None, None] * shape[None, :, :, None] * direction[:, None, None]
            builder.add(moved[:, :, None], columns[:, None, :, None], amount)
        bodies = leader[:, 0] >= 0
        columns = builder.new_columns(np.full(2 * leader[bodies].size, np.inf)).reshape(-1, k - 1, 2)
        builder.add(2 * leader[bodies][..., None] + AXIS, columns, 1.0)
        builder.add(moved[bodies], columns, 1.0)
        done[follower] = True
        done[leader[bodies]] = True
        for i, pair in enumerate(pairs):
            normal, tangent = contact.direction[i, 0], contact.tangent[i, 0]
            for inner in range(k - 1):
                builder.rows.append(JumpRow(int(jump[i, inner]), 1.0, index, normal, -1, int(pair), inner))
                where = (index, tangent, tangent, -1, int(pair), inner)
                builder.rub(0.0, SlipRow(int(slip[i, inner]), float(share[i, inner]), *where))


def inside_turning(problem: Problem, lattice: Lattice, builder: Builder, done: np.ndarray) -> None:
    """Where n̂ turns, u' = u'' + J: unknowns are c_1, …, c_k, the parts of J_1, …, J_(k−1) without any of them, and the
    displacement of the stiffer side."""
    k = lattice.degree
    for index, whole in enumerate(problem.contacts):
        pairs = np.flatnonzero(whole.turns)
        contact = whole.part(pairs)
        follower, leader, sign = _sides(problem, lattice, contact)
        moved = _dofs(follower)
        bounds = contact.gap_coefficients(k + 1)[:, 1:-1]
        columns = builder.new_columns(bounds.reshape(-1)).reshape(bounds.shape)
        turning = _Turning(contact, k)
        builder.add(moved[:, :, None], columns[:, None, :], sign[:, None, None] * turning.of_rows)
        rest = builder.new_columns(np.full((k - 2) * len(pairs), np.inf)).reshape(len(pairs), k - 2)
        builder.add(moved[:, :, None], rest[:, None, :], turning.of_rest)
        bodies = leader[:, 0] >= 0
        along = builder.new_columns(np.full(2 * leader[bodies].size, np.inf)).reshape(-1, 2 * (k - 1))
        builder.add(_dofs(leader[bodies]), along, 1.0)
        builder.add(moved[bodies], along, 1.0)
        done[follower] = True
        done[leader[bodies]] = True
        for pair, own, (first, last) in zip(pairs, columns, contact.direction):
            for inner, column in enumerate(own):
                normal = ((k - inner) * first + (inner + 1) * last) / (k + 1)
                builder.rows.append(JumpRow(int(column), 1.0, index, normal, -1, int(pair), inner))


def turning_friction(problem: Problem, lattice: Lattice, builder: Builder) -> None:
    """The work of friction on what is between the ends of pairs where t̂ turns, with the coefficients
    d_r = ((k + 1 − r) J_r·T0 + r J_(r−1)·T1)/(k + 1)."""
    k = lattice.degree
    # J_r from the values at the nodes.
    back = np.linalg.inv(bernstein(k))
    for index, whole in enumerate(problem.contacts):
        pairs = np.flatnonzero(whole.turns & whole.rubs)
        contact = whole.part(pairs)
        share = friction_weights(problem, contact, k + 1)
        sides = []
        for side, ends in enumerate((contact.first, contact.second)):
            inside = lattice.along(problem, contact.edges[:, side], ends[:, 0])
            sides.append(np.column_stack([ends[:, :1], inside, ends[:, 1:]]))
        for i, pair in enumerate(pairs):
            first, last = contact.tangent[i]
            for r in range(1, k + 1):
                along = ((k + 1 - r) * np.outer(back[r], first) + r * np.outer(back[r - 1], last)) / (k + 1)
                terms = [
                    (int(node), sign * factor)
                    for nodes, sign in zip(sides, (1.0, -1.0))
                    for node, factor in zip(nodes[i], along)
                    if node >= 0
                ]
                tangent = ((k + 1 - r) * first + r * last) / (k + 1)
                builder.rub_coupled(terms, SlipRow(-1, float(share[i, r]), index, tangent, tangent, -1, int(pair), r - 1))


class _Turning:
    """J at the nodes inside pairs along which n̂ turns, (m, 2(k − 1)) node by node.

    It is ``of_rows`` (m, 2(k − 1), k) times c_1, …, c_k, plus ``of_rest`` (m, 2(k − 1), k − 2) times what leaves all of these as
    they are, plus ``of_ends[0]`` and ``of_ends[1]`` (m, 2(k − 1), 2) times J_0 and J_k.
    """

    def __init__(self, contact: Contact, degree: int):
        k, m = degree, len(contact.first)
        first, last = contact.direction[:, 0], contact.direction[:, 1]
        rows, ends = np.zeros((m, k, k + 1, 2)), [np.zeros((m, k, 2)) for _ in range(2)]
        for r in range(1, k + 1):
            rows[:, r - 1, r] += (k + 1 - r) / (k + 1) * first
            rows[:, r - 1, r - 1] += r / (k + 1) * last
        ends[0], ends[1] = rows[:, :, 0], rows[:, :, k]
        inner = rows[:, :, 1:k].reshape(m, k, 2 * (k - 1))
        inverse = np.linalg.pinv(inner) if k > 2 else np.linalg.inv(inner)
        null = np.linalg.svd(inner)[2][:, k:].swapaxes(1, 2)
        values = bernstein(k)
        inside = np.kron(values[1:-1, 1:-1], np.eye(2))
        self.of_rows = inside @ inverse
        self.of_rest = inside @ null
        self.of_ends = [
            np.kron(values[1:-1, [end * k]], np.eye(2)) - self.of_rows @ ends[end] for end in range(2)
        ]  # fmt: skip


def _dofs(nodes: np.ndarray) -> np.ndarray:
    """Degrees of freedom (m, 2n) of the nodes (m, n), node by node."""
    return (2 * nodes[..., None] + AXIS).reshape(len(nodes), 2 * nodes.shape[1])


def turning_vertex_jumps(problem: Problem, lattice: Lattice) -> sparse.csr_matrix:
    """Maps u to the part of ± J inside the edges that follow that comes from J_0 and J_k, where n̂ turns."""
    parts = _Follow(lattice)
    for whole in problem.contacts:
        contact = whole.part(np.flatnonzero(whole.turns))
        follower, _, sign = _sides(problem, lattice, contact)
        turning = _Turning(contact, lattice.degree)
        parts.add(contact, follower, [sign[:, None, None] * part for part in turning.of_ends])
    return parts.matrix()


def vertex_jumps_inside(problem: Problem, lattice: Lattice) -> sparse.csr_matrix:
    """Maps u to the part of ± n j, with friction of ± J, inside the edges that follow that comes from the jump at their ends, where n̂ is
    constant."""
    parts = _Follow(lattice)
    k = lattice.degree
    for whole in problem.contacts:
        contact = whole.part(np.flatnonzero(~whole.turns))
        follower, _, sign = _sides(problem, lattice, contact)
        normal = contact.direction[:, 0]
        projection = normal[:, :, None] * normal[:, None, :]
        # With friction the tangential jump is told by unknowns, too.
        projection[contact.rubs] = np.eye(2)
        projection *= sign[:, None, None]
        shape = [bernstein(k)[1:-1, end * k] for end in range(2)]
        along = [s[None, :, None, None] * projection[:, None] for s in shape]
        parts.add(contact, follower, [a.reshape(len(normal), 2 * (k - 1), 2) for a in along])
    return parts.matrix()


class _Follow:
    """A matrix from displacements of the vertices at the ends of pairs to those of the nodes inside that follow them."""

    def __init__(self, lattice: Lattice):
        self.size = 2 * lattice.ends[2]
        self.entries = [(np.zeros(0, int), np.zeros(0, int), np.zeros(0))]

    def add(self, contact: Contact, follower: np.ndarray, weights: list[np.ndarray]) -> None:
        """``weights`` (m, 2n, 2) times the jump at the two ends goes to the nodes ``follower`` (m, n)."""
        rows = _dofs(follower)[:, :, None]
        for end, weight in enumerate(weights):
            for ends, sign in ((contact.first, 1.0), (contact.second, -1.0)):
                there = ends[:, end] >= 0
                columns = 2 * ends[there, end][:, None, None] + AXIS
                self.entries.append(
                    tuple(a.reshape(-1) for a in np.broadcast_arrays(rows[there], columns, sign * weight[there]))
                )

    def matrix(self) -> sparse.csr_matrix:
        """All of it."""
        i, j, v = (np.concatenate(parts) for parts in zip(*self.entries))
        return sparse.csr_matrix((v, (i, j)), shape=(self.size, self.size))


def _sides(problem: Problem, lattice: Lattice, contact: Contact) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes (m, k − 1) inside the edges of the softer and the stiffer side (−1: rigid) in the direction of the contact, and
    +1 where the softer one is the first side."""
    young = np.zeros(len(problem.edges))
    young[problem.triangle_edges] = np.array([body.young for body in problem.bodies])[problem.body][:, None]
    first, second = (
        lattice.along(problem, contact.edges[:, side], ends[:, 0])
        for side, ends in enumerate((contact.first, contact.second))
    )
    second_softer = (contact.edges[:, 1] >= 0) & (young[contact.edges[:, 1]] < young[contact.edges[:, 0]])
    follower = np.where(second_softer[:, None], second, first)
    leader = np.where(second_softer[:, None], first, second)
    return follower, leader, np.where(second_softer, -1.0, 1.0)


def _tangent(normals: np.ndarray) -> np.ndarray:
    return np.stack([-normals[..., 1], normals[..., 0]], axis=-1)
