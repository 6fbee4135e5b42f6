"""Command line: ``mpirun -n N python3 -m hypercircle_dual problem.json``; results go beside the file.

Exit codes: 0 result files written, 2 bad arguments or exchange file, 3 the solver failed, 4 PETSc not installed.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from . import DualFailure, NotInstalled


def run(path: Path) -> None:
    """Read, solve, write."""
    try:
        from . import compat
        from .run import solve
    except ImportError as error:
        raise NotInstalled(f"{error.name or 'a package'} cannot be imported ({error})") from error
    solve(compat.MPI.COMM_WORLD, path)


def leave(code: int) -> None:
    """End this rank; of several, one that fails takes the others along, which would wait for it forever."""
    sys.stderr.flush()
    if "mpi4py.MPI" in sys.modules:
        from mpi4py import MPI

        if MPI.COMM_WORLD.size > 1:
            MPI.COMM_WORLD.Abort(code)
    sys.exit(code)


def main() -> None:
    """Run and translate every failure into an exit code and one line on stderr."""
    parser = argparse.ArgumentParser(prog="hypercircle_dual", description=__doc__.splitlines()[0])
    parser.add_argument("problem", type=Path, help="the file problem.json, beside the arrays that belong to it")
    options = parser.parse_args()
    try:
        run(options.problem)
    except NotInstalled as missing:
        print(f"hypercircle-dual: not installed: {missing}", file=sys.stderr)
        leave(missing.exit_code)
    except DualFailure as failure:
        print(f"hypercircle-dual: {failure}", file=sys.stderr)
        leave(failure.exit_code)
    except (MemoryError, OSError, RuntimeError, ValueError) as error:
        print(f"hypercircle-dual: {type(error).__name__}: {error}", file=sys.stderr)
        leave(DualFailure.exit_code)


if __name__ == "__main__":
    main()
