"""Command line: ``mpirun -n N python3 -m hypercircle_dual problem.json``; results go beside the file.

Exit codes: 0 result files written, 2 bad arguments or exchange file, 3 the solver failed, 4 PETSc not installed.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from hypercircle_process import finish


def run(path: Path, program: Path | None) -> None:
    """Read, solve, write; or have ``program`` make the upper bound of its solution."""
    from . import compat
    from .bracket import relay
    from .run import solve

    if program is None:
        solve(compat.MPI.COMM_WORLD, path)
    else:
        relay(compat.MPI.COMM_WORLD, program, path)


def main() -> None:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(prog="hypercircle_dual", description=__doc__.splitlines()[0])
    parser.add_argument("problem", type=Path, help="the file problem.json, beside the arrays that belong to it")
    parser.add_argument("--bracket", type=Path, metavar="PROGRAM", help="run it on the parts in the folder PROBLEM")
    options = parser.parse_args()
    finish("hypercircle-dual", lambda: run(options.problem, options.bracket))


if __name__ == "__main__":
    main()
