"""Unknowns w with bounds, handed out one after the other, and the matrix T that makes displacements of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

AXIS = np.arange(2)
"""Offsets of the two components of a node."""


@dataclass(frozen=True)
class JumpRow:
    """One inequality of the model: which unknown carries it, and what its multiplier R ≥ 0 acts on.

    The row is factor · w[column] ≤ …, binding from above for factor > 0 and from below otherwise. ``vertex`` is the
    vertex of the first side, or −1 for coefficient ``inner`` between the ends of pair ``pair``. A translation d of the
    first side changes the row by ``normal`` · d.
    """

    column: int
    factor: float
    contact: int
    normal: np.ndarray
    vertex: int
    pair: int
    inner: int = 0


@dataclass(frozen=True)
class SlipRow:
    """One term of the work of friction: ``weight`` |w[column] − kink|, or ``weight`` times the jump that one of :class:`Coupled` rows is,
    and ``column`` is −1.

    Its part of ∂𝓛/∂w times ``vector`` is the force on the first side, along ``tangent`` where that is its direction. ``vertex``,
    ``pair`` and ``inner`` are those of :class:`JumpRow`.
    """

    column: int
    weight: float
    contact: int
    vector: np.ndarray
    tangent: np.ndarray
    vertex: int
    pair: int
    inner: int = 0


@dataclass(frozen=True)
class Coupled:
    """Terms of the work of friction that several unknowns decide: of each row of ``matrix`` (m, 2n), |row · u| times the weight in
    ``rows``."""

    matrix: sparse.csr_matrix
    rows: list[SlipRow]

    @property
    def weight(self) -> np.ndarray:
        """The weights (m,)."""
        return np.array([row.weight for row in self.rows])


@dataclass(frozen=True)
class Constraints:
    """u = T w + offset with lower ≤ w ≤ upper; ``rows`` lists the inequalities behind the finite bounds.

    Friction adds Σ weight |w − kink| to the energy, of which ``slips`` lists the terms, ``slid``, the work that supports
    decide alone, and that of the ``coupled`` rows.
    """

    T: sparse.csr_matrix
    offset: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    rows: list[JumpRow]
    kink: np.ndarray
    weight: np.ndarray
    slips: list[SlipRow]
    slid: float
    coupled: Coupled

    @property
    def bounded(self) -> np.ndarray:
        """Indices of the jump unknowns."""
        return np.flatnonzero(np.isfinite(self.lower) | np.isfinite(self.upper))


class Builder:
    """Collects entries of T, the offset and the bounds; columns are handed out as they are asked for."""

    def __init__(self, nodes: int):
        self.entries: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        self.offset = np.zeros(2 * nodes)
        self.lower: list[np.ndarray] = []
        self.upper: list[np.ndarray] = []
        self.columns = 0
        self.rows: list[JumpRow] = []
        self.slips: list[SlipRow] = []
        self.kinks: dict[int, float] = {}
        self.slid = 0.0
        self.jumps: list[tuple[list[tuple[int, np.ndarray]], SlipRow]] = []

    def new_columns(self, upper, lower=None) -> np.ndarray:
        upper = np.atleast_1d(np.asarray(upper, dtype=float))
        self.upper.append(upper)
        self.lower.append(np.full(len(upper), -np.inf) if lower is None else np.asarray(lower, dtype=float))
        first, self.columns = self.columns, self.columns + len(upper)
        return np.arange(first, self.columns)

    def add(self, rows, columns, values) -> None:
        rows, columns, values = np.broadcast_arrays(rows, columns, values)
        self.entries.append((rows.reshape(-1), columns.reshape(-1), values.reshape(-1)))

    def rub(self, kink: float, row: SlipRow) -> None:
        """Add a term to the work of friction; all terms of one unknown have the same ``kink``."""
        self.kinks[row.column] = kink
        self.slips.append(row)

    def rub_coupled(self, terms: list[tuple[int, np.ndarray]], row: SlipRow) -> None:
        """Add a term whose jump is the sum of ``terms``, each a node and the factors (2,) of its displacement."""
        self.jumps.append((terms, row))

    def coupled(self, size: int) -> Coupled:
        """All of these."""
        entries = [(i, 2 * node + c, factor[c]) for i, (terms, _) in enumerate(self.jumps) for node, factor in terms for c in range(2)]
        i, j, v = zip(*entries) if entries else ((), (), ())
        matrix = sparse.csr_matrix((np.array(v, float), (np.array(i, int), np.array(j, int))), shape=(len(self.jumps), size))
        return Coupled(matrix, [row for _, row in self.jumps])

    def friction(self) -> tuple[np.ndarray, np.ndarray]:
        """Kink and weight of every unknown, zero where there is no friction."""
        kink, weight = np.zeros(self.columns), np.zeros(self.columns)
        for column, value in self.kinks.items():
            kink[column] = value
        for row in self.slips:
            weight[row.column] += row.weight
        return kink, weight

    def matrix(self, rows: int) -> sparse.csr_matrix:
        i, j, v = (np.concatenate(parts) for parts in zip(*self.entries))
        return sparse.csr_matrix((v, (i, j)), shape=(rows, self.columns))
