"""The minimum of ½ wᵀA w − bᵀw + Σ c |w − κ| over lower ≤ w ≤ upper, by projected Newton steps that each lower the energy.

Bounds that hold w back are kept (the *face*), all other unknowns are moved to their minimum on it, and the step is bent
along the bounds it runs into, until the energy falls: Bertsekas, "Projected Newton methods for optimization problems
with simple constraints", SIAM J. Control Optim. 20 (1982). A bound is let go only where the gradient pulls away from it
by more than rounding, and only where the face's minimum is reached; then the step to the minimum of the larger face
goes downhill, however the bounds bend it. As the energy falls in each step, no face's minimum comes back, and the
method cannot jump between two states for ever.

Friction, the c |w − κ|, is linear on either side of its kink κ: an unknown that slips is bounded by the kink as by any bound, on the side
where it is, and one that sticks is held there as long as the gradient is at most c. That is w = κ + a − b with a, b ≥ 0.

The minimum on a face is found by conjugate gradients that are preconditioned with the factors of A + SHIFT on that
face: one or two iterations where the face is well supported. Where it can move without strain, the curvature of a
search direction is lost in rounding; the step then follows that direction until the bounds hold it.

Nothing here depends on units: whether a number matters is judged against what rounding leaves of the sums it comes
from, row by row. A has a unit diagonal. Arrays are the share of this rank.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from hypercircle_process import Failure, log

EPSILON = float(np.finfo(float).eps)

ROUNDING = 32.0
"""Largest rounding error of a row of A w − b, in units of the last place of the sum of its terms' absolute values."""

SHIFT = 1e-12
"""Added to the unit diagonal of what is factorised, so that a face that can move without strain has factors too."""

FACES = 200
"""Steps after which the method gives up; a hundred contacts that settle one after the other take fewer."""

CONJUGATE = 50
"""Conjugate gradients on one face before the bounds are looked at again."""

UNHELD = 1e-11
"""Below this, relative to all forces, what pulls a body in a direction that nothing holds is rounding of the data."""

STILL = 1e-9
"""Below this, relative to the fastest one, an unknown does not move along a direction without strain."""

HALVINGS = 30
"""Points tried along a bent path before the one where the first bound is met."""

IDLE = 3
"""Steps in a row whose effect on the energy is below the rounding of that effect, before no further one is tried."""

RESISTED, IMPROVEMENTS = 1e-6, 3
"""Added to the unit diagonal where further motion is resisted, and how often that is done."""

CLOSED = float(np.finfo(float).tiny)
"""Only bounds nearer than this hold at the start: those that are met already."""

AT_ROUNDING, NOTHING_LOWER = 2, 4
"""Why the method stopped: the gradient is down to its rounding, or no step lowers the energy measurably."""


@dataclass(frozen=True)
class Minimum:
    """Minimiser ``w``, gradient A w − b and what rounding may have left of it, row by row; ``left`` estimates
    the energy that residual and rounding can have cost."""

    w: np.ndarray
    gradient: np.ndarray
    rounding: np.ndarray
    left: float
    steps: int
    reason: int


