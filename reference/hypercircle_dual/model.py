"""The hybrid form on the triangles of this rank: K = Σ B Bᵀ, stresses s = Bᵀx + s̄, and what they leave of the loads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from . import compat
from .distribution import Numbering, connected_parts, number_unknowns, own_triangles, ragged, share_out
from .exchange import Files, ranges

CHUNK = 8192
"""Triangles that are worked on at a time."""


@dataclass(frozen=True)
class Group:
    """Triangles with equally many unknowns n and mode parameters q.

    ``unknowns`` (k, n) are places in ``Numbering.natural``, ``parameters`` (k, q) places among the parameters of this rank,
    ``kinds`` (c, q, n) the different Bᵀ, ``kind`` (k,) which of them each triangle has, ascending.
    """

    unknowns: np.ndarray
    parameters: np.ndarray
    kinds: np.ndarray
    kind: np.ndarray

    def chunks(self) -> Iterator[tuple[slice, np.ndarray]]:
        """Parts of the triangles with their Bᵀ: (k, q, n), or (q, n) where all have the same."""
        if 16 * len(self.kinds) <= len(self.kind):
            bounds = np.searchsorted(self.kind, np.arange(len(self.kinds) + 1))
            for kind, (low, high) in enumerate(zip(bounds[:-1], bounds[1:])):
                for start in range(low, high, CHUNK):
                    yield slice(start, min(start + CHUNK, high)), self.kinds[kind]
            return
        for start in range(0, len(self.kind), CHUNK):
            part = slice(start, min(start + CHUNK, len(self.kind)))
            yield part, self.kinds[self.kind[part]]


class Model:
    """Matrices and loads of this rank's triangles, and vectors over all ranks."""

    def __init__(self, comm, files: Files, padded: bool, whole_contact: bool = False) -> None:
        self.comm, self.files = comm, files
        self.load_size = 0.0
        self.triangles = own_triangles(comm, files, whole_contact)
        first, lengths = ragged(files, self.triangles, "start.i64")
        unknowns = files.pieces("unknowns.i64", first, lengths)
        self.numbering: Numbering = number_unknowns(comm, files, unknowns, padded)
        places = self.numbering.place(unknowns)
        first_parameter, parameters = ragged(files, self.triangles, "parameter.i64")
        self.parameter_places = ranges(first_parameter, parameters)
        self.given = np.asarray(files.array("given.f64")[self.parameter_places])
        load = files.pieces("load.f64", first, lengths)
        self.load = np.bincount(places, load, len(self.numbering.natural))
        self.groups = list(self._groups(places, lengths, parameters))

        self.zero = compat.vector(comm, self.numbering.local)
        self.window = compat.Window(self.zero, self.numbering.number)
        self.external = self.from_natural("external.f64")
        jumps = self.numbering.natural >= files.first_jump
        self.jump_numbers = self._of_jumps(self.numbering.number, jumps & self.numbering.owned).astype(np.int64)
        self.jump_window = compat.Window(self.zero, self.jump_numbers)
        held = np.isin(self.numbering.natural, files.held) & self.numbering.owned
        self.held = self.numbering.number[held]

    def _groups(self, places: np.ndarray, lengths: np.ndarray, parameters: np.ndarray) -> Iterator[Group]:
        matrices = self.files.array("matrix.i64")[self.triangles]
        starts = np.cumsum(lengths) - lengths
        first_parameter = np.cumsum(parameters) - parameters
        shapes, shape = np.unique(np.stack([lengths, parameters], 1), axis=0, return_inverse=True)
        for i, (n, q) in enumerate(shapes):
            members = np.flatnonzero(shape.reshape(-1) == i)
            begins, kind = np.unique(matrices[members], return_inverse=True)
            order = np.argsort(kind, kind="stable")
            members, kind = members[order], kind[order]
            kinds = self.files.pieces("matrices.f64", begins, np.full(len(begins), n * q)).reshape(len(begins), q, n)
            yield Group(
                places[starts[members, None] + np.arange(n)],
                first_parameter[members, None] + np.arange(q),
                kinds,
                kind,
            )

    def _of_jumps(self, values: np.ndarray, here: np.ndarray) -> np.ndarray:
        """Values at all jumps, of which ``here`` marks those that this rank has."""
        out = np.zeros(self.files.jumps)
        out[self.numbering.natural[here] - self.files.first_jump] = values[here]
        self.comm.Allreduce(compat.MPI.IN_PLACE, out)
        return out

    def from_natural(self, name: str):
        """A vector with the values that a file has for the unknowns."""
        natural, local = self.numbering.own_part()
        out = self.zero.duplicate()
        out.set(0.0)
        values = np.zeros(self.numbering.local)
        values[local] = self.files.array(name)[natural]
        out.array = values
        return out

    def jumps(self, x) -> np.ndarray:
        """The jumps among the unknowns, on every rank."""
        return self.jump_window.read(x)

    def set_jumps(self, x, values: np.ndarray) -> None:
        """Give the jumps values that every rank knows."""
        first, local = self.numbering.first, self.numbering.local
        here = np.flatnonzero((self.jump_numbers >= first) & (self.jump_numbers < first + local))
        array = x.array
        array[self.jump_numbers[here] - first] = values[here]
        x.array = array

    def fixed_numbers(self, closed: np.ndarray) -> np.ndarray:
        """Numbers of this rank's unknowns that stay as they are: held ones and closed jumps."""
        first, local = self.numbering.first, self.numbering.local
        jumps = self.jump_numbers[closed]
        return np.concatenate([self.held, jumps[(jumps >= first) & (jumps < first + local)]])

    def free(self, closed: np.ndarray):
        """1 at the free unknowns, 0 at the others."""
        out = self.zero.duplicate()
        mask = np.zeros(self.numbering.local)
        mask[self.numbering.own_part()[1]] = 1.0
        mask[self.fixed_numbers(closed) - self.numbering.first] = 0.0
        out.array = mask
        return out

    def stresses(self, x, given: bool) -> np.ndarray:
        """Mode parameters of this rank's triangles; without ``given`` those of a change of the unknowns."""
        values = self.window.read(x)
        out = self.given.copy() if given else np.zeros(len(self.given))
        for group in self.groups:
            for part, matrix in group.chunks():
                own = values[group.unknowns[part]]
                out[group.parameters[part]] += own @ matrix.T if matrix.ndim == 2 else np.matmul(matrix, own[..., None])[..., 0]
        return out

    def residual(self, s: np.ndarray):
        """Residual of the stresses against the loads, at every unknown."""
        left = self.load.copy()
        for group in self.groups:
            for part, matrix in group.chunks():
                own = s[group.parameters[part]]
                jumps = own @ matrix if matrix.ndim == 2 else np.matmul(own[:, None, :], matrix)[:, 0, :]
                left -= np.bincount(group.unknowns[part].reshape(-1), jumps.reshape(-1), len(left))
        out = self.external.copy()
        self.window.add(left, out)
        return out

    def nodal(self):
        """Displacements linear on triangles in terms of the unknowns, and their rigid motions: the matrix and three vectors."""
        files, (natural, local) = self.files, self.numbering.own_part()
        first, lengths = ragged(files, natural, "nodal_start.i64")
        component = files.pieces("nodal.i64", first, lengths)
        vertices, place = np.unique(component // 2, return_inverse=True)
        points = files.array("points.f64").reshape(-1, 2)
        begin, own, room, start = share_out(self.comm, len(points), vertices, np.full(len(vertices), 2))
        rows = np.repeat(local + self.numbering.first, lengths)
        columns = begin[place] + component % 2
        weights = files.pieces("nodal.f64", first, lengths)
        matrix = compat.entries(self.comm, (self.numbering.local, room), self.numbering.stride, rows, columns, weights)
        position = np.asarray(points[vertices[own]]) - np.mean(points, axis=0)
        turned = np.stack([-position[:, 1], position[:, 0]], 1)
        motions = []
        for values in (np.tile([1.0, 0.0], len(position)), np.tile([0.0, 1.0], len(position)), turned.reshape(-1)):
            motions.append(compat.vector(self.comm, room))
            motions[-1].array = values
        return matrix, motions

    def energy_product(self, a: np.ndarray, b: np.ndarray) -> float:
        """Σ over all triangles of a · b."""
        return self.comm.allreduce(float(a @ b))

    def matrix(self):
        """K over all ranks."""
        number, owned = self.numbering.number, self.numbering.owned
        own, other = self.zero.duplicate(), self.zero.duplicate()
        own.set(0.0)
        other.set(0.0)
        owner = self._owners()
        counts = np.zeros((2, len(number)))
        for group in self.groups:
            ranks = owner[group.unknowns]
            for rank in np.unique(ranks):
                alike = (ranks == rank).sum(1, keepdims=True)
                for side, mask in enumerate((ranks == rank, ranks != rank)):
                    alike_there = np.broadcast_to(alike, ranks.shape)[mask]
                    counts[side] += np.bincount(group.unknowns[mask], alike_there, len(number))
        self.window.add(counts[0], own)
        self.window.add(counts[1], other)
        # Gaps between blocks have a diagonal entry.
        local, size = self.numbering.local, self.zero.getSize()
        room = np.minimum(np.maximum(own.array_r, 1), local), np.minimum(other.array_r, size - local)
        out = compat.matrix(self.comm, local, self.numbering.stride, *room)
        self._add_stiffness(out, number)
        gaps = np.setdiff1d(np.arange(local), number[owned] - self.numbering.first) + self.numbering.first
        compat.add_blocks(out, gaps.reshape(-1, 1), np.ones((len(gaps), 1, 1)))
        compat.finish(out)
        return out

    def subdomain(self):
        """Σ B Bᵀ over this rank's triangles alone, by places in ``Numbering.natural``."""
        count = len(self.numbering.natural)
        room = np.zeros(count)
        for group in self.groups:
            room += np.bincount(group.unknowns.reshape(-1), minlength=count) * group.unknowns.shape[1]
        out = compat.matrix(compat.MPI.COMM_SELF, count, 1, np.minimum(room, count), np.zeros(count))
        self._add_stiffness(out, np.arange(count))
        compat.finish(out)
        return out

    def shared_parts(self) -> list[np.ndarray]:
        """Places in ``Numbering.natural`` by the connected parts of the ranks' triangles that have them, the same on all ranks."""
        parts = connected_parts(self.files, self.triangles)
        first, lengths = ragged(self.files, self.triangles, "start.i64")
        places = self.numbering.place(self.files.pieces("unknowns.i64", first, lengths))
        part = np.zeros(len(self.numbering.natural))
        before = self.comm.exscan(int(parts.max(initial=-1)) + 1) or 0
        np.maximum.at(part, places, np.repeat(parts + before + 1.0, lengths))
        # At most two ranks have an unknown, and two numbers are known by their sum and that of their squares.
        known = []
        for power in (1, 2):
            whole = self.zero.duplicate()
            whole.set(0.0)
            self.window.add(part**power, whole)
            known.append(self.window.read(whole))
        kind = np.unique(np.stack(known, 1), axis=0, return_inverse=True)[1].reshape(-1)
        return [np.flatnonzero(kind == k) for k in range(kind.max(initial=-1) + 1)]

    def _add_stiffness(self, out, number: np.ndarray) -> None:
        """Add B Bᵀ of all triangles of this rank to a matrix whose rows have these numbers."""
        for group in self.groups:
            for part, matrix in group.chunks():
                stiffness = np.swapaxes(matrix, -1, -2) @ matrix
                numbers = number[group.unknowns[part]]
                shape = (*numbers.shape, numbers.shape[1])
                compat.add_blocks(out, numbers, np.broadcast_to(stiffness, shape))

    def _owners(self) -> np.ndarray:
        """The rank that owns each unknown of this rank's triangles."""
        ends = np.cumsum(self.comm.allgather(self.numbering.local))
        return np.searchsorted(ends, self.numbering.number, side="right")
