"""The contact problem of ``hypercircle_dual`` against all its states, and files that contradict their format."""

import json
import os
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parent.parent


def least(schur, load, bound):
    """The minimum of ½ jᵀSj − cᵀj over j ≤ g: the least of those with each set of closed jumps that obey the bounds."""
    best = np.inf
    for closed in map(np.array, product((False, True), repeat=len(load))):
        jumps = np.where(closed, bound, 0.0)
        opened = ~closed
        if opened.any():
            rest = load[opened] - schur[np.ix_(opened, closed)] @ bound[closed]
            jumps[opened] = np.linalg.solve(schur[np.ix_(opened, opened)], rest)
        if np.all(jumps <= bound + 1e-12):
            best = min(best, 0.5 * jumps @ schur @ jumps - load @ jumps)
    return best


@pytest.mark.parametrize("seed", range(20))
def test_contact_state_has_least_energy(seed):
    from hypercircle_dual.contact import ContactProblem

    random = np.random.default_rng(seed)
    size = 7
    root = random.normal(size=(size, size))
    scale = 10.0 ** random.uniform(-4, 4, size)
    schur = (root @ root.T + 0.01 * np.eye(size)) * np.outer(scale, scale)
    load, bound = random.normal(size=size) * scale, np.abs(random.normal(size=size)) / scale
    guess = random.random(size) < (0.5 if seed % 2 else 1.0)
    state = ContactProblem(schur, np.diag(schur)).solve(load, bound, guess)
    assert np.all(state.jumps <= bound * (1.0 + 1e-12))
    assert np.all(state.jumps[state.closed] == pytest.approx(bound[state.closed]))
    energy = 0.5 * state.jumps @ schur @ state.jumps - load @ state.jumps
    assert energy == pytest.approx(least(schur, load, bound), rel=1e-9)


def test_newton_agrees_with_pivoting():
    from hypercircle_dual.contact import ContactProblem

    random = np.random.default_rng(5)
    root = random.normal(size=(12, 12))
    problem = ContactProblem(root @ root.T + np.eye(12), np.ones(12))
    load, bound = random.normal(size=12) * 3.0, np.full(12, 0.1)
    state = problem.solve(load, bound, np.ones(12, bool))
    assert np.array_equal(problem.scaled[0].newton(load, bound), state.closed)


def test_ranges_are_consecutive_numbers():
    from hypercircle_dual.exchange import ranges

    found = ranges(np.array([7, 2, 30]), np.array([2, 0, 3]))
    assert found.tolist() == [7, 8, 30, 31, 32]


HEADER = {
    "format": "hypercircle-dual", "version": 1, "triangles": 1, "unknowns": 12, "first_jump": 12, "parameters": 9,
    "held": [], "load": 1.0, "ranks": 1, "linear_solver": "mumps",
}  # fmt: skip


def call(folder, header):
    (folder / "problem.json").write_text(header)
    return subprocess.run(
        [sys.executable, "-m", "hypercircle_dual", str(folder / "problem.json")],
        env={**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"},
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "cannot be used"),
        (json.dumps({**HEADER, "version": 2}), "hypercircle-dual' 2"),
        (json.dumps({key: value for key, value in HEADER.items() if key != "load"}), "load"),
        (json.dumps(HEADER), "start.i64 cannot be read"),
    ],
)
def test_bad_files_are_refused(tmp_path, text, said):
    done = call(tmp_path, text)
    assert done.returncode == 2, done.stderr
    assert said in done.stderr and "Traceback" not in done.stderr


def test_ranks_that_do_not_see_each_other_are_refused(tmp_path):
    done = call(tmp_path, json.dumps({**HEADER, "ranks": 2}))
    assert done.returncode == 3 and "1 of 2 ranks see each other" in done.stderr, done.stderr


