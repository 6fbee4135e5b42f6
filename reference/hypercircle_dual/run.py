"""From the files of a problem to those of its answer: contact state and stresses in turn until they agree."""

from __future__ import annotations

import resource
from pathlib import Path
from time import perf_counter

import numpy as np

from hypercircle_process import Failure, log

from . import compat
from .exchange import Files, read
from .model import Model
from .refinement import ROUND_OFF, Refined, refine
from .solvers import Factorised, Iterated, Multigrid, Substructured

MOST_CHANGES = 60
"""Changes of the contact state at most, beside four for each end."""
GRAZING = 1e-12
"""Tension relative to the load and penetration relative to the largest jump that are round-off."""
UNSETTLED = 1e-8
"""As ``GRAZING``, after the changes have come to an end: with more there is no contact state."""
COARSE = 1e-4
"""Refinement of a contact state that is likely to change."""
MOST_REFINEMENTS, FEW_REFINEMENTS = 200, 4
"""Limits of its steps, and of those for a contact state that is likely to change."""
SOLVERS = {"mumps": Factorised, "gamg": Multigrid, "bddc": Substructured}


def solve(comm, path: Path) -> None:
    """Solve the problem of the file, and write the answer beside it."""
    start = perf_counter()
    files = read(path)
    if comm.size != files.ranks:
        raise Failure(
            f"{comm.size} of {files.ranks} ranks see each other: mpirun and mpi4py belong to different installations of MPI"
        )
    kind = SOLVERS[files.linear_solver]
    log(comm, f"{files.triangles} triangles, {files.unknowns} unknowns, {comm.size} ranks, PETSc {compat.PETSC_VERSION}")
    model = Model(comm, files, kind.padded, kind.whole_contact)
    solver = kind(model)
    settled = Settled(model, solver)
    log(comm, f"solved: {settled.steps} contact states, {solver.iterations} iterations")
    seconds = {
        "assemble": solver.assembled - start,
        "factor": solver.factorised - solver.assembled,
        "contact": settled.seconds_contact,
        "refine": settled.seconds_refine,
    }
    write(model, solver, settled, {name: comm.allreduce(value, compat.MPI.MAX) for name, value in seconds.items()})


