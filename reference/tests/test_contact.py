"""The contact condition itself: published numbers, orderings, and admissibility at and between the nodes."""

import numpy as np
import pytest
from scenes import Builder, two_blocks

# 𝓛 of P2 with the contact condition at its nodes, and of P1, for n × n squares, computed by independent programs (P1 at
# n = 4 by trying every set of closed nodes, as in test_enumeration).
KNOWN = {
    2: (-1.7603297315, -1.2400025037),
    4: (-1.7919905590, -1.5804524473),
    8: (-1.7958503770, -1.7321463913),
    16: (-1.7963184852, -1.7792832036),
}
LOWER_BOUND = -1.7964189504


def jumps(data, result):
    """Per pair: jump at the two ends, at the midpoint (P2) and the gap at the ends."""
    u, m = np.array(result["vertex_displacement"]), result["edge_displacement"]
    for contact in data["contacts"]:
        for pair in contact["pairs"]:
            n = np.array(pair["normal"])
            first, second = u[pair["first"]], 0.0 if pair["second"] is None else u[pair["second"]]
            middle = None
            if m is not None:
                opposite = 0.0 if pair["second"] is None else np.array(m[pair["edges"][1]])
                middle = (np.array(m[pair["edges"][0]]) - opposite) @ n
            yield (first - second) @ n, middle, np.array(pair["gap"])


@pytest.mark.parametrize("n", KNOWN)
def test_known_energies(solve, n):
    p2, p1 = KNOWN[n]
    assert solve(two_blocks(n), 2, nodal_contact=True)["energy"] == pytest.approx(p2, abs=1e-9)
    assert solve(two_blocks(n), 1)["energy"] == pytest.approx(p1, abs=1e-9)


@pytest.mark.parametrize("n", (2, 4, 8))
def test_orderings(solve, n):
    nodal = solve(two_blocks(n), 2, nodal_contact=True)
    p2, p1 = solve(two_blocks(n), 2), solve(two_blocks(n), 1)
    assert nodal["energy"] <= p2["energy"] + 1e-12
    assert LOWER_BOUND < p2["energy"] < p1["energy"]
    assert p2["admissible"] and p1["admissible"] and not nodal["admissible"]


@pytest.mark.parametrize("degree", (1, 2))
@pytest.mark.parametrize("angle", (0.0, 0.4))
def test_energy_identity_on_a_cone(solve, degree, angle):
    """Without gap and prescribed displacement the admissible set is a cone, hence 𝓛(u) = −½ ∫ c e:e."""
    result = solve(two_blocks(8, angle=angle), degree)
    assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-11)


@pytest.mark.parametrize("degree", (1, 2))
@pytest.mark.parametrize("gap", (0.0, 0.05))
def test_no_penetration_anywhere(solve, degree, gap):
    data = two_blocks(8, gap=gap)
    result = solve(data, degree)
    open_somewhere = closed_somewhere = False
    for ends, middle, allowed in jumps(data, result):
        s = np.linspace(0.0, 1.0, 21)
        limit = (1 - s) * allowed[0] + s * allowed[1]
        jump = (1 - s) * ends[0] + s * ends[1]
        if degree == 2:
            jump += 4 * s * (1 - s) * (middle - ends.mean())
        assert np.all(jump <= limit + 1e-13)
        open_somewhere |= bool(np.any(jump < limit - 1e-3))
        closed_somewhere |= bool(np.any(np.abs(jump - limit) < 1e-13))
    assert open_somewhere and closed_somewhere


def test_nodal_contact_penetrates_between_nodes(solve):
    """The reason for the Bernstein condition; this suite is able to see the difference."""
    data = two_blocks(8)
    worst = 0.0
    for ends, middle, _ in jumps(data, solve(data, 2, nodal_contact=True)):
        s = np.linspace(0.0, 1.0, 101)
        jump = (1 - s) * ends[0] + s * ends[1] + 4 * s * (1 - s) * (middle - ends.mean())
        worst = max(worst, jump.max())
    assert worst > 1e-5


@pytest.mark.parametrize("degree", (1, 2))
def test_resultant_is_that_of_statics(solve, degree):
    for angle in (0.0, 0.5):
        result = solve(two_blocks(8, angle=angle, thickness=0.2), degree)
        exact = -0.1 * np.array([np.cos(angle), np.sin(angle)])
        assert result["contacts"][0]["resultant"] == pytest.approx(exact, abs=1e-12)
        assert min(result["contacts"][0]["vertex_reaction"]) >= 0.0


@pytest.mark.parametrize("degree", (1, 2))
def test_complementarity(solve, degree):
    """R · (g − jump) = 0 at every vertex."""
    data = two_blocks(8, gap=0.02)
    result = solve(data, degree)
    contact = result["contacts"][0]
    reaction = dict(zip(contact["vertices"], contact["vertex_reaction"]))
    active = 0
    for pair, (ends, _, gap) in zip(data["contacts"][0]["pairs"], jumps(data, result)):
        for vertex, jump, allowed in zip(pair["first"], ends, gap):
            assert reaction[vertex] * (allowed - jump) == pytest.approx(0.0, abs=1e-12)
            active += reaction[vertex] > 0.0
    assert 0 < active < 16


@pytest.mark.parametrize("degree", (1, 2))
def test_parabolic_gap(solve, degree):
    """A block held sideways only is pressed on a rigid parabola: contact in the middle, open outside, force exact."""
    b = Builder()
    n = 16
    sides = b.block(b.body("block"), n, n // 2, lambda s, t: (2.0 * s - 1.0, t))
    b.load(sides["top"], lambda x, y: (0.0, -0.05))
    b.contact(sides["bottom"], None, (0.0, -1.0), lambda x, y: 0.25 * x * x)
    b.pin(sides["top"][n // 2], (1.0, 0.0))
    result = solve(b.data, degree)
    contact = result["contacts"][0]
    assert contact["resultant"] == pytest.approx([0.0, 0.1], abs=1e-11)
    reaction = np.array(contact["vertex_reaction"])
    assert np.all(reaction[[0, 1, -2, -1]] == 0.0) and reaction[n // 2] > 0.0
    assert all(np.all(ends <= gap + 1e-13) for ends, _, gap in jumps(b.data, result))


@pytest.mark.parametrize("degree", (1, 2))
def test_nothing_happens_without_a_load(solve, degree):
    """The solver starts with the gap closed, and has to come back to exactly nothing."""
    data = two_blocks(4, load=0.0, gap=0.5)
    data["roller"] += [{"edge": t["edge"], "normal": [-1.0, 0.0]} for t in data["tractions"]]
    data["tractions"] = []
    result = solve(data, degree)
    assert np.array(result["vertex_displacement"]) == pytest.approx(0.0, abs=1e-13)
    assert result["contacts"][0]["resultant"] == [0.0, 0.0]


@pytest.mark.parametrize("sabotage", ("flip-sign", "drop-row"))
@pytest.mark.parametrize("degree", (1, 2))
def test_sabotage_shows(solve, degree, sabotage):
    right = solve(two_blocks(8), degree)
    wrong = solve(two_blocks(8), degree, sabotage=sabotage)
    assert abs(wrong["energy"] - right["energy"]) > 1e-4 * abs(right["energy"])
    if sabotage == "drop-row":
        assert max(ends.max() for ends, _, _ in jumps(two_blocks(8), wrong)) > 1e-3
