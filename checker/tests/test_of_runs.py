"""Proofs that hypercircle makes: scenes of all kinds are proved, as they were claimed. HYPERCIRCLE names the program."""

import os
import subprocess
from pathlib import Path

import pytest
from hypercircle_check.main import check

ROOT = Path(__file__).parents[2]
PROGRAM = Path(os.environ.get("HYPERCIRCLE", ROOT / "target/debug/hypercircle"))
RUNS = [
    ("cases/two_blocks", []),
    ("cases/gravity", []),
    ("cases/inclined", ["--degree", "2"]),
    ("cases/gap", ["--degree", "3"]),
    ("cases/pin", []),
    ("cases/cylinder_on_block", []),
    ("cases/seal", []),
    ("cases/quadrilaterals", []),
    ("cases/sliding", ["--tolerance", "0.02"]),
    ("tests/scenes/standing_turned", []),
    ("tests/scenes/moved_rigidly", []),
    ("tests/scenes/soft_between_stiff", []),
    ("tests/scenes/three_that_meet_in_a_point", []),
]


@pytest.mark.skipif(not PROGRAM.is_file(), reason=f"{PROGRAM} is not built")
@pytest.mark.parametrize("scene, options", RUNS, ids=[Path(scene).name for scene, _ in RUNS])
def test_scene(tmp_path, scene, options):
    line = [PROGRAM, "solve", ROOT / f"{scene}.toml", "--proof", "--quiet", "--out", tmp_path, *options]
    subprocess.run(line, check=True, timeout=300)
    proof = check(tmp_path, ROOT / f"{scene}.toml")
    assert proof.lower <= proof.upper
