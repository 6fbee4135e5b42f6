"""Proofs that hypercircle makes: scenes of all kinds are proved, as they were claimed. HYPERCIRCLE names the program."""

import json
import os
import re
import subprocess
from pathlib import Path

import pytest
from by_hand import in_scene, refused, with_scene
from hypercircle_check.main import check, main, read

ROOT = Path(__file__).parents[2]
PROGRAM = Path(os.environ.get("HYPERCIRCLE") or ROOT / "target/debug/hypercircle")
RUNS = [
    ("cases/two_blocks", []),
    ("cases/gravity", []),
    ("cases/inclined", ["--degree", "2"]),
    ("cases/gap", ["--degree", "3"]),
    ("cases/pin", []),
    ("cases/cylinder_on_block", []),
    ("cases/seal", []),
    ("cases/quadrilaterals", []),
    ("cases/sliding", ["--tolerance", "0.02"]),
    ("cases/laminate", []),
    ("cases/bimetal", ["--degree", "2"]),
    ("cases/springs", []),
    ("cases/bonded", ["--degree", "3"]),
    ("cases/crack", []),
    ("cases/elastic_contact", ["--degree", "2"]),
    ("cases/compacted", []),
    ("cases/rotor", []),
    ("checker/tests/every_law", []),
    ("checker/tests/every_law", ["--tolerance", "0.01"]),
    ("cases/pushed_partly", []),
    ("cases/pushed_partly", ["--degree", "2", "--tolerance", "0.02"]),
    ("cases/pushed_slides", ["--degree", "3"]),
    ("cases/pushed_sticks", ["--degree", "2"]),
    ("cases/pulled_strip", []),
    ("cases/sheared_contact", ["--degree", "3"]),
    ("tests/scenes/held_by_friction", ["--tolerance", "0.05", "--adapt", "hp"]),
    ("tests/scenes/dragged_off_by_friction", []),
    ("checker/tests/rubbing_arc", []),
    ("checker/tests/rubbing_arc", ["--degree", "2"]),
    ("checker/tests/rubbing_arc", ["--degree", "3", "--adapt", "hp", "--tolerance", "0.05"]),
    ("tests/scenes/standing_turned", []),
    ("tests/scenes/moved_rigidly", []),
    ("tests/scenes/soft_between_stiff", []),
    ("tests/scenes/three_that_meet_in_a_point", []),
    ("tests/scenes/held_by_a_contact_that_opens", ["--degree", "8"]),
]

COARSER = {"cases/rotor": ("size = 0.008", "size = 0.025")}


@pytest.mark.parametrize("scene, options", RUNS, ids=[Path(scene).name for scene, _ in RUNS])
def test_scene(tmp_path, scene, options):
    path = ROOT / f"{scene}.toml"
    if scene in COARSER:
        text, path = path.read_text(), tmp_path / "scene.toml"
        assert COARSER[scene][0] in text
        path.write_text(text.replace(*COARSER[scene]))
    subprocess.run([PROGRAM, "solve", path, "--proof", "--quiet", "--out", tmp_path / "out", *options], check=True, timeout=300)
    proof = check(tmp_path / "out", path)
    assert proof.lower <= proof.upper


BAR = """
model = {{ kinematics = "plane-stress" }}
geometry = {{ size = 0.5, polygons = [{{ body = "bar", points = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]], edges = ["foot", "", "", "hub"] }}] }}
bodies.bar = {{ young = 2.0, poisson = 0.0, {force} }}
supports = [{{ on = "hub", type = "roller" }}, {{ on = "foot", type = "roller" }}]
"""


