"""Displacements on the quadrilaterals that pairs of triangles make."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypercircle_process import BadExchange
from hypercircle_reference.exchange import parse_problem
from hypercircle_reference.lattice import Lattice, square
from scenes import Builder, rotated, two_blocks


def wavy(s, t):
    """Moves the points inside the unit square, none of its sides."""
    bump = 0.12 * math.sin(math.pi * s) * math.sin(math.pi * t)
    return s + bump * math.cos(7.0 * t), t - bump * math.sin(5.0 * s + 1.0)


@pytest.mark.parametrize("degree", (1, 2, 3))
@pytest.mark.parametrize("angle", (0.0, 0.7))
def test_constant_stress_passes_distorted_quadrilaterals_and_a_contact(solve, degree, angle):
    young, poisson, pressure = 3.0, 0.35, 0.4
    b = Builder("plane-stress")
    point, vector = rotated(angle, (2.0, -1.0))
    materials = [b.body(name, young, poisson) for name in ("left", "right")]
    one = b.block(materials[0], 4, 3, lambda s, t: point(*wavy(s, t)))
    two = b.block(materials[1], 3, 3, lambda s, t: point(1.0 + wavy(s, t)[0], wavy(s, t)[1]))
    b.roller(one["bottom"], vector(0.0, -1.0))
    b.roller(two["bottom"], vector(0.0, -1.0))
    b.roller(two["right"], vector(1.0, 0.0))
    b.load(one["left"], lambda x, y: vector(pressure, 0.0))
    b.contact(one["right"], two["left"], vector(1.0, 0.0))
    result = solve(b.data, degree, "Q")
    assert (result["cells"], result["degree"]) == ("quadrilaterals", degree)
    strain = -pressure / young
    local = np.array([rotated(-angle)[1](x - 2.0, y + 1.0) for x, y in b.data["points"]])
    exact = np.array([vector(strain * (x - 2.0), -poisson * strain * y) for x, y in local])
    assert np.array(result["vertex_displacement"]) == pytest.approx(exact, abs=1e-12)
    assert result["energy"] == pytest.approx(-0.5 * pressure**2 / young * 2.0, rel=1e-12)
    assert result["contacts"][0]["resultant"] == pytest.approx(vector(-pressure, 0.0), abs=1e-12)


@pytest.mark.parametrize("degree", (1, 2))
@pytest.mark.parametrize("kinematics", ("plane-strain", "plane-stress"))
def test_scikit_fem_finds_the_same_on_distorted_quadrilaterals(solve, degree, kinematics):
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import ddot, sym_grad, trace

    young, poisson, pull = 2.0, 0.3, 0.7
    b = Builder(kinematics)
    sides = b.block(b.body("block", young, poisson, (0.2, -0.1)), 4, 3, wavy)
    b.clamp(sides["left"])
    b.load(sides["right"], lambda x, y: (pull, -0.5 * pull * y))
    result = solve(b.data, degree, "Q")

    mesh = skfem.MeshQuad(
        np.array(b.data["points"]).T, np.array([cell["corners"] for cell in b.data["quadrilaterals"]]).T
    )
    element = skfem.ElementVector({1: skfem.ElementQuad1, 2: skfem.ElementQuad2}[degree]())
    basis = skfem.Basis(mesh, element, intorder=11)
    mu = young / (2 * (1 + poisson))
    star = young * poisson / ((1 + poisson) * (1 - 2 * poisson) if kinematics == "plane-strain" else 1 - poisson**2)
    stiffness = skfem.BilinearForm(
        lambda u, v, w: star * trace(sym_grad(u)) * trace(sym_grad(v)) + 2 * mu * ddot(sym_grad(u), sym_grad(v))
    ).assemble(basis)
    right = skfem.FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[0] > 1 - 1e-9), intorder=6)
    load = skfem.LinearForm(lambda v, w: 0.2 * v[0] - 0.1 * v[1]).assemble(basis)
    load += skfem.LinearForm(lambda v, w: pull * v[0] - 0.5 * pull * w.x[1] * v[1]).assemble(right)
    held = basis.get_dofs(mesh.facets_satisfying(lambda x: x[0] < 1e-9)).flatten()
    u = skfem.solve(*skfem.condense(stiffness, load, D=held))
    assert result["energy"] == pytest.approx(-0.5 * load @ u, rel=1e-11)
    nodal = u[basis.nodal_dofs].T
    assert np.array(result["vertex_displacement"]) == pytest.approx(nodal, abs=1e-11)


@pytest.mark.parametrize("degree", (1, 2))
def test_larger_spaces_have_smaller_energies(solve, degree):
    """On rectangles a field of degree k in each direction is one of degree 2k on both triangles."""
    data = two_blocks(3)
    of = {space: solve(data, *space)["energy"] for space in ((degree, "Q"), (degree + 1, "Q"), (2 * degree, "P"), (degree, "P"))}
    slack = 1e-10 * abs(of[degree, "Q"])
    assert of[2 * degree, "P"] <= of[degree, "Q"] + slack
    assert of[degree + 1, "Q"] <= of[degree, "Q"] + slack
    assert of[degree, "Q"] <= of[degree, "P"] + slack


@pytest.mark.parametrize("degree", (1, 2, 3, 4))
def test_every_quadrilateral_has_its_nodes_where_the_square_has_them(degree):
    b = Builder()
    point, _ = rotated(0.3)
    b.block(b.body(), 2, 3, lambda s, t: point(2.0 * s + 0.5 * t, t))
    problem = parse_problem(b.data)
    lattice = Lattice.of(problem, degree)
    nodes = lattice.of_quadrilaterals(problem)
    assert sorted(set(nodes.reshape(-1))) == list(range(lattice.ends[2]))
    places = np.full((lattice.ends[2], 2), np.nan)
    steps = np.array([(degree - r, r - l, l) for r in range(degree + 1) for l in range(r + 1)]) / degree
    places[lattice.of_triangles(problem)] = steps @ problem.points[problem.triangles]
    x, y = square(degree).T
    shape = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
    assert places[nodes] == pytest.approx(shape @ problem.points[problem.quadrilaterals], abs=1e-14)


def test_what_is_no_mesh_of_quadrilaterals_is_refused(solve):
    data = two_blocks(2)
    data["quadrilaterals"].pop()
    with pytest.raises(BadExchange, match="some triangles are in none"):
        solve(data, 1, "Q")
    data["quadrilaterals"][0]["triangles"].reverse()
    with pytest.raises(BadExchange, match=r"quadrilaterals\[0\].triangles\[0\] is not the half"):
        parse_problem(data)


def test_two_ranks_agree_with_one(tmp_path, mpirun, solve):
    data = two_blocks(4)
    (tmp_path / "problem.json").write_text(json.dumps(data))
    command = [*mpirun, sys.executable, "-m", "hypercircle_reference", "problem.json", "--out", str(tmp_path)]
    command += ["--quadrilaterals", "2", "--quadrilaterals", "1"]
    root = Path(__file__).resolve().parent.parent
    subprocess.run(command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(root)}, check=True)
    assert not list(tmp_path.glob("primal-P*"))
    for degree in (1, 2):
        found = json.loads((tmp_path / f"primal-Q{degree}.json").read_text())
        alone = solve(data, degree, "Q")
        assert found["ranks"] == 2
        assert found["energy"] == pytest.approx(alone["energy"], rel=1e-11)
        assert np.array(found["vertex_displacement"]) == pytest.approx(np.array(alone["vertex_displacement"]), abs=1e-9)
