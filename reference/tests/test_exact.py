"""Solutions known in closed form, or by the laws of mechanics."""

import math

import numpy as np
import pytest
from hypercircle_process import Failure
from scenes import Builder, rotated, two_blocks

DEGREES = (1, 2, 3, 4)


def displacement(result):
    return np.array(result["vertex_displacement"])


def effective(young, poisson, kinematics):
    """Plane modulus and Poisson's ratio: plane strain is plane stress with E/(1 − ν²) and ν/(1 − ν)."""
    return (young, poisson) if kinematics == "plane-stress" else (young / (1 - poisson**2), poisson / (1 - poisson))


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("kinematics", ("plane-strain", "plane-stress"))
@pytest.mark.parametrize("angle", (0.0, 0.7))
def test_uniaxial_pressure_through_two_blocks(solve, degree, kinematics, angle):
    """Constant stress passes a closed contact unchanged, on rollers of any inclination."""
    young, poisson, pressure, thickness = 3.0, 0.35, 0.4, 0.25
    b = Builder(kinematics, thickness)
    point, vector = rotated(angle, (2.0, -1.0))
    materials = [b.body(name, young, poisson) for name in ("left", "right")]
    one = b.block(materials[0], 3, 2, lambda s, t: point(s, t))
    two = b.block(materials[1], 2, 2, lambda s, t: point(1.0 + s, t))
    b.roller(one["bottom"], vector(0.0, -1.0))
    b.roller(two["bottom"], vector(0.0, -1.0))
    b.roller(two["right"], vector(1.0, 0.0))
    b.load(one["left"], lambda x, y: vector(pressure, 0.0))
    b.contact(one["right"], two["left"], vector(1.0, 0.0))
    result = solve(b.data, degree)

    modulus, ratio = effective(young, poisson, kinematics)
    strain = -pressure / modulus
    local = np.array([rotated(-angle)[1](x - 2.0, y + 1.0) for x, y in b.data["points"]])
    exact = np.array([vector(strain * (x - 2.0), -ratio * strain * y) for x, y in local])
    assert displacement(result) == pytest.approx(exact, abs=1e-12)
    assert result["energy"] == pytest.approx(-0.5 * pressure**2 / modulus * 2.0 * thickness, rel=1e-12)
    assert result["contacts"][0]["resultant"] == pytest.approx(vector(-pressure * thickness, 0.0), abs=1e-12)
    assert min(result["contacts"][0]["vertex_reaction"]) > 0.0


@pytest.mark.parametrize("kinematics", ("plane-strain", "plane-stress"))
def test_pure_bending_is_quadratic(solve, kinematics):
    """σ_xx = −c y in a cantilever: the displacement is quadratic, so that P2 has it exactly."""
    young, poisson, c = 2.0, 0.3, 0.5
    b = Builder(kinematics)
    sides = b.block(b.body("beam", young, poisson), 4, 4, lambda s, t: (3.0 * s, t - 0.5))
    b.roller(sides["left"], (-1.0, 0.0))
    b.pin(sides["left"][2], (0.0, 1.0))
    b.load(sides["right"], lambda x, y: (-c * y, 0.0))
    result = solve(b.data, 2)
    round_off = 5e4 * 2.2e-16  # condition number of the scaled stiffness (computed: 4.9e4) times the unit round-off
    modulus, ratio = effective(young, poisson, kinematics)
    x, y = np.array(b.data["points"]).T
    exact = c / modulus * np.stack([-x * y, 0.5 * x**2 + 0.5 * ratio * y**2], axis=1)
    assert displacement(result) == pytest.approx(exact, abs=round_off)
    middle = 0.5 * (np.array(b.data["points"])[np.array(b.data["edges"])].sum(axis=1))
    x, y = middle.T
    exact = c / modulus * np.stack([-x * y, 0.5 * x**2 + 0.5 * ratio * y**2], axis=1)
    assert np.array(result["edge_displacement"]) == pytest.approx(exact, abs=round_off)
    assert result["energy"] == pytest.approx(-0.5 * c**2 / modulus * 3.0 / 12.0, rel=1e-12)