@pytest.mark.parametrize("force", ["body_force = { value = [0, 0], gradient = [[3.0, 0], [0, 0]] }", "body_force = { value = [-3.0, 0.0], gradient = [[6.0, 0], [0, 0]] }"])
def test_affine_force_against_a_bar(tmp_path, force):
    """A bar under f = a + b x along it: s = a (1 - x) + b (1 - x^2) / 2, and the energy is -1/2 int s^2 / E over it."""
    (tmp_path / "bar.toml").write_text(BAR.format(force=force))
    subprocess.run([PROGRAM, "solve", "bar.toml", "--proof", "--quiet", "--out", "out"], check=True, timeout=300, cwd=tmp_path)
    proof = check(tmp_path / "out")
    a, b = (0, 3) if "[0, 0], g" in force else (-3, 6)
    exact = -(a * a / 3 + a * b * 5 / 12 + b * b * 2 / 15) / 4 * 0.5
    assert float(proof.lower) == pytest.approx(exact, abs=1e-12)
    assert float(proof.upper) == pytest.approx(exact, abs=1e-12)


def pull_more(a):
    a["quantity0_tractions"] *= 1.001


def hold_less(a):
    wall = next(row[0] for row in a["displacement_edges"] if row[2] >= 0 and a["displacement_points"][row[0]][0] == 0)
    a["quantity0_u_vertices"][wall] += 1e-3


def claim_other(a):
    a["manifest"]["quantities"][0]["upper"] = a["manifest"]["quantities"][0]["lower"] = 0.0


def turn(a):
    with_scene(a, lambda text: text.replace("direction = [0.6, 0.8]", "direction = [0.8, 0.6]"))


def rename(a):
    a["manifest"]["quantities"][0]["name"] = "force"


def back(a):
    a["manifest"]["quantities"][0]["step"] *= -1


def test_quantities(tmp_path):
    """Intervals of mean displacements are proved, no wider than they were printed; and what was changed is refused for what it is."""
    line = [PROGRAM, "solve", ROOT / "checker/tests/cantilever.toml", "--proof", "--quiet", "--out", tmp_path]
    subprocess.run(line, check=True, timeout=300)
    proof = check(tmp_path)
    assert [name for name, *_ in proof.quantities] == ["tip", "top", "all"]
    for _, (low, high), (claimed, most) in proof.quantities:
        assert low < high and high - low < 1.05 * (most - claimed)
    changes = [
        (pull_more, "not in equilibrium"),
        (hold_less, "misses a support"),
        (claim_other, "'tip' lies between .* claims otherwise"),
        (turn, "not in equilibrium|claims otherwise"),
        (rename, "'force' of the proof is no mean displacement"),
        (back, "'tip' of the proof is no mean displacement"),
    ]
    for change, why in changes:
        refused(tmp_path / "changed.npz", again(tmp_path), change, why)


def again(folder):
    """The arrays of a proof, to be changed and written."""
    arrays = read(folder / "proof.npz")
    arrays["manifest"] = json.loads(bytes(arrays["manifest"]))
    del arrays["digest"]
    return arrays


FAR = """
model = { kinematics = "plane-stress" }
geometry = { size = 0.5, polygons = [{ body = "block", points = [[40, 0], [41, 0], [41, 1], [40, 1]], edges = ["foot", "", "top", ""] }] }
bodies = { block = { young = 2.0, poisson = 0.3, body_force = { value = [0, -1], gradient = [[0, 0], [0.1, 0]] } } }
supports = [{ on = "foot", type = "clamped" }]
tractions = [{ on = "top", value = [0, -1], gradient = [[0, 0], [0.3, 0]] }]
quantities = [{ name = "top", displacement = "top", direction = [0.6, -2] }]
"""


def test_far_away_and_along_a_direction_of_any_length(tmp_path):
    """Loads that vary are those of the scene wherever its coordinates count from, and a direction is one of any length."""
    (tmp_path / "far.toml").write_text(FAR)
    subprocess.run([PROGRAM, "solve", tmp_path / "far.toml", "--proof", "--quiet", "--out", tmp_path], check=True, timeout=300)
    proof = check(tmp_path, tmp_path / "far.toml")
    (_, (low, high), (claimed, most)), = proof.quantities
    assert high - low < 1.05 * (most - claimed)