def problem(folder, matrices, load, first_jump, solver="mumps"):
    """Files of triangles with all unknowns each, whose Bᵀ are ``matrices`` (triangles, parameters, unknowns)."""
    triangles, parameters, unknowns = matrices.shape
    jumps = unknowns - first_jump
    header = {**HEADER, "triangles": triangles, "unknowns": unknowns, "first_jump": first_jump,
              "parameters": triangles * parameters, "linear_solver": solver}  # fmt: skip
    integers = {
        "start": np.arange(triangles + 1) * unknowns,
        "unknowns": np.tile(np.arange(unknowns), triangles),
        "matrix": np.arange(triangles) * parameters * unknowns,
        "parameter": np.arange(triangles + 1) * parameters,
        "blocks": np.append(np.arange(first_jump + 1), unknowns) if jumps else np.arange(unknowns + 1),
        "pair": np.zeros(jumps),
    }
    numbers = {
        "matrices": matrices, "given": np.zeros(triangles * parameters), "load": np.zeros(triangles * unknowns),
        "external": load, "bound": np.zeros(jumps), "round_off": np.zeros(jumps),
    }  # fmt: skip
    for name, values in integers.items():
        np.asarray(values, "<i8").tofile(folder / f"{name}.i64")
    for name, values in numbers.items():
        np.asarray(values, "<f8").tofile(folder / f"{name}.f64")
    np.ones(jumps, "u1").tofile(folder / "guess.u8")
    (folder / "problem.json").write_text(json.dumps(header))
    return folder / "problem.json"


def test_a_correction_has_the_digits_of_what_it_corrects(tmp_path):
    from hypercircle_dual import compat
    from hypercircle_dual.exchange import read
    from hypercircle_dual.model import Model
    from hypercircle_dual.solvers import Factorised

    random = np.random.default_rng(3)
    size, first_jump = 10, 8
    # Stiffnesses from 1 to 10⁻⁸, as of a slender body.
    root = np.linalg.qr(random.normal(size=(size, size)))[0] * 10.0 ** -np.linspace(0, 4, size)
    path = problem(tmp_path, root.T[None], np.zeros(size), first_jump)
    model = Model(compat.MPI.COMM_SELF, read(path), Factorised.padded)
    left = model.zero.duplicate()
    # The rest of a residual beside the tractions of closed contact.
    left.array = np.concatenate([1e-12 * random.normal(size=first_jump), np.ones(size - first_jump)])
    found = Factorised(model).correct(left, np.ones(size - first_jump, bool)).array_r[:first_jump]
    expected = np.linalg.solve((root @ root.T)[:first_jump, :first_jump], left.array_r[:first_jump])
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(expected).max())


class Springs:
    """Solves with K and springs at open jumps, and leaves the contact state to be found by changing it."""

    def __init__(self, stiffness):
        self.stiffness = stiffness

    def state(self, r, room, start):
        return None

    def correct(self, r, closed):
        free = np.append(np.ones(len(self.stiffness) - len(closed), bool), ~closed)
        springs = np.diag(np.append(np.zeros(len(free) - len(closed)), 1e-6 * np.ones(len(closed))))
        d = r.duplicate()
        d.set(0.0)
        values = np.zeros(len(free))
        values[free] = np.linalg.solve((self.stiffness + springs)[np.ix_(free, free)], r.array_r[free])
        d.array = values
        return d


def point_between_obstacles(tmp_path, load):
    """Settles a point that two obstacles may stop, at 0.3 and 0.5, by springs of stiffness 1 and 2; at first it touches none."""
    from hypercircle_dual import compat
    from hypercircle_dual.exchange import read
    from hypercircle_dual.model import Model
    from hypercircle_dual.run import Settled

    modes = np.array([[1.0, -1.0, 0.0], [np.sqrt(2.0), 0.0, -np.sqrt(2.0)]])
    path = problem(tmp_path, modes[None], [load, 0.0, 0.0], 1)
    np.array([0.3, 0.5]).tofile(tmp_path / "bound.f64")
    np.array([0, 1], "<i8").tofile(tmp_path / "pair.i64")
    np.zeros(2, "u1").tofile(tmp_path / "guess.u8")
    return Settled(Model(compat.MPI.COMM_SELF, read(path), False), Springs(modes.T @ modes))


