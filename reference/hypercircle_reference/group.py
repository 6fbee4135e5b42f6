"""Elimination at one place: the vertices that supports and contacts couple there, as one small dense problem.

A *group* is a set of vertices joined by contact pairs (usually two, more where several bodies meet, one where only a
support or a rigid obstacle is present). Its displacement x obeys equalities C x = d (clamped values, rollers, pins)
and inequalities B x ≤ g, one row per jump v_n' + v_n''. :func:`eliminate` returns a parametrisation
x = x0 + J w + N y in which every w is itself a jump with plain bounds and y is free. One elimination treats every
special case alike: a contact that ends on a support, two rollers at a corner, a polyline with a corner, rows that
repeat each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.linalg import qr

RELATIVE = 1e-9
"""Below this, relative to unit rows, a direction counts as dependent and a value as equal."""


class Conflict(Exception):
    """Supports and contacts that contradict each other; the text says how, without saying where."""


@dataclass(frozen=True)
class Bound:
    """The inequality row that binds a jump unknown from one side, and its factor relative to that unknown."""

    row: int
    factor: float
    value: float


@dataclass(frozen=True)
class Slip:
    """Friction row ``row`` is F x = factor (w − kink) with the unknown w of index ``unknown``."""

    row: int
    unknown: int
    factor: float
    kink: float


@dataclass(frozen=True)
class Elimination:
    """x = offset + jumps w + free y; ``upper[k]`` and ``lower[k]`` bound w_k (None: unbounded on that side).

    ``given`` are the friction rows whose value the supports decide, with that value, and ``coupled`` those that are told by several
    unknowns, as at the corner of a contact line.
    """

    offset: np.ndarray
    jumps: np.ndarray
    free: np.ndarray
    upper: list[Bound | None]
    lower: list[Bound | None]
    slips: list[Slip]
    given: list[tuple[int, float]]
    coupled: list[int]


def eliminate(
    C: np.ndarray, d: np.ndarray, B: np.ndarray, g: np.ndarray, stiffness: np.ndarray, F: np.ndarray | None = None
) -> Elimination:
    """Parametrise {x : C x = d, B x ≤ g}; rows of C, B and F have entries of order one. Rows of F are unknowns too, as many as can be.

    The y are components of x, and ``stiffness``, one positive number per component, decides which: the stiff ones.
    The displacement of a stiff body is then an unknown of its own and never a small difference of large ones.

    Raises :class:`Conflict` where the equalities contradict each other, where they force a penetration, or where more
    independent inequalities act than the group has freedoms, so that no change of variables turns them into bounds.
    """
    offset, kernel = _solve_equalities(C, d)
    rows = B @ kernel
    slack = g - B @ offset
    scale = np.abs(g) + np.abs(B) @ np.abs(offset)
    live = np.linalg.norm(rows, axis=1) > RELATIVE
    if np.any(slack[~live] < -RELATIVE * scale[~live]):
        raise Conflict(f"the supports force a penetration of {-slack[~live].min():.3e}")

    leaders: list[int] = []
    upper: list[Bound | None] = []
    lower: list[Bound | None] = []
    for row in np.flatnonzero(live):
        for k, leader in enumerate(leaders):
            factor = rows[row] @ rows[leader] / (rows[leader] @ rows[leader])
            if np.linalg.norm(rows[row] - factor * rows[leader]) <= RELATIVE * np.linalg.norm(rows[row]):
                break
        else:
            leaders.append(row)
            upper.append(None)
            lower.append(None)
            k, factor = len(leaders) - 1, 1.0
        bound = Bound(int(row), float(factor), slack[row] / factor)
        if factor > 0.0:
            upper[k] = bound if upper[k] is None or bound.value < upper[k].value else upper[k]
        else:
            lower[k] = bound if lower[k] is None or bound.value > lower[k].value else lower[k]
    for above, below in zip(upper, lower):
        if above and below and below.value > above.value:
            raise Conflict("two contacts leave no room between them")

    chosen = _independent(rows[leaders], np.array([bound.value for bound in upper]), lower)
    leaders = [leaders[k] for k in chosen]
    upper, lower = [upper[k] for k in chosen], [lower[k] for k in chosen]
    rubbing = np.zeros((0, len(offset))) if F is None else F
    everything = np.vstack([B, rubbing])
    leaders += _further(everything @ kernel, leaders, len(B))
    own = everything[leaders]
    jumps, free = _parametrise(np.vstack([_independent_rows(C), own]), len(leaders), stiffness)
    rigid = own @ offset
    slips, given, coupled = _slips(rubbing, offset, kernel, own, rigid)
    new = [None] * (len(leaders) - len(chosen))
    return Elimination(
        offset=offset - jumps @ rigid,
        jumps=jumps,
        free=free,
        upper=[_shift(bound, value) for bound, value in zip(upper + new, rigid)],
        lower=[_shift(bound, value) for bound, value in zip(lower + new, rigid)],
        slips=slips,
        given=given,
        coupled=coupled,
    )


def _further(rows: np.ndarray, leaders: list[int], begin: int) -> list[int]:
    """Rows from ``begin`` on that are unknowns of their own: independent of the leaders and of each other."""
    found: list[int] = []
    for row in range(begin, len(rows)):
        if np.linalg.norm(rows[row]) <= RELATIVE:
            continue
        M = rows[leaders + found + [row]]
        if np.linalg.matrix_rank(M / np.linalg.norm(M, axis=1)[:, None], tol=RELATIVE) == len(M):
            found.append(row)
    return found


def _slips(rubbing, offset, kernel, own, rigid) -> tuple[list[Slip], list[tuple[int, float]], list[int]]:
    """The friction rows that are an unknown's, those that the supports decide, and all others."""
    slips: list[Slip] = []
    given: list[tuple[int, float]] = []
    coupled: list[int] = []
    kinks: dict[int, float] = {}
    for row, F in enumerate(rubbing):
        value = float(F @ offset)
        if np.linalg.norm(F @ kernel) <= RELATIVE:
            given.append((row, value))
            continue
        factors = np.linalg.lstsq((own @ kernel).T, F @ kernel, rcond=None)[0]
        used = np.flatnonzero(np.abs(factors) > RELATIVE)
        if len(used) > 1:
            coupled.append(row)
            continue
        k, factor = int(used[0]), float(factors[used[0]])
        rest = value - factor * float(rigid[k])
        if abs(rest) <= RELATIVE * (abs(value) + abs(factor * rigid[k])):
            rest = 0.0
        kink = -rest / factor
        before = kinks.setdefault(k, kink)
        if abs(before - kink) > RELATIVE * max(abs(before), abs(kink)):
            coupled.append(row)
        else:
            slips.append(Slip(row, k, factor, before))
    return slips, given, coupled


