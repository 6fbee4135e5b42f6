"""Who works on what: triangles by a graph partitioner, unknowns by the ranks that their triangles are on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import compat
from .exchange import Files


def own_triangles(comm, files: Files) -> np.ndarray:
    """The triangles of this rank, ascending."""
    if comm.size == 1:
        return np.arange(files.triangles)
    low, high = (files.triangles * r // comm.size for r in (comm.rank, comm.rank + 1))
    starts = np.asarray(files.array("beside_start.i64")[low : high + 1])
    neighbours = np.asarray(files.array("beside.i64")[starts[0] : starts[-1]])
    owner = compat.partition(comm, starts - starts[0], neighbours, files.triangles)
    sent = comm.alltoall([low + np.flatnonzero(owner == rank) for rank in range(comm.size)])
    return np.sort(np.concatenate(sent))


@dataclass(frozen=True)
class Numbering:
    """Numbers of the unknowns in vectors and matrices over all ranks.

    ``natural`` (k,) are the unknowns of this rank's triangles as the files number them, ascending, ``number`` their numbers
    and ``owned`` which of them have their entries on this rank. A vector has ``local`` entries here; ``stride`` is the
    distance of the blocks of unknowns that belong to one edge, 1 where they follow each other without gaps.
    """

    natural: np.ndarray
    number: np.ndarray
    owned: np.ndarray
    local: int
    first: int
    stride: int

    def place(self, natural: np.ndarray) -> np.ndarray:
        """Place in ``natural`` of unknowns that are all there."""
        return np.searchsorted(self.natural, natural)

    def own_part(self) -> tuple[np.ndarray, np.ndarray]:
        """The unknowns of this rank, and their places in its part of a vector."""
        return self.natural[self.owned], self.number[self.owned] - self.first


def number_unknowns(comm, files: Files, unknowns: np.ndarray, padded: bool) -> Numbering:
    """Number the unknowns; ``unknowns`` are those of this rank's triangles. ``padded`` gives every block the largest size."""
    natural = np.unique(unknowns)
    starts = files.array("blocks.i64")
    count = len(starts) - 1
    of_unknown = np.searchsorted(starts, natural, side="right") - 1
    blocks, block = np.unique(of_unknown, return_inverse=True)
    sizes = starts[blocks + 1] - starts[blocks]
    stride = comm.allreduce(int(sizes.max(initial=1)), compat.MPI.MAX) if padded else 1
    room = np.full(len(blocks), stride) if padded else sizes

    begin, own, local, first = share_out(comm, count, blocks, room)
    number = begin[block] + natural - starts[of_unknown]
    return Numbering(natural, number, own[block], local, first, stride)


def share_out(comm, count: int, things: np.ndarray, room: np.ndarray) -> tuple[np.ndarray, np.ndarray, int, int]:
    """Numbers for ``count`` things, of which each rank names those that it works with, and the room that each takes.

    Returns the first number of each of ``things``, whether it is this rank's, the room that this rank's take, and the first
    number here.
    """
    directory = compat.vector(comm, None, count)
    window = compat.Window(directory, things)
    directory.set(-1.0)
    window.maximum(np.full(len(things), float(comm.rank)), directory)
    own = window.read(directory) == comm.rank
    local = int(room[own].sum())
    first = comm.exscan(local) or 0
    begin = np.full(len(things), -1.0)
    begin[own] = first + np.cumsum(room[own]) - room[own]
    directory.set(-1.0)
    window.maximum(begin, directory)
    return window.read(directory).astype(np.int64), own, local, first


def ragged(files: Files, triangles: np.ndarray, starts: str) -> tuple[np.ndarray, np.ndarray]:
    """First entries and lengths of what belongs to each of the triangles."""
    bounds = files.array(starts)
    first = np.asarray(bounds[triangles])
    return first, np.asarray(bounds[triangles + 1]) - first
