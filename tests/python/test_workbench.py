"""The element workbench, held against the elements of scikit-fem."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

ELEMENTS = {
    "P1": (skfem.MeshTri, skfem.ElementTriP1),
    "P2": (skfem.MeshTri, skfem.ElementTriP2),
    "Q4": (skfem.MeshQuad, skfem.ElementQuad1),
}
ROOT = Path(__file__).resolve().parents[2]
CORNERS = np.array([[0.1, -0.1], [1.2, 0.1], [0.9, 1.1], [-0.1, 0.8]])


def basis_of(name, corners):
    """A mesh of one element, and the places of its unknowns."""
    mesh, element = ELEMENTS[name]
    count = 4 if name == "Q4" else 3
    mesh = mesh(np.ascontiguousarray(corners[:count].T), np.arange(count).reshape(-1, 1))
    return skfem.Basis(mesh, skfem.ElementVector(element()), intorder=4)


def assembled(name, corners, young, poisson):
    """K of scikit-fem in plane strain with its nodes, two unknowns a node."""
    basis = basis_of(name, corners)
    k = linear_elasticity(*lame_parameters(young, poisson)).assemble(basis).toarray()
    places = basis.doflocs.T
    # Unknowns of a node lie in one place: bring them together, x first as scikit-fem has them.
    nodes, order = [], []
    for i, place in enumerate(places):
        near = [n for n, x in enumerate(nodes) if np.allclose(x, place)]
        if near:
            order[near[0]].append(i)
        else:
            nodes.append(place)
            order.append([i])
    order = np.concatenate(order)
    return k[np.ix_(order, order)], np.array(nodes)


def finding(report, name):
    return next(f for f in report["findings"] if f["name"] == name)


def linear(nodes, young, poisson):
    """A linear triangle of ten lines."""
    (x0, y0), (x1, y1), (x2, y2) = nodes
    area = 0.5 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    b = np.zeros((3, 6))
    b[0, ::2] = b[2, 1::2] = np.array([y1 - y2, y2 - y0, y0 - y1]) / (2 * area)
    b[1, 1::2] = b[2, ::2] = np.array([x2 - x1, x0 - x2, x1 - x0]) / (2 * area)
    d = young / (1 + poisson) / (1 - 2 * poisson) * np.array(
        [[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, 0.5 - poisson]]
    )
    return area * b.T @ d @ b


@pytest.mark.parametrize("name", ELEMENTS)
def test_matrices_of_scikit_fem_pass(hypercircle, name):
    k, nodes = assembled(name, CORNERS, 3.0, 0.25)
    report = hypercircle.workbench(k, nodes, young=3.0, poisson=0.25, claim=["reference"], name=name)
    assert report["passed"], report["verdict"]
    assert report["diagnosis"] is None and finding(report, "reference")["value"] < 1e-12
    assert finding(report, "convergence")["passed"] is None
    stress = hypercircle.workbench(k, nodes, young=3.0, poisson=0.25, kinematics="plane-stress")
    assert not stress["passed"] and stress["diagnosis"]["cause"] == "plane-state"


def test_a_formula_is_examined_on_other_shapes_and_meshes(hypercircle, tmp_path):
    nodes = [[0, 0], [1, 0], [0, 1]]
    report = hypercircle.workbench(linear, nodes, young=2.0, poisson=0.3, waive=["incompressible"], out=tmp_path / "out")
    assert report["passed"], report["verdict"]
    assert all(f["passed"] is not None for f in report["findings"])
    assert not finding(report, "incompressible")["passed"]
    assert json.loads((tmp_path / "out/report.json").read_text()) == report
    assert (tmp_path / "out/report.html").exists() and (tmp_path / "out/junit.xml").exists()


def test_an_object_with_a_method_is_a_formula_too(hypercircle):
    class Element:
        def stiffness(self, nodes, young, poisson):
            return linear(nodes, young, poisson) * [[1]] * 2

    report = hypercircle.workbench(Element(), np.array([[0, 0], [1, 0], [0, 1]]), young=1.0, poisson=0.3)
    assert not report["passed"] and report["diagnosis"]["cause"] == "factor"
    assert "K is 2 times" in report["diagnosis"]["sentence"]
    assert finding(report, "bound")["passed"], "too stiff an element has too much energy, not too little"
    assert not finding(report, "convergence")["passed"]


def test_the_example_of_the_page_does_what_the_page_says(hypercircle, tmp_path, monkeypatch, capsys):
    page = (ROOT / "docs/workbench.md").read_text()
    first, second, third = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(first, names)
    report = hypercircle.workbench(names["K"], names["nodes"], young=1.0, poisson=0.3)
    assert [f["name"] for f in report["findings"] if f["claim"] and not f["passed"]] == ["rank"]
    assert report["diagnosis"]["sentence"] in page and finding(report, "rank")["sentence"] in page
    assert "K lacks a property it claims" + report["verdict"].split("claims")[1] in page
    exec(second, names)
    assert capsys.readouterr().out.strip() in page and (tmp_path / "out/mine/report.html").exists()
    assert finding(names["report"], "bound")["passed"] is False
    exec(third, names)
    assert capsys.readouterr().out.strip() in page
    lower = hypercircle.Scene(ROOT / "cases/two_blocks.toml").solve(element=names["Single"]()).lower
    assert lower < -1.7964, "a bound, and a poor one"


def test_what_is_no_element_is_an_input_error(hypercircle):
    nodes = [[0, 0], [1, 0], [0, 1]]
    with pytest.raises(hypercircle.InputError, match="6 × 6"):
        hypercircle.workbench(np.eye(4), nodes)
    with pytest.raises(hypercircle.InputError, match="no such thing"):
        def fails(*_):
            raise RuntimeError("no such thing")
        hypercircle.workbench(fails, nodes)
    with pytest.raises(hypercircle.InputError, match="array of rows"):
        hypercircle.workbench("K", nodes)
    with pytest.raises(hypercircle.InputError, match="beauty"):
        hypercircle.workbench(linear, nodes, waive=["beauty"])
    with pytest.raises(hypercircle.InputError, match="young and poisson"):
        hypercircle.workbench(np.eye(6), nodes, young=1.0)


@pytest.mark.parametrize("name", ELEMENTS)
@pytest.mark.parametrize("order", [2, 4])
def test_rings_of_scikit_fem_pass(hypercircle, name, order):
    """K of the full turn, by the rules of scikit-fem."""
    from skfem.helpers import ddot, sym_grad

    lame, shear = lame_parameters(3.0, 0.25)
    corners = CORNERS + [0.4, 0.0]
    basis = basis_of(name, corners).with_element(skfem.ElementVector(ELEMENTS[name][1]()))
    basis = skfem.Basis(basis.mesh, basis.elem, intorder=order)

    def form(turn, hoop):
        @skfem.BilinearForm
        def assembled(u, v, w):
            r = w.x[0]
            trace = lambda u: u.grad[0, 0] + u.grad[1, 1] + hoop * u[0] / r
            own = 2 * shear * (ddot(sym_grad(u), sym_grad(v)) + hoop * u[0] * v[0] / r**2)
            return (own + lame * trace(u) * trace(v)) * turn * r

        return assembled

    places = basis.doflocs.T
    numbers = {}
    for i, place in enumerate(places):
        numbers.setdefault(tuple(np.round(place, 9)), []).append(i)
    order_of = np.concatenate(list(numbers.values()))
    nodes = np.array(list(numbers))
    for turn, hoop, cause in [(2 * np.pi, 1, None), (1.0, 1, "per-radian"), (2 * np.pi, 0, "hoop-left-out")]:
        k = form(turn, hoop).assemble(basis).toarray()[np.ix_(order_of, order_of)]
        report = hypercircle.workbench(
            k, nodes, young=3.0, poisson=0.25, kinematics="axisymmetric", claim=["reference"]
        )
        found = report["diagnosis"] and report["diagnosis"]["cause"]
        assert found == cause, report["diagnosis"]
        assert report["passed"] == (cause is None), report["verdict"]
