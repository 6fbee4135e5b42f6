#!/usr/bin/python3
"""Stands in for the interpreter of the displacement model and makes one thing wrong.

HYPERCIRCLE_PLANT is `NAME SEED`: what is wrong, and which of several places it is put in. A fault of MODEL changes
problem.json before the true model reads it; the model then solves another problem in all honesty. A fault of RESULT
changes what the model wrote. Where a scene has no place for a fault, the run ends with exit code 9.
HYPERCIRCLE_PLANT_KEEP names a folder for what was handed over, HYPERCIRCLE_PLANT_OTHER one with the results of
another scene, HYPERCIRCLE_PLANT_PYTHON the true interpreter.
"""

import json
import os
import random
import shutil
import subprocess
import sys

NO_PLACE = 9


def pick(rng, items):
    if not items:
        sys.exit(NO_PLACE)
    return rng.choice(items)


# Each takes the problem and changes it.


def poisson_sign(problem, rng):
    for body in problem["bodies"]:
        body["poisson"] = -body["poisson"]
    if not any(body["poisson"] for body in problem["bodies"]):
        sys.exit(NO_PLACE)


def modulus(problem, rng):
    pick(rng, problem["bodies"])["young"] *= 1.05


def poisson(problem, rng):
    body = pick(rng, problem["bodies"])
    body["poisson"] *= 0.95
    if body["poisson"] == 0:
        sys.exit(NO_PLACE)


def thickness(problem, rng):
    problem["thickness"] *= 1.05


def kinematics(problem, rng):
    problem["kinematics"] = {"plane-strain": "plane-stress", "plane-stress": "plane-strain"}[problem["kinematics"]]


def weight_missing(problem, rng):
    pick(rng, [body for body in problem["bodies"] if any(body["body_force"])])["body_force"] = [0.0, 0.0]


def weight_sideways(problem, rng):
    body = pick(rng, [body for body in problem["bodies"] if any(body["body_force"])])
    x, y = body["body_force"]
    body["body_force"] = [y, -x]


def load_larger(problem, rng):
    if not problem["tractions"]:
        sys.exit(NO_PLACE)
    for entry in problem["tractions"]:
        entry["values"] = [[1.01 * x for x in value] for value in entry["values"]]


def load_missing_on_an_edge(problem, rng):
    problem["tractions"].remove(pick(rng, problem["tractions"]))


def load_constant_on_an_edge(problem, rng):
    entry = pick(rng, [e for e in problem["tractions"] if e["values"][0] != e["values"][1]])
    entry["values"] = [entry["values"][0]] * 2


def clamp_missing_on_an_edge(problem, rng):
    problem["clamped"].remove(pick(rng, problem["clamped"]))


def roller_missing_on_an_edge(problem, rng):
    problem["roller"].remove(pick(rng, problem["roller"]))


def roller_turned(problem, rng):
    entry = pick(rng, problem["roller"])
    x, y = entry["normal"]
    entry["normal"] = [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y]


def clamp_for_roller(problem, rng):
    entry = pick(rng, problem["roller"])
    problem["roller"].remove(entry)
    problem["clamped"].append({"edge": entry["edge"], "displacement": [0.0, 0.0]})


def displacement_larger(problem, rng):
    moved = [e for e in problem["clamped"] if any(e["displacement"])]
    if not moved:
        sys.exit(NO_PLACE)
    for entry in moved:
        entry["displacement"] = [1.05 * x for x in entry["displacement"]]


def pairs(problem):
    return [(contact, pair) for contact in problem["contacts"] for pair in contact["pairs"]]


def pair_missing(problem, rng):
    contact, pair = pick(rng, [p for p in pairs(problem) if len(p[0]["pairs"]) > 1])
    contact["pairs"].remove(pair)


def gap_larger(problem, rng):
    """By a hundredth of the edge's length at one end."""
    _, pair = pick(rng, pairs(problem))
    a, b = (problem["points"][v] for v in pair["first"])
    pair["gap"][rng.randrange(2)] += 0.01 * ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5


def gap_swapped(problem, rng):
    _, pair = pick(rng, [p for p in pairs(problem) if p[1]["gap"][0] != p[1]["gap"][1]])
    pair["gap"].reverse()


def contact_glued(problem, rng):
    """The first side held on an edge as if it were a roller."""
    contact, pair = pick(rng, [p for p in pairs(problem) if p[1]["second"] is None and len(p[0]["pairs"]) > 1])
    contact["pairs"].remove(pair)
    problem["roller"].append({"edge": pair["edges"][0], "normal": pair["normal"]})


