"""The package as users of notebooks and scripts need it: scenes of dictionaries, verify, jobs, tables, pictures, ctrl-C."""

import os
import signal
import subprocess
import sys
import textwrap
import time
import tomllib
import types
from pathlib import Path

import numpy as np
import pytest

from plate import written

CASES = Path(__file__).resolve().parents[2] / "cases"


def test_a_scene_of_dictionaries_is_that_of_its_file(hypercircle, tmp_path):
    tables = tomllib.loads((CASES / "two_blocks.toml").read_text())
    tables["title"] = 'a "title" with \\ and 摩擦 \x7f'
    tables["model"]["thickness"] = None
    for polygon in tables["geometry"]["polygons"]:
        polygon["points"] = np.array(polygon["points"], dtype=float)
    scene = hypercircle.Scene.from_dict(tables)
    assert scene.title == tables["title"]
    assert scene.solve().lower == hypercircle.Scene(CASES / "two_blocks.toml").solve().lower
    path = written(tmp_path)
    meshed = tomllib.loads(path.read_text()) | {"mesh": {"file": tmp_path / "plate.msh"}}
    assert hypercircle.Scene.from_dict(meshed).problem()["points"].shape == (25, 2)


def test_what_is_wrong_with_dictionaries_is_said(hypercircle):
    tables = tomllib.loads((CASES / "two_blocks.toml").read_text())
    with pytest.raises(hypercircle.InputError, match="poisson"):
        hypercircle.Scene.from_dict(tables | {"bodies": {"left": {"young": 1, "poisson": 0.7}}})
    with pytest.raises(hypercircle.InputError, match="bodies.left.young has the type object"):
        hypercircle.Scene.from_dict({"bodies": {"left": {"young": object()}}})
    itself = {}
    itself["model"] = itself
    with pytest.raises(hypercircle.InputError, match="more than 16 levels deep.*does it contain itself"):
        hypercircle.Scene.from_dict(itself)
    with pytest.raises(hypercircle.InputError, match=r"^model.kinematics has half of a pair of UTF-16.*'plane-\\ud800'"):
        hypercircle.Scene.from_dict({"model": {"kinematics": "plane-\ud800"}})
    with pytest.raises(hypercircle.InputError, match=r"^bodies.\\ud800 has half of a pair"):
        hypercircle.Scene.from_dict({"bodies": {"\ud800": {}}})


def test_verify_compares_with_fenicsx(hypercircle, tmp_path):
    scene = hypercircle.Scene(CASES / "two_blocks.toml")
    found = scene.verify(primal_degree=[2], out=tmp_path / "out")
    assert found.passed and found.lower <= found.upper and (tmp_path / "out/report.html").is_file()
    (model,) = found.report["primal"]
    assert model["name"] == "FEniCSx P2" and found.relative_error_bound == model["relative_error_bound"]
    with pytest.raises(hypercircle.InputError, match="primal_degree"):
        scene.verify(primal_degree=[0])


TUBE = """
model.kinematics = "axisymmetric"
geometry = { size = 0.25, polygons = [{ body = "tube", points = [[1, 0], [2, 0], [2, 1], [1, 1]], edges = ["foot", "out", "top", "bore"] }] }
bodies.tube = { young = 1.0, poisson = 0.3 }
supports = [{ on = "foot", type = "roller" }, { on = "top", type = "roller" }]
tractions = [{ on = "bore", pressure = 1.0 }]
"""


def test_a_body_of_revolution_has_four_stresses(hypercircle):
    solution = hypercircle.Scene.from_text(TUBE).solve(degree=3)
    # Lamé: radial and hoop stress A ± B/r² with A = 1/3, B = 4/3, and along the axis, where nothing moves, ν of their sum.
    lame = lambda r: np.stack([(1 - 4 / r**2) / 3, np.full_like(r, 0.3 * 2 / 3), np.zeros_like(r), (1 + 4 / r**2) / 3], axis=1)
    r = solution.stress_points[:, 0]
    assert solution.stress.shape == (len(r), 4) and np.abs(solution.stress - lame(r)).max() < 0.02
    centroids = solution.points[solution.triangles].mean(axis=1)[:, 0]
    assert np.abs(solution.mean_stress - lame(centroids)).max() < 0.1
    assert len(solution.maps["von_mises_dual"]) == len(solution.triangles)
    # The energy is −½ ∫ p u_r, and u_r = (1 + ν)((1 − 2ν) A r + B/r).
    exact = -0.5 * 2 * np.pi * 1.3 * (0.4 / 3 + 4 / 3)
    assert solution.lower <= exact <= solution.upper and solution.relative_error_bound < 1e-3
    with pytest.raises(hypercircle.InputError, match="revolution"):
        hypercircle.Scene.from_text(TUBE).solve(element=object())