def test_contact_stops_a_body_that_nothing_else_holds(tmp_path):
    settled = point_between_obstacles(tmp_path, 1.0)
    assert settled.closed.all()
    assert settled.now.x.array_r == pytest.approx([(1.0 + 0.3 + 2.0 * 0.5) / 3.0, 0.3, 0.5], rel=1e-12)
    assert settled.now.r.array_r[0] == pytest.approx(0.0, abs=1e-12)


def test_where_nothing_is_loaded_residuals_are_relative_to_the_least_that_counts(tmp_path):
    settled = point_between_obstacles(tmp_path, 0.0)
    assert not settled.closed.any()
    assert settled.model.load_size == HEADER["load"]


TWO_LEVELS = """
import numpy as np
from hypercircle_dual import compat

comm, n = compat.MPI.COMM_WORLD, 8
own = np.arange(n) + n * comm.rank
target = compat.matrix(comm, n, 2, np.full(n, n), np.zeros(n))
compat.add_blocks(target, own[None], (2.0 * np.eye(n) + 0.1)[None])
compat.finish(target)
# Four vertices on each rank; the last one moves nothing.
moving = own[:6] if comm.rank == comm.size - 1 else own
nodal = compat.entries(comm, (n, n), 2, moving, moving, np.ones(len(moving)))
motions = [compat.vector(comm, n) for _ in range(3)]
for motion, values in zip(motions, ([1.0, 0.0], [0.0, 1.0], [0.0, 1.0])):
    motion.array = np.tile(values, 4)
motions[2].array = motions[2].array_r * own
solver = compat.multigrid(target, nodal, motions, 1e-10, 50)
load = compat.vector(comm, n)
load.array = 1.0 + own
out = load.duplicate()
compat.solve(solver, load, out)
missing = (target * out - load).norm() / load.norm()
assert missing < 1e-9, missing
"""


def test_a_vertex_that_moves_nothing_is_in_no_way(mpirun):
    done = subprocess.run(
        [*mpirun, sys.executable, "-c", TWO_LEVELS],
        env={**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"},
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_a_missing_package_is_named(tmp_path):
    (tmp_path / "petsc4py.py").write_text("raise ModuleNotFoundError('no petsc4py here', name='petsc4py')")
    (tmp_path / "problem.json").write_text(json.dumps(HEADER))
    done = subprocess.run(
        [sys.executable, "-m", "hypercircle_dual", str(tmp_path / "problem.json")],
        env={**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 4
    assert done.stderr == "hypercircle-dual: not installed: petsc4py cannot be imported (no petsc4py here)\n"


@pytest.mark.parametrize("said", [[], [b"G", 5], [b"G", 1 << 16, *[0] * (1 << 16)]], ids=["nothing", "half", "no-ear"])
def test_part_that_ends_too_early_is_told(tmp_path, said):
    """A program that says nothing more, ends in the middle of a request, or before it has read a long answer."""
    text = b"".join(word if isinstance(word, bytes) else word.to_bytes(8, "little") for word in said)
    (tmp_path / "said").write_bytes(text)
    program = tmp_path / "part"
    program.write_text(f"#!/bin/sh\nexec 0<&-\ncat {tmp_path}/said\n")
    program.chmod(0o700)
    script = "import sys; from pathlib import Path; from hypercircle_dual.compat import MPI, PETSc;"
    script += "from hypercircle_dual.bracket import relay; relay(MPI.COMM_SELF, Path(sys.argv[1]), Path(sys.argv[2]))"
    ran = subprocess.run([sys.executable, "-c", script, program, tmp_path], cwd=ROOT, capture_output=True, text=True)
    assert ran.stderr.rstrip().endswith("the bracket of rank 0 ended before it was done"), ran.stderr
