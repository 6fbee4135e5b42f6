"""The change of variables where supports and contacts meet."""

import numpy as np
import pytest
from hypercircle_process import BadExchange
from hypercircle_reference.constraints import build
from hypercircle_reference.exchange import parse_problem
from hypercircle_reference.group import Conflict, eliminate
from scenes import Builder, two_blocks

ONES = np.ones(4)


def check(C, d, B, g, stiffness):
    """Every admissible w gives an admissible x, and all of {C x = d} is reached."""
    result = eliminate(C, d, B, g, stiffness)
    rng = np.random.default_rng(1)
    upper = np.array([np.inf if b is None else b.value for b in result.upper])
    lower = np.array([-np.inf if b is None else b.value for b in result.lower])
    for _ in range(20):
        w = np.clip(rng.normal(size=len(upper)), lower, upper)
        x = result.offset + result.jumps @ w + result.free @ rng.normal(size=result.free.shape[1])
        assert C @ x == pytest.approx(d, abs=1e-12)
        assert np.all(B @ x <= g + 1e-12)
    freedoms = C.shape[1] - (np.linalg.matrix_rank(C) if len(C) else 0)
    basis = np.hstack([result.jumps, result.free])
    assert basis.shape[1] == freedoms
    assert freedoms == 0 or np.linalg.matrix_rank(basis) == freedoms
    return result


def rows(*entries):
    return np.array(entries, dtype=float).reshape(len(entries), -1) if entries else np.zeros((0, 4))


@pytest.mark.parametrize("stiffness", (ONES, np.array([1.0, 1.0, 1e8, 1e8]), np.array([1e8, 1e8, 1.0, 1.0])))
def test_elimination_of_ordinary_and_odd_groups(stiffness):
    n = np.array([0.6, 0.8])
    pair = np.concatenate([n, -n])
    none = np.zeros(0)
    assert len(check(rows(), none, rows(pair), np.array([0.1]), stiffness).upper) == 1
    # A polyline with a corner: two normals at one vertex.
    corner = rows(pair, [1.0, 0.0, -1.0, 0.0])
    assert len(check(rows(), none, corner, np.array([0.1, 0.2]), stiffness).upper) == 2
    # One row twice, with different gaps: the smaller one binds.
    twice = check(rows(), none, rows(pair, pair), np.array([0.3, 0.1]), stiffness)
    assert [bound.value for bound in twice.upper] == pytest.approx([0.1])
    assert twice.upper[0].row == 1
    # Supports leave u = (x, 0): the first jump is 0.6 x ≤ 0.1, the second x ≤ h. The unknown is the first.
    held = rows([0.0, 1.0, 0, 0], [0, 0, 0, 1.0], [0, 0, 1.0, 0])
    for second, bound, binding in ((0.2, 0.1, 0), (0.05, 0.6 * 0.05, 1)):
        roller = check(held, np.zeros(3), corner, np.array([0.1, second]), stiffness)
        assert [(b.value, b.row) for b in roller.upper] == [(pytest.approx(bound), binding)]
    # Between two walls: bounded from both sides.
    walls = check(rows([0, 1.0, 0, 0]), np.zeros(1), rows([1.0, 0, 0, 0], [-1.0, 0, 0, 0]), np.array([0.2, 0.3]), stiffness)
    assert (walls.upper[0].value, walls.lower[0].value) == pytest.approx((0.2, -0.3))
    # The second side is moved by its support: the unknown is still the whole jump, bounded by the whole gap.
    driven = check(rows([0, 0, 1.0, 0], [0, 0, 0, 1.0]), np.array([-0.3, 0.1]), rows(pair), np.array([0.2]), stiffness)
    assert driven.upper[0].value == pytest.approx(0.2)
    # Everything held: no unknown is left, and a jump that is allowed is no conflict.
    held = check(np.eye(4), np.array([0.1, 0.0, 0.0, 0.0]), rows(pair), np.array([0.06]), stiffness)
    assert held.jumps.shape[1] == held.free.shape[1] == 0


