"""Bugs of the displacement model: each takes the problem and changes it, the model then solves another one in all honesty."""

from places import no_place, pick


def poisson_sign(problem, rng):
    for body in problem["bodies"]:
        body["poisson"] = -body["poisson"]
    if not any(body["poisson"] for body in problem["bodies"]):
        no_place()


def modulus(problem, rng):
    pick(rng, problem["bodies"])["young"] *= 1.05


def poisson(problem, rng):
    body = pick(rng, problem["bodies"])
    body["poisson"] *= 0.95
    if body["poisson"] == 0:
        no_place()


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
        no_place()
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
        no_place()
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


def gap_ignored(problem, rng):
    if not any(any(pair["gap"]) for _, pair in pairs(problem)):
        no_place()
    for _, pair in pairs(problem):
        pair["gap"] = [0.0 for _ in pair["gap"]]


def rollers_missing(problem, rng):
    """All of the first direction."""
    first = pick(rng, problem["roller"])["normal"]
    problem["roller"] = [e for e in problem["roller"] if abs(e["normal"][0] * first[1] - e["normal"][1] * first[0]) > 1e-9]


def thickness_ignored(problem, rng):
    if problem["thickness"] == 1.0:
        no_place()
    problem["thickness"] = 1.0


def materials_swapped(problem, rng):
    if len(problem["bodies"]) < 2:
        no_place()
    first, second = problem["bodies"][:2]
    for key in ("young", "poisson"):
        first[key], second[key] = second[key], first[key]


def contact_at_one_node(problem, rng):
    """Everything but the first node of the first pair is out of reach."""
    contact = pick(rng, [c for c in problem["contacts"] if len(c["pairs"]) > 2])
    far = 1e3 * max(abs(x) for point in problem["points"] for x in point)
    for k, pair in enumerate(contact["pairs"]):
        pair["gap"] = [pair["gap"][0] if k == 0 else far, far]


def triangle_of_another_body(problem, rng):
    if len(problem["bodies"]) < 2:
        no_place()
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


BUGS = [
    poisson_sign, modulus, poisson, thickness, kinematics, weight_missing, weight_sideways, load_larger,
    load_missing_on_an_edge, load_constant_on_an_edge, clamp_missing_on_an_edge, roller_missing_on_an_edge,
    roller_turned, clamp_for_roller, displacement_larger, pair_missing, gap_larger, gap_swapped, contact_glued,
    triangle_of_another_body, vertex_moved, gap_ignored, rollers_missing, thickness_ignored, materials_swapped,
    contact_at_one_node,
]  # fmt: skip
