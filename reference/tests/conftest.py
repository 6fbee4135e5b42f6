"""Makes the package and the scene builders importable, and runs problems in this process."""

import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]


@pytest.fixture
def solve():
    """``solve(data, degree, **options)`` → contents of the result file."""
    from mpi4py import MPI

    from hypercircle_reference.exchange import parse_problem
    from hypercircle_reference.run import solve_all

    def run(data, degree, **options):
        return solve_all(MPI.COMM_WORLD, parse_problem(data), [degree], **options)[0]

    return run
