"""From a problem to the result files' contents: each kind of cells once, then each degree on them."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from hypercircle_process import log

from . import compat, coulomb
from .constraints import Constraints, build as build_constraints
from .exchange import Problem
from .lattice import Lattice
from .model import GAUSS_POINTS, Mesh, QuadrilateralMesh, build as build_model
from .solve import Solution, minimise, without_strongest_row
from .touching import minimise_touching


MESHES = {"P": Mesh, "Q": QuadrilateralMesh}
"""The cells of each family of displacements."""


def solve_all(comm, problem: Problem, spaces, nodal_contact=False, sabotage=None, seconds=(0.0, 0.0)) -> list[dict]:
    """One result for each of ``spaces``, pairs of family and degree, in the layout of ``primal-P*.json``; equal on all ranks.

    ``seconds`` is what imports and reading took before; reading counts as part of making the mesh.
    """
    start = perf_counter()
    meshes = {family: MESHES[family](comm, problem) for family in dict.fromkeys(family for family, _ in spaces)}
    extent = float(np.max(np.ptp(problem.points, axis=0)))
    seconds_import, seconds_mesh = seconds[0], seconds[1] + perf_counter() - start
    results = []
    for family, degree in spaces:
        mesh = meshes[family]
        log(comm, f"{family}{degree}")
        start = perf_counter()
        constraints = build_constraints(problem, degree, nodal_contact)
        seconds_constraints = perf_counter() - start
        model = build_model(mesh, degree, flip_sign=sabotage == "flip-sign")
        start = perf_counter()

        def minimum(under: Constraints) -> Solution:
            if len(problem.touching.edges) == 0:
                return minimise(comm, model, under, extent)
            return minimise_touching(comm, mesh, model, under, degree, extent)

        solution = minimum(constraints)
        if sabotage == "drop-row":
            constraints = without_strongest_row(constraints, solution)
            solution = minimum(constraints)
        phases = {
            "import": seconds_import,
            "mesh": seconds_mesh,
            "assemble": model.seconds_assemble + seconds_constraints,
            "compile": model.seconds_compile,
            "solve": perf_counter() - start,
        }
        phases["total"] = sum(phases.values())
        log(comm, f"{family}{degree}: energy {solution.energy!r}, {solution.iterations} steps")
        result = _result(comm, problem, degree, nodal_contact, constraints, solution, phases)
        if coulomb.follows(problem):
            result["coulomb"] = _own_coulomb(problem, degree, minimum, result["contacts"])
            log(comm, f"{family}{degree}: Coulomb friction of its own, {result['coulomb']['iterations']} solutions")
        if family == "Q":
            result.update(cells="quadrilaterals", gauss_points=GAUSS_POINTS)
        results.append(result)
    return results


def _result(comm, problem: Problem, degree, nodal_contact, constraints, solution: Solution, seconds) -> dict:
    displacement = solution.displacement.reshape(-1, 2)
    vertices, edges, inside = np.split(displacement, Lattice.of(problem, degree).ends[:2])
    return {
        "format": "hypercircle-primal",
        "version": 1,
        "solver": "FEniCSx",
        "solver_version": compat.SOLVER_VERSION,
        "petsc_version": compat.PETSC_VERSION,
        "degree": degree,
        "ranks": comm.size,
        "energy": solution.energy,
        "strain_energy": solution.strain_energy,
        **({"friction_work": solution.friction} if any(contact.rubs.any() for contact in problem.contacts) else {}),
        "energy_rounding": solution.energy_rounding,
        "iterations": solution.iterations,
        "converged_reason": solution.reason,
        "unknowns": solution.unknowns,
        "admissible": degree == 1 or not (nodal_contact and problem.contacts),
        "seconds": seconds,
        "vertex_displacement": vertices.tolist(),
        "edge_displacement": edges.tolist() if degree > 1 else None,
        "triangle_displacement": inside.tolist() if degree > 2 else None,
        "contacts": _contacts(problem, degree, constraints, solution),
    }


def _own_coulomb(problem: Problem, degree: int, minimum, contacts: list[dict]) -> dict:
    """Coulomb friction with limits from the reactions of the model itself, from those in ``contacts`` on."""
    unit = coulomb.with_unit_bounds(problem)
    limits = coulomb.Limits(unit, degree, build_constraints(unit, degree))

    def solve(under: Constraints):
        solution = minimum(under)
        return solution, _contacts(unit, degree, under, solution)

    return coulomb.iterate(limits, contacts, solve)


def _contacts(problem: Problem, degree: int, constraints: Constraints, solution: Solution) -> list[dict]:
    """Reactions R ≥ 0: −∂𝓛/∂w shared out to the row that binds, and the forces of friction; with the force that all of them put
    on the first side."""
    order = [list(dict.fromkeys(contact.first.reshape(-1).tolist())) for contact in problem.contacts]
    place = [{v: i for i, v in enumerate(vertices)} for vertices in order]
    at_vertex, rubbing = ([np.zeros(len(vertices)) for vertices in order] for _ in range(2))
    inside = [[degree if turns else degree - 1 for turns in contact.turns] for contact in problem.contacts]
    at_edge, rubbing_inside = ([[[0.0] * count for count in counts] for counts in inside] for _ in range(2))
    resultant = np.zeros((len(problem.contacts), 2))
    by_friction = _by_friction(constraints, solution)
    for row in constraints.rows:
        reaction = max(-(solution.gradient[row.column] - by_friction[row.column]) / row.factor, 0.0)
        if not _at_bound(constraints, solution, row):
            continue
        if row.vertex >= 0:
            at_vertex[row.contact][place[row.contact][row.vertex]] += reaction
        else:
            at_edge[row.contact][row.pair][row.inner] += reaction
        resultant[row.contact] -= reaction * row.normal
    alone = [(row, by_friction[row.column] * row.weight / constraints.weight[row.column]) for row in constraints.slips]
    for row, size in alone + list(zip(constraints.coupled.rows, -solution.coupled)):
        force = size * row.vector
        along = float(force @ row.tangent) / float(row.tangent @ row.tangent)
        if row.vertex >= 0:
            rubbing[row.contact][place[row.contact][row.vertex]] += along
        else:
            rubbing_inside[row.contact][row.pair][row.inner] += along
        resultant[row.contact] += force
    return [
        {
            "name": contact.name,
            "vertices": order[index],
            "vertex_reaction": at_vertex[index].tolist(),
            "edge_reaction": at_edge[index] if degree > 1 else None,
            "vertex_friction": rubbing[index].tolist() if contact.rubs.any() else None,
            "edge_friction": rubbing_inside[index] if degree > 1 and contact.rubs.any() else None,
            "resultant": resultant[index].tolist(),
        }
        for index, contact in enumerate(problem.contacts)
    ]


def _by_friction(constraints: Constraints, solution: Solution) -> np.ndarray:
    """The part of every ∂𝓛/∂w that friction balances: all of it where there is no bound in the way, and where there is one
    what the unknown slips against, or what a bound does not push."""
    w, g, weight = solution.jumps, solution.gradient, constraints.weight
    slips, side = weight > 0.0, np.sign(w - constraints.kink)
    bound = np.where(w == constraints.upper, -1.0, np.where(w == constraints.lower, 1.0, 0.0))
    held = np.where(side != 0.0, -weight * side, np.where(g * bound > 0.0, 0.0, g))
    return np.where(slips, np.where(bound == 0.0, g, held), 0.0)


def _at_bound(constraints: Constraints, solution: Solution, row) -> bool:
    bound = constraints.upper if row.factor > 0.0 else constraints.lower
    return bool(solution.jumps[row.column] == bound[row.column])
