"""The minimiser alone against enumeration, and scenes on which steps that may raise the energy go round for ever."""

import math
from itertools import product

import numpy as np
import pytest
from hypercircle_process import Failure
from hypercircle_reference.coupled import CoupledDescent, Rows
from hypercircle_reference.descent import CLOSED, Descent
from mpi4py import MPI
from petsc4py import PETSc
from scipy import sparse
from scenes import Builder, arched_blocks, two_blocks

FREE, LOW, HIGH = range(3)


def descent(matrix, right, lower, upper, *friction):
    size = len(right)
    rows = np.arange(0, size * size + 1, size, dtype=PETSc.IntType)
    columns = np.tile(np.arange(size, dtype=PETSc.IntType), size)
    A = PETSc.Mat().createAIJ((size, size), csr=(rows, columns, matrix.reshape(-1)), comm=MPI.COMM_SELF)
    A.assemble()
    return Descent(A, right, lower, upper, None, *friction)


def descend(matrix, right, lower, upper, *friction):
    return descent(matrix, right, lower, upper, *friction).minimise()


def enumerated(matrix, right, lower, upper):
    """The lowest energy over all ways to put unknowns on their bounds; the others solve their equations."""
    energies = []
    choices = [[FREE] + [LOW] * int(np.isfinite(a)) + [HIGH] * int(np.isfinite(b)) for a, b in zip(lower, upper)]
    for state in product(*choices):
        state = np.array(state)
        w, free = np.where(state == LOW, lower, np.where(state == HIGH, upper, 0.0)), state == FREE
        if free.any():
            w[free] = np.linalg.pinv(matrix[np.ix_(free, free)], rcond=1e-9) @ (right - matrix @ w)[free]
        if np.all(w >= lower - 1e-9) and np.all(w <= upper + 1e-9):
            energies.append(0.5 * w @ matrix @ w - right @ w)
    return min(energies)


@pytest.mark.parametrize("loose", (0, 1, 2))
@pytest.mark.parametrize("seed", range(12))
def test_random_minima_are_those_of_enumeration(seed, loose):
    """``loose`` directions without curvature, held by bounds alone; matrices from well to badly conditioned."""
    rng = np.random.default_rng([seed, loose])
    size, bounded = 9, 7
    basis = np.linalg.qr(rng.normal(size=(size, size)))[0]
    curvature = 10.0 ** rng.uniform(-rng.choice([0, 2, 4]), 0, size)
    curvature[:loose] = 0.0
    matrix = (basis * curvature) @ basis.T
    scale = 1.0 / np.sqrt(np.diag(matrix))
    matrix = scale[:, None] * matrix * scale
    right = rng.normal(size=size)
    lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
    upper[:bounded] = rng.choice([0.0, 0.1, 1.0], bounded)
    if loose:
        lower[:bounded] = -rng.choice([0.1, 1.0], bounded)
    found = descend(matrix, right, lower, upper)
    energy = 0.5 * found.w @ matrix @ found.w - right @ found.w
    assert np.all(found.w >= lower) and np.all(found.w <= upper)
    assert energy == pytest.approx(enumerated(matrix, right, lower, upper), rel=1e-9)


def enumerated_with_friction(matrix, right, upper, kink, weight):
    """As ``enumerated``, with Σ weight |w − kink|: each of these unknowns sticks or slips one way or the other."""
    energies = []
    choices = [[FREE, HIGH] if np.isfinite(b) else [-1, 0, 1] if c > 0.0 else [FREE] for b, c in zip(upper, weight)]
    for state in product(*choices):
        state = np.array(state)
        rubs = weight > 0.0
        held = np.where(rubs, state == 0, state == HIGH)
        w = np.where(held, np.where(rubs, kink, np.minimum(upper, 1e300)), 0.0)
        pulled = right - np.where(rubs & ~held, weight * state, 0.0)
        if not held.all():
            w[~held] = np.linalg.pinv(matrix[np.ix_(~held, ~held)], rcond=1e-9) @ (pulled - matrix @ w)[~held]
        if np.all(w <= upper + 1e-9):
            energies.append(0.5 * w @ matrix @ w - right @ w + weight @ np.abs(w - kink))
    return min(energies)


@pytest.mark.parametrize("loose", (0, 2))
@pytest.mark.parametrize("seed", range(10))
def test_random_minima_with_friction_are_those_of_enumeration(seed, loose):
    """Two unknowns with bounds and five with friction, held by it alone in ``loose`` directions."""
    rng = np.random.default_rng([seed, loose, 7])
    size = 8
    basis = np.linalg.qr(rng.normal(size=(size, size)))[0]
    curvature = 10.0 ** rng.uniform(-rng.choice([0, 2, 4]), 0, size)
    curvature[:loose] = 0.0
    matrix = (basis * curvature) @ basis.T
    scale = 1.0 / np.sqrt(np.diag(matrix))
    matrix = scale[:, None] * matrix * scale
    right, upper = rng.normal(size=size), np.full(size, np.inf)
    upper[:2] = rng.choice([0.0, 0.1, 1.0], 2)
    kink, weight = np.zeros(size), np.zeros(size)
    kink[2:7] = rng.choice([0.0, 0.0, 0.3, -1.0], 5)
    weight[2:7] = 10.0 ** rng.uniform(-2.0, 1.0, 5)
    for direction in (basis[:, :loose] / scale[:, None]).T:
        # Friction holds the motions that nothing else holds: most of the load along them is taken away.
        right -= 0.9 * (right @ direction) / (direction @ direction) * direction
        weight[2:7] += 0.2 * abs(right @ direction) / np.abs(direction[2:7]).sum() + 1.0
    found = descend(matrix, right, np.full(size, -np.inf), upper, kink, weight)
    energy = 0.5 * found.w @ matrix @ found.w - right @ found.w + weight @ np.abs(found.w - kink)
    assert np.all(found.w <= upper)
    assert energy == pytest.approx(enumerated_with_friction(matrix, right, upper, kink, weight), rel=1e-9)