class Settled:
    """Stresses ``now`` and the closed jumps ``closed`` that go with them, after ``steps`` contact states."""

    def __init__(self, model: Model, solver) -> None:
        self.model, self.solver = model, solver
        self.steps, self.seconds_contact, self.seconds_refine = 0, 0.0, 0.0
        self.bound = np.asarray(model.files.array("bound.f64"))
        self.round_off = np.asarray(model.files.array("round_off.f64"))
        self.pair = np.asarray(model.files.array("pair.i64"))
        zero = model.zero.duplicate()
        zero.set(0.0)
        self.now = Refined.of(model, zero)
        model.load_size = _largest(model.external) or _largest(self.now.r) or model.files.load
        self.seen: set[bytes] = set()
        self._change(np.array(model.files.array("guess.u8"), bool))
        for _ in range(MOST_CHANGES + 4 * len(self.bound)):
            self._refine(COARSE if isinstance(solver, Iterated) else ROUND_OFF)
            following = self._following()
            if np.array_equal(following, self.closed):
                # Where contact alone holds a body a few steps may leave it without balance.
                self._refine(ROUND_OFF)
                following = self._following()
                if np.array_equal(following, self.closed):
                    following = self._stopped(following)
                if np.array_equal(following, self.closed):
                    return
            self._change(following)
        self._refine(ROUND_OFF)
        if self._misses().max(initial=0.0) > UNSETTLED:
            raise Failure("the contact state could not be determined: ends keep opening and closing")

    def _change(self, start: np.ndarray) -> None:
        """Take another contact state, and the unknowns that the solver has for it.

        Where it has none, or leads back, closed jumps move to their bounds and refinement does the rest. States that have
        been there before change one end at a time, which cannot cycle.
        """
        begin = perf_counter()
        room = self.bound - self.model.jumps(self.now.x)
        found = self.solver.state(self.now.r, room, start) if self.steps <= MOST_CHANGES else None
        if found is None:
            closed = start
            if closed.tobytes() in self.seen:
                last = np.flatnonzero(closed != self.closed)[-1:]
                closed = self.closed.copy()
                closed[last] = ~closed[last]
            self.seen.add(closed.tobytes())
            self.closed, self.steps = closed, self.steps + 1
            d = self.now.x.duplicate()
            d.set(0.0)
            self.model.set_jumps(d, np.where(closed, room, 0.0))
        else:
            state, d = found
            self.closed, self.steps = state.closed, self.steps + state.steps
        self.now = self.now.plus(self.model, 1.0, d, self.model.stresses(d, given=False))
        self.seconds_contact += perf_counter() - begin

    def _refine(self, enough: float) -> None:
        begin = perf_counter()
        most = MOST_REFINEMENTS if enough == ROUND_OFF else FEW_REFINEMENTS
        self.now = refine(self.model, self.now, self.closed, self.solver.correct, enough, most)
        self.seconds_refine += perf_counter() - begin

    def _misses(self) -> np.ndarray:
        """By how much each jump misses its state: tension where it is closed, penetration where it is open."""
        traction = np.where(self.closed, -self.model.jumps(self.now.r), 0.0)
        jumps = self.model.jumps(self.now.x)
        pressure = np.full(self.pair.max(initial=-1) + 1, self.model.files.load)
        np.maximum.at(pressure, self.pair, -traction)
        whole = max(np.abs(jumps).max(initial=0.0), np.abs(self.bound).max(initial=0.0))
        over = np.where(self.closed, traction - self.round_off, jumps - self.bound)
        of = np.where(self.closed, pressure[self.pair], whole)
        return np.where(over > 0.0, over / np.maximum(of, np.finfo(float).tiny), 0.0)

    def _following(self) -> np.ndarray:
        """The state that stresses and jumps ask for, the same on all ranks.

        One that has been there before gives way to the one in which contact stops a motion.
        """
        following = self.model.comm.bcast(self.closed == (self._misses() <= GRAZING))
        changes = not np.array_equal(following, self.closed)
        return self._stopped(following) if changes and following.tobytes() in self.seen else following

    def _stopped(self, following: np.ndarray) -> np.ndarray:
        """The state in which contact stops a motion that nothing holds, the same on all ranks; ``following`` without such a motion.

        The first open ends on its way are closed too.
        """
        if self.now.motion is None:
            return following
        growth = np.where(self.closed, 0.0, self.model.jumps(self.now.motion))
        room = np.maximum(self.bound - self.model.jumps(self.now.x), 0.0)
        way = np.divide(room, growth, out=np.full(len(room), np.inf), where=growth > 0.0)
        first = way.min(initial=np.inf)
        return self.model.comm.bcast(self.closed | (way <= first) if np.isfinite(first) else following)


def _largest(vector) -> float:
    return vector.norm(3)


def write(model: Model, solver, settled: Settled, seconds: dict) -> None:
    """Each rank its own part of the arrays, then the report."""
    comm, files = model.comm, model.files
    if comm.rank == 0:
        files.make("parameters.f64", files.parameters)
        files.make("moments.f64", files.unknowns)
        files.make("closed.u8", files.jumps)
        files.make("owner.i64", files.triangles)
    comm.barrier()
    natural, local = model.numbering.own_part()
    files.write("parameters.f64", model.parameter_places, settled.now.s)
    files.write("moments.f64", natural, settled.now.x.array_r[local])
    files.write("owner.i64", model.triangles, np.full(len(model.triangles), comm.rank))
    if comm.rank == 0:
        files.write("closed.u8", np.arange(files.jumps), settled.closed)
    memory = comm.gather(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
    comm.barrier()
    if comm.rank == 0:
        files.answer(
            {
                "ranks": comm.size,
                "steps": settled.steps,
                "iterations": solver.iterations,
                "first_iterations": solver.first_iterations,
                "petsc": compat.PETSC_VERSION,
                "seconds": seconds,
                "memory": memory,
            }
        )
