"""Bugs of the displacement model: each takes the problem and changes it, the model then solves another one in all honesty."""

from places import no_place, pick


def isotropic(problem):
    return [body for body in problem["bodies"] if "young" in body]


def constant(problem):
    """Bodies with a body force that is the same everywhere."""
    return [body for body in problem["bodies"] if isinstance(body["body_force"], list) and any(body["body_force"])]


def poisson_sign(problem, rng):
    own = isotropic(problem)
    for body in own:
        body["poisson"] = -body["poisson"]
    if not any(body["poisson"] for body in own):
        no_place()


def modulus(problem, rng):
    pick(rng, isotropic(problem))["young"] *= 1.05


def poisson(problem, rng):
    body = pick(rng, isotropic(problem))
    body["poisson"] *= 0.95
    if body["poisson"] == 0:
        no_place()


def thickness(problem, rng):
    problem["thickness"] *= 1.05


def kinematics(problem, rng):
    problem["kinematics"] = {"plane-strain": "plane-stress", "plane-stress": "plane-strain"}[problem["kinematics"]]


def weight_missing(problem, rng):
    pick(rng, constant(problem))["body_force"] = [0.0, 0.0]


def weight_sideways(problem, rng):
    body = pick(rng, constant(problem))
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
    for key in ("young", "poisson", "stiffness"):
        for body, value in ((first, second.get(key)), (second, first.get(key))):
            body.pop(key, None) if value is None else body.update({key: value})


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


def springs(problem, layer=None, touching=False):
    found = [s for s in problem.get("springs", []) if ("gap" in s) == touching]
    found = [s for s in found if layer is None or (s.get("opposite") is not None) == layer]
    return found or no_place()


def springs_softer(problem, rng):
    own = springs(problem, layer=False)
    for spring in [s for s in own if s["stiffness"] == own[0]["stiffness"]]:
        spring["stiffness"] = [0.8 * k for k in spring["stiffness"]]


def springs_missing_along(problem, rng):
    """The tangential ones, where there are both."""
    own = [s for s in springs(problem, layer=False) if all(s["stiffness"])] or no_place()
    for spring in own:
        spring["stiffness"][1] = 0.0


def springs_both_ways(problem, rng):
    """A normal foundation that holds along the boundary too."""
    own = [s for s in springs(problem, layer=False) if s["stiffness"][1] == 0.0] or no_place()
    for spring in own:
        spring["stiffness"][1] = spring["stiffness"][0]


def layer_stiffer(problem, rng):
    for spring in springs(problem, layer=True):
        spring["stiffness"] = [1000.0 * k for k in spring["stiffness"]]


def layer_swapped(problem, rng):
    for spring in springs(problem, layer=True):
        spring["stiffness"].reverse()


def layer_slides(problem, rng):
    for spring in springs(problem, layer=True):
        spring["stiffness"][1] = 0.0


def elastic_contact_stiffer(problem, rng):
    for spring in springs(problem, touching=True):
        spring["stiffness"] = [1.5 * k for k in spring["stiffness"]]


def elastic_contact_pulls(problem, rng):
    """Springs in the place of elastic contact without a gap."""
    for spring in [s for s in springs(problem, touching=True) if not any(s["gap"])] or no_place():
        del spring["gap"]


def elastic_contact_gap_ignored(problem, rng):
    own = springs(problem, touching=True)
    if not any(any(spring["gap"]) for spring in own):
        no_place()
    for spring in own:
        spring["gap"] = [0.0 for _ in spring["gap"]]


def warm(problem):
    return [body for body in problem["bodies"] if "initial_strain" in body] or no_place()


def temperature_missing(problem, rng):
    del pick(rng, warm(problem))["initial_strain"]


def temperature_of_other_sign(problem, rng):
    body = pick(rng, warm(problem))
    body["initial_strain"] = [[-x for x in row] for row in body["initial_strain"]]


def temperature_larger(problem, rng):
    for body in warm(problem):
        body["initial_strain"] = [[1.08 * x for x in row] for row in body["initial_strain"]]


def stiff(problem):
    return [body for body in problem["bodies"] if "stiffness" in body] or no_place()


def axes_swapped(problem, rng):
    """x and y of the material."""
    for body in stiff(problem):
        c, of = body["stiffness"], (1, 0, 2)
        sign = lambda i, j: -1.0 if (i == 2) != (j == 2) else 1.0
        body["stiffness"] = [[sign(i, j) * c[of[i]][of[j]] for j in range(3)] for i in range(3)]


def law_mirrored(problem, rng):
    """The angle of the material of the other sign."""
    for body in stiff(problem):
        c = body["stiffness"]
        if not (c[0][2] or c[1][2]):
            no_place()
        body["stiffness"] = [[-x if (i == 2) != (j == 2) else x for j, x in enumerate(row)] for i, row in enumerate(c)]


def law_stiffer(problem, rng):
    for body in stiff(problem):
        body["stiffness"] = [[1.2 * x for x in row] for row in body["stiffness"]]


def forces_that_vary(problem):
    return [body for body in problem["bodies"] if isinstance(body["body_force"], dict)] or no_place()


def slope_missing(problem, rng):
    """A body force that varies is taken for its value at the origin."""
    for body in forces_that_vary(problem):
        body["body_force"] = body["body_force"]["value"]


def slope_transposed(problem, rng):
    for body in forces_that_vary(problem):
        (a, b), (c, d) = body["body_force"]["gradient"]
        if b == c:
            no_place()
        body["body_force"]["gradient"] = [[a, c], [b, d]]


def varying_force_larger(problem, rng):
    for body in forces_that_vary(problem):
        force = body["body_force"]
        body["body_force"] = {
            "value": [1.1 * x for x in force["value"]],
            "gradient": [[1.1 * x for x in row] for row in force["gradient"]],
        }


BUGS = [
    poisson_sign, modulus, poisson, thickness, kinematics, weight_missing, weight_sideways, load_larger,
    load_missing_on_an_edge, load_constant_on_an_edge, clamp_missing_on_an_edge, roller_missing_on_an_edge,
    roller_turned, clamp_for_roller, displacement_larger, pair_missing, gap_larger, gap_swapped, contact_glued,
    triangle_of_another_body, vertex_moved, gap_ignored, rollers_missing, thickness_ignored, materials_swapped,
    contact_at_one_node, springs_softer, springs_missing_along, springs_both_ways, layer_stiffer, layer_swapped,
    layer_slides, elastic_contact_stiffer, elastic_contact_pulls, elastic_contact_gap_ignored, temperature_missing,
    temperature_of_other_sign, temperature_larger, axes_swapped, law_mirrored, law_stiffer, slope_missing,
    slope_transposed, varying_force_larger,
]  # fmt: skip
