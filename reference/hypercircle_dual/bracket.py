"""The upper bound rank by rank: each rank runs the caller's program on its part, and passes on what these say to each other.

The program knows nothing of MPI. It writes requests to its standard output and reads the answers from its standard input, all
little-endian numbers of eight bytes behind a letter:

- ``E``, to exchange numbers with some ranks: how many it gives to, and for each of these its number, how many numbers, and the
  numbers; then how many it takes from, and for each of these its number and how many numbers. The answer is these numbers.
- ``G``, to gather: how many numbers, and the numbers. The answer is as many of each rank, in their order.
- ``D`` when it is done.
"""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import numpy as np

from hypercircle_process import Failure

from .compat import MPI

COUNT, NUMBER = np.dtype("<i8"), np.dtype("<f8")


def relay(comm, program: Path, folder: Path) -> None:
    """Run ``program`` on the part of this rank until it is done."""
    # PETSc ends the process at a broken pipe; here it says that the program is gone.
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    command = [program, "part", folder / f"part-{comm.rank}", folder / f"found-{comm.rank}"]
    try:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as child:
            try:
                _serve(comm, child)
            except BaseException:
                child.kill()
                raise
    except (EOFError, BrokenPipeError):
        raise Failure(f"the bracket of rank {comm.rank} ended before it was done") from None
    if child.returncode != 0:
        raise Failure(f"the bracket of rank {comm.rank} ended with code {child.returncode}")
    comm.barrier()


def _serve(comm, child) -> None:
    requests = {b"E": _exchange, b"G": _gather}
    while (kind := child.stdout.read(1)) != b"D":
        if kind not in requests:
            raise EOFError
        answer = requests[kind](comm, child.stdout)
        child.stdin.write(answer)
        child.stdin.flush()


def _exchange(comm, requests) -> bytes:
    sent = []
    for _ in range(_count(requests)):
        rank, numbers = _count(requests), _numbers(requests)
        sent.append(comm.Isend([numbers, MPI.DOUBLE], rank))
    taken = []
    for _ in range(_count(requests)):
        rank, numbers = _count(requests), np.empty(_count(requests), NUMBER)
        comm.Recv([numbers, MPI.DOUBLE], rank)
        taken.append(numbers.tobytes())
    MPI.Request.Waitall(sent)
    return b"".join(taken)


def _gather(comm, requests) -> bytes:
    own = _numbers(requests)
    everyone = np.empty(comm.size * len(own), NUMBER)
    comm.Allgather([own, MPI.DOUBLE], [everyone, MPI.DOUBLE])
    return everyone.tobytes()


def _count(requests) -> int:
    return int(_read(requests, 1, COUNT)[0])


def _numbers(requests) -> np.ndarray:
    return _read(requests, _count(requests), NUMBER)


def _read(requests, count: int, kind: np.dtype) -> np.ndarray:
    text = requests.read(count * kind.itemsize)
    if len(text) != count * kind.itemsize:
        raise EOFError
    return np.frombuffer(text, kind)
