"""Results of Code_Aster. The file was written by MEDCoupling 9.14 from a solution of scikit-fem: triangles with six nodes, two steps, stresses of
cells beside the displacement, which has a component of contact and is stored for the nodes from the last to the first."""

import json
import subprocess
import sys

import h5py
import pytest

from conftest import PROGRAM, ROOT, hypercircle

RESULTS = ROOT / "tests" / "meshes" / "code_aster.rmed"
SCENE = f"""
model.kinematics = "plane-strain"
mesh.file = "{RESULTS}"
bodies.BLOC = {{ young = 200.0, poisson = 0.3 }}
supports = [{{ on = "GAUCHE", type = "clamped" }}]
tractions = [{{ on = "DROITE", value = [1.0, -0.5] }}]
"""


@pytest.fixture(autouse=True)
def with_h5py(monkeypatch):
    monkeypatch.setenv("HYPERCIRCLE_PYTHON", sys.executable)


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "block.toml"
    path.write_text(SCENE)
    return path


def held(scene, field, code):
    hypercircle("certify", scene, "--displacement", field, "--solution", "--out", scene.parent / "out", "--quiet", code=code)
    return json.loads((scene.parent / "out" / "report.json").read_text())


def test_a_result_is_the_solution_it_claims_to_be(scene):
    assert held(scene, RESULTS, 0)["primal"][0]["degree"] == 2


def test_a_mistake_is_found_and_named(scene):
    scene.write_text(SCENE.replace("200.0", "210.0"))
    report = held(scene, RESULTS, 1)
    assert "young" in json.dumps(report["diagnosis"]).lower() or "E of" in report["diagnosis"][0]["sentence"]


def test_components_of_contact_are_no_displacement(scene, tmp_path):
    field = tmp_path / "pressed.rmed"
    field.write_bytes(RESULTS.read_bytes())
    with h5py.File(field, "a") as file:
        for step in file["CHA"]["RESU____DEPL"].values():
            values = step["NOE"]["PFL_NODE"]["CO"]
            values[2 * len(values) // 3:] = -7.5
    assert held(scene, field, 0)["primal"][0]["degree"] == 2


def test_polygons_and_structured_grids_are_refused(tmp_path):
    for kind, change, found in (
        ("polygons", lambda mesh: mesh["MAI"].move("TR6", "POG"), "polygons"),
        ("grid", lambda mesh: mesh["NOE"].move("COO", "IDX"), "structured grid"),
    ):
        path = tmp_path / f"{kind}.med"
        path.write_bytes(RESULTS.read_bytes())
        with h5py.File(path, "a") as file:
            (mesh,) = file["ENS_MAA"].values()
            (step,) = mesh.values() if "NOE" not in mesh else [mesh]
            change(step)
        done = subprocess.run([PROGRAM, "mesh", path], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 2 and found in done.stderr


def test_a_displacement_at_some_nodes_alone_is_none(scene, tmp_path):
    field = tmp_path / "some.rmed"
    field.write_bytes(RESULTS.read_bytes())
    with h5py.File(field, "a") as file:
        (profile,) = file["PROFILS"].values()
        profile["PFL"][0] = profile["PFL"][1]
    hypercircle("certify", scene, "--displacement", field, "--solution", "--out", tmp_path / "out", "--quiet", code=2)