def test_a_direction_that_nothing_stops_is_a_failure():
    matrix = np.array([[1.0, -1.0], [-1.0, 1.0]])
    with pytest.raises(Failure, match="neither supports nor contacts hold the bodies"):
        descend(matrix, np.array([-1.0, -1.0]), np.array([-np.inf, -np.inf]), np.array([1.0, np.inf]))


@pytest.mark.parametrize("degree", (1, 2))
@pytest.mark.parametrize("rise", (0.03, 0.1, 0.3))
def test_curved_contact_of_facets_arrives(solve, degree, rise):
    """Contact alone carries the load, hence the resultant; without a gap 𝓛 = −½ ∫ c e:e."""
    for softer in (1.0, 1e-3):
        result = solve(arched_blocks(8, rise, softer), degree)
        assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-9)
        assert result["contacts"][0]["resultant"][1] == pytest.approx(-0.05 * 1.3, rel=1e-7)


@pytest.mark.parametrize("degree", (1, 2))
def test_nearly_incompressible_beside_stiff(solve, degree):
    data = arched_blocks(6, 0.1, 1e-4, poisson=0.4999999)
    result = solve(data, degree)
    assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-6)
    assert result["contacts"][0]["resultant"][1] == pytest.approx(-0.05 * 1.3, rel=1e-5)


@pytest.mark.parametrize("degree", (1, 2))
def test_a_body_moved_rigidly_is_without_energy(solve, degree):
    """Its support moves it by 10⁶ of its size across a gap that stays open: no strain, no force, hardly any doubt."""
    b = Builder()
    sides = b.block(b.body("block", 1e5), 3, 3, lambda s, t: (s, t))
    b.clamp(sides["left"], (1e6, -2e6))
    b.contact(sides["right"], None, (1.0, 0.0), lambda x, y: 2e6)
    result = solve(b.data, degree)
    at_stake = 1e5 * 1e12
    assert abs(result["energy"]) <= result["energy_rounding"] < 1e-24 * at_stake
    assert result["contacts"][0]["resultant"] == [0.0, 0.0]
    assert np.array(result["vertex_displacement"]) == pytest.approx(np.tile([1e6, -2e6], (16, 1)), rel=1e-12)


@pytest.mark.parametrize("degree", (1, 2, 3))
def test_a_wide_gap_that_stays_open_is_found_open(solve, degree):
    """A block free to slide along a roller, all but across a gap of 500: it would slide 1.7e5 times its size until that
    closes, whence rounding hides the way back. The other block is moved by its clamp. Nothing is strained."""
    b, lean = Builder(), 0.003
    sliding = b.block(b.body("sliding", 1.7), 3, 4, lambda s, t: (s + lean * t * (1.0 - s), t))
    moved = b.block(b.body("moved", 0.13, 0.2), 3, 4, lambda s, t: (1.0 + s, t))
    b.roller(sliding["left"], (-1.0 / math.hypot(1.0, lean), lean / math.hypot(1.0, lean)))
    b.clamp(moved["right"], (0.28, 0.0))
    b.contact(sliding["right"], moved["left"], (1.0, 0.0), lambda x, y: 500.0)
    result = solve(b.data, degree)
    assert abs(result["energy"]) < 1e-24
    assert result["contacts"][0]["resultant"] == [0.0, 0.0]


def test_rounding_of_the_energy_is_told(solve):
    """A rigid block on a soft one: the energy tends to a limit, and differs from it by what rounding is said to do."""
    energies = {}
    for ratio in (1e8, 1e9, 1e10, 1e11):
        data = two_blocks(8)
        data["bodies"][0]["young"] = ratio
        result = solve(data, 2)
        energies[ratio] = result["energy"], result["energy_rounding"]
    limit = energies[1e8][0]
    for ratio, (energy, rounding) in energies.items():
        # The strain of the stiff block is worth about 2 / ratio; the estimate is one of size.
        assert abs(energy - limit) < 10.0 * rounding + 4e-8
        assert rounding < 1e-17 * ratio


def coupled(matrix, right, lower, upper, row, bound):
    """The minimum with ``bound`` |row·w|, and the force along the row."""
    rows = Rows.of(sparse.csr_matrix([row]), np.array([bound]), np.zeros(1))
    found, forces = CoupledDescent(descent(matrix, right, lower, upper), rows).minimise(CLOSED)
    return found, float(forces[0])


MATRIX = np.array([[1.0, 0.3, -0.2, 0.1], [0.3, 1.0, 0.25, -0.1], [-0.2, 0.25, 1.0, 0.4], [0.1, -0.1, 0.4, 1.0]])


@pytest.mark.parametrize("slip", (1e-9, -3e-7))
def test_a_row_whose_unknowns_are_all_held_slides_with_its_bound(slip):
    """Rounds that add a stiffness times the slip would take a thousand million of them to arrive at it."""
    held = np.array([0.2, 0.2 - slip, 1.0, 0.5])
    lower = np.array([0.2, 0.2 - slip, -np.inf, -np.inf])
    found, force = coupled(MATRIX, MATRIX @ held, lower, np.where(np.isfinite(lower), lower, np.inf), [1.0, -1.0, 0.0, 0.0], 0.7)
    assert force == pytest.approx(math.copysign(0.7, slip), rel=1e-12)
    assert found.w == pytest.approx(held, rel=1e-9)
