"""Command line: ``python3 -m hypercircle_reference problem.json --out DIR --degree 1 --degree 2 --quadrilaterals 1``.

Exit codes: 0 result files written, 2 bad arguments or exchange file, 3 the solver failed, 4 FEniCSx not installed.
"""

from __future__ import annotations

from time import perf_counter

STARTED = perf_counter()

import argparse
import logging
from pathlib import Path

from hypercircle_process import finish, log

from . import HIGHEST_DEGREE


def arguments() -> argparse.Namespace:
    """Parse the command line."""
    parser = argparse.ArgumentParser(prog="hypercircle_reference", description=__doc__.splitlines()[0])
    parser.add_argument("problem", type=Path, help="the exchange file problem.json")
    parser.add_argument("--out", type=Path, required=True, help="folder for primal-P1.json, primal-P2.json, …, primal-Q1.json, …")
    degrees = range(1, HIGHEST_DEGREE + 1)
    parser.add_argument("--degree", type=int, choices=degrees, action="append", help="on triangles; repeat for several; 1 and 2 if none is given")
    parser.add_argument("--quadrilaterals", type=int, choices=degrees, action="append", metavar="DEGREE", help="on quadrilaterals; repeat for several")
    parser.add_argument("--nodal-contact", action="store_true", help="bound the jump at the nodes only")
    parser.add_argument("--sabotage", choices=("flip-sign", "drop-row"), help="plant a bug on purpose")
    return parser.parse_args()


def run(options: argparse.Namespace) -> None:
    """Read, solve for every degree, and only then write."""
    from . import compat
    from .exchange import read_problem
    from .results import write_result
    from .run import solve_all

    comm = compat.MPI.COMM_WORLD
    imported = perf_counter() - STARTED
    start = perf_counter()
    problem = read_problem(options.problem)
    read = perf_counter() - start
    log(comm, f"{len(problem.triangles)} triangles, {comm.size} ranks, DOLFINx {compat.SOLVER_VERSION}")
    on_triangles = options.degree or (() if options.quadrilaterals else (1, 2))
    spaces = [("P", degree) for degree in sorted(set(on_triangles))]
    spaces += [("Q", degree) for degree in sorted(set(options.quadrilaterals or ()))]
    results = solve_all(comm, problem, spaces, options.nodal_contact, options.sabotage, (imported, read))
    if comm.rank == 0:
        for (family, degree), result in zip(spaces, results):
            write_result(options.out / f"primal-{family}{degree}.json", result)


def main() -> None:
    """Parse the command line and run."""
    options = arguments()
    logging.disable(logging.INFO)  # the compiler's command lines would fill the log
    finish("hypercircle-reference", lambda: run(options))


if __name__ == "__main__":
    main()
