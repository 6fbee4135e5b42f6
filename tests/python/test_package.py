"""The package as its users have it: arrays, exceptions, threads, fields that are certified."""

import json
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

CASES = Path(__file__).resolve().parents[2] / "cases"


def case(hypercircle, name, old="", new=""):
    return hypercircle.Scene.from_text((CASES / f"{name}.toml").read_text().replace(old, new), name=name)


def test_a_scene_says_what_it_is(hypercircle):
    scene = hypercircle.Scene(CASES / "two_blocks.toml")
    assert scene.name == "two_blocks" and scene.path == CASES / "two_blocks.toml"
    assert [body["name"] for body in scene.bodies] == ["left", "right"]
    assert scene.contacts == ["left_face|right_face"] and scene.quantities == []
    assert scene.kinematics == "plane-strain" and scene.thickness == 1.0
    assert "left, right" in repr(scene)


def test_quadrilaterals_of_the_mesh_file_are_told(hypercircle):
    mesh = hypercircle.Scene(CASES / "quadrilaterals.toml").problem(refine=1)
    cells, points = mesh["quadrilaterals"], mesh["points"]
    assert cells.shape == (800, 4) and len(mesh["triangles"]) == 1600
    x, y = points[cells].transpose(2, 0, 1)
    areas = 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1)
    assert areas == pytest.approx(np.full(800, 1 / 400), rel=1e-12)
    assert hypercircle.Scene(CASES / "two_blocks.toml").problem()["quadrilaterals"].shape == (0, 4)


@pytest.mark.parametrize("degree", [1, 3])
def test_places_of_stresses_are_theirs(hypercircle, degree):
    """The exact stress of this scene is linear on each body, and every degree finds it."""
    solution = hypercircle.Scene(CASES / "bending.toml").solve(degree=degree)
    parts = zip(solution.body, np.split(solution.stress, solution.stress_start[1:-1]), np.split(solution.stress_points, solution.stress_start[1:-1]))
    parts = list(parts)
    for body in set(solution.body):
        stress = np.concatenate([s for b, s, _ in parts if b == body])
        places = np.concatenate([p for b, _, p in parts if b == body])
        linear = np.column_stack([np.ones(len(places)), places])
        fitted = linear @ np.linalg.lstsq(linear, stress, rcond=None)[0]
        assert np.abs(fitted - stress).max() < 1e-9 * np.abs(stress).max()
        assert np.ptp(stress[:, 0]) + np.ptp(stress[:, 1]) > 0.1 * np.abs(stress).max(), "it is not constant"
    means = np.array([s.mean(axis=0) for _, s, _ in parts])
    if degree == 1:
        assert np.allclose(means, solution.mean_stress, rtol=0, atol=1e-12 * np.abs(means).max())


def test_arrays_are_views_that_keep_their_solution(hypercircle):
    solution = hypercircle.Scene(CASES / "two_blocks.toml").solve()
    contact = solution.contacts["left_face|right_face"]
    for array in [solution.stress, solution.points, solution.triangles, solution.body, contact.pressure]:
        assert not array.flags.owndata and not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    assert np.shares_memory(solution.stress, solution.stress) and solution.triangles.dtype == np.intp
    stress, copy = solution.stress, solution.stress.copy()
    del solution
    others = [hypercircle.Scene(CASES / "two_blocks.toml").solve(degree=2) for _ in range(3)]
    assert np.array_equal(stress, copy) and len(others) == 3
    # The load is 4 - 7 y over a side of length one.
    steps = np.diff(contact.arc_length)
    force = np.sum(0.5 * steps * (contact.pressure[1:] + contact.pressure[:-1]))
    assert force == pytest.approx(0.5, rel=1e-10) and contact.force[0] == pytest.approx(-0.5, rel=1e-10)
    assert contact.length == 1.0 and 0 < contact.open_fraction < 1


def test_a_scene_far_away_has_its_own_coordinates(hypercircle):
    here = case(hypercircle, "patch")
    points = here.solve().points
    text = (CASES / "patch.toml").read_text()
    import tomllib

    polygons = tomllib.loads(text)["geometry"]["polygons"]
    assert {tuple(p) for polygon in polygons for p in polygon["points"]} <= {tuple(p) for p in points.tolist()}
    for polygon in polygons:
        text = text.replace(str(polygon["points"]), str([[x + 1e7, y] for x, y in polygon["points"]]))
    away = hypercircle.Scene.from_text(text).solve().points
    assert away[:, 0].min() == 1e7 + points[:, 0].min() and away.shape == points.shape


def test_a_tolerance_is_reached_or_the_status_says_so(hypercircle, tmp_path):
    scene = hypercircle.Scene(CASES / "two_blocks.toml")
    reached = scene.solve(tolerance=0.05)
    assert reached.relative_error_bound <= 0.05 and reached.status == "agree"
    stopped = scene.solve(tolerance=1e-4, max_triangles=60, out=tmp_path / "out")
    assert stopped.relative_error_bound > 1e-4 and stopped.status == "disagree"
    written = json.loads((tmp_path / "out/report.json").read_text())
    assert written["energy"] == stopped.report["energy"] and written["verdict"] == stopped.verdict
    # Each interval holds the exact energy.
    assert max(reached.lower, stopped.lower) < min(reached.upper, stopped.upper)


WRONG = [
    (dict(method="newton"), "InputError", "condensed"),
    (dict(refine=-1), "InputError", "another value"),
    (dict(tolerance=float("nan")), "InputError", "another value"),
    (dict(tolerance_of={"tip": 0.1}), "InputError", r"\[\[quantities\]\]"),
    (dict(degree=2, method="uzawa"), "InputError", "another method"),
    (dict(max_memory="20k"), "SolveError", "allow more"),
    (dict(refine=9), "InputError", "coarser mesh"),
]


