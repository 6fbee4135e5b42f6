"""Friction with a given bound: patch tests with energies known by hand, and what is changed is refused for what it is."""

from math import comb

import numpy as np
import pytest
from by_hand import blocks, in_scene, refused, refused_once_changed, with_scene, write
from flint import arb, fmpq
from hypercircle_check import Refused
from hypercircle_check.main import check
from hypercircle_check.mesh import Joint
from hypercircle_check.scene import Scene, at, rows
from hypercircle_check.upper import absolute

SLIDES = {"bound": 0.1, "shear": -0.1, "moved": 1.0}  # all of the contact, by 1 - 4 * 0.1
STICKS = {"bound": 0.1, "shear": -0.05, "moved": 0.2}
PUSHED = {"bound": 0.1, "shear": 0.05}  # the left block, which friction alone holds along the contact


@pytest.mark.parametrize("what, energy", [
    (SLIDES, 1 + 0.1 * 1.0 - 2 * 0.1**2),
    ({**SLIDES, "shear": 0.1, "moved": -1.0, "n": 3, "degree": 2, "thickness": 0.5}, (1 + 0.1 * 1.0 - 2 * 0.1**2) / 2),
    ({**SLIDES, "bound": "[[0.0, 0.1], [1.0, 0.1], [2.0, 7.0]]", "degree": 3}, 1 + 0.1 * 1.0 - 2 * 0.1**2),
    ({**SLIDES, "bound": 0.0, "shear": 0.0}, 1.0),
    (STICKS, 1 + 0.2**2 / 8),
    ({**STICKS, "bound": 1e9, "n": 3}, 1 + 0.2**2 / 8),
    ({**STICKS, "bound": "[[0.25, 0.3], [0.75, 0.06]]", "degree": 2}, 1 + 0.2**2 / 8),
    (PUSHED, -1.25 - 2 * 0.05**2),
    ({**PUSHED, "bound": "[[0.0, 0.07], [1.0, 0.06]]", "degree": 3, "n": 3}, -1.25 - 2 * 0.05**2),
])
def test_patch(tmp_path, what, energy):
    write(blocks(**what), tmp_path / "proof.npz")
    proof = check(tmp_path)
    assert float(proof.lower) == pytest.approx(energy, abs=1e-12)
    assert float(proof.upper) == pytest.approx(energy, abs=1e-12)
    assert proof.lower <= energy + 1e-15 and proof.upper >= energy - 1e-15
    assert not any("additional load" in premise for premise in proof.premises)


def test_what_friction_alone_holds_is_brought_into_balance(tmp_path):
    arrays = blocks(**PUSHED)
    arrays["frictions"] *= 1 + 1e-9
    arrays["manifest"]["claim"]["lower"] -= 1e-8
    write(arrays, tmp_path / "proof.npz")
    proof = check(tmp_path)
    assert not any("additional load" in premise for premise in proof.premises)
    assert float(proof.lower) == pytest.approx(-1.255, abs=1e-8)


@pytest.mark.parametrize("degree", [1, 3])
def test_friction_is_clipped_to_its_bound(tmp_path, degree):
    """What rounding leaves above the bound goes, in every coefficient."""
    arrays = blocks(**SLIDES, degree=degree)
    arrays["frictions"] *= 1 + 1e-9
    arrays["manifest"]["claim"]["lower"] -= 1e-8
    write(arrays, tmp_path / "proof.npz")
    rubs = [joint for joint in check(tmp_path).stress.mesh.joints if joint.bound]
    assert rubs and all(abs(x) <= fmpq(*(0.1).as_integer_ratio()) for joint in rubs for x in joint.pressure)


def above(a):
    a["frictions"] *= 1.01


def against(a):
    a["frictions"] *= -1


def left_out(a):
    a["manifest"]["claim"]["upper"] -= 0.1 * 0.6


def left_out_nearly(a):
    a["manifest"]["claim"]["upper"] -= 0.1 * 0.6 * 1e-6


def missing(a):
    del a["frictions"]


def few(a):
    a["friction_counts"], a["frictions"] = a["friction_counts"][:-1], a["frictions"][:-2]


def nothing(a):
    a["frictions"][1] = np.nan


CHANGES = [
    pytest.param(above, "friction of pair 0 is above its bound", id="above"),
    pytest.param(against, "not in equilibrium", id="against"),
    pytest.param(in_scene("bound = 0.1", "bound = 0.0999"), "friction of pair 0 is above its bound", id="lowered"),
    pytest.param(in_scene("bound = 0.1", "bound = [[0.0, 0.1], [0.5, 0.1], [1.0, 0.0999]]"), "friction of pair 1 is above its bound", id="lowered_in_part"),
    pytest.param(in_scene("bound = 0.1", "bound = 0.1001"), "upper bound .* is claimed, and only", id="raised"),
    pytest.param(in_scene(", friction = { bound = 0.1 }", ""), "not in equilibrium", id="gone"),
    pytest.param(left_out, "upper bound .* is claimed, and only", id="left_out"),
    pytest.param(left_out_nearly, "upper bound .* is claimed, and only", id="left_out_nearly"),
    pytest.param(missing, "lacks 'frictions'", id="missing"),
    pytest.param(few, "does not have a friction for every contact pair", id="few"),
    pytest.param(nothing, "a friction of the proof is no number", id="nothing"),
    pytest.param(in_scene("bound = 0.1", "coefficient = 0.1"), "does not know the key `coefficient`", id="coulomb"),
    pytest.param(in_scene("bound = 0.1", "bound = [0.1, 0.2]"), "is a range", id="ranged"),
    pytest.param(in_scene("bound = 0.1", "bound = -0.1"), "a bound of friction is -0.1", id="negative"),
    pytest.param(in_scene("bound = 0.1", "bound = [[1.0, 0.1], [0.0, 0.1]]"), "a bound of friction is", id="backwards"),
]


