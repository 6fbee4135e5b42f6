"""The contact problem on its jumps alone: min ½ jᵀSj − cᵀj over j ≤ g, with the dense Schur complement S.

Primal–dual active sets, started from closed contact; where they come back to a state they have been in, TAO's
bound-constrained interior point gives another start. The problem is solved in units in which the diagonal of S is one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from . import DualFailure, compat

MOST_STEPS = 200
GRAZING = 1e-13
"""Tension and penetration below this fraction of the terms at the end, or of the largest jump, are round-off."""
SPRINGS = (0.0, 1e-13, 1e-11, 1e-9)
"""What is added to the diagonal of S where the open part has free motions: the least that leaves it definite."""


@dataclass(frozen=True)
class State:
    """Jumps (m,), which of them are at their bound, and the steps taken."""

    jumps: np.ndarray
    closed: np.ndarray
    steps: int


class ContactProblem:
    """S (m, m), in units ``unit`` (m,): jumps are these times the numbers that S takes."""

    def __init__(self, schur: np.ndarray) -> None:
        diagonal = np.abs(np.diag(schur))
        self.unit = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        self.matrix = schur * np.outer(self.unit, self.unit)

    def solve(self, load: np.ndarray, bound: np.ndarray, start: np.ndarray | None) -> State:
        """The contact state; ``start`` (m,) is a first guess of the closed jumps."""
        c, g = load * self.unit, bound / self.unit
        closed = np.ones(len(c), bool) if start is None else start.copy()
        state = self._pivot(c, g, closed)
        if state is None:
            closed = compat.interior_point(self.matrix, c, g)
            state = self._pivot(c, g, closed)
        if state is None:
            raise DualFailure("the contact state could not be determined: ends keep opening and closing")
        return State(state.jumps * self.unit, state.closed, state.steps)

    def with_closed(self, load: np.ndarray, bound: np.ndarray, closed: np.ndarray) -> np.ndarray:
        """Jumps with the closed ones at their bound and the others in equilibrium."""
        jumps = self._equilibrium(load * self.unit, bound / self.unit, closed)
        if jumps is None:
            raise DualFailure("the contact state could not be determined: its open part leaves a body without hold")
        return jumps * self.unit

    def _equilibrium(self, c: np.ndarray, g: np.ndarray, closed: np.ndarray) -> np.ndarray | None:
        jumps = np.where(closed, g, 0.0)
        opened = np.flatnonzero(~closed)
        if len(opened) == 0:
            return jumps
        rest = c[opened] - self.matrix[opened] @ jumps
        block = self.matrix[np.ix_(opened, opened)]
        for spring in SPRINGS:
            try:
                factor = cho_factor(block + spring * np.diag(np.diag(block)), lower=True)
            except LinAlgError:
                continue
            jumps[opened] = cho_solve(factor, rest)
            return jumps if np.all(np.isfinite(jumps)) else None
        return None

    def _pivot(self, c: np.ndarray, g: np.ndarray, closed: np.ndarray) -> State | None:
        seen = set()
        while len(seen) < MOST_STEPS and closed.tobytes() not in seen:
            seen.add(closed.tobytes())
            jumps = self._equilibrium(c, g, closed)
            if jumps is None:
                return None
            tension = self.matrix @ jumps - c
            terms = np.abs(self.matrix) @ np.abs(jumps) + np.abs(c)
            slack = GRAZING * np.maximum(terms, terms[~closed].max(initial=0.0))
            depth = GRAZING * max(np.abs(jumps).max(initial=0.0), np.abs(g).max(initial=0.0))
            following = np.where(closed, tension <= slack, jumps > g + depth)
            if np.array_equal(following, closed):
                return State(jumps, closed, len(seen))
            closed = following
        return None

    def apply(self, jumps: np.ndarray) -> np.ndarray:
        """S j."""
        return (self.matrix @ (jumps / self.unit)) / self.unit
