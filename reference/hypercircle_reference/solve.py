"""Minimise ½ wᵀA w − bᵀw over lower ≤ w ≤ upper with PETSc, where A = TᵀK T and b = Tᵀ(f − K u0).

Unknowns are scaled so that A has a unit diagonal: residuals of a stiff and a soft body, in any units, are then
comparable. PETSc's reduced-space Newton method for variational inequalities (``vinewtonrsls``) starts from the displacement with
every jump at its bound: a body that only contact holds has no solution with all jumps free. The outcome is checked
here, not taken from PETSc's word.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from . import ReferenceFailure, log
from .constraints import Constraints
from .model import Model

RESIDUAL = 1e-8
"""Largest admitted residual, relative to load and energy norm of the solution."""

ENERGY = 1e-5
"""Largest admitted effect of the residual on the energy, relative to the same."""


@dataclass(frozen=True)
class Solution:
    """Displacement u and gradient 𝓛'(u) in the numbering of the exchange file, equal on all ranks.

    ``gradient`` (columns of T) is Tᵀ(K u − f); where a bound is active it is minus the multiplier. Energies include
    the thickness.
    """

    displacement: np.ndarray
    gradient: np.ndarray
    jumps: np.ndarray
    energy: float
    strain_energy: float
    iterations: int
    reason: int
    unknowns: int


class Reduced:
    """The model in the unknowns w, distributed over the ranks by where their nodes live."""

    def __init__(self, comm, model: Model, constraints: Constraints):
        self.comm, self.model, self.constraints = comm, model, constraints
        nodes, ranges = model.numbering.nodes, model.numbering.ranges
        T = constraints.T.tocsc()
        T.sort_indices()
        representative = nodes[T.indices[T.indptr[:-1]] // 2]
        owner = np.searchsorted(ranges[:, 1], representative, side="right")
        self.order = np.lexsort((representative, owner))
        ends = np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=comm.size))])
        self.begin, self.end = int(ends[comm.rank]), int(ends[comm.rank + 1])
        mine = model.numbering.owned(comm.rank)
        self.dofs = (2 * mine[:, None] + np.arange(2)).reshape(-1)
        local = T[:, self.order].tocsr()[self.dofs]
        local.sort_indices()
        sizes = ((len(self.dofs), 2 * int(ranges.max())), (self.end - self.begin, len(self.order)))
        csr = (local.indptr.astype(PETSc.IntType), local.indices.astype(PETSc.IntType), local.data)
        self.T = PETSc.Mat().createAIJ(sizes, csr=csr, comm=comm)
        self.T.assemble()
        self.A = model.stiffness.PtAP(self.T)
        self.offset = model.load.duplicate()
        self.offset.array[:] = constraints.offset[self.dofs]
        right = model.load.copy()
        right.axpy(-1.0, model.stiffness * self.offset)
        self.b = self.A.createVecRight()
        self.T.multTranspose(right, self.b)
        diagonal = self.A.getDiagonal()
        self.scale = diagonal.duplicate()
        self.scale.array[:] = 1.0 / np.sqrt(diagonal.array_r)
        self.A.diagonalScale(self.scale, self.scale)
        self.b.pointwiseMult(self.b, self.scale)
        self.lower, self.upper = self._vector(constraints.lower), self._vector(constraints.upper)
        bounded = np.zeros(len(self.order), dtype=bool)
        bounded[constraints.bounded] = True
        local_bounded = bounded[self.order[self.begin : self.end]]
        self.bounded = np.flatnonzero(local_bounded).astype(PETSc.IntType)
        self.unbounded = np.flatnonzero(~local_bounded).astype(PETSc.IntType)

    def _vector(self, values: np.ndarray) -> PETSc.Vec:
        vector = self.A.createVecRight()
        scaled = values[self.order[self.begin : self.end]] / self.scale.array_r
        vector.array[:] = np.clip(scaled, PETSc.NINFINITY, PETSc.INFINITY)
        return vector

    def residual(self, w: PETSc.Vec) -> PETSc.Vec:
        """A w − b."""
        out = self.A * w
        out.axpy(-1.0, self.b)
        return out

    def clamped_start(self) -> PETSc.Vec:
        """The minimiser with every jump held at its bound."""
        w = self.A.createVecRight()
        upper, lower = self.upper.array_r[self.bounded], self.lower.array_r[self.bounded]
        w.array[self.bounded] = np.where(upper < PETSc.INFINITY, upper, lower)
        right = self.residual(w)
        right.scale(-1.0)
        rows = PETSc.IS().createGeneral(self.unbounded + self.begin, comm=self.comm)
        matrix = self.A.createSubMatrix(rows, rows)
        free_right = right.getSubVector(rows)
        step = free_right.duplicate()
        ksp = PETSc.KSP().create(self.comm)
        _direct(ksp)
        ksp.setOperators(matrix)
        ksp.solve(free_right, step)
        if ksp.getConvergedReason() < 0 or not np.isfinite(step.norm()):
            raise ReferenceFailure("the supports do not hold the bodies even with every contact closed")
        w.array[self.unbounded] = step.array_r
        right.restoreSubVector(rows, free_right)
        ksp.destroy()
        return w

    def minimise(self) -> Solution:
        """Run the solver, check residual and feasibility, and gather the solution."""
        w = self.clamped_start()
        start = load = self._size(w)
        iterations, reason = 0, 2
        if len(self.constraints.bounded):
            # A second run only polishes: the round-off to be expected is known once the size of w is.
            for _ in range(2):
                tolerance = max(1e-13 * load, np.finfo(float).eps * self._norm() * w.norm())
                steps, reason = self._newton(w, tolerance, load)
                iterations += steps
                # A wide gap makes the start far larger than the solution, which is what counts.
                load = max(self._size(w), 1e-5 * start)
        else:
            iterations = 1
        gradient = self.residual(w)
        self._check(w, gradient, load)
        return self._gather(w, gradient, iterations, reason)

    def _size(self, w: PETSc.Vec) -> float:
        """What a residual is compared with: load and energy norm. Scaled forces are square roots of energies."""
        unscaled = w.duplicate()
        unscaled.pointwiseMult(w, self.scale)
        u = self.T * unscaled
        u.axpy(1.0, self.offset)
        return self.b.norm() + np.sqrt(max(u.dot(self.model.stiffness * u), 0.0))

    def _norm(self) -> float:
        return self.A.norm(PETSc.NormType.INFINITY)

    def _newton(self, w: PETSc.Vec, tolerance: float, load: float) -> tuple[int, int]:
        options = PETSc.Options()
        prefix = "hypercircle_"
        # PETSc's own tolerance for "on the bound" is an absolute length, which no choice of units would survive; the
        # projection puts w on the bound exactly.
        options[prefix + "snes_vi_zero_tolerance"] = 0.0
        options[prefix + "snes_linesearch_type"] = "basic"
        snes = PETSc.SNES().create(self.comm)
        snes.setOptionsPrefix(prefix)
        snes.setType("vinewtonrsls")
        snes.setFunction(lambda _, x, out: self.residual(x).copy(out), self.b.duplicate())
        snes.setJacobian(lambda *_: None, self.A)
        snes.setVariableBounds(self.lower, self.upper)
        snes.setTolerances(rtol=0.0, atol=tolerance, stol=0.0, max_it=100)
        snes.setConvergenceTest(_Stop(tolerance, 0.1 * RESIDUAL * load))
        snes.setMonitor(lambda _, step, norm: log(self.comm, f"newton step {step}, residual {norm:.3e}"))
        _direct(snes.getKSP())
        snes.setFromOptions()
        snes.solve(None, w)
        steps, reason = snes.getIterationNumber(), snes.getConvergedReason()
        snes.destroy()
        if reason < 0:
            raise ReferenceFailure(f"PETSc's variational-inequality solver stopped with reason {reason} after {steps} steps")
        return steps, reason

    def _check(self, w: PETSc.Vec, gradient: PETSc.Vec, load: float) -> None:
        """Equilibrium, bounds, and the digits that round-off leaves: the residual's work bounds the error in 𝓛."""
        x, g = w.array_r, gradient.array_r
        lower, upper = self.lower.array_r, self.upper.array_r
        wrong = g.copy()
        wrong[(x >= upper) & (g <= 0.0)] = 0.0
        wrong[(x <= lower) & (g >= 0.0)] = 0.0
        residual = np.sqrt(self.comm.allreduce(float(wrong @ wrong)))
        outside = self.comm.allreduce(int(np.sum((x > upper) | (x < lower))))
        finite = np.isfinite(residual)
        if not finite or residual > RESIDUAL * load or outside:
            raise ReferenceFailure(
                f"the solution fails its check: relative residual {residual / load if load else residual:.2e} "
                f"(allowed {RESIDUAL:.0e}), {outside} jumps beyond their bounds"
            )
        if residual * w.norm() > ENERGY * load * load:
            raise ReferenceFailure(
                f"round-off may have changed the energy by {residual * w.norm() / (load * load):.1e} of itself (allowed "
                f"{ENERGY:.0e}): a body moves rigidly by far more than it deforms, beyond what displacements can resolve"
            )

    def _gather(self, w: PETSc.Vec, gradient: PETSc.Vec, iterations: int, reason: int) -> Solution:
        closed = [w.array_r == bound.array_r for bound in (self.upper, self.lower)]
        w.pointwiseMult(w, self.scale)
        gradient.pointwiseDivide(gradient, self.scale)
        mine = self.order[self.begin : self.end]
        # Scaling there and back may miss the bound by a rounding error.
        for at, bound in zip(closed, (self.constraints.upper, self.constraints.lower)):
            w.array[at] = bound[mine[at]]
        u = self.T * w
        u.axpy(1.0, self.offset)
        strain_energy = 0.5 * u.dot(self.model.stiffness * u)
        displacement = np.zeros(len(self.constraints.offset))
        pieces = self.comm.allgather((self.dofs, u.array_r.copy(), w.array_r.copy(), gradient.array_r.copy()))
        for dofs, values, *_ in pieces:
            displacement[dofs] = values
        jumps, derivative = np.empty(len(self.order)), np.empty(len(self.order))
        jumps[self.order] = np.concatenate([piece[2] for piece in pieces])
        derivative[self.order] = np.concatenate([piece[3] for piece in pieces])
        return Solution(
            displacement=displacement,
            gradient=derivative,
            jumps=jumps,
            energy=strain_energy - u.dot(self.model.load),
            strain_energy=strain_energy,
            iterations=iterations,
            reason=reason,
            unknowns=len(self.order),
        )