@pytest.mark.parametrize("change, why", CHANGES)
def test_changes_are_refused_for_what_they_are(tmp_path, change, why):
    refused_once_changed(tmp_path / "proof.npz", blocks(**SLIDES), change, why)


def test_where_it_sticks_no_sliding_is_free(tmp_path):
    """A block that slid by a part of what it sticks with has more energy, by the friction: what it would have without it is not proved."""
    arrays = blocks(**STICKS)
    for of in ("vertices", "edges", "inside"):
        arrays[f"u_{of}"] = arrays[f"u_{of}"].copy()
    slid, whose = 1e-4, arrays["displacement_triangles"][arrays["displacement_bodies"] == 0]
    right = [e for e, row in enumerate(arrays["displacement_edges"]) if row[0] not in whose]
    arrays["u_vertices"][9:, 1] += slid  # the right block leaves its wall: its support is missed
    arrays["u_edges"][right, 1] += slid
    arrays["u_inside"][32:, 1] += slid
    with_scene(arrays, lambda text: text.replace('on = "wall", type = "clamped"', f'on = "wall", type = "clamped", displacement = [0.0, {slid}]'))
    arrays["manifest"]["claim"]["lower"] -= 1e-5
    refused(tmp_path / "proof.npz", arrays, lambda a: None, "upper bound .* is claimed, and only")
    arrays["manifest"]["claim"]["upper"] += 0.1 * slid
    write(arrays, tmp_path / "proof.npz")
    assert float(check(tmp_path).upper) == pytest.approx(1 + 0.2**2 / 8 + 0.1 * slid, abs=1e-12)


OBSTACLE = """
model = { kinematics = "plane-strain" }
bodies.block = { young = 1.0, poisson = 0.3 }
contacts = [{ on = "foot", friction = { bound = 0.1 }, obstacle = SHAPE, move = MOVE }]
"""


@pytest.mark.parametrize("shape, move, known", [
    ("{ line = [[-1, 0], [1, 0]] }", "[0.0, 0.1]", True),
    ("{ line = [[-1, 0], [1, 0.5]] }", "[-0.025, 0.1]", True),
    ("{ line = [[-1, 0], [1, 0]] }", "[1e-9, 0.1]", False),
    ("{ circle = { centre = [0, -5], radius = 5 } }", "[0.0, 0.1]", False),
    ("{ circle = { centre = [0, -5], radius = 5 } }", "[0.0, 0.0]", True),
])
def test_obstacles_that_move_along_themselves(shape, move, known):
    text = OBSTACLE.replace("SHAPE", shape).replace("MOVE", move).encode()
    if known:
        Scene(text)
    else:
        with pytest.raises(Refused, match="moves along itself"):
            Scene(text)


def test_bounds_along_the_arc_length():
    table = rows([[0.5, 0.0], [1.25, 0.75], [1.5, 0.25]])
    found = [float(at(table, fmpq(s, 8))) for s in (0, 4, 7, 10, 11, 12, 20)]
    assert found == [0.0, 0.0, 0.375, 0.75, 0.5, 0.25, 0.25]
    assert at(rows(0.25), fmpq(3)) == fmpq(1, 4) == at(rows([[1.0, 0.25]]), fmpq(0))


def bernstein(c, points):
    return sum(comb(len(c) - 1, i) * float(x) * points**i * (1 - points) ** (len(c) - 1 - i) for i, x in enumerate(c))


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_friction_within_its_limits_is_within_its_bound(count):
    """Whatever coefficients lie between the limits, and those of the bound itself are admissible where the degree can have it."""
    joint = Joint((0, 1), (0, 1), [[fmpq(0), fmpq(1)]], arb(1), [fmpq(0)], bound=[fmpq(1, 5), fmpq(1, 20)])
    points, limits = np.linspace(0, 1, 101), joint.limits(count)
    most = bernstein([0.2, 0.05], points)
    for signs in np.random.default_rng(count).integers(0, 2, (20, count)):
        assert (abs(bernstein([limits[i][k] for i, k in enumerate(signs)], points)) <= most + 1e-15).all()
    reached = bernstein([high for _, high in limits], points)
    assert np.allclose(reached, most if count > 1 else 0.05, atol=1e-15)


@pytest.mark.parametrize("b, weight, signs", [
    ([3, -7], [1, 2], 1),
    ([7, -12, 9], [1, 0], 2),
    ([1, -4, 5, -1], [2, 2], 3),
    ([-1, -2, 0], [1, 3], 0),
    ([0, 0], [1, 1], 0),
])
def test_integrals_of_absolute_values(b, weight, signs):
    """Never below the integral, and hardly above it: against sums at many points."""
    points = (np.arange(200_000) + 0.5) / 200_000
    value = lambda c: bernstein(c, points)
    assert (np.diff(np.sign(value(b))) != 0).sum() == signs
    exact = np.mean(value(weight) * abs(value(b)))
    found = float(absolute([fmpq(x) for x in b], [fmpq(x) for x in weight]))
    assert -1e-9 < found - exact < 1e-9
    coarse = float(absolute([fmpq(x) for x in b], [fmpq(x) for x in weight], depth=3))
    assert coarse > exact - 1e-9 and (signs == 0 or coarse > exact + 1e-4)
