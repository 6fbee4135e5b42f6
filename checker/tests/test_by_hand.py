"""Patch tests: both bounds are the exact energy, which is known by hand; and whatever is changed is refused for what it is."""

import json
import zipfile

import numpy as np
import pytest
from by_hand import blocks, refused, refused_once_changed, with_scene, write
from hypercircle_check import Refused
from hypercircle_check.main import check, main


@pytest.mark.parametrize("n, gap, young, thickness, degree", [(1, 0.0, 1.0, 1.0, 1), (2, 0.25, 1.0, 0.5, 1), (3, 0.1, 4.0, 1.0, 2), (2, -0.5, 1.0, 3.0, 3)])
def test_patch(tmp_path, n, gap, young, thickness, degree):
    write(blocks(n, gap, young, thickness, degree), tmp_path / "proof.npz")
    proof = check(tmp_path)
    energy = -thickness * (0.5 + 0.5 / young + gap)
    assert float(proof.lower) == pytest.approx(energy, abs=1e-12)
    assert float(proof.upper) == pytest.approx(energy, abs=1e-12)
    assert proof.lower <= energy + 1e-16 and proof.upper >= energy - 1e-16
    assert main([str(tmp_path)]) == 0


ALONG = "orthotropic = { young = [1.0, 5.0, 3.0], poisson = [0, 0, 0.3], shear = 0.5 }"
ACROSS = "orthotropic = { young = [5.0, 1.0, 3.0], poisson = [0, 0, 0.3], shear = 0.5, angle = 90.0 }"
# Turned by 30 degrees, this one has 1/E = 1 along x, and neither contraction nor shear.
TURNED = "compliance = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]], angle = 30.0"
STIFFNESS = "stiffness = [[1.0, 0, 0, 0, 0, 0], [0, 2.0, 1.0, 0, 0, 0], [0, 1.0, 3.0, 0, 0, 0], [0, 0, 0, 4, 0, 0], [0, 0, 0, 0, 5, 0], [0, 0, 0, 0, 0, 6.0]]"
WARM = f"{ALONG}, expansion = [0.01, 0.0, 0.0], temperature = 20.0"
TENSE = f"{ALONG}, initial_stress = [-0.5, 0.0, 0.0]"
OF_ALL_KINDS = [
    {"left": ALONG},
    {"left": ACROSS},
    {"left": TURNED},
    {"left": STIFFNESS, "degree": 2},
    {"left": WARM, "grown": 0.2},
    {"left": TENSE, "grown": 0.5, "degree": 2},
    {"wall": 4.0},
    {"elastic": 4.0, "young": 2.0},
    {"layer": 8.0, "thickness": 0.5},
    {"wall": 4.0, "layer": 8.0, "left": WARM, "grown": 0.2, "degree": 3},
]


@pytest.mark.parametrize("what", OF_ALL_KINDS, ids=lambda what: "-".join(what))
def test_patch_of_every_law(tmp_path, what):
    arrays = blocks(**what)
    write(arrays, tmp_path / "proof.npz")
    proof, claim = check(tmp_path), arrays["manifest"]["claim"]
    energy = (claim["lower"] + claim["upper"]) / 2
    assert float(proof.lower) == pytest.approx(energy, abs=1e-13)
    assert float(proof.upper) == pytest.approx(energy, abs=1e-13)


def test_admissible_but_worse_fields_prove_less(tmp_path):
    arrays = blocks()
    arrays["manifest"]["claim"]["upper"] += 1.0
    arrays["u_vertices"][:9, 0] -= 0.125  # the left block stands back from the seat
    arrays["u_edges"][[e for e, row in enumerate(arrays["displacement_edges"]) if row[0] < 9], 0] -= 0.125
    arrays["u_inside"][:32, 0] -= 0.125
    write(arrays, tmp_path / "proof.npz")
    proof = check(tmp_path)
    assert float(proof.upper) == pytest.approx(-1.25 + 0.125)
    assert float(proof.lower) == pytest.approx(-1.25)


def traction(a):
    inner = next(e for e in range(len(a["stress_edges"])) if a["stress_edges"][e, 2] < 0 and abs(a["tractions"][2 * e]).max() > 0)
    a["tractions"][2 * inner] += 1e-3


