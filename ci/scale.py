"""Runs the engine on refined scenes, or on all cases, and prints a table; ci/scale says how."""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = os.environ["HYPERCIRCLE"]
SCENE = os.environ.get("SCENE", "cases/two_blocks.toml")


def solve(scene, *options):
    """The report of a run, or what it said."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([PROGRAM, "solve", scene, "--quiet", "--out", folder, *options], capture_output=True, text=True)
        if done.returncode != 0:
            return None, done.stderr
        return json.loads((Path(folder) / "report.json").read_text()), ""


def engine(ranks, solver):
    return "--engine", "petsc", "--ranks", str(ranks), "--linear-solver", solver


def note(report):
    """First and all iterations and megabytes, from the note of the engine."""
    text = next(note["text"] for note in report["notes"] if "PETSc" in note["text"])
    first = re.search(r"(\d+) iterations in the first solve, (\d+) in all", text)
    return (*(first.groups() if first else ("–", "–")), re.search(r"(\d+) MB", text)[1])


def scale(refinements, ranks, solvers):
    heads = ["triangles", "unknowns", "solver", "ranks", "contact states", "iterations, first solve", "all", "MB, largest rank", "s, set-up", "s"]
    print(f"| {' | '.join(heads)} |\n|{'--:|' * len(heads)}", flush=True)
    for n in refinements:
        for solver in solvers:
            for size in ranks:
                report, said = solve(SCENE, "--refine", n, *engine(size, solver))
                if report is None:
                    print(f"| {n} refinements | | {solver} | {size} | {' '.join(said.split())[:300]} |", flush=True)
                    continue
                dual = report["dual"]
                seconds = dual["seconds"]
                first, all_of_them, memory = note(report)
                states = re.search(r"states tried: (\d+)", str(report["notes"]))[1]
                spent = sum(seconds[phase] for phase in ("assemble", "factor", "contact", "recover"))
                print(
                    f"| {dual['triangles']:,} | {dual['unknowns']:,} | {solver} | {size} | {states} | {first} | {all_of_them} "
                    f"| {memory} | {seconds['factor']:.1f} | {spent:.1f} |",
                    flush=True,
                )


def cases(ranks):
    """Prints the differences from the condensed method; the exit code says whether all lower bounds agree to 1e-9."""
    failed = 0
    print("| scene | ranks | lower bounds differ by | upper bounds, part of the gap | equilibrium |")
    print("|---|--:|--:|--:|--:|", flush=True)
    for scene in sorted([*Path("cases").glob("*.toml"), *Path("tests/scenes").glob("*.toml")]):
        expected, said = solve(str(scene))
        for size in ranks:
            found, said = solve(str(scene), *engine(size, "mumps"))
            if found is None or expected is None:
                failed += found is not None or expected is not None
                print(f"| {scene.stem} | {size} | {' '.join(said.split())[:200]} |", flush=True)
                continue
            a, b = expected["energy"], found["energy"]
            lower = abs(a["lower"] - b["lower"]) / max(abs(a["lower"]), abs(a["upper"]), 1e-300)
            upper = abs(a["upper"] - b["upper"]) / max(a["gap"], 1e-9 * abs(a["upper"]), 1e-300)
            residual = found["dual"]["equilibrium_residual"]
            failed += lower > 1e-9 or residual > 1e-9
            print(f"| {scene.stem} | {size} | {lower:.1e} | {upper:.1e} | {residual:.1e} |", flush=True)
    return failed


if __name__ == "__main__":
    arguments = [argument.split() for argument in sys.argv[1:]]
    if arguments[:1] == [["cases"]]:
        sys.exit(cases(arguments[1] if len(arguments) > 1 else ["1", "2", "4"]) > 0)
    defaults = [["0", "1", "2", "3", "4"], ["1", "2"], ["mumps", "gamg"]]
    scale(*(arguments + defaults[len(arguments):]))
