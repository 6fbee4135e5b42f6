#!/usr/bin/python3 -IS
"""Stands in for the interpreter of the displacement model and of meshio, and hands back something changed.

HYPERCIRCLE_FUZZ is a seed. For the displacement model a result of the right shape is made up and changed; for meshio what
HYPERCIRCLE_FUZZ_FIELD names is changed. Now and then it fails, hangs, dies, floods or writes nothing.
"""

import json
import os
import random
import signal
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import changes

chance = random.Random(os.environ["HYPERCIRCLE_FUZZ"])


def made_up(problem, degree):
    """A result of the right shape: small rigid motions, no reactions."""
    motion = [chance.choice([0.0, 1e-3, 1.0, chance.gauss(0, 1)]) for _ in range(2)]
    moved = lambda count: [[x + chance.gauss(0, 1e-3) for x in motion] for _ in range(count)]
    contacts = []
    for contact in problem["contacts"]:
        pairs = contact["pairs"]
        vertices = [pairs[0]["first"][0]] + [pair["first"][1] for pair in pairs] if pairs else []
        inner = [1 if pair["direction"][0] == pair["direction"][1] else 2 for pair in pairs]
        contacts.append({
            "name": contact["name"], "vertices": vertices, "vertex_reaction": [0.1] * len(vertices),
            "edge_reaction": [[0.1] * n for n in inner] if degree == 2 else None, "resultant": [-1.0, 0.0],
        })
    return {
        "format": "hypercircle-primal", "version": 1, "solver": "FEniCSx", "solver_version": "0", "petsc_version": "0",
        "degree": degree, "ranks": 1, "energy": -1.0, "strain_energy": 1.0, "energy_rounding": 1e-15, "iterations": 1,
        "converged_reason": 2, "unknowns": 8, "admissible": True,
        "seconds": dict.fromkeys(["import", "mesh", "assemble", "compile", "solve", "total"], 0.1),
        "vertex_displacement": moved(len(problem["points"])),
        "edge_displacement": moved(len(problem["edges"])) if degree == 2 else None, "contacts": contacts,
    }


def misbehave():
    """What a program can do beside handing back a file."""
    kind = chance.randrange(40)
    if kind == 0:
        sys.exit(chance.choice([1, 2, 3, 4, 44, 255]))
    elif kind == 1:
        os.kill(os.getpid(), chance.choice([signal.SIGKILL, signal.SIGSEGV, signal.SIGTERM]))
    elif kind == 2:
        time.sleep(100)
    elif kind == 3:
        os.write(chance.choice([1, 2]), b"\x1b[31m\xff" * 200_000)
    elif kind == 4:
        sys.exit(0)


arguments = sys.argv[1:]
misbehave()
if "--out" in arguments:
    with open(arguments[2], encoding="utf-8") as file:
        problem = json.load(file)
    folder = arguments[arguments.index("--out") + 1]
    for degree in (1, 2):
        with open(f"{folder}/primal-P{degree}.json", "wb") as file:
            file.write(changes.result(made_up(problem, degree), chance))
else:
    with open(os.environ["HYPERCIRCLE_FUZZ_FIELD"], "rb") as file:
        text = file.read()
    try:
        text = changes.result(json.loads(text), chance)
    except ValueError:
        text = changes.in_bytes(text, chance)
    with open(arguments[-1], "wb") as file:
        file.write(text)
