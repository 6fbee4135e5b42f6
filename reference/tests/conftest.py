"""Makes the package and the scene builders importable, and runs problems in this process or on two ranks."""

import os
import shutil
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
# Where `ci/setup tests` puts scikit-fem.
sys.path.append(str(HERE.parent.parent / os.environ.get("CARGO_TARGET_DIR", "target") / "python"))


@pytest.fixture
def solve():
    """``solve(data, degree, family="P", **options)`` → contents of the result file."""
    from mpi4py import MPI

    from hypercircle_reference.exchange import parse_problem
    from hypercircle_reference.run import solve_all

    def run(data, degree, family="P", **options):
        return solve_all(MPI.COMM_WORLD, parse_problem(data), [(family, degree)], **options)[0]

    return run


@pytest.fixture
def mpirun():
    """Starts two ranks; a missing launcher is an error, not a reason to skip."""
    if shutil.which("mpirun") is None:
        pytest.fail("mpirun is missing: ci/setup tests installs it, from Debian's openmpi-bin")
    return "mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"