def test_own_weight_is_quadratic(solve):
    """A column under its own weight between smooth walls: u_y = −ρ (H y − y²/2) / M, M the constrained modulus."""
    young, poisson, weight, height = 5.0, 0.2, 0.3, 2.0
    b = Builder(thickness=0.5)
    sides = b.block(b.body("column", young, poisson, (0.0, -weight)), 2, 4, lambda s, t: (s, height * t))
    b.roller(sides["left"], (-1.0, 0.0))
    b.roller(sides["right"], (1.0, 0.0))
    b.clamp(sides["bottom"])
    result = solve(b.data, 2)
    modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    y = np.array(b.data["points"])[:, 1]
    assert displacement(result)[:, 1] == pytest.approx(-weight / modulus * (height * y - 0.5 * y**2), abs=1e-12)
    assert result["energy"] == pytest.approx(-0.5 * (weight**2) * height**3 / (3 * modulus) * 0.5, rel=1e-12)


@pytest.mark.parametrize("degree", DEGREES)
def test_prescribed_displacement(solve, degree):
    """Pressing a block between two plates that move: uniform strain, work of the plates in the energy."""
    b = Builder("plane-stress")
    sides = b.block(b.body("block", 2.0, 0.0), 3, 3, lambda s, t: (s, t))
    b.clamp(sides["bottom"])
    b.clamp(sides["top"], (0.0, -0.1))
    result = solve(b.data, degree)
    assert displacement(result)[:, 1] == pytest.approx(-0.1 * np.array(b.data["points"])[:, 1], abs=1e-13)
    assert result["energy"] == pytest.approx(0.5 * 2.0 * 0.01, rel=1e-12)


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("rigid", (False, True))
def test_gap_closes_before_force_passes(solve, degree, rigid):
    """A plate drives a block of ν = 0 by 0.3 across a gap of 0.1 onto a second block, or onto a rigid wall."""
    b = Builder("plane-stress", thickness=2.0)
    one = b.block(b.body("one", 1.0, 0.0), 2, 2, lambda s, t: (s, t))
    b.clamp(one["left"], (0.3, 0.0))
    opposite = None
    if not rigid:
        two = b.block(b.body("two", 1.0, 0.0), 2, 2, lambda s, t: (1.0 + s, t))
        b.clamp(two["right"])
        opposite = two["left"]
    b.contact(one["right"], opposite, (1.0, 0.0), lambda x, y: 0.1)
    result = solve(b.data, degree)
    stress = 0.2 if rigid else 0.1
    assert result["contacts"][0]["resultant"] == pytest.approx([-2.0 * stress, 0.0], abs=1e-12)
    assert result["energy"] == pytest.approx(2.0 * 0.5 * stress**2 * (1 if rigid else 2), rel=1e-11)


@pytest.mark.parametrize("degree", DEGREES)
def test_open_contact_carries_nothing(solve, degree):
    b = Builder()
    one = b.block(b.body("one"), 2, 2, lambda s, t: (s, t))
    b.clamp(one["left"])
    b.load(one["right"], lambda x, y: (0.1, 0.0))
    b.contact(one["top"], None, (0.0, 1.0), lambda x, y: 0.5)
    closed = solve(b.data, degree)
    b.data["contacts"] = []
    assert closed["energy"] == pytest.approx(solve(b.data, degree)["energy"], rel=1e-12)
    assert closed["contacts"][0]["resultant"] == pytest.approx([0.0, 0.0], abs=0.0)


@pytest.mark.parametrize("degree", DEGREES)
def test_resting_block_is_pinned_and_in_balance(solve, degree):
    """A block that only contact and a pin hold passes its weight and load on, at the place statics says."""
    b = Builder(thickness=0.5)
    lower = b.block(b.body("lower"), 4, 2, lambda s, t: (2.0 * s, t))
    upper = b.block(b.body("upper", body_force=(0.0, -1.0)), 2, 2, lambda s, t: (0.5 + s, 1.0 + t))
    b.clamp(lower["bottom"])
    b.load(upper["top"], lambda x, y: (0.0, -(x - 0.5)))
    b.contact(lower["top"][1:4], upper["bottom"], (0.0, 1.0))
    b.pin(upper["bottom"][1], (1.0, 0.0))
    result = solve(b.data, degree)
    contact = result["contacts"][0]
    assert contact["resultant"] == pytest.approx([0.0, -0.5 * 1.5], rel=1e-10, abs=1e-12)
    x = np.array(b.data["points"])[contact["vertices"], 0]
    moment = x @ contact["vertex_reaction"]
    if degree > 1:
        # b_j multiplies the Bernstein polynomial B_j, whose first moment is that of the point j/k of the edge.
        s = np.arange(1, degree) / degree
        moment += np.sum((x[:-1, None] * (1.0 - s) + x[1:, None] * s) * contact["edge_reaction"])
    assert moment == pytest.approx(0.5 * (1.0 * 1.0 + (1.0 / 3.0 + 0.5 * 0.5)), rel=1e-9)


