"""Friction on jumps that several unknowns decide, as at the corner of a contact line or where the direction of contact turns.

The terms c_k |r_k·w − e_k| are no law of one unknown. Each gets one, s_k with the law c_k |s_k − e_k|, and r_k·w = s_k is asked for by
an augmented Lagrangian: forces f_k and a spring of stiffness STIFF in between, whose minimum :mod:`descent` finds; then
f_k += STIFF (r_k·w − s_k), until no spring is stretched. As the quadratic and the laws are convex that converges whatever STIFF
is, and what it converges to is the minimum of the problem and not of a regularised one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from mpi4py import MPI
from petsc4py import PETSc

from hypercircle_process import Failure, log

from .descent import CLOSED, EPSILON, ROUNDING, Descent, Minimum

STIFF, STIFFER, STIFFEST = 100.0, 30.0, 1e7
"""Stiffness of the springs beside the unit diagonal of A; by how much it grows where rounds gain little; and the most it is."""

SLOW = 0.3
"""Rounds gain little where what is stretched falls by less than this factor."""

SAME = 1e-3
"""A spring stays stretched where that changes by less than this part of it from round to round."""

STRETCHED = 1e-13
"""Springs are as good as rigid where they are stretched by less, relative to the largest jump."""

ROUNDS = 60
"""Rounds after which the method gives up."""


@dataclass(frozen=True)
class Rows:
    """r_k (m, n) as rows over all unknowns, each divided by its ``length``, with c_k and e_k (m,) to match; equal on all ranks."""

    matrix: sp.csr_matrix
    weight: np.ndarray
    kink: np.ndarray
    length: np.ndarray

    @staticmethod
    def of(matrix: sp.csr_matrix, weight: np.ndarray, kink: np.ndarray) -> "Rows":
        """Scales rows to unit length."""
        length = np.sqrt(np.asarray(matrix.multiply(matrix).sum(axis=1)).ravel())
        length[length == 0.0] = 1.0
        return Rows(sp.diags(1.0 / length) @ matrix, weight * length, kink / length, length)


class CoupledDescent:
    """A :class:`Descent` with coupled rows beside its own laws; the arrays are the share of this rank."""

    def __init__(self, descent: Descent, rows: Rows, stiff: float = STIFF):
        self.descent, self.rows, self.comm, self.stiff = descent, rows, descent.comm, stiff
        A = descent.A
        begin, end = A.getOwnershipRange()
        size, count = A.getSize()[0], len(rows.weight)
        first = np.asarray(self.comm.allgather(end))
        # Each row belongs to the rank of its first unknown, behind the unknowns of that rank.
        leader = np.array([row.indices[0] if row.nnz else 0 for row in rows.matrix], dtype=int)
        owner = np.searchsorted(first, leader, side="right")
        self.order = np.argsort(owner, kind="stable")
        counts = np.bincount(owner, minlength=self.comm.size)
        before = np.concatenate([[0], np.cumsum(counts)])
        self.own = self.order[before[self.comm.rank] : before[self.comm.rank + 1]]
        self.unknowns = end - begin
        rank_of = np.searchsorted(first, np.arange(size), side="right")
        number = np.arange(size) + before[rank_of]
        slack = np.empty(count, dtype=int)
        slack[self.order] = np.repeat(first, counts) + np.arange(count)
        self.columns, self.slack = (begin, end), slack
        # [r, −1] for every row, over all unknowns and jumps.
        R = rows.matrix.tocoo()
        i, j = np.concatenate([R.row, np.arange(count)]), np.concatenate([number[R.col], slack])
        stretch = sp.csr_matrix((np.concatenate([R.data, -np.ones(count)]), (i, j)), shape=(count, size + count))
        self.stretch = stretch
        mine = np.concatenate([number[begin:end], slack[self.own]])
        springs = (stiff * stretch.T @ stretch).tocsr()[mine]
        indptr, indices, values = A.getValuesCSR()
        own = sp.csr_matrix((values, number[indices], indptr), shape=(end - begin, size + count))
        whole = (sp.vstack([own, sp.csr_matrix((len(self.own), size + count))]) + springs).tocsr()
        diagonal = np.empty(size + count)
        for numbers, part in self.comm.allgather((mine, np.asarray(whole[np.arange(len(mine)), mine]).ravel())):
            diagonal[numbers] = part
        self.mine, self.scale = mine, 1.0 / np.sqrt(diagonal)
        whole = (sp.diags(self.scale[mine]) @ whole @ sp.diags(self.scale)).tocsr()
        whole.sort_indices()
        csr = (whole.indptr.astype(PETSc.IntType), whole.indices.astype(PETSc.IntType), whole.data)
        sizes = ((len(mine), size + count),) * 2
        self.matrix = PETSc.Mat().createAIJ(sizes, csr=csr, comm=A.getComm())
        self.matrix.assemble()

    def _joined(self, of_unknowns: np.ndarray, of_rows: np.ndarray) -> np.ndarray:
        return np.concatenate([of_unknowns, of_rows[self.own]])

    def _all(self, x: np.ndarray) -> np.ndarray:
        """The whole of a vector from the shares of all ranks."""
        whole = np.empty(len(self.scale))
        for numbers, part in self.comm.allgather((self.mine, x)):
            whole[numbers] = part
        return whole

    def minimise(self, near: np.ndarray | float, forces: np.ndarray | None = None) -> tuple[Minimum, np.ndarray]:
        """The minimum, with the forces of friction in its gradient, and the f_k (m,), which begin with ``forces``."""
        it, rows = self.descent, self.rows
        scale = self.scale[self.mine]
        infinite = np.full(len(rows.weight), np.inf)
        lower, upper = self._joined(it.lower, -infinite) / scale, self._joined(it.upper, infinite) / scale
        kink, weight = self._joined(it.kink, rows.kink) / scale, self._joined(it.weight, rows.weight) * scale
        wide = self._joined(np.broadcast_to(near, it.b.shape), infinite) / scale
        forces = np.zeros(len(rows.weight)) if forces is None else forces
        start, steps, best = None, 0, np.inf
        before, hurried = np.full(len(forces), np.inf), np.zeros(len(forces), bool)
        load = self.comm.allreduce(float(np.abs(it.terms).max(initial=0.0)), MPI.MAX)
        for _ in range(ROUNDS):
            right = self._joined(it.b, 0.0 * forces) - (self.stretch.T @ forces)[self.mine]
            terms = self._joined(it.terms, 0.0 * forces) + (abs(self.stretch).T @ np.abs(forces))[self.mine]
            descent = Descent(self.matrix, right * scale, lower, upper, terms * scale, kink, weight)
            found = descent.minimise(wide, start)
            start, steps = found.w, steps + found.steps
            x = self._all(found.w * scale)
            stretched = self.stretch @ x
            forces = forces + self.stiff * stretched
            size = max(np.abs(rows.kink).max(initial=0.0), np.abs(x[self.slack]).max(initial=0.0), self._size(x))
            worst = np.abs(stretched).max(initial=0.0)
            log(self.comm, f"coupled friction: stretched by {worst:.1e} of {size:.1e}")
            # Rounding ends what is gained from round to round, and so does that of what the loads do on the unit diagonal, or that of
            # displacements where those along the contact are next to none.
            hidden = worst <= EPSILON * max(load, ROUNDING * np.abs(x).max(initial=0.0))
            if hidden or worst <= STRETCHED * size or (worst >= best and worst <= 1e4 * STRETCHED * size):
                return self._found(found, forces, steps), forces / rows.length
            # What has all its unknowns held slides by what they say: its force is the whole bound, to which rounds would climb slowly.
            stays = (np.abs(stretched - before) <= SAME * np.abs(stretched)) & (np.abs(stretched) > STRETCHED * size)
            slides, before = stays & ~hurried & (np.abs(forces) < rows.weight), stretched
            if slides.any():
                forces = np.where(slides, np.copysign(rows.weight, stretched), forces)
                hurried, best = hurried | slides, np.inf
                continue
            if worst > SLOW * best and self.stiff < STIFFEST:
                return CoupledDescent(it, rows, STIFFER * self.stiff).minimise(near, forces)
            best = min(best, worst)
        raise Failure(f"the friction of coupled jumps has not settled after {ROUNDS} rounds")

    def improved(self, found: Minimum, forces: np.ndarray) -> tuple[Minimum, np.ndarray]:
        """:meth:`Descent.improved`, and the forces that go with it."""
        rows = self.rows

        def minimise(change: Descent, w: np.ndarray) -> Minimum:
            nonlocal forces
            left = replace(rows, kink=rows.kink - rows.matrix @ np.concatenate(self.comm.allgather(w)))
            moved, forces = CoupledDescent(change, left).minimise(CLOSED, forces * rows.length)
            return moved

        best = self.descent.improved(found, minimise)
        return replace(best, gradient=best.gradient + self._along(forces * rows.length)), forces

    def _along(self, forces: np.ndarray) -> np.ndarray:
        """What forces on the rows do on the unknowns of this rank."""
        begin, end = self.columns
        return (self.rows.matrix.T @ forces)[begin:end]

    def _size(self, x: np.ndarray) -> float:
        """The largest of the displacements that the jumps are sums of."""
        used = np.unique(self.stretch.indices)
        return float(np.abs(x[used]).max(initial=0.0))

    def _found(self, found: Minimum, forces: np.ndarray, steps: int) -> Minimum:
        """The share of the unknowns proper."""
        it = self.descent
        scale = self.scale[self.mine][: self.unknowns]
        w = found.w[: self.unknowns] * scale
        # Scaling there and back may miss a bound by a rounding error.
        for bound in (it.upper, it.lower, np.where(it.rubs, it.kink, np.inf)):
            w = np.where(np.isfinite(bound) & (np.abs(w - bound) <= 4.0 * EPSILON * np.abs(bound)), bound, w)
        return Minimum(w, it.gradient(w) + self._along(forces), found.rounding[: self.unknowns] / scale, found.left, steps, found.reason)