def _shift(bound: Bound | None, value: float) -> Bound | None:
    return bound and Bound(bound.row, bound.factor, bound.value + value)


def _solve_equalities(C: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    size = C.shape[1]
    if len(C) == 0:
        return np.zeros(size), np.eye(size)
    left, singular, right = np.linalg.svd(C)
    rank = int(np.sum(singular > RELATIVE))
    offset = right[:rank].T @ ((left[:, :rank].T @ d) / singular[:rank])
    if np.any(np.abs(C @ offset - d) > RELATIVE * np.max(np.abs(d), initial=0.0)):
        raise Conflict("the supports prescribe two different displacements")
    return offset, right[rank:].T


def _independent(M: np.ndarray, upper: np.ndarray, lower: list[Bound | None]) -> tuple[int, ...]:
    """Leaders that span all others; those left out must follow from the bounds of those kept."""
    everything = tuple(range(len(M)))
    rank = np.linalg.matrix_rank(M, tol=RELATIVE) if len(M) else 0
    if rank == len(M):
        return everything
    for kept in combinations(everything, rank):
        base = M[list(kept)]
        if np.linalg.matrix_rank(base, tol=RELATIVE) < rank:
            continue
        out = [k for k in everything if k not in kept]
        weights = np.linalg.lstsq(base.T, M[out].T, rcond=None)[0].T
        implied = weights @ upper[list(kept)] <= upper[out] + RELATIVE * np.abs(upper[out])
        if np.all(weights >= -RELATIVE) and np.all(implied) and not any(lower[k] for k in out):
            return kept
    raise Conflict(f"{len(M)} contact conditions act on {rank} freedoms and none of them follows from the others")


def _independent_rows(C: np.ndarray) -> np.ndarray:
    """A basis of the row space of C, rows of unit length."""
    if len(C) == 0:
        return C
    _, singular, right = np.linalg.svd(C)
    return right[: int(np.sum(singular > RELATIVE))]


def _parametrise(A: np.ndarray, jumps: int, stiffness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """J and N with A J = (0, 1)ᵀ on the last ``jumps`` rows and A N = 0, for A of full row rank.

    As many components as A has rows are solved for, the softest that allow it (pivoted QR of the scaled columns).
    """
    rank, size = A.shape
    pivots = qr(A / np.sqrt(stiffness), mode="r", pivoting=True)[1] if rank else np.arange(size)
    solved, kept = pivots[:rank], np.sort(pivots[rank:])
    right = np.zeros((size, jumps))
    free = np.zeros((size, len(kept)))
    free[kept, np.arange(len(kept))] = 1.0
    if rank:
        right[solved] = np.linalg.solve(A[:, solved], np.eye(rank)[:, rank - jumps :])
        free[solved] = np.linalg.solve(A[:, solved], -A[:, kept])
    return right, free
