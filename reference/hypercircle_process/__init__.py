"""Common parts of all solvers that run as separate processes: failure, reports and exit.

Exit codes: 0 result files written, 2 bad arguments or exchange file, 3 the solver failed, 4 a package is not installed.
"""

from __future__ import annotations

import sys
from typing import Callable


class Failure(Exception):
    """A run that ends without a result; ``exit_code`` tells the caller of what kind."""

    exit_code = 3


class BadExchange(Failure):
    """A file of the exchange cannot be read, or contradicts itself or another one."""

    exit_code = 2


class NotInstalled(Failure):
    """A package that the solver needs, or one of its parts, is missing."""

    exit_code = 4


def log(comm, text: str) -> None:
    """One line of progress on stderr, from rank 0 only."""
    if comm.rank == 0:
        say(text)


def say(text: str) -> None:
    """One line on stderr, written in one piece: what several ranks write in several pieces becomes one line of all."""
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()


def finish(name: str, work: Callable[[], None]) -> None:
    """Do the ``work``, and translate every failure into an exit code and one line on stderr that begins with ``name``."""
    try:
        work()
    except (NotInstalled, ImportError) as missing:
        say(f"{name}: not installed: {_missing(missing)}")
        _leave(NotInstalled.exit_code)
    except Failure as failure:
        say(f"{name}: {failure}")
        _leave(failure.exit_code)
    except (MemoryError, OSError, RuntimeError, ValueError) as error:
        say(f"{name}: {type(error).__name__}: {error}")
        _leave(Failure.exit_code)


def _missing(error: Exception) -> str:
    return f"{error.name or 'a package'} cannot be imported ({error})" if isinstance(error, ImportError) else str(error)


def _leave(code: int) -> None:
    """End this rank; of several, one that fails takes the others along, which would wait for it forever."""
    if "mpi4py.MPI" in sys.modules:
        from mpi4py import MPI

        if MPI.COMM_WORLD.size > 1:
            MPI.COMM_WORLD.Abort(code)
    sys.exit(code)
