"""The hybrid form of the stress problem on PETSc, over MPI ranks.

The package reads the element matrices that the caller wrote, solves min ½ xᵀKx − fᵀx over edge moments x whose jumps on
the contact are bounded, and writes the mode parameters of the stresses. Data travels
``exchange → distribution → model → solvers → contact → refinement → run → exchange``; ``compat`` holds every call to PETSc
whose spelling or options depend on its release. docs/exchange.md describes the files.
"""

from __future__ import annotations

import sys


class DualFailure(Exception):
    """A run that ends without a result; ``exit_code`` tells the caller of what kind."""

    exit_code = 3


class BadExchange(DualFailure):
    """A file of the exchange cannot be read, or contradicts another one."""

    exit_code = 2


class NotInstalled(DualFailure):
    """PETSc or one of its parts is missing."""

    exit_code = 4


def log(comm, text: str) -> None:
    """One line of progress on stderr, from rank 0 only."""
    if comm.rank == 0:
        print(text, file=sys.stderr, flush=True)