def test_contradictions_are_named():
    C = rows([1.0, 0, 0, 0], [1.0, 0, 0, 0])
    with pytest.raises(Conflict, match="two different displacements"):
        eliminate(C, np.array([0.0, 0.1]), rows(), np.zeros(0), ONES)
    with pytest.raises(Conflict, match="penetration of 1.000e-01"):
        eliminate(np.eye(4), np.array([0.1, 0, 0, 0]), rows([1.0, 0, -1.0, 0]), np.zeros(1), ONES)
    with pytest.raises(Conflict, match="3 contact conditions act on 2 freedoms"):
        angles = np.array([0.0, 2.0, 4.0])
        B = np.column_stack([np.cos(angles), np.sin(angles), np.zeros((3, 2))])
        eliminate(rows([0, 0, 1.0, 0], [0, 0, 0, 1.0]), np.zeros(2), B, np.ones(3), ONES)


def test_implied_row_is_left_out():
    """(n1 + n2)·u ≤ 3 follows from n1·u ≤ 1 and n2·u ≤ 1."""
    B = rows([1.0, 1.0, 0, 0], [1.0, 0, 0, 0], [0, 1.0, 0, 0])
    result = eliminate(rows([0, 0, 1.0, 0], [0, 0, 0, 1.0]), np.zeros(2), B, np.array([3.0, 1.0, 1.0]), ONES)
    assert sorted(bound.row for bound in result.upper) == [1, 2]


@pytest.mark.parametrize("degree", (1, 2))
@pytest.mark.parametrize("nodal", (False, True))
def test_unknowns_are_the_jumps(degree, nodal):
    """Random admissible w: every bounded unknown equals the jump, or the Bernstein coefficient, it stands for."""
    data = two_blocks(3, angle=0.3, gap=0.1)
    data["bodies"][0]["young"] = 100.0
    problem = parse_problem(data)
    constraints = build(problem, degree, nodal)
    w = np.random.default_rng(2).normal(size=constraints.T.shape[1])
    u = (constraints.T @ w + constraints.offset).reshape(-1, 2)
    vertices, contact = len(problem.points), problem.contacts[0]
    other = {int(a): int(b) for a, b in zip(contact.first.reshape(-1), contact.second.reshape(-1))}
    seen = 0
    for row in constraints.rows:
        if row.vertex >= 0:
            jump = (u[row.vertex] - u[other[row.vertex]]) @ row.normal
        else:
            middle, ends = vertices + contact.edges[row.pair], (contact.first[row.pair], contact.second[row.pair])
            jump = (u[middle[0]] - u[middle[1]]) @ row.normal
            if not nodal:
                jump = 2.0 * jump - 0.5 * ((u[ends[0]] - u[ends[1]]) @ row.normal).sum()
        assert row.factor * w[row.column] == pytest.approx(jump, abs=1e-12)
        assert constraints.upper[row.column] == pytest.approx(0.1)
        seen += 1
    assert seen == (4 if degree == 1 else 7)
    assert np.linalg.matrix_rank(constraints.T.toarray()) == constraints.T.shape[1]


@pytest.mark.parametrize("degree", (1, 2))
def test_contact_that_ends_on_supports(solve, degree):
    """Both sides clamped where the contact ends: the jump there is given, the rest still meets without penetration."""
    b = Builder()
    lower = b.block(b.body("lower"), 4, 4, lambda s, t: (s, t - 1.0))
    upper = b.block(b.body("upper"), 4, 4, lambda s, t: (s, t))
    for block in (lower, upper):
        b.clamp(block["left"])
    b.clamp(lower["bottom"])
    b.load(upper["top"], lambda x, y: (0.0, -0.2))
    b.contact(upper["bottom"], lower["top"], (0.0, -1.0))
    result = solve(b.data, degree)
    assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-11)
    u = np.array(result["vertex_displacement"])
    assert np.all(u[upper["bottom"], 1] >= u[lower["top"], 1] - 1e-14)
    b.data["contacts"] = []
    assert result["energy"] > solve(b.data, degree)["energy"] + 1e-6