@pytest.mark.parametrize("degree", DEGREES)
def test_units_do_not_matter(solve, degree):
    """Lengths in units of 1e-9 or 1e6, moduli of 1e11: the same dimensionless energy and the same steps."""
    reference = solve(two_blocks(8), degree)
    for length, young in ((1e-9, 1.0), (1e6, 2.1e11), (1.0, 1e-6)):
        data = two_blocks(8)
        data["points"] = [[length * x, length * y] for x, y in data["points"]]
        for body in data["bodies"]:
            body["young"] = young
        for traction in data["tractions"]:
            traction["values"] = [[young * 1e-3 * p for p in value] for value in traction["values"]]
        result = solve(data, degree)
        assert result["energy"] / (length**2 * young * 1e-6) == pytest.approx(reference["energy"], rel=1e-9)
        assert result["iterations"] == reference["iterations"]


def test_incompressible_limit_and_stiff_against_soft(solve):
    """Extreme materials still end in a checked solution with the contact force of statics."""
    for poisson, ratio in ((0.499999, 1.0), (0.3, 1e8), (0.3, 1e-6)):
        data = two_blocks(8)
        data["bodies"][0]["poisson"] = data["bodies"][1]["poisson"] = poisson
        data["bodies"][1]["young"] = ratio
        result = solve(data, 2)
        assert result["contacts"][0]["resultant"] == pytest.approx([-0.5, 0.0], abs=1e-7)


@pytest.mark.parametrize("ratio", (1e4, 1e8))
def test_stiff_support_of_a_soft_block(solve, ratio):
    """Whichever side is named first: the contact force is that of statics to all digits, the energies are equal."""
    energies = []
    for stiff_first in (True, False):
        b = Builder()
        stiff = b.block(b.body("stiff", ratio), 8, 8, lambda s, t: (s, t))
        soft = b.block(b.body("soft", 1.0), 8, 8, lambda s, t: (1.0 + s, t))
        b.clamp(stiff["left"])
        b.roller(soft["bottom"], (0.0, -1.0))
        b.load(soft["right"], lambda x, y: (7.0 * y - 4.0, 0.0))
        sides = (stiff["right"], soft["left"]) if stiff_first else (soft["left"], stiff["right"])
        sign = 1.0 if stiff_first else -1.0
        b.contact(*sides, (sign, 0.0))
        result = solve(b.data, 2)
        assert result["contacts"][0]["resultant"] == pytest.approx([-0.5 * sign, 0.0], abs=1e-12)
        assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-11)
        energies.append(result["energy"])
    assert energies[0] == pytest.approx(energies[1], rel=1e-12)


def test_stiff_block_carried_by_a_soft_one(solve):
    """Its rigid motion leaves few digits to its strain: six digits of the force are required, or a refusal."""
    data = two_blocks(8)
    data["bodies"][0]["young"] = 1e6
    assert solve(data, 2)["contacts"][0]["resultant"] == pytest.approx([-0.5, 0.0], abs=0.5e-6)
    data["bodies"][0]["young"] = 1e12
    with pytest.raises(Failure, match="rounding hides it"):
        solve(data, 2)


def test_rotation_changes_nothing(solve):
    straight, turned = solve(two_blocks(8), 2), solve(two_blocks(8, angle=math.radians(33.0)), 2)
    assert turned["energy"] == pytest.approx(straight["energy"], rel=1e-11)
    assert turned["iterations"] == straight["iterations"]
