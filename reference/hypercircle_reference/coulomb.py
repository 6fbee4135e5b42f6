"""Coulomb friction by the displacement model itself: |F_i| ≤ μ R_i at every coefficient of the jump.

With the limits held the law is that of a given bound, and has a minimum. From the reactions R of one solution follow the limits of
the next, until they do not change any more. Nothing says that this ends, or that there is one end only.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np

from hypercircle_process import Failure

from .builder import Constraints, Coupled, SlipRow
from .exchange import Problem
from .friction import vertex_slips

MOST = 60
"""Solutions before giving up."""

ARRIVED = 1e-9
"""Limits that change by no more than this part of their sum have arrived."""

SLOW, PATIENCE = 0.9, 3
"""So many steps in a row that leave more than this part of the change before them halve the steps to come."""


def follows(problem: Problem) -> bool:
    """True if any contact has a coefficient of friction."""
    return any(contact.coefficient > 0.0 for contact in problem.contacts)


def with_unit_bounds(problem: Problem) -> Problem:
    """The problem with a bound of one wherever friction has a coefficient."""
    contacts = [
        replace(contact, friction=np.ones_like(contact.friction)) if contact.coefficient > 0.0 else contact
        for contact in problem.contacts
    ]
    return replace(problem, contacts=contacts)


class Limits:
    """The limits of all coefficients of the slip, from reactions; ``problem`` and ``constraints`` are those with unit bounds."""

    def __init__(self, problem: Problem, degree: int, constraints: Constraints):
        self.problem, self.constraints = problem, constraints
        # Force of friction at a vertex for a unit bound, along each tangent and along all.
        along, self.whole = defaultdict(float), defaultdict(float)
        for (first, _), tangent, weight, contact in vertex_slips(problem, degree):
            along[(contact, first, *tangent)] += weight
            self.whole[contact, first] += weight
        self.along = dict(along)

    def of(self, contacts: list[dict]) -> np.ndarray:
        """μ R of the reactions that results of a solution list, one for each slip, then for each coupled row; nan without a coefficient."""
        at = [dict(zip(contact["vertices"], contact["vertex_reaction"])) for contact in contacts]
        inside = [contact["edge_reaction"] for contact in contacts]
        return np.array([self._of(row, at, inside) for row in self._rows()])

    def constrained(self, limits: np.ndarray) -> Constraints:
        """The constraints with these limits."""
        rows = [
            row if np.isnan(limit) else replace(row, weight=self._factor(row) * limit)
            for row, limit in zip(self._rows(), limits)
        ]
        count = len(self.constraints.slips)
        slips = [row for row in rows[:count] if row.weight > 0.0]
        weight = np.zeros_like(self.constraints.weight)
        for row in slips:
            weight[row.column] += row.weight
        some = np.flatnonzero([row.weight > 0.0 for row in rows[count:]])
        coupled = Coupled(self.constraints.coupled.matrix[some], [rows[count + i] for i in some])
        return replace(self.constraints, slips=slips, weight=weight, coupled=coupled)

    def _rows(self) -> list[SlipRow]:
        return self.constraints.slips + self.constraints.coupled.rows

    def _of(self, row: SlipRow, at: list[dict], inside: list) -> float:
        mu = self.problem.contacts[row.contact].coefficient
        if not mu > 0.0:
            return np.nan
        if row.vertex < 0:
            return mu * inside[row.contact][row.pair][row.inner]
        share = self.along[(row.contact, row.vertex, *row.tangent)] / self.whole[row.contact, row.vertex]
        return mu * share * at[row.contact].get(row.vertex, 0.0)

    def _factor(self, row: SlipRow) -> float:
        """The jump of the contact for a unit of the unknown."""
        return 1.0 if row.vertex < 0 else row.weight / self.along[(row.contact, row.vertex, *row.tangent)]


def iterate(limits: Limits, contacts: list[dict], solve) -> dict:
    """The result of iterating from the reactions in ``contacts``; ``solve`` makes a solution and its list of contacts from constraints."""
    now, step, slow, before = limits.of(contacts), 1.0, 0, np.inf
    known, change, energy = ~np.isnan(now), np.inf, None
    for count in range(1, MOST + 1):
        try:
            solution, contacts = solve(limits.constrained(now))
        except Failure:
            # With these limits the bodies lose their hold, or nearly so.
            break
        # The energy contains, with a unit bound, the work of slips that supports alone decide.
        energy = solution.energy if limits.constraints.slid == 0.0 else None
        found = limits.of(contacts)
        size = max(np.sum(found[known]), np.sum(now[known]))
        change = float(np.sum(np.abs(found - now)[known]) / size) if size > 0.0 else 0.0
        if change <= ARRIVED:
            break
        slow = slow + 1 if change > SLOW * before else 0
        if slow >= PATIENCE:
            step, slow = 0.5 * step, 0
        now, before = now + step * (found - now), change
    return {
        "iterations": count,
        "converged": change <= ARRIVED,
        "change": change if np.isfinite(change) else None,
        "energy": energy,
        "contacts": [
            {
                "name": contact["name"],
                "pressure": _sum(contact["vertex_reaction"], contact["edge_reaction"]),
                "friction": _sum(contact["vertex_friction"], contact["edge_friction"]),
            }
            for contact in contacts
        ],
    }


def _sum(at_vertices: list | None, inside: list | None) -> float:
    return float(sum(at_vertices or []) + sum(sum(pair) for pair in inside or []))