def test_a_chart_is_what_the_command_leaves(hypercircle, tmp_path):
    scene = hypercircle.Scene(CASES / "patch.toml")
    found = scene.chart(out=tmp_path / "out", methods=["condensed"], refine=1, repeats=1)
    (patch,) = found["scenes"]
    assert [run["level"] for run in patch["runs"]] == [0, 1] and (tmp_path / "out/chart.html").is_file()
    assert all(run["plot"]["lower"] <= patch["reference"]["Ok"]["upper"] for run in patch["runs"])
    with pytest.raises(hypercircle.InputError, match="no method"):
        scene.chart(out=tmp_path / "out", methods=["fast"])
    with pytest.raises(hypercircle.InputError, match="write it"):
        hypercircle.Scene.from_text(TUBE).chart(out=tmp_path)


def test_a_job_is_many_scenes(hypercircle, tmp_path):
    (tmp_path / "bad.toml").write_text("nonsense")
    found = hypercircle.job([CASES / "patch.toml", CASES / "gap.toml", tmp_path / "bad.toml"], "solve", out=tmp_path / "out", jobs=2)
    assert found["exit"] == 2 and found["counts"]["agree"] == 2 and found["counts"]["scenes"] == 3
    with pytest.raises(hypercircle.InputError, match="--refine"):
        hypercircle.job(CASES / "patch.toml", "solve", out=tmp_path / "out", options=["--refine", "99"])
    with pytest.raises(hypercircle.InputError, match="use one of"):
        hypercircle.job([], "chart", out=tmp_path)


def test_tables_are_columns(hypercircle):
    text = (CASES / "two_blocks.toml").read_text() + '\n[[quantities]]\nname = "tip"\ndisplacement = "left_load"\ndirection = [1, 0]\n'
    solution = hypercircle.Scene.from_text(text).solve(tolerance=0.01)
    table = solution.table("quantities")
    assert table["name"] == ["tip"] and table["lower"][0] == solution.quantities["tip"].lower
    history = solution.table("history")
    assert {len(column) for column in history.values()} == {len(solution.report["history"])} and min(history["triangles"]) > 0
    (force,) = solution.table("contacts")["resultant.dual.0"]
    assert force == solution.contacts["left_face|right_face"].force[0]
    assert solution.table("checks")["passed"] == [True] * len(solution.report["checks"])
    with pytest.raises(hypercircle.InputError, match="contacts"):
        solution.table("no such")


def test_a_notebook_shows_verdict_and_intervals(hypercircle):
    text = (CASES / "two_blocks.toml").read_text() + '\n[[quantities]]\nname = "<tip>"\ndisplacement = "left_load"\ndirection = [1, 0]\n'
    scene = hypercircle.Scene.from_text(text)
    page = scene.solve()._repr_html_()
    assert "agree" in page and "&lt;tip&gt;" in page and "<tip>" not in page
    assert "quantity/&lt;tip&gt;/given" in scene.certify(values={"<tip>": 7.0})._repr_html_()


