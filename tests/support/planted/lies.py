"""Lies about the result: each takes what the model wrote for both degrees and changes it."""

import json
import os

from places import no_place, pick


def largest(result):
    return max((abs(x) for u in result["vertex_displacement"] for x in u), default=0.0)


def displacements(result):
    return result["vertex_displacement"] + (result["edge_displacement"] or [])


def each(edge_reaction, change):
    """Every coefficient of every pair changed; nothing where the degree has none."""
    return edge_reaction and [[change(x) for x in pair] for pair in edge_reaction]


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
            for key in ("vertex_reaction", "resultant"):
                contact[key] = [1.01 * x for x in contact[key]]
            contact["edge_reaction"] = each(contact["edge_reaction"], lambda x: 1.01 * x)


def moved_as_a_whole(results, rng):
    for result in results:
        size = 1e-2 * (largest(result) or 1.0)
        for u in displacements(result):
            u[0] += size


def displacements_shorter(results, rng):
    for result in results:
        result["vertex_displacement"].pop()


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


def in_a_contact(results, rng, key, change, where=any):
    """One contact's list `key` replaced by what `change` makes of it, for a list that is `where`."""
    for result in results:
        contact = pick(rng, [contact for contact in result["contacts"] if where(contact[key])])
        contact[key] = change(contact[key])


def reactions_shorter(results, rng):
    in_a_contact(results, rng, "vertex_reaction", lambda r: r[:-1], where=len)


def reactions_permuted(results, rng):
    in_a_contact(results, rng, "vertex_reaction", lambda r: r[1:] + r[:1], where=lambda r: len(set(r)) > 1)


def reactions_larger(results, rng):
    in_a_contact(results, rng, "vertex_reaction", lambda r: [1.05 * x for x in r])


def reaction_at_a_foreign_vertex(results, rng):
    """A pair of reactions that adds nothing to the resultant, at vertices that need not touch anything."""

    def with_a_pair(reactions):
        size = 0.05 * (max(map(abs, reactions)) or 1.0)
        return [reactions[0] + size, *reactions[1:-1], reactions[-1] - size]

    in_a_contact(results, rng, "vertex_reaction", with_a_pair, where=lambda r: len(r) > 2)


def pulls(results, rng):
    in_a_contact(results, rng, "vertex_reaction", lambda r: [-x for x in r])


def resultant_larger(results, rng):
    in_a_contact(results, rng, "resultant", lambda r: [1.05 * x for x in r])


def vertices_of_another_body(results, rng):
    for result in results:
        count = len(result["vertex_displacement"])
        in_a_contact([result], rng, "vertices", lambda v: [(v[0] + 7) % count, *v[1:]], where=len)


def contacts_in_another_order(results, rng):
    for result in results:
        if len(result["contacts"]) < 2:
            no_place()
        result["contacts"].reverse()


def called_inadmissible(results, rng):
    for result in results:
        result["admissible"] = not result["admissible"]


def of_another_scene(results):
    """Each result with the one of the same degree from another scene."""
    folder = os.environ.get("HYPERCIRCLE_PLANT_OTHER") or no_place()
    for result in results:
        with open(os.path.join(folder, f"primal-P{result['degree']}.json"), encoding="utf-8") as file:
            yield result, json.load(file)


def another_scene(results, rng):
    for result, other in of_another_scene(results):
        result.clear()
        result.update(other)


def another_scene_of_the_same_shape(results, rng):
    """Numbers of another scene in arrays of the right lengths."""
    for result, other in of_another_scene(results):
        for key in ("vertex_displacement", "edge_displacement"):
            if result[key]:
                result[key] = [other[key][i % len(other[key])] for i in range(len(result[key]))]
        for key in ("energy", "strain_energy"):
            result[key] = other[key]


def linear_for_quadratic(results, rng):
    """The linear solution handed in as the quadratic one."""
    if len(results) < 2:
        no_place()
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
        mine["edge_reaction"] = each(mine["edge_reaction"], lambda _: 0.0)


LIES = [
    one_displacement, one_midpoint, all_displacements, everything_larger, moved_as_a_whole, displacements_shorter,
    reactions_shorter, energy_larger, energy_lower, strain_energy_larger, not_a_number, energy_not_a_number,
    reactions_permuted, reactions_larger, reaction_at_a_foreign_vertex, vertices_of_another_body, resultant_larger,
    contacts_in_another_order, pulls, called_inadmissible, another_scene, another_scene_of_the_same_shape,
    linear_for_quadratic,
]  # fmt: skip
