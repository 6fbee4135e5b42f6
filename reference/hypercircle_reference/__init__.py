"""Displacement model of plane frictionless contact, the reference the stress solution is compared with.

The package reads ``problem.json``, minimises the potential energy 𝓛 over continuous P1 or P2 displacements with
FEniCSx and PETSc, and writes ``primal-P1.json`` or ``primal-P2.json``. Data travels
``exchange → constraints → model → descent → solve → exchange``; ``compat`` holds every call that depends on the DOLFINx
release.
"""

from __future__ import annotations

import sys


class ReferenceFailure(Exception):
    """A run that ends without a result; ``exit_code`` tells the caller of what kind."""

    exit_code = 3


class BadExchange(ReferenceFailure):
    """The exchange file cannot be read, or contradicts itself."""

    exit_code = 2


class NotInstalled(ReferenceFailure):
    """FEniCSx or one of its parts is missing."""

    exit_code = 4


def log(comm, text: str) -> None:
    """One line of progress on stderr, from rank 0 only."""
    if comm.rank == 0:
        print(text, file=sys.stderr, flush=True)