@pytest.mark.parametrize("options, kind, remedy", WRONG)
def test_what_cannot_be_solved_says_what_to_do(hypercircle, options, kind, remedy):
    scene = hypercircle.Scene(CASES / "two_blocks.toml")
    with pytest.raises(getattr(hypercircle, kind), match=remedy) as caught:
        scene.solve(**options)
    assert caught.value.remedy and str(caught.value).endswith(caught.value.remedy)


def test_no_equilibrium_and_no_scene(hypercircle, tmp_path):
    pulled = case(hypercircle, "two_blocks", "[4.0, 0.0]", "[-4.0, 0.0]")
    with pytest.raises(hypercircle.InfeasibleError, match="left.*lifts off") as caught:
        pulled.solve()
    assert "support" in caught.value.remedy
    with pytest.raises(hypercircle.InputError, match=r"two_blocks.toml:\d+:\d+: `poisson`"):
        case(hypercircle, "two_blocks", "poisson = 0.3", "poisson = 0.5")
    with pytest.raises(ValueError, match="no such scene file"):
        hypercircle.Scene(tmp_path / "nowhere.toml")
    with pytest.raises(TypeError):
        hypercircle.Scene(CASES / "patch.toml").solve(tolerence=0.1)


def test_other_threads_run_while_a_scene_is_solved(hypercircle):
    ticks, ended = [], threading.Event()

    def tick():
        while not ended.is_set():
            ticks.append(None)
            time.sleep(1e-4)

    scene = hypercircle.Scene(CASES / "two_blocks.toml")
    thread = threading.Thread(target=tick)
    thread.start()
    before = len(ticks)
    scene.solve(refine=2)
    after = len(ticks)
    ended.set()
    thread.join()
    assert after - before > 5
    with ThreadPoolExecutor(3) as pool:
        lower = list(pool.map(lambda n: scene.solve(refine=1, threads=n).lower, [1, 2, 1]))
    assert lower[0] == lower[2] and lower[1] == pytest.approx(lower[0], rel=1e-12)


def no_field(hypercircle, scene, *arrays, **options):
    with pytest.raises(hypercircle.InputError) as caught:
        scene.certify(*arrays, **options)
    assert caught.value.remedy
    return str(caught.value)


def test_what_is_no_field_says_what_to_do(hypercircle):
    scene = hypercircle.Scene(CASES / "patch.toml")
    mesh = scene.problem()
    points, triangles, u = mesh["points"], mesh["triangles"], np.zeros((len(mesh["points"]), 2))
    refused = lambda *arrays, **options: no_field(hypercircle, scene, *arrays, **options)
    assert "give points, triangles and displacement" in refused()
    assert "all three" in refused(points, triangles)
    assert "whole numbers" in refused(points, triangles + 0.5, u)
    assert "-1" in refused(points, triangles - 1, u)
    assert "beyond" in refused(points, triangles + 1, u)
    assert "for" in refused(points, triangles, u[1:])
    assert "components" in refused(points, triangles, np.zeros((len(u), 4)))
    assert "no finite" in refused(points, triangles, u * np.nan)
    assert "not in the mesh" in refused(points + 0.1, triangles, u)
    assert "nodes" in refused(points, triangles[:, :2], u)
    assert "'tip'" in refused(values={"tip": 1.0})
    assert "beauty" in refused(points, triangles, u, allow={"beauty": 1.0})
    assert "nope.vtu" in refused(file="nope.vtu")
    assert "field names" in refused(points, triangles, u, field="zz")
    assert "one thing" in refused(values={})
    assert "only values are certified" in refused(values={"tip": 1.0}, solution=True)


def test_a_field_is_certified_as_the_command_does(hypercircle, tmp_path):
    """The patch test: the exact displacement is linear on each body, so its own error is none but round-off."""
    scene = hypercircle.Scene(CASES / "patch.toml")
    solution = scene.solve()
    exact = solution.displacement
    arrays = solution.points, solution.triangles, exact
    certificate = scene.certify(*arrays, solution=True, out=tmp_path / "out")
    assert certificate.passed and certificate.diagnosis is None and certificate.relative_error_bound < 1e-6
    assert json.loads((tmp_path / "out/report.json").read_text())["verdict"] == certificate.verdict
    assert certificate.residual.shape == (len(solution.triangles),) and scene.diagnose(*arrays) is None
    half = solution.certify(*(a.tolist() for a in arrays[:2]), 0.5 * exact, solution=True, name="half of it")
    assert not half.passed and half.causes and half.residual.max() > 1e-3
    assert "half of it" in half.verdict and half.diagnosis["findings"]
    single = solution.certify(*arrays[:2], exact.astype(np.float32))
    assert single.passed and single.residual is None
    assert certificate.lower <= certificate.upper


def test_values_are_certified_without_a_field(hypercircle):
    asked = '[[quantities]]\nname = "seat"\nforce = "left_face|right_face"\n'
    text = (CASES / "two_blocks.toml").read_text().replace("size = 0.125", "size = 0.5") + asked
    scene = hypercircle.Scene.from_text(text)
    # The load is 4 - 7 y over a side of length one.
    assert scene.certify(values={"seat": 0.5}).passed
    solution = scene.solve()
    wrong = solution.certify(values={"seat": 0.6})
    assert not wrong.passed and wrong.relative_error_bound is None
    assert [check["name"] for check in wrong.checks if not check["passed"]] == ["quantity/seat/given"]
    assert 0.5 in solution.quantities["seat"] and 0.6 not in solution.quantities["seat"]
