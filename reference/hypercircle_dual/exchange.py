"""The files shared with the caller: a header and arrays of little-endian numbers of eight bytes each."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hypercircle_process import BadExchange

FORMAT = "hypercircle-dual"
VERSION = 1
TYPES = {"f64": np.dtype("<f8"), "i64": np.dtype("<i8"), "u8": np.dtype("u1")}


@dataclass(frozen=True)
class Files:
    """The header of ``problem.json`` and the folder of its arrays, of which a rank reads the parts that it needs."""

    folder: Path
    triangles: int
    unknowns: int
    first_jump: int
    parameters: int
    held: np.ndarray
    load: float
    ranks: int
    linear_solver: str

    @property
    def jumps(self) -> int:
        """Number of jumps, the last unknowns."""
        return self.unknowns - self.first_jump

    def array(self, name: str) -> np.ndarray:
        """The array of a file, read where it is looked at."""
        path, kind = self.folder / name, TYPES[name.rpartition(".")[2]]
        try:
            if path.stat().st_size == 0:
                return np.empty(0, kind)
            return np.memmap(path, kind, "r")
        except (OSError, ValueError) as error:
            raise BadExchange(f"{path} cannot be read ({error})") from error

    def pieces(self, name: str, starts: np.ndarray, lengths: np.ndarray) -> np.ndarray:
        """Consecutive pieces of an array, one after the other."""
        return np.asarray(self.array(name)[ranges(starts, lengths)])

    def write(self, name: str, places: np.ndarray, values: np.ndarray) -> None:
        """Put values at their places of a file that :meth:`make` made."""
        if len(places):
            out = np.memmap(self.folder / name, TYPES[name.rpartition(".")[2]], "r+")
            out[places] = values
            out.flush()

    def make(self, name: str, count: int) -> None:
        """Make a file of ``count`` zeros."""
        with open(self.folder / name, "wb") as out:
            out.truncate(count * TYPES[name.rpartition(".")[2]].itemsize)

    def answer(self, content: dict) -> None:
        """Write the report, last of all files."""
        text = json.dumps({"format": FORMAT, "version": VERSION, **content})
        (self.folder / "answer.json").write_text(text, encoding="utf-8")


def ranges(starts: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """The numbers of [start, start + length), range after range."""
    ends = np.cumsum(lengths)
    total = int(ends[-1]) if len(ends) else 0
    return np.arange(total) + np.repeat(starts - (ends - lengths), lengths)


def read(path: Path) -> Files:
    """Read the header."""
    try:
        header = json.loads(path.read_text(encoding="utf-8"))
        if (header["format"], header["version"]) != (FORMAT, VERSION):
            raise BadExchange(f"{path} is {header['format']!r} {header['version']}, not {FORMAT!r} {VERSION}")
        return Files(
            folder=path.parent,
            triangles=int(header["triangles"]),
            unknowns=int(header["unknowns"]),
            first_jump=int(header["first_jump"]),
            parameters=int(header["parameters"]),
            held=np.array(header["held"], np.int64),
            load=float(header["load"]),
            ranks=int(header["ranks"]),
            linear_solver=str(header["linear_solver"]),
        )
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadExchange(f"{path} cannot be used ({type(error).__name__}: {error})") from error
