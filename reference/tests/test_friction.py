"""Friction with a given bound: closed answers, limits, statics, and every state of a coarse mesh tried in turn."""

import json
import math
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypercircle_process import BadExchange, Failure
from scenes import Builder, rotated, rub, two_blocks
from test_enumeration import dense_model

DEGREES = (1, 2, 3)


def sheared(slide, bound, angle=0.0, thickness=1.0, poisson=0.3):
    """A unit block on another, the upper moved by ``slide`` at its top, the lower clamped below; sides loaded so that shear is uniform."""
    b = Builder(thickness=thickness)
    point, vector = rotated(angle, (0.3, -0.2))
    shear = 1.0 / (2.0 * (1.0 + poisson))
    stress = min(0.5 * shear * abs(slide), bound) * math.copysign(1.0, slide)
    lower = b.block(b.body("lower", poisson=poisson), 4, 3, lambda s, t: point(s, t - 1.0))
    upper = b.block(b.body("upper", poisson=poisson), 4, 3, lambda s, t: point(s, t))
    b.clamp(lower["bottom"])
    b.clamp(upper["top"], vector(slide, 0.0))
    for block in (lower, upper):
        b.load(block["left"], lambda x, y: vector(0.0, -stress))
        b.load(block["right"], lambda x, y: vector(0.0, stress))
    b.contact(upper["bottom"], lower["top"], vector(0.0, -1.0))
    b.friction(lambda x, y: bound)
    return b.data, stress, shear


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("slide", (0.1, 0.3, -0.3))
@pytest.mark.parametrize("angle", (0.0, 0.6))
def test_uniform_shear_sticks_or_slips(solve, degree, slide, angle):
    """Below the bound the blocks are one; beyond it the shear is the bound and the rest of the way is slid, either way."""
    bound, thickness = 0.05, 0.5
    data, stress, shear = sheared(slide, bound, angle, thickness)
    result = solve(data, degree)
    slid = abs(slide) - 2.0 * abs(stress) / shear
    energy = thickness * (stress**2 / shear + bound * max(slid, 0.0))
    assert result["energy"] == pytest.approx(energy, rel=1e-11)
    assert result["friction_work"] == pytest.approx(thickness * bound * max(slid, 0.0), abs=1e-14)
    contact = result["contacts"][0]
    # The lower block holds the upper one back.
    force = rotated(angle)[1](-stress * thickness, 0.0)
    assert contact["resultant"] == pytest.approx(force, abs=1e-12)
    total = sum(contact["vertex_friction"]) + sum(map(sum, contact["edge_friction"] or []))
    first = data["contacts"][0]["pairs"][0]["friction"]["tangent"][0]
    assert total * np.array(first) == pytest.approx(force, abs=1e-12)
    u = np.array(result["vertex_displacement"])
    pair = data["contacts"][0]["pairs"][1]
    jump = (u[pair["first"][0]] - u[pair["second"][0]]) @ rotated(angle)[1](1.0, 0.0)
    assert jump == pytest.approx(math.copysign(max(slid, 0.0), slide), abs=1e-12)


def pulled_strip(pull, bound, length=2.0, height=0.1, n=16):
    """A strip so stiff across that its sections stay upright, on a rigid floor, pulled at x = 0."""
    b = Builder("plane-stress")
    sides = b.block(b.body("strip"), n, 1, lambda s, t: (length * s, height * t))
    b.data["bodies"][0] = {
        "name": "strip", "body_force": [0.0, 0.0], "stiffness": [[1.0, 0.0, 0.0], [0.0, 1e6, 0.0], [0.0, 0.0, 1e7]],
    }  # fmt: skip
    b.load(sides["left"], lambda x, y: (-pull, 0.0))
    b.load(sides["top"], lambda x, y: (0.0, -0.01))
    b.contact(sides["bottom"], None, (0.0, -1.0))
    b.friction(lambda x, y: bound)
    return b.data


