"""Coulomb friction of the displacement model itself: statics, and the law at every coefficient of the jump."""

import math

import numpy as np
import pytest
from hypercircle_process import BadExchange
from scenes import Builder

DEGREES = (1, 2, 3)


def wedge(mu, down=0.01, angle=20.0, n=4):
    """A wedge with faces at ``angle`` degrees to the vertical in a rigid groove; with the force across its top."""
    alpha = math.radians(angle)
    half = 0.3 + math.tan(alpha)
    b = Builder()
    sides = b.block(b.body("wedge"), n, n, lambda s, t: ((2.0 * s - 1.0) * (0.3 + t * math.tan(alpha)), t))
    b.load(sides["top"], lambda x, y: (0.0, -down))
    b.contact(sides["left"], None, (-math.cos(alpha), -math.sin(alpha)))
    b.contact(sides["right"], None, (math.cos(alpha), -math.sin(alpha)))
    for index, contact in enumerate(b.data["contacts"]):
        b.friction(lambda x, y: 0.01 * mu, index)
        contact["coefficient"] = mu
    return b.data, 2.0 * half * down


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("mu", (0.2, 0.5))
def test_a_wedge_presses_as_statics_says(solve, degree, mu):
    """It slides along both faces: 2 N (sin α + μ cos α) = P."""
    data, load = wedge(mu)
    own = solve(data, degree)["coulomb"]
    alpha = math.radians(20.0)
    normal = load / (2.0 * (math.sin(alpha) + mu * math.cos(alpha)))
    assert own["converged"]
    for contact in own["contacts"]:
        assert contact["pressure"] == pytest.approx(normal, rel=1e-7)
        assert abs(contact["friction"]) == pytest.approx(mu * normal, rel=1e-7)


@pytest.mark.parametrize("degree", DEGREES)
def test_limits_that_are_given_and_go_with_the_reactions_are_kept(solve, degree):
    """A load that turns no face leaves uniform pressures: with the bound μ p the first solution is the last one."""
    mu, pressure, push = 0.4, 0.1, 0.03
    b = Builder()
    sides = b.block(b.body("block", poisson=0.0), 4, 2, lambda s, t: (2.0 * s, t))
    b.load(sides["top"], lambda x, y: (push, -pressure))
    b.load(sides["left"], lambda x, y: (0.0, -push))
    b.load(sides["right"], lambda x, y: (0.0, push))
    b.contact(sides["bottom"], None, (0.0, -1.0))
    b.friction(lambda x, y: mu * pressure)
    b.data["contacts"][0]["coefficient"] = mu
    result = solve(b.data, degree)
    own = result["coulomb"]
    assert own["iterations"] == 1 and own["energy"] == pytest.approx(result["energy"], rel=1e-12)
    assert own["contacts"][0]["pressure"] == pytest.approx(2.0 * pressure)
    assert own["contacts"][0]["friction"] == pytest.approx(-2.0 * push)
    assert np.isfinite(own["change"])


def test_every_pair_of_a_contact_with_a_coefficient_has_friction(solve):
    data, _ = wedge(0.2)
    del data["contacts"][1]["pairs"][2]["friction"]
    with pytest.raises(BadExchange, match=r"contacts\[1\].pairs\[2\] has no friction"):
        solve(data, 1)


def test_without_a_coefficient_there_is_nothing_of_its_own(solve):
    data, _ = wedge(0.2)
    for contact in data["contacts"]:
        del contact["coefficient"]
    assert "coulomb" not in solve(data, 1)