@pytest.mark.parametrize("degree", (1, 2))
def test_three_bodies_meet_in_a_point(solve, degree):
    """Two blocks side by side on a third: under uniform pressure the stress is uniform, through every contact."""
    b = Builder("plane-stress")
    base = b.block(b.body("base", 1.0, 0.0), 4, 2, lambda s, t: (2.0 * s, t))
    left = b.block(b.body("left", 1.0, 0.0), 2, 2, lambda s, t: (s, 1.0 + t))
    right = b.block(b.body("right", 1.0, 0.0), 2, 2, lambda s, t: (1.0 + s, 1.0 + t))
    b.clamp(base["bottom"])
    b.load(left["left"], lambda x, y: (0.1, 0.0))
    b.load(right["right"], lambda x, y: (-0.1, 0.0))
    for block in (left, right):
        b.load(block["top"], lambda x, y: (0.0, -0.3))
    b.contact(base["top"][:3], left["bottom"], (0.0, 1.0), name="under left")
    b.contact(base["top"][2:], right["bottom"], (0.0, 1.0), name="under right")
    b.contact(left["right"], right["left"], (1.0, 0.0), name="between")
    b.pin(left["right"][1], (1.0, 0.0))
    result = solve(b.data, degree)
    assert [contact["resultant"] for contact in result["contacts"]] == [
        pytest.approx([0.0, -0.3], abs=1e-12),
        pytest.approx([0.0, -0.3], abs=1e-12),
        pytest.approx([-0.1, 0.0], abs=1e-12),
    ]
    assert result["energy"] == pytest.approx(-0.5 * (0.3**2 * 4.0 + 0.1**2 * 2.0), rel=1e-11)


@pytest.mark.parametrize("degree", (1, 2))
def test_corner_in_the_contact_line(solve, degree):
    """A block in a rigid right-angled corner: one vertex with two normals, uniform pressure from both free sides."""
    b = Builder("plane-stress")
    block = b.block(b.body("block", 1.0, 0.25), 3, 3, lambda s, t: (s, t))
    b.load(block["right"], lambda x, y: (-0.2, 0.0))
    b.load(block["top"], lambda x, y: (0.0, -0.1))
    b.contact(block["left"][::-1], None, (-1.0, 0.0))
    b.contact(block["bottom"], None, (0.0, -1.0))
    corner, floor = b.data["contacts"][0], b.data["contacts"].pop()
    corner["pairs"] += floor["pairs"]
    result = solve(b.data, degree)
    assert result["contacts"][0]["resultant"] == pytest.approx([0.2, 0.1], abs=1e-12)
    assert result["energy"] == pytest.approx(-0.5 * (0.04 + 0.01 - 2 * 0.25 * 0.02), rel=1e-11)


def test_two_rollers_hold_a_vertex(solve):
    b = Builder()
    block = b.block(b.body(), 2, 2, lambda s, t: (s, t))
    b.roller(block["bottom"], (0.0, -1.0))
    b.roller(block["left"], (-1.0, 0.0))
    b.load(block["right"], lambda x, y: (0.3, 0.0))
    assert solve(b.data, 1)["vertex_displacement"][0] == [0.0, 0.0]


def test_conflicting_scene_names_the_place():
    b = Builder()
    one = b.block(b.body("one"), 2, 2, lambda s, t: (s, t))
    two = b.block(b.body("two"), 2, 2, lambda s, t: (1.0 + s, t))
    b.clamp(one["top"], (0.1, 0.0))
    b.clamp(two["top"])
    b.contact(one["right"], two["left"], (1.0, 0.0))
    with pytest.raises(BadExchange, match=r"at \(1, 1\): the supports force a penetration"):
        build(parse_problem(b.data), 2)
