"""Refinement on the stresses.

Moments of a stiff body are those of its rigid motion but for a small rest, and only the rest gives stress. So the traction
jumps r of the present stresses are taken as a load, and the *stress* of the correction is added; directions are made
conjugate, steps minimise the energy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .model import Model

ROUND_OFF = 2e-14
"""Traction jumps against the loads at which refinement ends …"""
ENOUGH = 1e-11
"""… or at which it may end when it has not helped for some steps."""
PATIENCE, MOST_PATIENCE = 4, 25
UNBALANCED = 1e-4
"""Traction jumps against the loads that are more than what a solve leaves."""
HELD = 0.5
"""Part of the work of a load that stresses take up; springs have more than the rest where nothing holds a body."""


@dataclass
class Refined:
    """Unknowns x, mode parameters s of this rank's triangles, and the residual r of every unknown.

    On free unknowns r is a jump of traction, on closed jumps minus the normal traction. Where no equilibrium was found since the
    contact state leaves a body without hold against its load, ``motion`` is where that goes.
    """

    x: object
    s: np.ndarray
    r: object
    motion: object = None

    @classmethod
    def of(cls, model: Model, x) -> "Refined":
        """The stresses of the unknowns ``x``."""
        s = model.stresses(x, given=True)
        return cls(x, s, model.residual(s))

    def plus(self, model: Model, step: float, d, ds: np.ndarray) -> "Refined":
        """With ``step`` times a correction and its stresses added."""
        x, s = self.x.copy(), self.s + step * ds
        x.axpy(step, d)
        return Refined(x, s, model.residual(s))


def refine(
    model: Model, now: Refined, closed: np.ndarray, correct: Callable, enough: float, most: int
) -> Refined:
    """The stresses of least energy with this contact state, from those of ``now``."""
    free = model.free(closed)
    load = model.load_size

    def stray(r) -> float:
        masked = r.duplicate()
        masked.pointwiseMult(r, free)
        return masked.norm(3) / load if load > 0.0 else masked.norm(3)

    best, least, stale = now, stray(now.r), 0
    previous, motion = None, None
    for _ in range(most):
        if least <= enough or stale >= (PATIENCE if least <= ENOUGH else MOST_PATIENCE):
            break
        r = now.r.duplicate()
        r.pointwiseMult(now.r, free)
        d = correct(now.r, closed)
        product = d.dot(r)
        if previous is not None:
            last, r_last, product_last = previous
            d.axpy((product - d.dot(r_last)) / product_last, last)
        ds = model.stresses(d, given=False)
        energy = model.energy_product(ds, ds)
        if motion is None and energy < HELD * d.dot(r):
            motion = d.copy()
        step = d.dot(r) / energy if energy > 0.0 else np.nan
        if not np.isfinite(step):
            break
        now = now.plus(model, step, d, ds)
        size = stray(now.r)
        if size < least:
            best, least, stale = now, size, 0
        else:
            stale += 1
        previous = d, r, product
    return replace(best, motion=motion) if least > UNBALANCED else best