class _Stop:
    """Converged below ``tolerance``, or below ``enough`` when round-off keeps the residual from falling further."""

    def __init__(self, tolerance: float, enough: float):
        self.tolerance, self.enough, self.before = tolerance, enough, np.inf

    def __call__(self, snes, step: int, norms) -> int:
        residual = norms[2]
        stuck = residual <= self.enough and residual > 0.5 * self.before
        self.before = residual
        if residual <= self.tolerance:
            return PETSc.SNES.ConvergedReason.CONVERGED_FNORM_ABS
        if stuck:
            return PETSc.SNES.ConvergedReason.CONVERGED_FNORM_RELATIVE
        if not np.isfinite(residual):
            return PETSc.SNES.ConvergedReason.DIVERGED_FNORM_NAN
        return PETSc.SNES.ConvergedReason.CONVERGED_ITERATING


def _direct(ksp: PETSc.KSP) -> None:
    ksp.setType("preonly")
    preconditioner = ksp.getPC()
    preconditioner.setType("lu")
    preconditioner.setFactorSolverType("mumps")


def minimise(comm, model: Model, constraints: Constraints) -> Solution:
    """Solve the reduced problem; :class:`ReferenceFailure` says why there is no solution to trust."""
    try:
        return Reduced(comm, model, constraints).minimise()
    except PETSc.Error as error:
        raise ReferenceFailure(f"PETSc stopped with error {error.ierr}: {error}") from error


def without_strongest_row(constraints: Constraints, solution: Solution) -> Constraints:
    """The constraints with one closed vertex jump left unbounded, a planted bug: the one with the largest reaction."""
    candidates = [row for row in constraints.rows if row.vertex >= 0 and row.factor > 0.0]
    if not candidates:
        raise ReferenceFailure("there is no contact row to drop")
    strongest = max(candidates, key=lambda row: -solution.gradient[row.column] / row.factor)
    if not solution.gradient[strongest.column] < 0.0:
        raise ReferenceFailure("no contact row is closed, so that dropping one would change nothing")
    upper = constraints.upper.copy()
    upper[strongest.column] = np.inf
    return Constraints(constraints.T, constraints.offset, constraints.lower, upper, constraints.rows)
