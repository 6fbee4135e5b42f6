"""The reduced problem: minimise ½ wᵀA w − bᵀw + Σ c |w − κ| over lower ≤ w ≤ upper, where A = TᵀK T and b = Tᵀ(f − K u0).

Unknowns are scaled so that A has a unit diagonal: residuals of a stiff and a soft body, in any units, are then
comparable. :mod:`descent` finds the minimum. The outcome is checked here by the conditions that prove a minimum, and
with it comes an estimate of what rounding can have done to the energy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sparse
from petsc4py import PETSc

from hypercircle_process import Failure, log

from .constraints import Constraints
from .coupled import CoupledDescent, Rows
from .descent import CLOSED, EPSILON, Descent, Minimum, absolute
from .model import Model

RESIDUAL = 1e-8
"""Largest admitted residual beyond its own rounding, relative to load and energy norm of the solution."""


@dataclass(frozen=True)
class Solution:
    """Displacement u and gradient 𝓛'(u) in the numbering of the exchange file, equal on all ranks.

    ``gradient`` (columns of T) is Tᵀ(K u − f); where a bound is active it is minus the multiplier, and the force of friction where
    there is any. Energies include the thickness, ``energy`` the work of ``friction``; ``energy_rounding`` estimates what
    rounding and residual can have cost it.
    """

    displacement: np.ndarray
    gradient: np.ndarray
    jumps: np.ndarray
    coupled: np.ndarray
    energy: float
    strain_energy: float
    friction: float
    energy_rounding: float
    iterations: int
    reason: int
    unknowns: int


class Reduced:
    """The model in the unknowns w, distributed over the ranks by where their nodes live."""

    def __init__(self, comm, model: Model, constraints: Constraints, extent: float):
        self.comm, self.model, self.constraints = comm, model, constraints
        self.reach = extent + float(np.max(np.abs(constraints.offset), initial=0.0))
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
        self.terms = self._terms()
        diagonal = self.A.getDiagonal()
        self.scale = diagonal.duplicate()
        self.scale.array[:] = 1.0 / np.sqrt(diagonal.array_r)
        self.A.diagonalScale(self.scale, self.scale)
        self.b.pointwiseMult(self.b, self.scale)
        self.terms *= self.scale.array_r
        self.lower, self.upper = self._mine(constraints.lower), self._mine(constraints.upper)
        self.kink, self.weight = self._mine(constraints.kink), self._own(constraints.weight) * self.scale.array_r

    def _terms(self) -> np.ndarray:
        """|T|ᵀ(|f| + |K| |u0|): what the entries of b are sums of, before they cancel."""
        offset, size, result = self.offset.copy(), self.model.load.copy(), self.b.duplicate()
        offset.abs()
        size.abs()
        size.axpy(1.0, absolute(self.model.stiffness) * offset)
        absolute(self.T).multTranspose(size, result)
        return result.array_r.copy()

    def _mine(self, values: np.ndarray) -> np.ndarray:
        """This rank's share of bounds, scaled like the unknowns."""
        return self._own(values) / self.scale.array_r

    def _own(self, values: np.ndarray) -> np.ndarray:
        """This rank's share of values, one for each unknown."""
        return values[self.order[self.begin : self.end]]

    def minimise(self) -> Solution:
        """Run the solver, check equilibrium and bounds, and gather the solution. Start with contacts closed whose gap
        the bodies could be thought to cross; where that fails, once more with those alone that are closed already.
        Without loads nothing crosses a gap, and the two come in the other order."""
        right = self.b.array_r.copy()
        descent = Descent(self.A, right, self.lower, self.upper, self.terms, self.kink, self.weight)
        first, second = self.reach / self.scale.array_r, CLOSED
        if not self.b.norm():
            first, second = second, first
        try:
            found = self._checked(descent, first)
        except Failure as failure:
            log(self.comm, f"{failure}; once more, from other closed contacts")
            try:
                found = self._checked(descent, second)
            except Failure:
                raise failure from None
        return self._gather(*found)

    def _checked(self, descent: Descent, near: np.ndarray | float) -> tuple[Minimum, np.ndarray]:
        """The minimum found from bounds nearer than ``near``, improved where it fails its check; and forces of coupled rows."""
        coupled = CoupledDescent(descent, self._coupled()) if self.constraints.coupled.rows else None
        found, forces = coupled.minimise(near) if coupled else (descent.minimise(near), np.zeros(0))
        try:
            self._check(descent, found)
        except Failure as failure:
            log(self.comm, f"{failure}; once more, with further motion resisted")
            found, forces = coupled.improved(found, forces) if coupled else (descent.improved(found), forces)
            self._check(descent, found)
        return found, forces

    def _coupled(self) -> Rows:
        """The coupled rows in the scaled unknowns."""
        coupled, scale = self.constraints.coupled, np.concatenate(self.comm.allgather(self.scale.array_r.copy()))
        matrix = (coupled.matrix @ self.constraints.T)[:, self.order] @ sparse.diags(scale)
        kink = -(coupled.matrix @ self.constraints.offset)
        return Rows.of(matrix.tocsr(), coupled.weight, kink)

    def _displacement(self, w: PETSc.Vec) -> PETSc.Vec:
        """u = T w + u0 of the unscaled unknowns."""
        u = self.T * w
        u.axpy(1.0, self.offset)
        return u

    def _size(self, w: np.ndarray) -> float:
        """Scale of a residual: load and energy norm. Scaled forces are square roots of energies."""
        unscaled = self.scale.copy()
        unscaled.array[:] *= w
        u = self._displacement(unscaled)
        return (self.b.norm() or self._overlap()) + np.sqrt(max(u.dot(self.model.stiffness * u), 0.0))

    def _overlap(self) -> float:
        """Energy norm of what undoes the overlaps at the start, and of what rounded coordinates do not show. Without loads a
        solution may be rigid, and these are all that its rounding can be held against."""
        undone = np.clip(0.0, self.lower, self.upper)
        unseen = EPSILON * self.reach / self.scale.min()[1]
        return np.sqrt(self.comm.allreduce(float(undone @ undone))) + unseen

    def _check(self, descent: Descent, found: Minimum) -> None:
        """Equilibrium, bounds and friction. What rounding leaves of a row of the residual says nothing against the solution."""
        x = found.w
        wrong = descent.imbalance(x, found.gradient)
        beyond = wrong - np.minimum(wrong, found.rounding)
        residual = np.sqrt(self.comm.allreduce(float(beyond @ beyond)))
        outside = self.comm.allreduce(int(np.sum((x > self.upper) | (x < self.lower))))
        load = self._size(x)
        if not residual <= RESIDUAL * load or outside:
            raise Failure(
                f"the solution fails its check: relative residual {residual / load if load else residual:.2e} "
                f"(allowed {RESIDUAL:.0e}), {outside} jumps beyond their bounds"
            )
        if not found.left <= load * load:
            raise Failure(
                f"round-off leaves nothing of the energy: the residual alone may have changed it by {found.left:.1e} "
                f"where {load * load:.1e} is at stake; a body moves rigidly by far more than displacements can resolve"
            )

    def _gather(self, found: Minimum, coupled: np.ndarray) -> Solution:
        rubs = self.weight > 0.0
        closed = [found.w == self.upper, found.w == self.lower, rubs & (found.w == self.kink)]
        slipped = self.comm.allreduce(float(self.weight @ np.abs(found.w - self.kink)))
        w, gradient = self.scale.duplicate(), self.scale.duplicate()
        w.array[:] = found.w * self.scale.array_r
        gradient.array[:] = found.gradient / self.scale.array_r
        mine = self.order[self.begin : self.end]
        # Scaling there and back may miss the bound by a rounding error.
        for at, bound in zip(closed, (self.constraints.upper, self.constraints.lower, self.constraints.kink)):
            w.array[at] = bound[mine[at]]
        u = self._displacement(w)
        strain_energy, work = self.model.strain_energy(u), u.dot(self.model.working)
        displacement = np.zeros(len(self.constraints.offset))
        pieces = self.comm.allgather((self.dofs, u.array_r.copy(), w.array_r.copy(), gradient.array_r.copy()))
        for dofs, values, *_ in pieces:
            displacement[dofs] = values
        rows = self.constraints.coupled
        friction = slipped + self.constraints.slid + float(rows.weight @ np.abs(rows.matrix @ displacement))
        jumps, derivative = np.empty(len(self.order)), np.empty(len(self.order))
        jumps[self.order] = np.concatenate([piece[2] for piece in pieces])
        derivative[self.order] = np.concatenate([piece[3] for piece in pieces])
        return Solution(
            displacement=displacement,
            gradient=derivative,
            jumps=jumps,
            coupled=coupled,
            energy=strain_energy + friction - work,
            strain_energy=strain_energy,
            friction=friction,
            energy_rounding=self._energy_rounding(u, strain_energy) + 4.0 * EPSILON * friction + found.left,
            iterations=found.steps,
            reason=found.reason,
            unknowns=len(self.order),
        )

    def _energy_rounding(self, u: PETSc.Vec, strain_energy: float) -> float:
        """Error of 𝓛(u) from a relative change of each displacement by some roundings, and from the sums over all of them.

        With |δu| ≤ ε |u|, ‖δu‖² ≤ ε² |u|ᵀ|K||u| in the energy norm, and 𝓛 changes by ‖u‖ ‖δu‖ + ½ ‖δu‖² + |f|ᵀ|δu|.
        """
        size, load = u.copy(), self.model.load.copy()
        size.abs()
        load.abs()
        change = 4.0 * EPSILON * np.sqrt(max(size.dot(absolute(self.model.stiffness) * size), 0.0))
        energy = max(strain_energy, 0.0)
        sums = EPSILON * np.sqrt(len(self.constraints.offset)) * (energy + size.dot(load))
        return np.sqrt(2.0 * energy) * change + 0.5 * change * change + 4.0 * sums


def minimise(comm, model: Model, constraints: Constraints, extent: float) -> Solution:
    """Solve the reduced problem on a mesh of that ``extent``; :class:`Failure` says why no solution can be trusted."""
    try:
        return Reduced(comm, model, constraints, extent).minimise()
    except PETSc.Error as error:
        raise Failure(f"PETSc stopped with error {error.ierr}: {error}") from error


def without_strongest_row(constraints: Constraints, solution: Solution) -> Constraints:
    """The constraints with one closed vertex jump left unbounded, a planted bug: the one with the largest reaction."""
    candidates = [row for row in constraints.rows if row.vertex >= 0 and row.factor > 0.0]
    if not candidates:
        raise Failure("there is no contact row to drop")
    strongest = max(candidates, key=lambda row: -solution.gradient[row.column] / row.factor)
    if not solution.gradient[strongest.column] < 0.0:
        raise Failure("no contact row is closed, so that dropping one would change nothing")
    upper = constraints.upper.copy()
    upper[strongest.column] = np.inf
    return replace(constraints, upper=upper)
