"""The contact problem on its jumps alone: min ½ jᵀSj − cᵀj over j ≤ g, with the dense Schur complement S.

Primal–dual active sets, started from a first guess; where they come back to a state they have been in, TAO's
bound-constrained Newton method gives another start. The problem is solved in units in which the diagonal of S is one; where
that fails, in units that are kept from rounding, which is all that is left of S where nothing but contact holds a body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from hypercircle_process import Failure

from . import compat

MOST_STEPS = 200
GRAZING = 1e-13
"""Tension and penetration below this fraction of the terms at the end, or of the largest jump, are round-off."""
SPRINGS = (0.0, 1e-13, 1e-11, 1e-9)
"""Shifts of the diagonal of S where the open part has free motions: the least that leaves it definite is used."""
SOFT = (1e-12, 1e-4)
"""Parts of the diagonal of K below which that of S counts as this part."""


@dataclass(frozen=True)
class State:
    """Jumps (m,), which of them are at their bound, and the steps taken."""

    jumps: np.ndarray
    closed: np.ndarray
    steps: int


class ContactProblem:
    """S (m, m); ``stiffness`` (m,) is the diagonal of K."""

    def __init__(self, schur: np.ndarray, stiffness: np.ndarray) -> None:
        self.schur = schur
        self.scaled = [Scaled(schur, np.maximum(np.diag(schur), soft * stiffness)) for soft in SOFT]

    def apply(self, jumps: np.ndarray) -> np.ndarray:
        """S j."""
        return self.schur @ jumps

    def solve(self, load: np.ndarray, bound: np.ndarray, closed: np.ndarray) -> State | None:
        """The contact state, or nothing where S does not tell it; ``closed`` (m,) is a first guess of the closed jumps."""
        for scaled in self.scaled:
            found = scaled.pivot(load, bound, closed) or scaled.pivot(load, bound, scaled.newton(load, bound))
            if found is not None:
                return found
        return None

    def with_closed(self, load: np.ndarray, bound: np.ndarray, closed: np.ndarray) -> np.ndarray:
        """Jumps with the closed ones at their bound and the others in equilibrium."""
        for scaled in self.scaled:
            jumps = scaled.equilibrium(load * scaled.unit, bound / scaled.unit, closed)
            if jumps is not None:
                return jumps * scaled.unit
        raise Failure("the contact state could not be determined: its open part leaves a body without hold")


class Scaled:
    """S (m, m) in units ``unit`` (m,) that make ``diagonal`` one: jumps are these times the numbers that it takes."""

    def __init__(self, schur: np.ndarray, diagonal: np.ndarray) -> None:
        self.unit = 1.0 / np.sqrt(diagonal)
        self.matrix = schur * np.outer(self.unit, self.unit)

    def newton(self, load: np.ndarray, bound: np.ndarray) -> np.ndarray:
        """Closed jumps, nearly."""
        return compat.newton(self.matrix, load * self.unit, bound / self.unit)

    def equilibrium(self, c: np.ndarray, g: np.ndarray, closed: np.ndarray) -> np.ndarray | None:
        """Jumps with the closed ones at their bound; nothing where the others are not determined."""
        jumps = np.where(closed, g, 0.0)
        opened = np.flatnonzero(~closed)
        if len(opened) == 0:
            return jumps
        rest = c[opened] - self.matrix[opened] @ jumps
        block = self.matrix[np.ix_(opened, opened)]
        for spring in SPRINGS:
            try:
                factor = cho_factor(block + spring * np.eye(len(block)), lower=True)
            except LinAlgError:
                continue
            jumps[opened] = cho_solve(factor, rest)
            return jumps if np.all(np.isfinite(jumps)) else None
        return None

    def pivot(self, load: np.ndarray, bound: np.ndarray, closed: np.ndarray) -> State | None:
        """The contact state, or nothing where states come back."""
        c, g = load * self.unit, bound / self.unit
        seen = set()
        while len(seen) < MOST_STEPS and closed.tobytes() not in seen:
            seen.add(closed.tobytes())
            jumps = self.equilibrium(c, g, closed)
            if jumps is None:
                return None
            tension = self.matrix @ jumps - c
            terms = np.abs(self.matrix) @ np.abs(jumps) + np.abs(c)
            slack = GRAZING * np.maximum(terms, terms[~closed].max(initial=0.0))
            depth = GRAZING * max(np.abs(jumps).max(initial=0.0), np.abs(g).max(initial=0.0))
            following = np.where(closed, tension <= slack, jumps > g + depth)
            if np.array_equal(following, closed):
                return State(jumps * self.unit, closed, len(seen))
            closed = following
        return None