class Descent:
    """The quadratic, its bounds, and the ``weight`` c and the ``kink`` κ of friction. ``A`` is a PETSc matrix with unit diagonal, the
    vectors are arrays; ``terms`` are the sums of absolute values that rounding of ``b`` comes from, by default those of its
    entries."""

    def __init__(
        self,
        A: PETSc.Mat,
        b: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        terms: np.ndarray | None = None,
        kink: np.ndarray | None = None,
        weight: np.ndarray | None = None,
    ):
        self.comm, self.A, self.b, self.lower, self.upper = A.getComm().tompi4py(), A, b, lower, upper
        self.kink = np.zeros_like(b) if kink is None else kink
        self.weight = np.zeros_like(b) if weight is None else weight
        self.rubs = self.weight > 0.0
        self.terms = (np.abs(b) if terms is None else terms) + self.weight
        self._take(np.zeros_like(b))
        self.absolute = absolute(A)
        self._in, self._out = A.createVecRight(), A.createVecLeft()
        self.begin = A.getOwnershipRange()[0]

    def minimise(self, near: np.ndarray | float = np.inf, start: np.ndarray | None = None) -> Minimum:
        """Start with every unknown at its bound where that is nearer than ``near``, since a body may be held by contact
        alone, or with those at a bound that are so at ``start``, and descend. From a bound far away, rounding can hide the way back."""
        nothing = np.zeros_like(self.b)
        if self._count((self.b != 0.0) | (self.lower > 0.0) | (self.upper < 0.0) | self.rubs & (self.kink != 0.0)) == 0:
            return Minimum(nothing, nothing, nothing, 0.0, 1, AT_ROUNDING)
        bound = np.where(np.isfinite(self.upper), self.upper, self.lower)
        bound = np.where(self.rubs, np.clip(self.kink, self.lower, self.upper), bound)
        bounded = np.isfinite(bound) & (np.abs(bound) < near)
        begin = np.clip(nothing if start is None else start, self.lower, self.upper)
        if start is not None:
            bounded, bound = (begin == self.upper) | (begin == self.lower) | self.rubs & (begin == self.kink), begin
        w, face = np.where(bounded, bound, begin), _Face(self, bounded)
        self._take(np.where(bounded, 0.0, np.sign(w - self.kink)))
        gradient, unit = self._gradient(w, nothing)
        step, _ = face.step(w, self._slope(gradient), unit)
        w = np.clip(w + step, self.low, self.high)
        # Where the answer is zero, what remains of this start must not count.
        floor = EPSILON * EPSILON * self.product(self.absolute, np.abs(w))
        faces, idle, met = 1, 0, None
        while True:
            gradient, unit = self._gradient(w, floor)
            if met is None:
                pulled = ROUNDING * unit
                self._take(self._sides(w, gradient, pulled))
                slope = self._slope(gradient)
                held = (w >= self.high) & (slope <= pulled) | (w <= self.low) & (slope >= -pulled)
            else:
                slope, held = self._slope(gradient), face.held | met
            if self._count(held != face.held) > 0:
                if faces == FACES:
                    raise Failure(f"the contact has not settled after {faces} steps")
                face.destroy()
                face, faces = _Face(self, held), faces + 1
            step, left = face.step(w, slope, unit)
            log(self.comm, f"step {faces}: {self._count(held)} bounds hold, energy to be gained {left:.3e}")
            moves = self._count(step != 0.0) > 0
            found = self._search(w, step, slope) if moves else None
            if found is not None:
                there, change, met = found
                idle = idle + 1 if -change <= ROUNDING * self.dot(unit, np.abs(there - w)) else 0
                w = there
                if idle < IDLE or met is not None:
                    continue
                gradient, unit = self._gradient(w, floor)
            elif met is not None:
                met = None  # the minimum of this face is reached: see which bounds to let go
                continue
            left += face.rounding(unit)
            face.destroy()
            return Minimum(w, gradient, ROUNDING * unit, left, faces, NOTHING_LOWER if moves else AT_ROUNDING)

    def improved(self, found: Minimum, minimise: Callable[[Descent, np.ndarray], Minimum] | None = None) -> Minimum:
        """This minimum with a smaller residual, where a motion that costs next to no energy has gone far: its rounding
        error is large beside the errors in all other directions, bounds included, and hides them. These are corrected
        with any further motion resisted (the proximal point method), by changes that are small again. ``minimise`` finds
        the change, if there is more to it than this quadratic, from the descent for it and what is changed."""
        matrix = self.A.copy()
        matrix.shift(RESISTED)
        best, w = found, found.w
        gradient, unit = self._gradient(w, 0.0)
        for _ in range(IMPROVEMENTS):
            bounds = (self.lower - w, self.upper - w)
            change = Descent(matrix, -gradient, *bounds, unit / EPSILON, self.kink - w, self.weight)
            moved = minimise(change, w) if minimise else change.minimise(CLOSED)
            there = np.where(moved.w == change.upper, self.upper, np.where(moved.w == change.lower, self.lower, w + moved.w))
            there = np.where(self.rubs & (moved.w == change.kink), self.kink, there)
            w = np.clip(there, self.lower, self.upper)
            gradient, unit = self._gradient(w, 0.0)
            best = Minimum(w, gradient, ROUNDING * unit, found.left, best.steps + moved.steps, best.reason)
        matrix.destroy()
        return best

    def gradient(self, w: np.ndarray) -> np.ndarray:
        """A w − b."""
        return self._gradient(w, 0.0)[0]

    def imbalance(self, w: np.ndarray, gradient: np.ndarray) -> np.ndarray:
        """How far the gradient A w − b is from what bounds and friction can balance, row by row."""
        side = np.sign(w - self.kink)
        least = np.where(self.rubs & (side == 0.0), -self.weight, self.weight * side)
        most = np.where(self.rubs & (side == 0.0), self.weight, self.weight * side)
        least, most = np.where(w <= self.lower, -np.inf, least), np.where(w >= self.upper, np.inf, most)
        return np.maximum(np.maximum(-gradient - most, least + gradient), 0.0)

    def _sides(self, w: np.ndarray, gradient: np.ndarray, pulled: np.ndarray) -> np.ndarray:
        """Which side of its kink each unknown is on, or is pulled to by more than friction and rounding; 0 where it sticks."""
        away = np.where(np.abs(gradient) > self.weight + pulled, -np.sign(gradient), 0.0)
        return np.where(w == self.kink, away, np.sign(w - self.kink))

    def _take(self, side: np.ndarray) -> None:
        """Bounds ``low`` and ``high`` on these sides of the kinks."""
        self.side = np.where(self.rubs, side, 0.0)
        self.low = np.where(self.rubs & (side >= 0.0), np.maximum(self.lower, self.kink), self.lower)
        self.high = np.where(self.rubs & (side <= 0.0), np.minimum(self.upper, self.kink), self.upper)

    def _slope(self, gradient: np.ndarray) -> np.ndarray:
        """The gradient with friction on the sides taken; where an unknown sticks, what friction leaves of it."""
        sticks = self.rubs & (self.side == 0.0)
        return np.where(sticks, gradient - np.clip(gradient, -self.weight, self.weight), gradient + self.weight * self.side)

    def _gradient(self, w: np.ndarray, floor: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A w − b, and a unit in the last place of each row."""
        size = self.product(self.absolute, np.abs(w)) + self.terms
        return self.product(self.A, w) - self.b, EPSILON * size + floor

    def _search(self, w: np.ndarray, step: np.ndarray, gradient: np.ndarray):
        """A point of lower energy on the path that ``step`` takes along the bounds, the change of the energy, and the
        bounds met (``None`` where the whole step was free to take). ``None`` if rounding hides every fall.

        Tried are points ever nearer, to meet many bounds at once where that pays; the last is where one is met first.
        """
        bound = np.where(step > 0.0, self.high, self.low)
        room = np.divide(bound - w, step, out=np.full_like(w, np.inf), where=step != 0.0)
        first = self.comm.allreduce(float(np.min(room[room > 0.0], initial=np.inf)), MPI.MIN)
        shortest = min(first, 1.0)
        for length in (*(0.5**k for k in range(HALVINGS)), shortest):
            last = length <= shortest
            length = max(length, shortest)
            met = room <= length
            moved = np.where(met, bound - w, length * step)
            slope, curvature = self.dot(gradient, moved), self.dot(moved, self.product(self.A, moved))
            if last and -slope < curvature:
                # Bounds met at once keep their unknowns where they are, and what is left of the step is too long.
                share = -slope / curvature
                met, moved, slope, curvature = room <= 0.0, share * moved, share * slope, share * share * curvature
            change = slope + 0.5 * curvature
            if change <= 0.1 * slope < 0.0:
                there = np.where(met, bound, np.clip(w + moved, self.low, self.high))
                return there, change, met if self._count(met) > 0 else None
            if last:
                break
        return None

    def product(self, matrix: PETSc.Mat, x: np.ndarray) -> np.ndarray:
        """Matrix times vector."""
        self._in.array[:] = x
        matrix.mult(self._in, self._out)
        return self._out.array_r.copy()

    def dot(self, x: np.ndarray, y: np.ndarray) -> float:
        """Scalar product over all ranks, the same number on each."""
        return self.comm.allreduce(float(x @ y))

    def _any(self, condition: np.ndarray) -> bool:
        return self._count(condition) > 0

    def _count(self, condition: np.ndarray) -> int:
        return self.comm.allreduce(int(np.count_nonzero(condition)))


class _Face:
    """All w whose ``held`` entries stay where they are, with the factors that lead to its minimum."""

    def __init__(self, descent: Descent, held: np.ndarray):
        self.descent, self.held = descent, held
        matrix = descent.A.copy()
        matrix.shift(SHIFT)
        matrix.zeroRowsColumns((np.flatnonzero(held) + descent.begin).astype(PETSc.IntType), 1.0)
        self._ksp = PETSc.KSP().create(matrix.getComm())
        self._ksp.setType("preonly")
        preconditioner = self._ksp.getPC()
        preconditioner.setType("lu")
        preconditioner.setFactorSolverType("mumps")
        self._ksp.setOperators(matrix)
        self._matrix, self._in, self._out = matrix, matrix.createVecRight(), matrix.createVecLeft()

    def destroy(self) -> None:
        """Give the factors back."""
        self._ksp.destroy()
        self._matrix.destroy()

    def step(self, w: np.ndarray, gradient: np.ndarray, unit: np.ndarray) -> tuple[np.ndarray, float]:
        """The way from ``w`` to the minimum on this face, zero where rounding leaves nothing to gain; and that gain."""
        it = self.descent
        step, residual = np.zeros_like(w), np.where(self.held, 0.0, -gradient)
        ahead = self._solve(residual)
        left = 0.5 * it.dot(np.abs(residual), np.abs(ahead))
        slope, direction = it.dot(residual, ahead), ahead
        for _ in range(CONJUGATE):
            # Of sums of rounded terms with signs by chance, the root of the sum of squares is left.
            if not slope > np.sqrt(it.dot(unit * unit, ahead * ahead)):
                break
            image = np.where(self.held, 0.0, it.product(it.A, direction))
            curvature = it.dot(direction, image)
            size = np.abs(direction)
            if curvature <= 4.0 * EPSILON * it.dot(size, it.product(it.absolute, size)):
                wrong = unit + EPSILON * it.product(it.absolute, np.abs(step))
                noise = np.sqrt(it.dot(wrong * wrong, direction * direction))
                reach = self._reach(w + step, direction) if slope > ROUNDING * noise else None
                if reach is not None:
                    return step + reach * direction, left
                if slope > UNHELD / EPSILON * np.sqrt(it.dot(unit, unit) * it.dot(direction, direction)):
                    raise Failure(
                        "neither supports nor contacts hold the bodies against the loads, or so softly beside the "
                        "stiffness of a body that rounding hides it"
                    )
                # In balance but for the rounding of coordinates and loads: SHIFT holds the body well enough.
                return step + ahead, left
            length = slope / curvature
            step, residual = step + length * direction, residual - length * image
            ahead = self._solve(residual)
            before, slope = slope, it.dot(residual, ahead)
            direction = ahead + slope / before * direction
        return step, left

    def rounding(self, unit: np.ndarray) -> float:
        """The energy that a gradient wrong by some units in the last place costs, the sign of each row by chance.

        The entries of A are rounded too, which no residual shows: a body whose strain they lose moves as they say.
        """
        signs = np.random.default_rng(self.descent.begin).choice((-1.0, 1.0), len(unit))
        wrong = np.where(self.held, 0.0, 4.0 * signs * unit)
        return 0.5 * abs(self.descent.dot(wrong, self._solve(wrong)))

    def _solve(self, right: np.ndarray) -> np.ndarray:
        self._in.array[:] = right
        self._ksp.solve(self._in, self._out)
        if self._ksp.getConvergedReason() < 0:
            raise Failure("PETSc could not factorise the stiffness matrix")
        return np.where(self.held, 0.0, self._out.array_r)

    def _reach(self, w: np.ndarray, direction: np.ndarray) -> float | None:
        """How far it is along ``direction`` until every bound in the way is met; ``None`` where there is none."""
        comm = self.descent.comm
        largest = comm.allreduce(float(np.max(np.abs(direction), initial=0.0)), MPI.MAX)
        bound = np.where(direction > 0.0, self.descent.high, self.descent.low)
        meets = np.isfinite(bound) & (np.abs(direction) > STILL * largest)
        if self.descent._count(meets) == 0:
            return None
        return comm.allreduce(float(np.max((bound - w)[meets] / direction[meets], initial=0.0)), MPI.MAX) or 1.0


def absolute(matrix: PETSc.Mat) -> PETSc.Mat:
    """The matrix of absolute values, for bounds on the rounding of sums."""
    rows, columns, values = matrix.getValuesCSR()
    result = PETSc.Mat().createAIJ(matrix.getSizes(), csr=(rows, columns, np.abs(values)), comm=matrix.getComm())
    result.assemble()
    return result
