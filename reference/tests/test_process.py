"""The command as it is called: files, exit codes, ranks."""

import copy
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from scenes import arched_blocks, two_blocks

ROOT = Path(__file__).parent.parent


DEGREES = ("--degree", "1", "--degree", "2", "--degree", "3")


def call(folder, *arguments, data=None, text=None, launcher=(), python=(), **environment):
    problem = folder / "problem.json"
    if data is not None or text is not None:
        problem.write_text(json.dumps(data) if text is None else text)
    command = [*launcher, sys.executable, *python, "-m", "hypercircle_reference", str(problem), "--out", str(folder / "out")]
    return subprocess.run(
        [*command, *arguments],
        env={**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", **environment},
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
    )  # fmt: skip


def result(folder, degree):
    return json.loads((folder / "out" / f"primal-P{degree}.json").read_text())


def test_writes_what_the_format_promises(tmp_path):
    data = two_blocks(4)
    done = call(tmp_path, *DEGREES, data=data)
    assert done.returncode == 0, done.stderr
    assert sorted(os.listdir(tmp_path / "out")) == ["primal-P1.json", "primal-P2.json", "primal-P3.json"]
    for degree in (1, 2, 3):
        found = result(tmp_path, degree)
        assert (found["format"], found["version"], found["degree"], found["ranks"]) == ("hypercircle-primal", 1, degree, 1)
        assert set(found["seconds"]) == {"import", "mesh", "assemble", "compile", "solve", "total"}
        assert np.shape(found["vertex_displacement"]) == (len(data["points"]), 2)
        contact = found["contacts"][0]
        assert len(contact["vertices"]) == len(contact["vertex_reaction"]) == 5
        if degree > 1:
            assert np.shape(found["edge_displacement"]) == ((degree - 1) * len(data["edges"]), 2)
            assert np.shape(contact["edge_reaction"]) == (4, degree - 1)
        else:
            assert found["edge_displacement"] is None and contact["edge_reaction"] is None
        assert (found["triangle_displacement"] is None) == (degree < 3)


def test_two_ranks_give_the_same_numbers(tmp_path, mpirun):
    data = two_blocks(8, angle=0.2, gap=0.01)
    folders = [tmp_path / "one", tmp_path / "two"]
    launchers = [(), mpirun]
    for folder, launcher in zip(folders, launchers):
        folder.mkdir()
        done = call(folder, *DEGREES, data=data, launcher=launcher)
        assert done.returncode == 0, done.stderr
    for degree in (1, 2, 3):
        one, two = (result(folder, degree) for folder in folders)
        assert two["ranks"] == 2
        assert two["energy"] == pytest.approx(one["energy"], rel=1e-12)
        assert np.array(two["vertex_displacement"]) == pytest.approx(np.array(one["vertex_displacement"]), abs=1e-10)
        reactions = [np.array(found["contacts"][0]["vertex_reaction"]) for found in (one, two)]
        assert reactions[1] == pytest.approx(reactions[0], abs=1e-11)


def test_two_ranks_settle_a_curved_contact(tmp_path, mpirun):
    folders = [tmp_path / "one", tmp_path / "two"]
    for folder, launcher in zip(folders, [(), mpirun]):
        folder.mkdir()
        done = call(folder, *DEGREES, data=arched_blocks(8, 0.1), launcher=launcher)
        assert done.returncode == 0, done.stderr
    for degree in (1, 2, 3):
        one, two = (result(folder, degree) for folder in folders)
        assert (two["ranks"], two["iterations"]) == (2, one["iterations"])
        assert two["energy"] == pytest.approx(one["energy"], rel=1e-12)
        assert 0.0 < two["energy_rounding"] < 1e-11 * abs(two["energy"])


def test_failure_of_several_ranks_ends_all(tmp_path, mpirun):
    data = two_blocks(2)
    data["clamped"] = []
    done = call(tmp_path, data=data, launcher=mpirun)
    assert done.returncode == 3
    assert not (tmp_path / "out").exists()


def test_no_support_is_a_failure_not_a_number(tmp_path):
    data = two_blocks(2)
    data["clamped"] = []
    done = call(tmp_path, data=data)
    assert done.returncode == 3
    assert "hypercircle-reference:" in done.stderr
    assert not (tmp_path / "out").exists()


def test_loss_of_contact_is_a_failure(tmp_path):
    done = call(tmp_path, data=two_blocks(4, load=-1.0))
    assert done.returncode == 3 and not (tmp_path / "out").exists()


def test_missing_package(tmp_path):
    (tmp_path / "dolfinx.py").write_text("raise ModuleNotFoundError('no dolfinx here', name='dolfinx')")
    done = call(tmp_path, data=two_blocks(2), PYTHONPATH=f"{tmp_path}{os.pathsep}{ROOT}")
    assert done.returncode == 4
    assert done.stderr.startswith("hypercircle-reference: not installed: dolfinx")
    assert done.stderr.count("\n") == 1


def test_a_failure_is_written_in_one_piece(monkeypatch):
    """Unbuffered output, as ``PYTHONUNBUFFERED`` asks for, mixes with the output of other ranks at the same time."""
    from hypercircle_process import Failure, NotInstalled, finish

    class Pieces(list):
        write = list.append

        def flush(self):
            pass

    def fails(with_what):
        raise with_what

    for failure, code, said in [
        (NotInstalled("nothing is here"), 4, "name: not installed: nothing is here\n"),
        (Failure("no contact"), 3, "name: no contact\n"),
        (ValueError("three"), 3, "name: ValueError: three\n"),
    ]:
        pieces = Pieces()
        monkeypatch.setattr(sys, "stderr", pieces)
        with pytest.raises(SystemExit) as end:
            finish("name", lambda: fails(failure))
        assert (end.value.code, pieces) == (code, [said])


def changed(path, value):
    data = copy.deepcopy(two_blocks(2))
    place = data
    for key in path[:-1]:
        place = place[key]
    if value is KeyError:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return json.dumps(data)


MALFORMED = {
    "empty": "",
    "truncated": changed(["thickness"], 1.0)[:200],
    "list": "[]",
    "format": changed(["format"], "other"),
    "version": changed(["version"], 2),
    "kinematics": changed(["kinematics"], "axisymmetric"),
    "thickness": changed(["thickness"], 0.0),
    "thickness text": changed(["thickness"], "1"),
    "thickness missing": changed(["thickness"], KeyError),
    "young": changed(["bodies", 0, "young"], -1.0),
    "poisson": changed(["bodies", 1, "poisson"], 0.5),
    "body_force": changed(["bodies", 1, "body_force"], [0.0]),
    "body not object": changed(["bodies", 1], 3),
    "body index": changed(["body", 0], 7),
    "nan": changed(["points", 0], [float("nan"), 0.0]),
    "infinite": changed(["points", 0], [1e999, 0.0]),
    "ragged": changed(["points", 0], [0.0]),
    "point text": changed(["points", 0], ["a", "b"]),
    "vertex index": changed(["triangles", 0], [0, 1, 99]),
    "negative index": changed(["triangles", 0], [0, 1, -1]),
    "fractional index": changed(["triangles", 0], [0, 1, 2.5]),
    "clockwise": changed(["triangles", 0], [4, 1, 0]),
    "no triangles": changed(["triangles"], []),
    "triangle_edges": changed(["triangle_edges", 0], [0, 0, 0]),
    "clamped edge": changed(["clamped", 0, "edge"], 999),
    "roller normal": changed(["roller", 0, "normal"], [0.0, -2.0]),
    "traction": changed(["tractions", 0, "values"], [[0.0, 1.0]]),
    "pairs": changed(["contacts", 0, "pairs"], {}),
    "pair edge": changed(["contacts", 0, "pairs", 0, "edges"], [0, 1]),
    "pair second": changed(["contacts", 0, "pairs", 0, "second"], [0, 1]),
    "pair edges empty": changed(["contacts", 0, "pairs", 0, "edges"], []),
    "rigid without edges": changed(["contacts", 0, "pairs", 0], {"second": None, "edges": []}),
    "pin": changed(["pins"], [{"vertex": 0}]),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_files_are_refused_by_name(tmp_path, name):
    from hypercircle_process import BadExchange
    from hypercircle_reference.exchange import read_problem

    path = tmp_path / "problem.json"
    path.write_text(MALFORMED[name])
    with pytest.raises(BadExchange) as refusal:
        read_problem(path)
    assert len(str(refusal.value)) > 10 and "\n" not in str(refusal.value)


@pytest.mark.parametrize("name", ("empty", "truncated", "list", "format", "nan"))
def test_malformed_files_end_with_two(tmp_path, name):
    done = call(tmp_path, text=MALFORMED[name])
    assert done.returncode == 2
    assert done.stderr.startswith("hypercircle-reference: ") and "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


def test_missing_file_and_folder(tmp_path):
    assert call(tmp_path).returncode == 2
    (tmp_path / "problem.json").mkdir()
    assert call(tmp_path).returncode == 2


def test_what_a_killed_run_left_half_compiled_is_compiled_anew(tmp_path):
    from hypercircle_reference import compat

    data, cache = two_blocks(2), tmp_path / "cache"
    home = {"XDG_CACHE_HOME": str(cache)}
    assert call(tmp_path, "--degree", "1", data=data).returncode == 0
    # As a run leaves them that is killed in the compiler: begun, and never finished.
    begun = time.time() - 2 * compat.ABANDONED
    (cache / "fenics").mkdir(parents=True)
    for source in compat.cache_folder().glob("*.c"):
        copy = Path(shutil.copy(source, cache / "fenics"))
        os.utime(copy, (begun, begun))
    start = time.monotonic()
    done = call(tmp_path, "--degree", "1", data=data, **home)
    assert done.returncode == 0, done.stderr
    assert time.monotonic() - start < 60.0


def test_a_module_that_another_process_compiles_is_waited_for(tmp_path):
    from mpi4py import MPI

    from hypercircle_reference import compat

    young, old, done = (tmp_path / f"libffcx_forms_{name}.c" for name in ("young", "old", "done"))
    for source in (young, old, done):
        source.touch()
    for source in (old, done):
        os.utime(source, (0.0, 0.0))
    done.with_name(f"{done.name}.cached").touch()
    compat.remove_abandoned(tmp_path)
    assert young.exists() and done.exists() and not old.exists()

    tries = []

    def compiles(failure, times):
        tries.append(failure)
        if len(tries) <= times:
            raise failure
        return "compiled"

    late = TimeoutError("JIT compilation timed out, probably due to a failed previous compile.")
    assert compat.jit(MPI.COMM_WORLD, lambda: compiles(late, 2)) == "compiled"
    assert len(tries) == 3
    tries.clear()
    with pytest.raises(RuntimeError):
        compat.jit(MPI.COMM_WORLD, lambda: compiles(RuntimeError("of another kind"), 1))
    assert len(tries) == 1