def test_strip_held_by_friction_and_pulled(solve):
    """E u'' h = τ̄ where it slips, over a length h P/τ̄: 𝓛 = −τ̄² l³/(6 E h), and the end moves by τ̄ l²/(2 E h)."""
    pull, bound, height = 0.1, 0.01, 0.1
    slipped = height * pull / bound
    result = solve(pulled_strip(pull, bound), 2)
    assert result["energy"] == pytest.approx(-(bound**2) * slipped**3 / (6.0 * height), rel=1e-5)
    assert result["vertex_displacement"][0][0] == pytest.approx(-bound * slipped**2 / (2.0 * height), rel=1e-5)
    u = np.array(result["vertex_displacement"])[:17, 0]
    assert np.all(u[9:] == 0.0) and np.all(u[:8] < 0.0)
    contact = result["contacts"][0]
    assert contact["resultant"] == pytest.approx([height * pull, 2.0 * 0.01], rel=1e-6)


def pressed(bound, angle=0.0, young=1.0, n=6):
    """Two blocks with a load from the left that tilts, pushed down too: parts stick, parts slip, parts open."""
    data = two_blocks(n, lambda y: 1.2 - y, angle=angle)
    data["roller"] = []
    data["bodies"][0]["young"] = young
    _, vector = rotated(angle)
    for traction in data["tractions"]:
        traction["values"] = [[a + b for a, b in zip(value, vector(0.0, -0.15))] for value in traction["values"]]
    for pair in data["contacts"][0]["pairs"]:
        rub(pair, data["points"], bound if callable(bound) else lambda x, y: bound)
    return data


@pytest.mark.parametrize("degree", DEGREES)
def test_more_than_friction_can_hold_is_a_failure(solve, degree):
    """Nothing but friction keeps the pressed block up: 0.15 pulls it down."""
    assert solve(pressed(0.151), degree)["contacts"][0]["resultant"] == pytest.approx([-0.7, 0.15], abs=1e-10)
    with pytest.raises(Failure, match="neither supports nor contacts hold the bodies"):
        solve(pressed(0.149), degree)


def supported(data):
    """With the roller below, so that nothing depends on friction alone."""
    return {**data, "roller": two_blocks(len(data["contacts"][0]["pairs"]))["roller"]}


@pytest.mark.parametrize("degree", DEGREES)
def test_no_bound_is_no_friction(solve, degree):
    data = supported(pressed(0.0))
    none = json.loads(json.dumps(data))
    for pair in none["contacts"][0]["pairs"]:
        del pair["friction"]
    assert solve(data, degree)["energy"] == solve(none, degree)["energy"]


@pytest.mark.parametrize("degree", DEGREES)
def test_a_bound_that_is_never_reached_is_a_rough_contact(solve, degree):
    """A block pressed on a rigid floor and pushed: with friction enough it is one that is clamped there."""
    b = Builder()
    sides = b.block(b.body("block"), 4, 4, lambda s, t: (s, t))
    b.load(sides["top"], lambda x, y: (0.1, -1.0))
    b.contact(sides["bottom"], None, (0.0, -1.0))
    b.friction(lambda x, y: 1e6)
    rough = solve(b.data, degree)
    b.data["contacts"] = []
    b.clamp(sides["bottom"])
    assert rough["energy"] == pytest.approx(solve(b.data, degree)["energy"], rel=1e-11)
    assert rough["friction_work"] == 0.0


@pytest.mark.parametrize("degree", DEGREES)
def test_energy_grows_with_the_bound(solve, degree):
    bounds = (0.0, 1e-6, 0.01, 0.05, 0.1, 0.2, 0.5, 2.0, 1e3, 1e9)
    energies = [solve(supported(pressed(bound)), degree)["energy"] for bound in bounds]
    assert np.all(np.diff(energies) >= -1e-13)
    assert energies[5] > energies[0] + 1e-4 and energies[-1] > energies[2] + 1e-4


