"""Finds the module that `ci/python-module` builds."""

import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "python"))
sys.path.insert(0, str(Path(__file__).resolve().parent))


@pytest.fixture(scope="session")
def hypercircle():
    """The module under test; a missing one is an error, not a reason to skip."""
    try:
        import hypercircle as module
    except ImportError as error:
        pytest.fail(f"build the module first with ci/python-module: {error}")
    return module