def triangle_of_another_body(problem, rng):
    if len(problem["bodies"]) < 2:
        sys.exit(NO_PLACE)
    triangle = rng.randrange(len(problem["body"]))
    problem["body"][triangle] = (problem["body"][triangle] + 1) % len(problem["bodies"])


def vertex_moved(problem, rng):
    """An inner vertex by a tenth of an edge."""
    ends = {}
    for edge, (a, b) in enumerate(problem["edges"]):
        for v in (a, b):
            ends.setdefault(v, []).append(edge)
    count = {}
    for edges in problem["triangle_edges"]:
        for edge in edges:
            count[edge] = count.get(edge, 0) + 1
    inner = [v for v, edges in ends.items() if all(count.get(e) == 2 for e in edges)]
    vertex = pick(rng, inner)
    a, b = (problem["points"][v] for v in problem["edges"][ends[vertex][0]])
    problem["points"][vertex] = [x + 0.1 * (q - p) for x, p, q in zip(problem["points"][vertex], a, b)]


MODEL = [
    poisson_sign, modulus, poisson, thickness, kinematics, weight_missing, weight_sideways, load_larger,
    load_missing_on_an_edge, load_constant_on_an_edge, clamp_missing_on_an_edge, roller_missing_on_an_edge,
    roller_turned, clamp_for_roller, displacement_larger, pair_missing, gap_larger, gap_swapped, contact_glued,
    triangle_of_another_body, vertex_moved,
]  # fmt: skip

# Each takes the results of both degrees and changes them.


def largest(result):
    return max((abs(x) for u in result["vertex_displacement"] for x in u), default=0.0)


def displacements(result):
    return result["vertex_displacement"] + (result["edge_displacement"] or [])


def one_displacement(results, rng):
    """One component by a thousandth of the largest, the same vertex in both."""
    at, component = rng.randrange(len(results[0]["vertex_displacement"])), rng.randrange(2)
    for result in results:
        result["vertex_displacement"][at][component] += 1e-3 * (largest(result) or 1.0)


def one_midpoint(results, rng):
    result = results[-1]
    at = pick(rng, range(len(result["edge_displacement"] or [])))
    result["edge_displacement"][at][rng.randrange(2)] += 1e-3 * (largest(result) or 1.0)


def all_displacements(results, rng):
    for result in results:
        for u in displacements(result):
            u[:] = [1.01 * x for x in u]


def everything_larger(results, rng):
    """As of a load that is larger by a hundredth: displacements, forces and energy belong together."""
    for result in results:
        for u in displacements(result):
            u[:] = [1.01 * x for x in u]
        for key in ("energy", "strain_energy"):
            result[key] *= 1.01**2
        for contact in result["contacts"]:
            for key in ("vertex_reaction", "edge_reaction", "resultant"):
                contact[key] = contact[key] and [1.01 * x for x in contact[key]]


def moved_as_a_whole(results, rng):
    for result in results:
        size = 1e-2 * (largest(result) or 1.0)
        for u in displacements(result):
            u[0] += size


def displacements_shorter(results, rng):
    for result in results:
        result["vertex_displacement"].pop()


def reactions_shorter(results, rng):
    for result in results:
        pick(rng, result["contacts"])["vertex_reaction"].pop()


def energy_larger(results, rng):
    """By one per cent of the strain energy."""
    for result in results:
        result["energy"] += 0.01 * (result["strain_energy"] or 1.0)


def energy_lower(results, rng):
    for result in results:
        result["energy"] -= 0.01 * (result["strain_energy"] or 1.0)


def strain_energy_larger(results, rng):
    for result in results:
        result["strain_energy"] = 1.01 * result["strain_energy"] or 1.0


def not_a_number(results, rng):
    for result in results:
        result["vertex_displacement"][0][0] = float("nan")


def energy_not_a_number(results, rng):
    for result in results:
        result["energy"] = float("nan")


def reactions_permuted(results, rng):
    for result in results:
        contact = pick(rng, [c for c in result["contacts"] if len(set(c["vertex_reaction"])) > 1])
        before = contact["vertex_reaction"]
        contact["vertex_reaction"] = before[1:] + before[:1]


def reactions_larger(results, rng):
    for result in results:
        contact = pick(rng, [c for c in result["contacts"] if any(c["vertex_reaction"])])
        contact["vertex_reaction"] = [1.05 * r for r in contact["vertex_reaction"]]


def reaction_at_a_foreign_vertex(results, rng):
    """A pair of reactions that adds nothing to the resultant, at vertices that need not touch anything."""
    for result in results:
        contact = pick(rng, [c for c in result["contacts"] if len(c["vertices"]) > 2])
        size = 0.05 * (max(map(abs, contact["vertex_reaction"])) or 1.0)
        contact["vertex_reaction"][0] += size
        contact["vertex_reaction"][-1] -= size


