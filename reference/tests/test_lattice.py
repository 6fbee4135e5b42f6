"""Nodes and loads of any degree against polynomials."""

import numpy as np
import pytest
from hypercircle_reference.exchange import parse_problem
from hypercircle_reference.lattice import Lattice, bernstein, traction_weights, weights
from scenes import two_blocks


@pytest.mark.parametrize("degree", range(1, 10))
def test_every_node_has_one_number_wherever_it_is_seen_from(degree):
    """A node that two triangles share is at one place: the mean of their corners by their weights."""
    problem = parse_problem(two_blocks(3, angle=0.3))
    lattice = Lattice.of(problem, degree)
    nodes, at = lattice.of_triangles(problem), weights(degree) / degree
    places = np.einsum("ni,tic->tnc", at, problem.points[problem.triangles])
    found = np.full((lattice.ends[2], 2), np.nan)
    found[nodes] = places
    assert found[nodes] == pytest.approx(places, abs=1e-14)
    assert np.all(np.isfinite(found))
    assert found[: len(problem.points)] == pytest.approx(problem.points)
    if degree > 1:
        first, last = problem.points[problem.edges[5]]
        s = np.arange(1, degree)[:, None] / degree
        assert found[lattice.inside_edges(np.array([5]))[0]] == pytest.approx((1 - s) * first + s * last)


@pytest.mark.parametrize("degree", range(1, 10))
def test_tractions_are_integrated_exactly(degree):
    """∫ P v for v = s^m through its values at the nodes, P = 2 − 5 s."""
    s = np.arange(degree + 1) / degree
    for m in range(degree + 1):
        found = s**m @ traction_weights(degree) @ [2.0, -3.0]
        assert found == pytest.approx(2 / (m + 1) - 5 / (m + 2), abs=1e-11)
    assert bernstein(degree).sum(axis=1) == pytest.approx(1.0)
