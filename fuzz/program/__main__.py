"""Runs the program on changed scenes, meshes, fields and results, and asserts what has to hold of any run."""

import argparse
import collections
import concurrent.futures
import itertools
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import trial

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--minutes", type=float, help="stop after so many minutes")
parser.add_argument("--runs", type=int, help="stop after so many runs")
parser.add_argument("--seed", default="1", help="begins every seed of this call")
parser.add_argument("--only", metavar="SEED", help="repeat one run, as its folder is named after the dash")
parser.add_argument("--jobs", type=int, default=2)
parser.add_argument("--binary", default=str(trial.ROOT / "target/debug/hypercircle"))
parser.add_argument("--out", type=Path, default=Path("out/fuzz"))
args = parser.parse_args()

binary, kept = os.path.abspath(args.binary), args.out.absolute()
kept.mkdir(parents=True, exist_ok=True)
material = trial.Material()
until = time.monotonic() + 60 * args.minutes if args.minutes else float("inf")


def one(seed):
    place = Path(tempfile.mkdtemp(prefix="fuzzed-"))
    try:
        found = trial.prepare(material, seed)
        trial.run(found, binary, place)
        if found.faults:
            trial.keep(found, place, binary, kept)
        return found
    finally:
        shutil.rmtree(place, ignore_errors=True)


def work(worker):
    done = []
    for number in itertools.count(worker, args.jobs):
        if time.monotonic() > until or (args.runs is not None and number >= args.runs):
            return done
        done.append(one(f"{args.seed}-{number}"))
        if done[-1].faults:
            print(f"{done[-1].kind}-{done[-1].seed}: {'; '.join(done[-1].faults)}", flush=True)


if args.only:
    trials = [one(args.only)]
else:
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        trials = [t for done in pool.map(work, range(args.jobs)) for t in done]
print("| files | runs | " + " | ".join(f"exit {code}" for code in range(6)) + " | longest, s | findings |")
print("|---|" + "---:|" * 9)
for kind in sorted({t.kind for t in trials}) + ["all"]:
    group = [t for t in trials if kind in (t.kind, "all")]
    codes = collections.Counter(t.code for t in group)
    cells = [len(group), *(codes[code] for code in range(6)), f"{max(t.seconds for t in group):.1f}", sum(bool(t.faults) for t in group)]
    print(f"| {kind} | " + " | ".join(map(str, cells)) + " |")
if any(t.faults for t in trials):
    print(f"findings, each with a script that repeats it: {kept}")
    sys.exit(1)