@pytest.mark.parametrize("degree", DEGREES)
def test_forces_obey_the_law(solve, degree):
    """|R_t| is at most ∫ τ̄ B, and that against the slip; without gap and motion of supports 𝓛 = −½ ∫ c e:e − 0."""
    bound = lambda x, y: 0.16 + 0.05 * y
    data = pressed(bound)
    result = solve(data, degree)
    contact, k = result["contacts"][0], degree
    # ½ a(u, u) + j(u) − L(u) at the minimum: a(u, u) + j(u) = L(u).
    assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-10)
    assert result["friction_work"] > 0.0
    u = np.array(result["vertex_displacement"])
    place = {v: i for i, v in enumerate(contact["vertices"])}
    most = np.zeros(len(place))
    opposite = {}
    for pair in data["contacts"][0]["pairs"]:
        (a, b), length = pair["friction"]["bound"], pair["friction"]["length"]
        near, far = 1.0 / (k + 1) - 1.0 / ((k + 1) * (k + 2)), 1.0 / ((k + 1) * (k + 2))
        most[place[pair["first"][0]]] += length * (near * a + far * b)
        most[place[pair["first"][1]]] += length * (near * b + far * a)
        opposite.update(zip(pair["first"], pair["second"]))
    tangent = np.array(data["contacts"][0]["pairs"][0]["friction"]["tangent"][0])
    slips = sticks = 0
    for vertex, limit, force in zip(contact["vertices"], most, contact["vertex_friction"]):
        jump = (u[vertex] - u[opposite[vertex]]) @ tangent
        assert abs(force) <= limit * (1.0 + 1e-12)
        if jump != 0.0:
            assert force == pytest.approx(-math.copysign(limit, jump), rel=1e-9)
            slips += 1
        else:
            sticks += abs(force) < 0.999 * limit
    assert slips > 0 and sticks > 0
    assert contact["resultant"] == pytest.approx([-0.7, 0.15], abs=1e-11)


@pytest.mark.parametrize("degree", DEGREES)
def test_rotation_and_the_softer_side_change_nothing(solve, degree):
    for young in (1.0, 30.0):
        straight, turned = solve(pressed(0.18, young=young), degree), solve(pressed(0.18, 0.7, young), degree)
        assert turned["energy"] == pytest.approx(straight["energy"], rel=1e-11)
        assert turned["friction_work"] == pytest.approx(straight["friction_work"], rel=1e-8)


@pytest.mark.parametrize("degree", DEGREES)
def test_corner_of_a_contact_line(solve, degree):
    """A block in a rigid corner, pressed out of uniform stress by friction on one of its two sides; statics has the force."""
    b = Builder("plane-stress")
    block = b.block(b.body("block", 1.0, 0.25), 3, 3, lambda s, t: (s, t))
    b.load(block["right"], lambda x, y: (-0.2, -0.02))
    b.load(block["top"], lambda x, y: (0.03, -0.1))
    b.contact(block["left"][::-1], None, (-1.0, 0.0))
    b.contact(block["bottom"], None, (0.0, -1.0))
    corner, floor = b.data["contacts"][0], b.data["contacts"].pop()
    corner["pairs"] += floor["pairs"]
    b.friction(lambda x, y: 0.01)
    rubbed = solve(b.data, degree)
    assert rubbed["contacts"][0]["resultant"] == pytest.approx([0.17, 0.12], abs=1e-11)
    assert rubbed["energy"] == pytest.approx(-rubbed["strain_energy"], rel=1e-10)
    for pair in b.data["contacts"][0]["pairs"]:
        del pair["friction"]
    assert rubbed["energy"] > solve(b.data, degree)["energy"] + 1e-6