def test_a_picture_shows_one_number_a_triangle(hypercircle):
    class Axes:
        figure = None

        def tripcolor(self, *what, **how):
            self.what, self.how = what, how

        def set_aspect(self, aspect):
            self.aspect = aspect

    solution = hypercircle.Scene(CASES / "two_blocks.toml").solve()
    axes = solution.plot("xx", ax=Axes(), deformed=2.0, cmap="magma")
    x, y, triangles = axes.what
    assert np.allclose(np.column_stack([x, y]), solution.points + 2.0 * solution.displacement)
    assert (triangles == solution.triangles).all() and axes.how["cmap"] == "magma"
    assert (axes.how["facecolors"] == solution.mean_stress[:, 0]).all()
    shares = [name for name in solution.maps if name.startswith("gap_share")]
    assert abs(solution.maps[shares[0]].sum() - 1) < 1e-9
    assert (solution.plot(ax=Axes()).how["facecolors"] == solution.maps["von_mises_dual"]).all()
    with pytest.raises(hypercircle.InputError, match="von_mises_dual"):
        solution.plot("zz", ax=Axes())
    with pytest.raises(hypercircle.InputError, match="one number for each"):
        solution.plot([1.0], ax=Axes())


def test_a_grid_of_pyvista_has_what_is_known_of_the_triangles(hypercircle, monkeypatch):
    class Grid:
        def __init__(self, cells, points):
            (self.triangles,), self.points = cells.values(), points
            self.cell_data, self.point_data = {}, {}

    # PyVista asks for a dozen packages: these are the calls that it takes, of 0.49.
    stand_in = types.SimpleNamespace(UnstructuredGrid=Grid, CellType=types.SimpleNamespace(TRIANGLE=5))
    monkeypatch.setitem(sys.modules, "pyvista", stand_in)
    for scene, components in ((CASES / "two_blocks.toml", 3), (CASES / "tube.toml", 4)):
        solution = hypercircle.Scene(scene).solve()
        grid = solution.to_pyvista()
        assert (grid.points[:, :2] == solution.points).all() and not grid.points[:, 2].any()
        assert (grid.triangles == solution.triangles).all() and (grid.cell_data["body"] == solution.body).all()
        stresses = [name for name in grid.cell_data if name.startswith("stress_")]
        assert len(stresses) == components and (grid.cell_data[stresses[1]] == solution.mean_stress[:, 1]).all()
        assert solution.maps.keys() <= grid.cell_data.keys()
        assert (grid.point_data["displacement"][:, :2] == solution.displacement).all()
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match="pip install pyvista"):
        solution.to_pyvista()


def test_a_report_that_is_changed_changes_no_verdict(hypercircle):
    scene = hypercircle.Scene(CASES / "patch.toml")
    solution = scene.solve()
    wrong = solution.certify(solution.points, solution.triangles, 0.5 * solution.displacement, solution=True)
    for found in (wrong, solution):
        status, checks = found.status, len(found.report["checks"])
        found.report["status"] = "agree" if status == "disagree" else "disagree"
        found.report["checks"].clear()
        assert found.status == status and len(found.report["checks"]) == checks
    wrong.checks.clear()
    wrong.causes.clear()
    wrong.diagnosis["findings"].clear()
    assert not wrong.passed and wrong.checks and wrong.causes and wrong.diagnosis["findings"]


def test_ctrl_c_ends_a_solve():
    """A solve that would take minutes ends soon after the signal, as an exception, and the next one works."""
    body = f"""
        import hypercircle
        scene = hypercircle.Scene({str(CASES / "two_blocks.toml")!r})
        print("ready", flush=True)
        try:
            scene.solve(tolerance=1e-6, adapt="h")
            print("ended", flush=True)
        except KeyboardInterrupt:
            print("interrupted", scene.solve().status, flush=True)
        """
    # A background process of a shell ignores the signal, and so do all its children.
    heard = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(body)], stdout=subprocess.PIPE, text=True, preexec_fn=heard
    )
    assert process.stdout.readline() == "ready\n"
    time.sleep(1.0)
    began = time.monotonic()
    os.kill(process.pid, signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said == "interrupted agree\n"
    assert time.monotonic() - began < 30


def test_the_command_is_that_of_the_program(hypercircle, tmp_path):
    command = Path(sys.executable).parent / "hypercircle"
    run = lambda *words: subprocess.run([command, *words], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run("--version").stdout.startswith(f"hypercircle {hypercircle.__version__}\n")
    assert run("solve", CASES / "patch.toml", "--quiet").returncode == 0
    assert '"command_line": "hypercircle solve' in (tmp_path / "out/patch/report.json").read_text()
    assert run("solve", "no.toml").returncode == 2 and run("no").returncode == 2
