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
class Constraints:
    """u = T w + offset with lower ≤ w ≤ upper; ``rows`` lists the inequalities behind the finite bounds."""

    T: sparse.csr_matrix
    offset: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    rows: list[JumpRow]

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

    def new_columns(self, upper, lower=None) -> np.ndarray:
        upper = np.atleast_1d(np.asarray(upper, dtype=float))
        self.upper.append(upper)
        self.lower.append(np.full(len(upper), -np.inf) if lower is None else np.asarray(lower, dtype=float))
        first, self.columns = self.columns, self.columns + len(upper)
        return np.arange(first, self.columns)

    def add(self, rows, columns, values) -> None:
        rows, columns, values = np.broadcast_arrays(rows, columns, values)
        self.entries.append((rows.reshape(-1), columns.reshape(-1), values.reshape(-1)))

    def matrix(self, rows: int) -> sparse.csr_matrix:
        i, j, v = (np.concatenate(parts) for parts in zip(*self.entries))
        return sparse.csr_matrix((v, (i, j)), shape=(rows, self.columns))
