"""Who works on what: triangles by a graph partitioner, unknowns by the ranks that their triangles are on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from . import compat
from .exchange import Files


def own_triangles(comm, files: Files, whole_contact: bool) -> np.ndarray:
    """The triangles of this rank, ascending; with ``whole_contact`` those of a contact pair are on one rank."""
    if comm.size == 1:
        return np.arange(files.triangles)
    bounds = files.triangles * np.arange(comm.size + 1) // comm.size
    low, high = bounds[comm.rank : comm.rank + 2]
    starts = np.asarray(files.array("beside_start.i64")[low : high + 1])
    neighbours = np.asarray(files.array("beside.i64")[starts[0] : starts[-1]])
    starts = starts - starts[0]
    if whole_contact:
        together = Together(np.asarray(files.array("pair_triangles.i64")).reshape(-1, 2))
        starts, neighbours = together.merged(comm, bounds, starts, neighbours)
        owner = together.spread(comm, bounds, compat.partition(comm, starts, neighbours, files.triangles))
    else:
        owner = compat.partition(comm, starts, neighbours, files.triangles)
    sent = comm.alltoall([low + np.flatnonzero(owner == rank) for rank in range(comm.size)])
    return np.sort(np.concatenate(sent))


class Together:
    """Nodes of a graph that are to be in one part: the first of each group stands for all of them.

    The rows of the graph are divided among the ranks at ``bounds``.
    """

    def __init__(self, pairs: np.ndarray) -> None:
        self.members, place = np.unique(pairs, return_inverse=True)
        place = place.reshape(pairs.shape)
        count = len(self.members)
        graph = coo_matrix((np.ones(len(pairs)), (place[:, 0], place[:, 1])), (count, count))
        group = connected_components(graph, directed=False)[1]
        self.first = self.members[np.unique(group, return_index=True)[1]][group]

    def stands_for(self, nodes: np.ndarray) -> np.ndarray:
        """The nodes that stand for these."""
        place = np.searchsorted(self.members, nodes)
        known = np.append(self.members, -1)[place] == nodes
        return np.where(known, np.append(self.first, -1)[place], nodes)

    def merged(self, comm, bounds: np.ndarray, starts: np.ndarray, neighbours: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """This rank's rows of the graph in which each group is its first node, and the others have no neighbours."""
        low, high = bounds[comm.rank : comm.rank + 2]
        rows = self.stands_for(np.repeat(np.arange(low, high), np.diff(starts)))
        entries = np.stack([rows, self.stands_for(neighbours)], 1)
        target = np.searchsorted(bounds, rows, side="right") - 1
        found = np.concatenate(comm.alltoall([entries[target == rank] for rank in range(comm.size)]))
        found = np.unique(found[found[:, 0] != found[:, 1]], axis=0)
        return np.searchsorted(found[:, 0], np.arange(low, high + 1)), found[:, 1]

    def spread(self, comm, bounds: np.ndarray, owner: np.ndarray) -> np.ndarray:
        """The parts ``owner`` of this rank's nodes, with every member of a group in the part of its first."""
        low, high = bounds[comm.rank : comm.rank + 2]
        here = (self.first >= low) & (self.first < high)
        known = np.zeros(len(self.first), np.int64)
        known[here] = owner[self.first[here] - low]
        comm.Allreduce(compat.MPI.IN_PLACE, known)
        own, owner = (self.members >= low) & (self.members < high), owner.copy()
        owner[self.members[own] - low] = known[own]
        return owner


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


def connected_parts(files: Files, triangles: np.ndarray) -> np.ndarray:
    """The number of the part that each of these triangles belongs to, where contact does not connect."""
    first, lengths = ragged(files, triangles, "beside_start.i64")
    beside = files.pieces("beside.i64", first, lengths)
    own = np.repeat(np.arange(len(triangles)), lengths)
    place = np.searchsorted(triangles, beside)
    here = np.append(triangles, -1)[place] == beside
    pairs = np.sort(np.asarray(files.array("pair_triangles.i64")).reshape(-1, 2), axis=1)
    edges = np.sort(np.stack([triangles[own], beside], 1), axis=1)
    bonded = here & ~np.isin(edges @ [files.triangles, 1], pairs @ [files.triangles, 1])
    shape = (len(triangles), len(triangles))
    graph = coo_matrix((np.ones(np.count_nonzero(bonded)), (own[bonded], place[bonded])), shape)
    return connected_components(graph, directed=False)[1]


def ragged(files: Files, triangles: np.ndarray, starts: str) -> tuple[np.ndarray, np.ndarray]:
    """First entries and lengths of what belongs to each of the triangles."""
    bounds = files.array(starts)
    first = np.asarray(bounds[triangles])
    return first, np.asarray(bounds[triangles + 1]) - first
