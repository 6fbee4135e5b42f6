"""Proofs that hypercircle makes: scenes of all kinds are proved, as they were claimed. HYPERCIRCLE names the program."""

import os
import re
import subprocess
from pathlib import Path

import pytest
from hypercircle_check.main import check, main

ROOT = Path(__file__).parents[2]
NAMED = os.environ.get("HYPERCIRCLE")
PROGRAM = Path(NAMED or ROOT / "target/debug/hypercircle")
# A program that was named has to be there: these tests then fail without it.
needs_program = pytest.mark.skipif(not NAMED and not PROGRAM.is_file(), reason=f"{PROGRAM} is not built")
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


@needs_program
@pytest.mark.parametrize("scene, options", RUNS, ids=[Path(scene).name for scene, _ in RUNS])
def test_scene(tmp_path, scene, options):
    line = [PROGRAM, "solve", ROOT / f"{scene}.toml", "--proof", "--quiet", "--out", tmp_path, *options]
    subprocess.run(line, check=True, timeout=300)
    proof = check(tmp_path, ROOT / f"{scene}.toml")
    assert proof.lower <= proof.upper


@needs_program
def test_page(tmp_path, capsys):
    """docs/proof.md shows what the checker prints, but for version, time and digits that are rounding."""
    page = (ROOT / "docs/proof.md").read_text()
    shown = page.split("```text\n")[1].split("```")[0].splitlines()
    case = ROOT / "cases/two_blocks.toml"
    subprocess.run([PROGRAM, "solve", case, "--proof", "--quiet", "--out", tmp_path], check=True, timeout=300)
    assert main([str(tmp_path), "--scene", str(case)]) == 0
    rough = lambda lines: [re.sub(r"\d\.\de-1[1-9]", "so much", line) for line in lines]
    assert rough(capsys.readouterr().out.splitlines())[: len(shown)] == rough(shown)
