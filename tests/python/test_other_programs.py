"""Solutions of CalculiX and GetFEM, with their own elements and contact, as they are and with mistakes made there."""

import re

import numpy as np
import other_programs
import pytest
import scenes

PENALTY = "contact/left_face|right_face/penalty"
LOAD = 1e-7
"""CalculiX turns the direction of contact with the displacement, which is then of second order to seven digits."""


@pytest.fixture(scope="module")
def blocks(hypercircle, tmp_path_factory):
    folder = tmp_path_factory.mktemp("calculix")
    scene = hypercircle.Scene(scenes.two_blocks(folder, 8, (4 * LOAD, -7 * LOAD))[0])
    problem, solution = scene.problem(), scene.solve()

    def judged(**made):
        field = other_programs.calculix(problem, folder, **made)
        verdict = solution.certify(problem["points"], problem["triangles"], field, solution=True, name="calculix")
        assert "round-off" not in verdict.verdict
        return field, verdict

    judged.problem = problem
    return judged


def strain_energy(problem, field):
    """½a(u, u) of linear elements in plane strain with E = 1 and ν = 0.3."""
    corners, values = problem["points"][problem["triangles"]], field[problem["triangles"]]
    sides, moved = (np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], 2) for x in (corners, values))
    gradient = moved @ np.linalg.inv(sides)
    strain = 0.5 * (gradient + gradient.swapaxes(1, 2))
    shear, lame = 0.5 / 1.3, 0.3 / (1.3 * 0.4)
    density = 0.5 * lame * np.trace(strain, axis1=1, axis2=2) ** 2 + shear * (strain**2).sum((1, 2))
    return 0.5 * np.abs(np.linalg.det(sides)) @ density


def test_a_stiff_penalty_is_a_solution(blocks):
    _, verdict = blocks(stiffness=1e6)
    assert verdict.passed and verdict.diagnosis is None


@pytest.mark.parametrize("stiffness", [20.0, 100.0])
def test_what_a_penalty_costs_is_what_a_stiffer_one_gains(blocks, stiffness):
    problem = blocks.problem
    (stiff, _), (soft, verdict) = blocks(stiffness=1e6), blocks(stiffness=stiffness)
    assert not verdict.passed
    (finding,) = verdict.diagnosis["findings"]
    # Every node stands for the eighth of a unit; those at the ends are open or stand for half of it.
    assert finding["name"] == PENALTY and abs(finding["value"] - stiffness / 8) < 0.01 * stiffness / 8
    # CalculiX was given it for each unit of area.
    assert f"({stiffness:#.4g} for each unit of area" in finding["sentence"]
    number = r"([0-9.]+(?:e[-+]?[0-9]+)?)"
    told = re.search(f"lowers the energy by {number} to {number} and changes the stresses by at most {number} %", finding["sentence"])
    least, most, percent = map(float, told.groups())
    potential = lambda u: strain_energy(problem, u) - (other_programs.nodal_forces(problem) * u).sum()
    assert 0.999 * least <= potential(stiff) - potential(soft) <= 1.001 * most
    change = np.sqrt(strain_energy(problem, soft - stiff) / strain_energy(problem, stiff))
    assert change <= 0.01 * percent <= 3 * change


def test_contact_that_turns_with_the_sides_is_named(hypercircle, tmp_path):
    scene = hypercircle.Scene(scenes.two_blocks(tmp_path, 8, (4e-4, -7e-4))[0])
    problem = scene.problem()
    field = other_programs.calculix(problem, tmp_path, stiffness=1e6)
    verdict = scene.certify(problem["points"], problem["triangles"], field, solution=True, name="calculix")
    assert not verdict.passed and "contact turns with the sides" in verdict.diagnosis["sentence"]
    assert "round-off" not in verdict.verdict


def test_another_modulus_is_named(blocks):
    _, verdict = blocks(stiffness=1e6, young=(1.05, 1.0))
    (finding,) = verdict.diagnosis["findings"]
    assert finding["name"] == "body/left/young" and abs(finding["value"] - 1.05) < 1e-3


def test_sides_that_are_tied_are_named(blocks):
    _, verdict = blocks(stiffness=None)
    assert not verdict.passed
    assert [f["name"] for f in verdict.diagnosis["findings"]] == ["contact/left_face|right_face/tied"]


@pytest.mark.parametrize("degree", [1, 2])
def test_getfem_solves_what_it_claims(hypercircle, tmp_path, degree):
    scene = hypercircle.Scene(scenes.two_blocks(tmp_path, 8)[0])
    problem, solution = scene.problem(), scene.solve()
    right = solution.certify(*other_programs.getfem(problem, degree), solution=True, name="getfem")
    assert right.passed and right.diagnosis is None, right.verdict
    wrong = solution.certify(*other_programs.getfem(problem, degree, young=(1.0, 1.1)), solution=True, name="getfem")
    (finding,) = wrong.diagnosis["findings"]
    assert finding["name"] == "body/right/young" and abs(finding["value"] - 1.1) < 1e-6