def vertices_of_another_body(results, rng):
    for result in results:
        contact = pick(rng, result["contacts"])
        contact["vertices"][0] = (contact["vertices"][0] + 7) % len(result["vertex_displacement"])


def resultant_larger(results, rng):
    for result in results:
        contact = pick(rng, [c for c in result["contacts"] if any(c["resultant"])])
        contact["resultant"] = [1.05 * x for x in contact["resultant"]]


def contacts_in_another_order(results, rng):
    for result in results:
        if len(result["contacts"]) < 2:
            sys.exit(NO_PLACE)
        result["contacts"].reverse()


def pulls(results, rng):
    for result in results:
        contact = pick(rng, [c for c in result["contacts"] if any(c["vertex_reaction"])])
        contact["vertex_reaction"] = [-r for r in contact["vertex_reaction"]]


def called_inadmissible(results, rng):
    for result in results:
        result["admissible"] = not result["admissible"]


def another_scene(results, rng):
    folder = os.environ.get("HYPERCIRCLE_PLANT_OTHER")
    if not folder:
        sys.exit(NO_PLACE)
    for result in results:
        with open(os.path.join(folder, f"primal-P{result['degree']}.json"), encoding="utf-8") as file:
            other = json.load(file)
        result.clear()
        result.update(other)


def another_scene_of_the_same_shape(results, rng):
    """Numbers of another scene in arrays of the right lengths."""
    folder = os.environ.get("HYPERCIRCLE_PLANT_OTHER")
    if not folder:
        sys.exit(NO_PLACE)
    for result in results:
        with open(os.path.join(folder, f"primal-P{result['degree']}.json"), encoding="utf-8") as file:
            other = json.load(file)
        for key in ("vertex_displacement", "edge_displacement"):
            if result[key]:
                result[key] = [other[key][i % len(other[key])] for i in range(len(result[key]))]
        for key in ("energy", "strain_energy"):
            result[key] = other[key]


def linear_for_quadratic(results, rng):
    """The linear solution handed in as the quadratic one."""
    if len(results) < 2:
        sys.exit(NO_PLACE)
    linear, quadratic = results
    with open(os.environ["HYPERCIRCLE_PLANT_PROBLEM"], encoding="utf-8") as file:
        edges = json.load(file)["edges"]
    u = linear["vertex_displacement"]
    quadratic["vertex_displacement"] = u
    quadratic["edge_displacement"] = [[0.5 * (p + q) for p, q in zip(u[a], u[b])] for a, b in edges]
    for key in ("energy", "strain_energy"):
        quadratic[key] = linear[key]
    for mine, theirs in zip(quadratic["contacts"], linear["contacts"]):
        mine.update(vertex_reaction=theirs["vertex_reaction"], resultant=theirs["resultant"])
        mine["edge_reaction"] = mine["edge_reaction"] and [0.0] * len(mine["edge_reaction"])


RESULT = [
    one_displacement, one_midpoint, all_displacements, everything_larger, moved_as_a_whole, displacements_shorter,
    reactions_shorter, energy_larger, energy_lower, strain_energy_larger, not_a_number, energy_not_a_number,
    reactions_permuted, reactions_larger, reaction_at_a_foreign_vertex, vertices_of_another_body, resultant_larger,
    contacts_in_another_order, pulls, called_inadmissible, another_scene, another_scene_of_the_same_shape,
    linear_for_quadratic,
]  # fmt: skip


def change(path, how):
    with open(path, encoding="utf-8") as file:
        content = json.load(file)
    how(content)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(content, file)


def main():
    if sys.argv[1:] == ["--list"]:
        for kind, faults in (("model", MODEL), ("result", RESULT)):
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
    for fault in MODEL:
        if fault.__name__ == name:
            change(problem, lambda content: fault(content, rng))
    code = subprocess.call([python, *sys.argv[1:]])
    folder = os.path.dirname(problem)
    paths = [os.path.join(folder, f"primal-P{degree}.json") for degree in (1, 2)]
    paths = [path for path in paths if os.path.exists(path)]
    for fault in RESULT:
        if code == 0 and fault.__name__ == name:
            results = []
            for path in paths:
                with open(path, encoding="utf-8") as file:
                    results.append(json.load(file))
            fault(results, rng)
            for path, result in zip(paths, results):
                with open(path, "w", encoding="utf-8") as file:
                    json.dump(result, file)
    keep = os.environ.get("HYPERCIRCLE_PLANT_KEEP")
    if keep:
        os.makedirs(keep, exist_ok=True)
        for path in paths:
            shutil.copy(path, keep)
    return code


if __name__ == "__main__":
    sys.exit(main())
