"""The change of variables u = T w + u0 that makes the jump along the direction of contact an unknown.

Nodes are numbered as in :mod:`lattice`; degree of freedom 2·node + component. Clamped values, rollers and pins are
eliminated. Every remaining unknown is either free or a jump (v' − v'')·n̂ with plain bounds, as PETSc's
variational-inequality solvers need it.

On a contact edge of degree k with one direction n̂ the jump has the Bernstein coefficients b_0, …, b_k. They are the jump
unknowns, b_0 and b_k those at the vertices, so that bounding them by the coefficients of the linear gap bounds the jump
everywhere on the edge, not only at its nodes.

Where n̂ turns from N0 to N1 along the edge, the jump is of degree k + 1. With J_0, …, J_k the Bernstein coefficients of
v' − v'' its own are c_r = ((k + 1 − r) J_r·N0 + r J_(r−1)·N1)/(k + 1). Those between c_0 and c_(k+1) are k unknowns in place
of as many of the 2(k − 1) components of J_1, …, J_(k−1). The jump of P1 is a quadratic there, bounded at the vertices.

Where there is friction, the coefficients of the tangential jump are unknowns too; see :mod:`friction`.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.csgraph import connected_components

from hypercircle_process import BadExchange

from .builder import Builder, Constraints, JumpRow, SlipRow
from .exchange import Problem
from .friction import check as check_friction, vertex_slips
from .group import Conflict, eliminate
from .inside import inside_contacts, inside_friction, inside_supports, inside_turning
from .inside import turning_friction, turning_vertex_jumps, vertex_jumps_inside
from .lattice import Lattice


def build(problem: Problem, degree: int, nodal_contact: bool = False) -> Constraints:
    """The constraints of degree ``degree``; ``nodal_contact`` bounds the jump at the nodes only.

    Raises :class:`BadExchange` where supports and contacts contradict each other.
    """
    check_friction(problem, degree, nodal_contact)
    lattice = Lattice.of(problem, degree)
    nodes = lattice.ends[2]
    builder = Builder(nodes)
    done = np.ones(nodes, dtype=bool)
    done[lattice.of_triangles(problem)] = False
    _vertex_groups(problem, degree, builder, done)
    if degree > 1:
        inside_supports(problem, lattice, builder, done)
        inside_contacts(problem, lattice, builder, done, nodal_contact)
        inside_friction(problem, lattice, builder, done)
        if not nodal_contact:
            inside_turning(problem, lattice, builder, done)
            turning_friction(problem, lattice, builder)
    free = np.flatnonzero(~done)
    dofs = (2 * free[:, None] + np.arange(2)).reshape(-1)
    builder.add(dofs, builder.new_columns(np.full(len(dofs), np.inf)), 1.0)

    T, offset = builder.matrix(2 * nodes), builder.offset
    if degree > 1 and not nodal_contact:
        # Unknowns inside a contact edge follow the jumps at its ends, too.
        follow = vertex_jumps_inside(problem, lattice) + turning_vertex_jumps(problem, lattice)
        T = (T + follow @ T).tocsr()
        offset = offset + follow @ offset
    bounds = (np.concatenate(builder.lower), np.concatenate(builder.upper))
    return Constraints(T, offset, *bounds, builder.rows, *builder.friction(), builder.slips, builder.slid, builder.coupled(2 * nodes))


def _vertex_groups(problem: Problem, degree: int, builder: Builder, done: np.ndarray) -> None:
    equalities = _vertex_equalities(problem, degree)
    jumps, slips = _vertex_jumps(problem), vertex_slips(problem, degree)
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
    rubbing: list[list] = [[] for _ in range(count)]
    for slip in slips:
        rubbing[label[slot[slip[0][0]]]].append(slip)
    stiffness = _vertex_stiffness(problem)
    for vertices, equal, jump, slip in zip(members, fixed, bounded, rubbing):
        _one_group(problem, builder, stiffness, vertices, equal, jump, slip)
    done[touched] = True


def _one_group(problem: Problem, builder: Builder, stiffness, vertices, equalities, jumps, slips) -> None:
    place = {v: 2 * i for i, v in enumerate(vertices)}
    C, d = np.zeros((len(equalities), 2 * len(vertices))), np.zeros(len(equalities))
    for i, (v, direction, value) in enumerate(equalities):
        C[i, place[v] : place[v] + 2] = direction
        d[i] = value
    g = np.array([gap for _, _, gap, _ in jumps])
    # Rows of the jump along normals, then along tangents.
    B = np.zeros((len(jumps) + len(slips), 2 * len(vertices)))
    for i, ((a, b), direction, *_) in enumerate(jumps + slips):
        B[i, place[a] : place[a] + 2] += direction
        if b >= 0:
            B[i, place[b] : place[b] + 2] -= direction
    try:
        result = eliminate(C, d, B[: len(jumps)], g, np.repeat(stiffness[vertices], 2), B[len(jumps) :])
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
    for slip in result.slips:
        (first, _), tangent, weight, contact = slips[slip.row]
        where = (contact, tangent / slip.factor, tangent, first, -1)
        builder.rub(slip.kink, SlipRow(int(columns[slip.unknown]), weight * abs(slip.factor), *where))
    for row in result.coupled:
        ends, tangent, weight, contact = slips[row]
        terms = [(v, sign * tangent) for v, sign in zip(ends, (1.0, -1.0)) if v >= 0]
        builder.rub_coupled(terms, SlipRow(-1, weight, contact, tangent, tangent, ends[0], -1))
    builder.slid += sum(slips[row][2] * abs(value) for row, value in result.given)


def _vertex_stiffness(problem: Problem) -> np.ndarray:
    """Largest Young's modulus around each vertex."""
    young = np.array([body.young for body in problem.bodies])[problem.body]
    stiffness = np.zeros(len(problem.points))
    np.maximum.at(stiffness, problem.triangles, young[:, None])
    return stiffness


def _vertex_equalities(problem: Problem, degree: int) -> list[tuple[int, np.ndarray, float]]:
    """(vertex, direction, value) of every u(vertex) · direction = value; equal ones once."""
    found: dict[tuple, tuple[int, np.ndarray, float]] = {}
    axes = np.eye(2)

    def add(vertex, direction, value):
        found.setdefault((int(vertex), *direction, value), (int(vertex), direction, float(value)))

    for edge, values in zip(problem.clamped_edges, problem.clamped_values):
        for vertex, displacement in zip(problem.edges[edge], values):
            add(vertex, axes[0], displacement[0])
            add(vertex, axes[1], displacement[1])
    for edge, direction, value in zip(problem.roller_edges, problem.roller_directions, problem.roller_values):
        for vertex in problem.edges[edge]:
            add(vertex, direction, value)
    for vertex, direction, only in zip(problem.pin_vertices, problem.pin_directions, problem.pin_degrees):
        if only in (0, degree):
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
