#!/usr/bin/python3
"""Stands in for the interpreter of the displacement model and makes one thing wrong.

HYPERCIRCLE_PLANT is `NAME SEED`: what is wrong, and which of several places it is put in. A bug of the model (`bugs.py`)
changes problem.json before the true model reads it. A lie about the result (`lies.py`) changes what the model wrote.
Where a scene has no place for a fault, the run ends with exit code 9, and with 8 where the fault itself is wrong.
HYPERCIRCLE_PLANT_KEEP names a folder for what was handed over, HYPERCIRCLE_PLANT_OTHER one with the results of
another scene, HYPERCIRCLE_PLANT_PYTHON the true interpreter.
"""

import json
import os
import random
import shutil
import subprocess
import sys
import traceback

# PYTHONSAFEPATH leaves out the folder of a script.
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from bugs import BUGS  # noqa: E402
from lies import LIES  # noqa: E402


BROKEN = 8


def plant(fault, paths, rng):
    """Lets `fault` change what is in the files."""
    contents = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            contents.append(json.load(file))
    try:
        fault(contents[0] if fault in BUGS else contents, rng)
    except Exception:
        traceback.print_exc()
        sys.exit(BROKEN)
    for path, content in zip(paths, contents):
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file)


def main():
    if sys.argv[1:] == ["--list"]:
        for kind, faults in (("model", BUGS), ("result", LIES)):
            for fault in faults:
                print(kind, fault.__name__)
        return 0
    python = os.environ.get("HYPERCIRCLE_PLANT_PYTHON", "/usr/bin/python3")
    problem = next((a for a in sys.argv[1:] if os.path.basename(a) == "problem.json"), None)
    if problem is None:
        return subprocess.call([python, *sys.argv[1:]])
    os.environ["HYPERCIRCLE_PLANT_PROBLEM"] = problem
    name, seed = os.environ.get("HYPERCIRCLE_PLANT", "nothing 0").split()
    rng = random.Random(int(seed))
    for fault in BUGS:
        if fault.__name__ == name:
            plant(fault, [problem], rng)
    code = subprocess.call([python, *sys.argv[1:]])
    folder = os.path.dirname(problem)
    paths = [os.path.join(folder, f"primal-P{degree}.json") for degree in (1, 2)]
    paths = [path for path in paths if os.path.exists(path)]
    for fault in LIES:
        if code == 0 and fault.__name__ == name:
            plant(fault, paths, rng)
    keep = os.environ.get("HYPERCIRCLE_PLANT_KEEP")
    if keep:
        os.makedirs(keep, exist_ok=True)
        for path in paths:
            shutil.copy(path, keep)
    return code


if __name__ == "__main__":
    sys.exit(main())
