"""Contact whose direction n̂ turns along the edges: jumps of one degree more, bounded all along."""

import numpy as np
import pytest
from hypercircle_reference.constraints import build
from hypercircle_reference.exchange import parse_problem
from scenes import Builder, two_blocks


def turn(data, angle, gap=None):
    """Give the contact of ``data`` the direction at angle ``angle(x, y)`` from the normal of each vertex."""
    points = data["points"]
    for pair in data["contacts"][0]["pairs"]:
        base = np.arctan2(pair["normal"][1], pair["normal"][0])
        at = [base + angle(*points[v]) for v in pair["first"]]
        pair["direction"] = [[float(np.cos(a)), float(np.sin(a))] for a in at]
        if gap is not None:
            pair["gap"] = [gap(*points[v]) for v in pair["first"]]
    return data


def lagrange(degree, t):
    """Values of the shape functions of an edge with nodes at equal steps."""
    nodes = np.arange(degree + 1) / degree
    return [np.prod([(t - q) / (p - q) for q in nodes if q != p]) for p in nodes]


def sides(problem, contact, degree):
    """Nodes of both sides of every pair from end to end; of degree k, k − 1 inside each edge after the vertices."""
    count = len(problem.points)
    for ends, edges in ((contact.first, contact.edges[:, 0]), (contact.second, contact.edges[:, 1])):
        inside = count + (degree - 1) * edges[:, None] + np.arange(degree - 1)
        forward = problem.edges[edges, 0] == ends[:, 0]
        yield np.column_stack([ends[:, :1], np.where(forward[:, None], inside, inside[:, ::-1]), ends[:, 1:]])


def largest_excess(problem, u, degree):
    """Largest (v' − v'')·n̂ − g at many points of every pair."""
    worst, contact = -np.inf, problem.contacts[0]
    first, second = sides(problem, contact, degree)
    for t in np.linspace(0.0, 1.0, 41):
        jump = np.einsum("i,mic->mc", lagrange(degree, t), u[first] - u[second])
        n = (1 - t) * contact.direction[:, 0] + t * contact.direction[:, 1]
        gap = (1 - t) * contact.gap[:, 0] + t * contact.gap[:, 1]
        worst = max(worst, float(np.max(np.sum(jump * n, axis=1) - gap)))
    return worst


def of_nodes(result):
    return np.array(result["vertex_displacement"] + (result["edge_displacement"] or []))


@pytest.mark.parametrize("young", (1.0, 100.0))
@pytest.mark.parametrize("degree", (2, 3, 4))
@pytest.mark.parametrize("turned", (True, False))
def test_admissible_unknowns_make_admissible_fields(young, degree, turned):
    """Random w within their bounds: the jump exceeds the gap nowhere."""
    data = two_blocks(3, angle=0.3)
    if turned:
        data = turn(data, lambda x, y: 0.4 * y - 0.1, lambda x, y: 0.05 + 0.02 * y)
    data["bodies"][0]["young"] = young
    problem = parse_problem(data)
    constraints = build(problem, degree)
    assert np.linalg.matrix_rank(constraints.T.toarray()) == constraints.T.shape[1]
    rng = np.random.default_rng(1)
    for _ in range(20):
        w = rng.normal(size=constraints.T.shape[1])
        w = np.clip(w, constraints.lower, constraints.upper)
        u = (constraints.T @ w + constraints.offset).reshape(-1, 2)
        assert largest_excess(problem, u, degree) < 1e-12


@pytest.mark.parametrize("degree", (2, 3, 4))
def test_rows_say_what_a_translation_does(degree):
    """The row of every bounded unknown changes by its normal under a translation of the first side."""
    problem = parse_problem({**turn(two_blocks(3), lambda x, y: 0.5 * y), "roller": [], "clamped": []})
    constraints = build(problem, degree)
    for d in (np.array([1.0, 0.0]), np.array([0.0, 1.0])):
        u = np.zeros((constraints.T.shape[0] // 2, 2))
        u[next(sides(problem, problem.contacts[0], degree))] = d
        w = np.linalg.lstsq(constraints.T.toarray(), u.reshape(-1) - constraints.offset, rcond=None)[0]
        for row in (row for row in constraints.rows if row.vertex < 0):
            assert row.factor * w[row.column] == pytest.approx(row.normal @ d, abs=1e-12)


@pytest.mark.parametrize("degree", (1, 2, 3, 4))
def test_reactions_balance_the_loads(solve, degree):
    """A direction that turns: the reactions push along it, and their sum is what supports and loads leave to them."""
    b = Builder()
    lower = b.block(b.body("lower"), 5, 3, lambda s, t: (s, t - 1.0))
    upper = b.block(b.body("upper"), 5, 3, lambda s, t: (s, t))
    b.clamp(lower["bottom"])
    b.load(upper["top"], lambda x, y: (0.0, -0.3))
    b.contact(upper["bottom"], lower["top"], (0.0, -1.0))
    b.roller(upper["left"], (-1.0, 0.0))
    data = turn(b.data, lambda x, y: 0.3 * (x - 0.5))
    result = solve(data, degree)
    contact = result["contacts"][0]
    assert contact["resultant"][1] == pytest.approx(0.3, rel=1e-9)
    assert min(contact["vertex_reaction"]) >= 0.0
    problem = parse_problem(data)
    if degree > 1:
        assert all(len(inner) == degree and min(inner) >= 0.0 for inner in contact["edge_reaction"])
        assert largest_excess(problem, of_nodes(result), degree) < 1e-12
    # The conditions form a cone.
    assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-10)


def test_a_pin_of_one_degree_holds_no_other():
    data = two_blocks(2)
    data["pins"] += [{"vertex": 0, "direction": [1.0, 0.0]}, {"vertex": 1, "direction": [1.0, 0.0], "degree": 1}]
    for degree, held in ((1, [True, True]), (2, [True, False])):
        changes = build(parse_problem(data), degree).T
        assert [changes[2 * vertex].nnz == 0 for vertex in (0, 1)] == held
