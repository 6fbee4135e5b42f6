"""Finds the package that `ci/python-package` installs, and what `ci/setup` puts beside it."""

import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "python"))
sys.path.insert(0, str(Path(__file__).resolve().parent))


@pytest.fixture(scope="session")
def hypercircle():
    """The package under test; a missing one is an error, not a reason to skip."""
    try:
        import hypercircle as module
    except ImportError as error:
        pytest.fail(f"install the package first with ci/python-package: {error}")
    return module
