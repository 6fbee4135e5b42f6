"""Command line: ``python3 -m hypercircle_reference problem.json --out DIR --degree 1 --degree 2``.

Exit codes: 0 result files written, 2 bad arguments or exchange file, 3 the solver failed, 4 FEniCSx not installed.
"""

from __future__ import annotations

from time import perf_counter

STARTED = perf_counter()

import argparse
import logging
import os
import sys
import threading
from pathlib import Path

from . import NotInstalled, ReferenceFailure, log


def arguments() -> argparse.Namespace:
    """Parse the command line."""
    parser = argparse.ArgumentParser(prog="hypercircle_reference", description=__doc__.splitlines()[0])
    parser.add_argument("problem", type=Path, help="the exchange file problem.json")
    parser.add_argument("--out", type=Path, required=True, help="folder for primal-P1.json and primal-P2.json")
    parser.add_argument("--degree", type=int, choices=(1, 2), action="append", help="1 or 2; repeat for both")
    parser.add_argument("--nodal-contact", action="store_true", help="bound the P2 jump at the nodes only")
    parser.add_argument("--sabotage", choices=("flip-sign", "drop-row"), help="plant a bug on purpose")
    parser.add_argument("--stop-with-stdin", action="store_true", help="end when standard input is closed")
    return parser.parse_args()


def run(options: argparse.Namespace) -> None:
    """Read, solve for every degree, and only then write."""
    try:
        from . import compat
        from .run import solve_all
    except ImportError as error:
        raise NotInstalled(f"{error.name or 'a package'} cannot be imported ({error})") from error
    from .exchange import read_problem, write_result

    comm = compat.MPI.COMM_WORLD
    imported = perf_counter() - STARTED
    start = perf_counter()
    problem = read_problem(options.problem)
    read = perf_counter() - start
    log(comm, f"{len(problem.triangles)} triangles, {comm.size} ranks, DOLFINx {compat.SOLVER_VERSION}")
    degrees = sorted(set(options.degree or (1, 2)))
    results = solve_all(comm, problem, degrees, options.nodal_contact, options.sabotage, (imported, read))
    if comm.rank == 0:
        for degree, result in zip(degrees, results):
            write_result(options.out / f"primal-P{degree}.json", result)


def leave(code: int) -> None:
    """End this rank; of several, one that fails takes the others along, which would wait for it forever."""
    sys.stderr.flush()
    if code and "mpi4py.MPI" in sys.modules:
        from mpi4py import MPI

        if MPI.COMM_WORLD.size > 1:
            MPI.COMM_WORLD.Abort(code)
    sys.exit(code)


def stop_with_stdin() -> None:
    """Leave when the process that started this one is gone, seen by the end of standard input."""

    def wait() -> None:
        while os.read(0, 4096):
            pass
        os._exit(3)

    threading.Thread(target=wait, daemon=True).start()


def main() -> None:
    """Run and translate every failure into an exit code and one line on stderr."""
    options = arguments()
    logging.disable(logging.INFO)  # the compiler's command lines would fill the log
    if options.stop_with_stdin and int(os.environ.get("OMPI_COMM_WORLD_RANK", "0")) == 0:
        stop_with_stdin()
    try:
        run(options)
    except NotInstalled as missing:
        print(f"hypercircle-reference: not installed: {missing}", file=sys.stderr)
        leave(missing.exit_code)
    except ReferenceFailure as failure:
        print(f"hypercircle-reference: {failure}", file=sys.stderr)
        leave(failure.exit_code)
    except (MemoryError, OSError, RuntimeError, ValueError) as error:
        print(f"hypercircle-reference: {type(error).__name__}: {error}", file=sys.stderr)
        leave(ReferenceFailure.exit_code)


if __name__ == "__main__":
    main()