def enumerated(data, bound):
    """P1 by a dense model: every vertex closed or open, and sticking or slipping either way; the one state that holds."""
    stiffness, load = dense_model(data)
    held = [2 * v + c for support in data["clamped"] for v in data["edges"][support["edge"]] for c in range(2)]
    pairs = sorted({ends for pair in data["contacts"][0]["pairs"] for ends in zip(pair["first"], pair["second"])})
    jump, slide = np.zeros((2, len(pairs), len(load)))
    heights = np.array([data["points"][first][1] for first, _ in pairs])
    for row, (first, second) in enumerate(pairs):
        jump[row, [2 * first, 2 * second]] = slide[row, [2 * first + 1, 2 * second + 1]] = 1.0, -1.0
    share = np.where((heights < 1e-9) | (heights > 1.0 - 1e-9), 0.5, 1.0) * bound / (len(pairs) - 1)
    free = np.setdiff1d(np.arange(len(load)), held)
    stiffness, load, jump, slide = stiffness[np.ix_(free, free)], load[free], jump[:, free], slide[:, free]
    found = []
    for closed in product((False, True), repeat=len(pairs)):
        for slips in product((-1, 0, 1), repeat=len(pairs)):
            slips = np.array(slips)
            rows = np.vstack([jump[np.array(closed)], slide[slips == 0]])
            system = np.block([[stiffness, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
            right = np.concatenate([load - slide.T @ (share * slips), np.zeros(len(rows))])
            if np.linalg.matrix_rank(system) < len(system):
                continue
            u, reaction = np.split(np.linalg.solve(system, right), [len(load)])
            normal, tangential = np.split(reaction, [sum(closed)])
            kept = np.all(np.abs(tangential) <= share[slips == 0] + 1e-12) and np.all(normal > -1e-12)
            if kept and np.all(jump @ u < 1e-12) and np.all((slide @ u)[slips != 0] * slips[slips != 0] > -1e-12):
                found.append(0.5 * u @ stiffness @ u - load @ u + share @ np.abs(slide @ u))
    return found


@pytest.mark.parametrize("bound", (0.16, 0.2, 0.4))
def test_energy_is_that_of_the_state_found_by_trying_all(solve, bound):
    data = pressed(bound, n=2)
    found = enumerated(data, bound)
    assert found and np.ptp(found) < 1e-11
    assert solve(data, 1)["energy"] == pytest.approx(found[0], rel=1e-10)


def test_quadrilaterals_and_triangles_agree(solve):
    """Both approach the same energy from above, the finer spaces from nearer."""
    data = pressed(0.18)
    q1, q2, p2 = solve(data, 1, "Q")["energy"], solve(data, 2, "Q")["energy"], solve(data, 2)["energy"]
    assert q2 < q1 and abs(q2 - p2) < 0.1 * (q1 - q2)


@pytest.mark.parametrize("turns", (False, True))
def test_two_ranks_find_the_same(solve, mpirun, tmp_path, turns):
    data = rings(12, -0.2, 0.015) if turns else pressed(0.18)
    (tmp_path / "problem.json").write_text(json.dumps(data))
    command = (sys.executable, "-m", "hypercircle_reference", "problem.json", "--out", ".", "--degree", "2")
    here = Path(__file__).parent.parent
    subprocess.run((*mpirun, *command), cwd=tmp_path, check=True, env={**__import__("os").environ, "PYTHONPATH": str(here)})
    shared, alone = json.loads((tmp_path / "primal-P2.json").read_text()), solve(data, 2)
    assert shared["ranks"] == 2
    assert shared["energy"] == pytest.approx(alone["energy"], rel=1e-11)
    assert shared["contacts"][0]["vertex_friction"] == pytest.approx(alone["contacts"][0]["vertex_friction"], abs=1e-10)


def test_what_is_not_modelled_is_refused(solve):
    data = pressed(0.18)
    with pytest.raises(BadExchange, match="nodes only"):
        solve(data, 2, nodal_contact=True)


def rings(n, turned, bound, quarter=0.5 * math.pi):
    """A ring in another one, n edges around: the outer one clamped at radius 3, the inner one turned at radius 1, in contact at 2."""
    b = Builder()

    def ring(body, low, high, layers=3):
        base = len(b.data["points"])
        for j in range(layers + 1):
            r = low + (high - low) * j / layers
            b.data["points"] += [[r * math.cos(4 * quarter * i / n), r * math.sin(4 * quarter * i / n)] for i in range(n)]
        at = lambda i, j: base + j * n + i % n
        for j in range(layers):
            for i in range(n):
                p, q, r, s = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
                for corners in [(p, r, q), (p, s, r)]:
                    b.triangle(body, corners)
        return [[at(i, j) for i in range(n + 1)] for j in (0, layers)]

    inner, outer = ring(b.body("inner"), 1.0, 2.0), ring(b.body("outer"), 2.0, 3.0)
    b.clamp(outer[1])
    for e in b.edges_of(inner[0]):
        ends = [b.data["points"][v] for v in b.data["edges"][e]]
        b.data["clamped"].append({"edge": e, "displacement": [[-turned * y, turned * x] for x, y in ends]})
    b.contact(inner[1], outer[0], (1.0, 0.0))
    for pair in b.data["contacts"][0]["pairs"]:
        normals = np.array([b.data["points"][v] for v in pair["first"]]) / 2.0
        middle = normals.sum(axis=0)
        pair["direction"] = normals.tolist()
        pair["normal"] = (middle / np.linalg.norm(middle)).tolist()
        rub(pair, b.data["points"], lambda x, y: bound)
    return b.data


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("turned", (0.05, -0.2))
def test_a_ring_turns_in_another_one(solve, degree, turned):
    """Shear T/(2π r²); beyond the bound at r = 2 the ring slides, which a direction that turns lets it do."""
    bound, shear = 0.015, 1.0 / 2.6
    torque = abs(turned) * 4.0 * math.pi * shear / (1.0 - 1.0 / 9.0)
    most = 2.0 * math.pi * 4.0 * bound
    held = min(torque, most)
    slid = abs(turned) * (1.0 - held / torque)
    exact = 0.5 * held * (abs(turned) - slid) + held * slid
    errors = []
    for n in (12, 24):
        result = solve(rings(n, turned, bound), degree)
        errors.append(abs(result["energy"] / exact - 1.0))
        assert (result["friction_work"] > 1e-12) == (torque > most)
        force = np.array(result["contacts"][0]["vertex_friction"])
        assert np.ptp(force) < 1e-9 and force[0] * turned < 0.0
    # The rest of the error is from the polygon in the place of the circle, and the shear of 1/r² in three layers.
    assert errors[1] < (0.08 if degree == 1 else 0.02) and errors[1] < 0.55 * errors[0], errors


@pytest.mark.parametrize("degree", (2, 3))
def test_coupled_friction_obeys_its_law(solve, degree):
    """Where the direction turns, too: work that is Σ c |d|, the balance of work, and a resultant of statics; the same on any unknowns."""
    b = Builder()
    lower = b.block(b.body("lower"), 5, 3, lambda s, t: (s, t - 1.0))
    upper = b.block(b.body("upper", 3.0), 5, 3, lambda s, t: (s, t))
    b.clamp(lower["bottom"])
    b.load(upper["top"], lambda x, y: (0.09, -0.3 + 0.2 * x))
    b.contact(upper["bottom"], lower["top"], (0.0, -1.0))
    energies = []
    for pair in b.data["contacts"][0]["pairs"]:
        angles = [0.3 * (b.data["points"][v][0] - 0.5) for v in pair["first"]]
        pair["direction"] = [[math.sin(a), -math.cos(a)] for a in angles]
        rub(pair, b.data["points"], lambda x, y: 0.12)
    for softer in (1.0, 9.0):
        b.data["bodies"][0]["young"] = softer
        result = solve(b.data, degree)
        assert result["energy"] == pytest.approx(-result["strain_energy"], rel=1e-9)
        assert result["contacts"][0]["resultant"] == pytest.approx([-0.09, 0.2], rel=1e-9)
        assert result["friction_work"] > 0.0
        energies.append(result["energy"])
    assert energies[1] > energies[0]