def vertex(a):
    a["stress_points"][4] += [1e-3, 0]


def pull(a):
    a["pressures"][0] *= -1


def triangle(a):
    for name in ("stress_triangles", "stress_bodies", "stress_degrees"):
        a[name] = a[name][:-1]


def claim(a):
    a["manifest"]["claim"]["lower"] *= 0.99


def upper_claim(a):
    a["manifest"]["claim"]["upper"] -= 1e-6


def penetrates(a):
    a["u_vertices"][5] += [1e-3, 0]


def support(a):
    wall = next(row[0] for row in a["displacement_edges"] if row[2] == 3)
    a["u_vertices"][wall] += [0, 1e-3]


def material(a):
    with_scene(a, lambda text: text.replace("young = 1.0", "young = 1.01"))


def load(a):
    with_scene(a, lambda text: text.replace("value = [1.0", "value = [1.01"))


def name(a):
    for of in ("stress", "displacement"):
        a[f"{of}_edges"][a[f"{of}_edges"][:, 2] == 3, 2] = -1


def one_name(a):
    edges = a["displacement_edges"]
    edges[np.flatnonzero(edges[:, 2] == 3)[0], 2] = -1


def pair(a):
    a["displacement_pairs"], a["displacement_pair_data"] = a["displacement_pairs"][:-1], a["displacement_pair_data"][:-1]


def gap(a):
    a["displacement_pair_data"][0, 7] += 0.1


def direction(a):
    a["stress_pair_data"][0, :4] = [-1, 0, -1, 0]


def scene(a):
    a["scene"] = np.frombuffer(bytes(a["scene"]).replace(b"1.0", b"2.0"), np.uint8)


def key(a):
    with_scene(a, lambda text: text.replace("poisson = 0.0 }", "poisson = 0.0, plasticity = 1 }"))


def law(a):
    with_scene(a, lambda text: text.replace("young = [1.0, 5.0, 3.0]", "young = [1.01, 5.0, 3.0]"))


def angle(a):
    with_scene(a, lambda text: text.replace("shear = 0.5", "shear = 0.5, angle = 1.0"))


def temperature(a):
    with_scene(a, lambda text: text.replace("temperature = 20.0", "temperature = 20.1"))


def springs(a):
    with_scene(a, lambda text: text.replace("stiffness = [4.0", "stiffness = [4.1"))


def rigid(a):
    with_scene(a, lambda text: text.replace("stiffness = [4.0, 2.0]", "").replace('"spring",', '"clamped"'))


def layer(a):
    with_scene(a, lambda text: text.replace("stiffness = [8.0", "stiffness = [7.9"))


def glued(a):
    with_scene(a, lambda text: text.replace(", stiffness = [8.0, 3.0]", ""))


def apart(a):
    edges = a["stress_edges"]
    edges[np.flatnonzero(edges[:, 2] == 2)[0], 2] = -1


def turning(a):
    with_scene(a, lambda text: text.replace("temperature = 20.0", "temperature = 20.0, rotation = { density = 1.0, omega = 0.1, about = [0.5, 0.5] }"))


def coupled(a):
    with_scene(a, lambda text: text.replace("poisson = [0, 0, 0.3]", "poisson = [0, 0, 1.3]"))


def ranged(a):
    with_scene(a, lambda text: text.replace("stiffness = [8.0, 3.0]", "stiffness = [[7.0, 8.0], 3.0]"))


ALL = {"wall": 4.0, "layer": 8.0, "left": WARM, "grown": 0.2}
LAW_CHANGES = [
    (law, "is claimed, and only"),
    (angle, "is claimed, and only"),
    (temperature, "is claimed, and only"),
    (springs, "is claimed, and only"),
    (rigid, "misses a support"),
    (layer, "is claimed, and only"),
    (glued, "part of the bond face.seat, and nothing is opposite"),
    (apart, "part of the bond face.seat, and nothing is opposite"),
    (turning, "not in equilibrium"),
    (coupled, "those of no material"),
    (ranged, "scene cannot be read"),
]