@pytest.mark.parametrize("gap, other", [
    ("[[0.0, 0.01], [0.5, 0.02], [1.0, 0.03]]", "[[0.0, 0.02], [0.5, 0.04], [1.0, 0.06]]"),
    ("{ circle = 20.0, at = 0.5 }", "{ circle = 10.0, at = 0.5 }"),
    ("{ parabola = 20.0, at = 0.5 }", "{ parabola = 20.0, at = 0.55 }"),
])
def test_gaps_of_another_scene(tmp_path, gap, other):
    """A proof for one gap is none for another, whatever kind of gap it is."""
    scene = FAR.replace("[0, -1], gradient = [[0, 0], [0.3, 0]]", "[0, -1]").replace("quantities", "# quantities")
    scene = scene.replace("supports", "contacts = [{ on = \"top\", gap = GAP }]\nsupports").replace("value = [0, -1] }", "value = [0, 1] }")
    scene = scene.replace("tractions", "# tractions").replace("[0, -1], gradient = [[0, 0], [0.1, 0]]", "[0, 1], gradient = [[0, 0], [0, 0]]")
    (tmp_path / "gap.toml").write_text(scene.replace("GAP", gap))
    subprocess.run([PROGRAM, "solve", tmp_path / "gap.toml", "--proof", "--quiet", "--out", tmp_path], check=True, timeout=300)
    check(tmp_path)
    refused(tmp_path / "changed.npz", again(tmp_path), in_scene(gap, other), "is not that of the scene")


@pytest.mark.parametrize("degree", ["1", "3"])
def test_friction_along_a_curve(tmp_path, degree):
    scene = ROOT / "checker/tests/rubbing_arc.toml"
    line = [PROGRAM, "solve", scene, "--proof", "--quiet", "--degree", degree, "--out", tmp_path]
    subprocess.run(line, check=True, timeout=300)
    proof = check(tmp_path, scene)
    assert any("the bound of friction is linear between vertices" in premise for premise in proof.premises)
    work = json.loads((tmp_path / "report.json").read_text())["energy"]["friction_work"]
    assert work > 10 * (proof.claim[1] - proof.claim[0]) / 1000
    changes = [
        (lambda a: a.update(frictions=a["frictions"] * 1.01), "friction of pair .* is above its bound"),
        (lambda a: a.update(frictions=-a["frictions"]), "not in equilibrium"),
        (in_scene("[0.3, 0.2]", "[0.3, 0.199]"), "friction of pair .* is above its bound"),
        (lambda a: a["manifest"]["claim"].update(upper=proof.claim[1] - work), "upper bound .* is claimed, and only"),
    ]
    for change, why in changes:
        refused(tmp_path / "changed.npz", again(tmp_path), change, why)


def test_bodies_that_the_scene_does_not_bond(tmp_path):
    """One mesh of two bodies is no proof of a scene in which they are apart."""
    line = [PROGRAM, "solve", ROOT / "cases/bonded.toml", "--proof", "--quiet", "--out", tmp_path]
    subprocess.run(line, check=True, timeout=300)
    unbonded = in_scene('[[bonds]]\nbetween = ["left_face", "right_face"]', "")
    refused(tmp_path / "changed.npz", again(tmp_path), unbonded, "joins what the scene does not bond")


def test_page(tmp_path, capsys):
    """docs/proof.md shows what the checker prints, but for version, time and digits that are rounding."""
    page = (ROOT / "docs/proof.md").read_text()
    shown = page.split("```text\n")[1].split("```")[0].splitlines()
    case = ROOT / "cases/two_blocks.toml"
    subprocess.run([PROGRAM, "solve", case, "--proof", "--quiet", "--out", tmp_path], check=True, timeout=300)
    assert main([str(tmp_path), "--scene", str(case)]) == 0
    rough = lambda lines: [re.sub(r"\d\.\de-1[1-9]", "so much", line) for line in lines]
    assert rough(capsys.readouterr().out.splitlines())[: len(shown)] == rough(shown)
