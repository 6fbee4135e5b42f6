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


def differ(expected, found):
    """By how much lower and upper bounds differ, relative to the larger of both; nothing where there is no energy."""
    size = max(abs(expected["lower"]), abs(expected["upper"]))
    return [abs(expected[bound] - found[bound]) / size if size > 0.0 else 0.0 for bound in ("lower", "upper")]


def cases(ranks, solver):
    """Prints the differences from the condensed method, and counts the runs that differ.

    Lower bounds are to agree to 1e-9, and upper ones too unless the scene leaves a displacement open, on which they depend.
    """
    failed = 0
    print("| scene | ranks | lower bounds differ by | upper bounds | equilibrium | displacement |")
    print("|---|--:|--:|--:|--:|---|", flush=True)
    for scene in sorted([*Path("cases").glob("*.toml"), *Path("tests/scenes").glob("*.toml")]):
        expected, refused = solve(str(scene))
        for size in ranks:
            found, said = solve(str(scene), *engine(size, solver))
            if found is None and "bodies of revolution" in said:
                continue
            if found is None or expected is None:
                failed += found is not None or expected is not None
                print(f"| {scene.stem} | {size} | {' '.join((said or refused).split())[:200]} |", flush=True)
                continue
            lower, upper = differ(expected["energy"], found["energy"])
            is_open = any("the displacement" in note["text"].lower() for note in expected["notes"])
            residual = found["dual"]["equilibrium_residual"]
            failed += lower > 1e-9 or residual > 1e-9 or (upper > 1e-9 and not is_open)
            known = "left open" if is_open else "unique"
            print(f"| {scene.stem} | {size} | {lower:.0e} | {upper:.0e} | {residual:.0e} | {known} |", flush=True)
    return failed


if __name__ == "__main__":
    arguments = [argument.split() for argument in sys.argv[1:]]
    if arguments[:1] == [["cases"]]:
        ranks, [solver] = [*arguments[1:], *[["1", "2", "4"], ["mumps"]][len(arguments) - 1 :]]
        sys.exit(cases(ranks, solver) > 0)
    defaults = [["0", "1", "2", "3", "4"], ["1", "2"], ["mumps", "gamg"]]
    scale(*(arguments + defaults[len(arguments):]))