@pytest.mark.parametrize("change, why", LAW_CHANGES, ids=[change.__name__ for change, _ in LAW_CHANGES])
def test_changes_of_laws_are_refused(tmp_path, change, why):
    refused_once_changed(tmp_path / "proof.npz", blocks(**ALL), change, why)


def turned(a):
    a["stress_triangles"][0] = a["stress_triangles"][0][::-1]


def nothing(a):
    a["tractions"][0] = np.nan


def missing(a):
    del a["u_inside"]


def degree(a):
    a["stress_degrees"][0] = 200


def nameless(a):
    del a["manifest"]["scene"]


def files(a):
    a["manifest"]["mesh_files"] = None


CHANGES = [
    (traction, "not in equilibrium: edge"),
    (vertex, "not in equilibrium|area"),
    (pull, "contact traction of pair 0 pulls"),
    (triangle, "no triangle on its left|area of its polygons"),
    (claim, "lower bound .* is claimed, and only"),
    (upper_claim, "upper bound .* is claimed, and only"),
    (penetrates, "penetrates a contact"),
    (support, "misses a support"),
    (material, "is claimed, and only"),
    (load, "out of balance|not in equilibrium"),
    (name, "no edge of the stress mesh is part of 'wall'"),
    (one_name, "lies on no side of its polygon without a name"),
    (pair, "no pair holds it"),
    (gap, "gap of contact .* is not that of the scene"),
    (direction, "does not point out of its first side"),
    (scene, "not the one that its hash names"),
    (key, "does not know the key `plasticity`"),
    (turned, "turned over|no edge|same side"),
    (nothing, "no number"),
    (missing, "lacks 'u_inside'"),
    (degree, "stress of degree 200; none is above 24"),
    (nameless, "lacks 'scene'"),
    (files, "malformed"),
]


@pytest.mark.parametrize("change, why", CHANGES, ids=[change.__name__ for change, _ in CHANGES])
def test_changes_are_refused_for_what_they_are(tmp_path, capsys, change, why):
    refused(tmp_path / "proof.npz", blocks(), change, why)
    assert main([str(tmp_path)]) == 1
    assert capsys.readouterr().out.startswith("not proved: ")


def test_a_name_is_one_line(tmp_path, capsys):
    """What a proof calls its scene is nobody's word but its own."""
    arrays = blocks()
    arrays["manifest"]["scene"] = "x\x1b[2J lies between 0 and 1.\nproved: the exact energy of y"
    write(arrays, tmp_path / "proof.npz")
    assert main([str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "\x1b" not in said and said.count("\nproved:") == 0


def test_any_change_of_the_file_is_refused(tmp_path):
    write(blocks(), tmp_path / "proof.npz", digest=False)
    with pytest.raises(Refused, match="digest"):
        check(tmp_path)
    (tmp_path / "proof.npz").write_bytes(b"nonsense")
    with pytest.raises(Refused, match="cannot be read"):
        check(tmp_path)
    with zipfile.ZipFile(tmp_path / "proof.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("scene.npy", bytes(1000))
    content = bytearray((tmp_path / "proof.npz").read_bytes())
    content[30 + len("scene.npy")] ^= 0xFF  # the first byte that is compressed
    (tmp_path / "proof.npz").write_bytes(content)
    with pytest.raises(Refused, match="cannot be read"):
        check(tmp_path)
    assert main([str(tmp_path / "nowhere")]) == 1


def test_report_and_scene_must_be_those_of_the_proof(tmp_path):
    arrays = blocks()
    write(arrays, tmp_path / "proof.npz")
    claim = arrays["manifest"]["claim"]
    (tmp_path / "report.json").write_text(json.dumps({"energy": claim}))
    (tmp_path / "scene.toml").write_bytes(bytes(arrays["scene"]))
    assert main([str(tmp_path), "--scene", str(tmp_path / "scene.toml")]) == 0
    (tmp_path / "scene.toml").write_bytes(bytes(arrays["scene"]) + b"\n")
    with pytest.raises(Refused, match="is not the scene of the proof"):
        check(tmp_path, tmp_path / "scene.toml")
    (tmp_path / "report.json").write_text(json.dumps({"energy": {**claim, "upper": claim["upper"] - 1e-3}}))
    with pytest.raises(Refused, match="report.json has the upper bound"):
        check(tmp_path)
