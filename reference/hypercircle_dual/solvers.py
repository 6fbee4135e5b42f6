"""Ways from traction jumps to a correction of the unknowns with a given contact state.

:class:`Factorised` factorises once, with the diagonal of the jumps shifted so that K is definite even where contact alone
holds a body, and forms the Schur complement on the jumps by back-substitutions. :class:`Iterated` takes closed jumps out of
K and solves by an iteration; it finds the contact state by changing what stresses and jumps contradict. Its preconditioner
is that of :class:`Multigrid` or :class:`Substructured`.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np

from . import compat
from .contact import ContactProblem
from .model import Model

INNER = 1e-6
"""Relative residual of an iteration; refinement does the rest."""
MOST_ITERATIONS = 300
SPRING = 1e-6
"""Shift of the diagonal of open jumps, relative to it."""


class Factorised:
    """K with shifted jumps, factorised by MUMPS, and the contact problem that is left."""

    padded, whole_contact = False, False

    def __init__(self, model: Model) -> None:
        self.model = model
        self.iterations = self.first_iterations = 0
        matrix = model.matrix()
        diagonal = matrix.getDiagonal()
        self.shift = model.jumps(diagonal)
        add = diagonal.duplicate()
        add.set(0.0)
        model.set_jumps(add, self.shift)
        diagonal.axpy(1.0, add)
        matrix.setDiagonal(diagonal)
        matrix.zeroRowsColumns(model.held.astype(compat.INDEX), 1.0)
        compat.finish(matrix)
        self.assembled = perf_counter()
        self.solver = compat.factorisation(matrix)
        self.factorised = perf_counter()
        self.contact = ContactProblem(self._schur(), self.shift)

    def _schur(self) -> np.ndarray:
        """S = (A⁻¹ on the jumps)⁻¹ − shift, by one back-substitution for each jump; the shift keeps A⁻¹ well conditioned there."""
        m = self.model.files.jumps
        inverse = np.zeros((m, m))
        load, x = self.model.zero.duplicate(), self.model.zero.duplicate()
        for k in range(m):
            unit = np.zeros(m)
            unit[k] = 1.0
            load.set(0.0)
            self.model.set_jumps(load, unit)
            self._solve(load, x)
            inverse[k] = self.model.jumps(x)
        inverse = 0.5 * (inverse + inverse.T)
        return np.linalg.inv(inverse) - np.diag(self.shift) if m else inverse

    def _solve(self, load, x) -> None:
        compat.solve(self.solver, load, x)

    def _condense(self, r):
        """A⁻¹r without the part of r on held unknowns and jumps, and the load c that is left on the jumps.

        Closed jumps carry tractions as large as the load: solved for with the rest, their rounding would be all that is left
        of a small r.
        """
        on_jumps = self.model.jumps(r)
        r, z = r.copy(), r.duplicate()
        self._clear_held(r)
        self.model.set_jumps(r, np.zeros(len(on_jumps)))
        self._solve(r, z)
        jumps = self.model.jumps(z)
        return z, on_jumps + self.contact.apply(jumps) + self.shift * jumps

    def _expand(self, z, jumps: np.ndarray):
        """All unknowns, from A⁻¹r and the jumps they are to have."""
        change = jumps - self.model.jumps(z)
        load, x = z.duplicate(), z.duplicate()
        load.set(0.0)
        self.model.set_jumps(load, self.contact.apply(change) + self.shift * change)
        self._solve(load, x)
        x.axpy(1.0, z)
        self.model.set_jumps(x, jumps)
        return x

    def _clear_held(self, r) -> None:
        array = r.array
        array[self.model.held - self.model.numbering.first] = 0.0
        r.array = array

    def state(self, r, room: np.ndarray, start: np.ndarray):
        """The contact state under the load ``r`` with jumps up to ``room``, and the unknowns that go with it, if S tells."""
        z, c = self._condense(r)
        state = self._on_first(lambda: self.contact.solve(c, room, start))
        return state and (state, self._expand(z, state.jumps))

    def correct(self, r, closed: np.ndarray):
        """The change of the unknowns that takes ``r`` away while closed jumps and held unknowns stay."""
        z, c = self._condense(r)
        return self._expand(z, self._on_first(lambda: self.contact.with_closed(c, np.zeros(len(c)), closed)))

    def _on_first(self, find: Callable):
        """The result of ``find`` on the first rank, for all ranks, so that all go on with the same digits."""
        return self.model.comm.bcast(find() if self.model.comm.rank == 0 else None)


class Iterated:
    """K without its closed jumps, in a ``unit`` of its own, solved by conjugate gradients."""

    padded, whole_contact = False, False
    unit = 1.0

    def __init__(self, model: Model) -> None:
        self.model = model
        self.iterations = self.first_iterations = 0
        self.nodal, self.motions = model.nodal()
        self._assemble()
        self.assembled = perf_counter()
        self.solver, self.closed = None, None
        self._prepare(np.ones(model.files.jumps, bool))
        self.factorised = perf_counter()

    def _assemble(self) -> None:
        """Assembles the parts that do not depend on the contact state."""
        raise NotImplementedError

    def _preconditioned(self, closed: np.ndarray):
        """The solver for a contact state."""
        raise NotImplementedError

    def _prepare(self, closed: np.ndarray) -> None:
        if self.closed is not None and np.array_equal(closed, self.closed):
            return
        if self.solver is not None:
            self.solver.destroy()
            compat.collect(self.model.comm)
        self.closed = closed.copy()
        self.solver = self._preconditioned(closed)

    def state(self, r, room: np.ndarray, start: np.ndarray) -> None:
        """Nothing: the state is found by changing what stresses and jumps contradict."""

    def correct(self, r, closed: np.ndarray):
        """As :meth:`Factorised.correct`."""
        self._prepare(closed)
        load, x = r.duplicate(), r.duplicate()
        load.pointwiseMult(r, self.model.free(closed))
        load.scale(1.0 / self.unit)
        made = compat.solve(self.solver, load, x)
        self.first_iterations = self.first_iterations or made
        self.iterations += made
        return x


class Multigrid(Iterated):
    """Two levels: block Jacobi on the unknowns, and algebraic multigrid below.

    One step of the preconditioner smooths, corrects by a displacement linear on triangles, and smooths. On these K is the
    stiffness matrix of linear finite elements, where algebraic multigrid is at home.
    """

    padded = True

    def _assemble(self) -> None:
        self.matrix = self.model.matrix()

    def _preconditioned(self, closed: np.ndarray):
        matrix = self.matrix.copy()
        # Open contact may leave a body without hold; refinement takes what the springs do away.
        diagonal, springs = matrix.getDiagonal(), self.model.zero.duplicate()
        springs.set(0.0)
        self.model.set_jumps(springs, SPRING * self.model.jumps(diagonal))
        diagonal.axpy(1.0, springs)
        matrix.setDiagonal(diagonal)
        matrix.zeroRowsColumns(self.model.fixed_numbers(closed).astype(compat.INDEX), 1.0)
        compat.finish(matrix)
        nodal = self.nodal.copy()
        nodal.diagonalScale(self.model.free(closed), None)
        return compat.multigrid(matrix, nodal, self.motions, INNER, MOST_ITERATIONS)


class Substructured(Iterated):
    """Balancing domain decomposition by constraints: the triangles of each rank are a subdomain, which is factorised.

    Two subdomains agree in the moments of all rigid motions on what they share before any iteration. Where a rank has parts of
    two bodies in contact, or a part in pieces, this holds for each of them, or nothing would keep one in its place. Contact
    lies within subdomains: open contact between two would keep neither.
    """

    whole_contact = True

    def _assemble(self) -> None:
        self.matrix = self.model.subdomain()
        self.motions = [self.nodal * motion for motion in self.motions]
        self.fields = self.model.shared_parts()
        # Factorisations take small pivots for none: no row is to be below those that stand alone, which have ones. Powers of two
        # keep all digits.
        diagonal = self.matrix.getDiagonal().array_r
        least = self.model.comm.allreduce(diagonal[diagonal > 0.0].min(initial=np.inf), compat.MPI.MIN)
        self.unit = 2.0 ** np.round(np.log2(least)) if np.isfinite(least) else 1.0
        self.matrix.scale(1.0 / self.unit)

    def _preconditioned(self, closed: np.ndarray):
        numbering, matrix = self.model.numbering, self.matrix.copy()
        first = self.model.files.first_jump
        jumps = np.flatnonzero(numbering.natural >= first)
        fixed = np.isin(numbering.natural, self.model.files.held)
        fixed[jumps] = closed[numbering.natural[jumps] - first]
        diagonal = matrix.getDiagonal()
        values = diagonal.array
        values[jumps] *= 1.0 + SPRING
        diagonal.array = values
        matrix.setDiagonal(diagonal)
        fixed = np.flatnonzero(fixed).astype(compat.INDEX)
        matrix.zeroRowsColumns(fixed, 1.0)
        compat.finish(matrix)
        motions = [motion.copy() for motion in self.motions]
        for motion in motions:
            motion.pointwiseMult(motion.copy(), self.model.free(closed))
        return compat.substructured(
            self.model.comm, matrix, numbering.number, numbering.local, fixed, self.fields, motions, INNER, MOST_ITERATIONS
        )
