"""The element workbench, held against the elements of Basix."""

import functools

import basix
import numpy as np
import pytest

LAGRANGE = {"P1": ("triangle", 1), "P2": ("triangle", 2), "P3": ("triangle", 3), "Q4": ("quadrilateral", 1)}
CORNERS = {
    "usual": [[0.1, -0.1], [1.2, 0.1], [-0.1, 0.8], [0.9, 1.1]],
    "flat": [[3.0, 1.0], [5.0, 1.0], [3.1, 1.1], [5.2, 1.3]],
    "clockwise": [[0.0, 0.0], [-0.3, 2.0], [0.9, 0.2], [1.1, 1.9]],
}
"""Corners in the order of Basix: the last one of a quadrilateral is opposite to the first."""
FROM_ONE_MATRIX = ["symmetry", "rigid-motions", "self-equilibrium", "rank", "definiteness", "patch-energy", "patch-forces"]
YOUNG, POISSON = 3.0, 0.25


@functools.cache
def lagrange(shape, degree):
    """A scalar element with nodes at equal distances."""
    shape = getattr(basix.CellType, shape)
    return basix.create_element(basix.ElementFamily.P, shape, degree, basix.LagrangeVariant.equispaced)


def nodes_of(name, corners):
    """Where Basix has the nodes of an element with straight sides."""
    shape, degree = LAGRANGE[name]
    weights = lagrange(shape, 1).tabulate(0, lagrange(shape, degree).points)[0, :, :, 0]
    return weights @ np.array(corners)[: weights.shape[1]]


def stiffness(name, nodes, young, poisson, quadrature=None):
    """K in plane strain, isoparametric, with the nodes, slopes and quadrature of Basix; x and y of a node follow each other."""
    shape, degree = LAGRANGE[name]
    element = lagrange(shape, degree)
    points, weights = basix.make_quadrature(element.cell_type, 2 * degree if quadrature is None else quadrature)
    lame, shear = young * poisson / (1 + poisson) / (1 - 2 * poisson), young / (2 + 2 * poisson)
    hooke = np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])
    k = np.zeros((2 * len(nodes), 2 * len(nodes)))
    for weight, slopes in zip(weights, element.tabulate(1, points)[1:, :, :, 0].swapaxes(0, 1)):
        jacobian = slopes @ nodes
        slopes = np.linalg.solve(jacobian, slopes)
        strain = np.zeros((3, 2 * len(nodes)))
        strain[0, ::2] = strain[2, 1::2] = slopes[0]
        strain[1, 1::2] = strain[2, ::2] = slopes[1]
        k += weight * abs(np.linalg.det(jacobian)) * strain.T @ hooke @ strain
    return k


def examined(hypercircle, k, nodes, **options):
    return hypercircle.workbench(k, nodes, young=YOUNG, poisson=POISSON, **options)


def missing(report):
    """Properties that are claimed and do not hold."""
    return [f["name"] for f in report["findings"] if f["claim"] and f["passed"] is False]


@pytest.mark.parametrize("corners", CORNERS.values(), ids=CORNERS)
@pytest.mark.parametrize("name", LAGRANGE)
def test_matrices_of_basix_pass(hypercircle, name, corners):
    nodes = nodes_of(name, corners)
    report = examined(hypercircle, stiffness(name, nodes, YOUNG, POISSON), nodes, name=name)
    assert report["passed"] and report["diagnosis"] is None, report["verdict"]
    found = {f["name"]: f for f in report["findings"]}
    assert all(found[property]["passed"] for property in FROM_ONE_MATRIX)
    # No textbook's element that the workbench knows has ten nodes.
    assert found["reference"]["passed"] is (None if name == "P3" else True)
    assert name == "P3" or found["reference"]["value"] < 1e-12


@pytest.mark.parametrize("name", ["P1", "P2"])
def test_a_patch_of_two_triangles_passes_as_one_element(hypercircle, name):
    a, b, c, d = CORNERS["usual"]
    halves = [nodes_of(name, [a, b, c]), nodes_of(name, [d, c, b])]
    nodes, place = np.unique(np.concatenate(halves).round(12), axis=0, return_inverse=True)
    assert len(nodes) == {"P1": 4, "P2": 9}[name]
    k = np.zeros((2 * len(nodes), 2 * len(nodes)))
    for half, numbers in zip(halves, place.reshape(2, -1)):
        unknowns = np.ravel(2 * numbers[:, None] + [0, 1])
        k[np.ix_(unknowns, unknowns)] += stiffness(name, half, YOUNG, POISSON)
    report = examined(hypercircle, k, nodes)
    assert report["passed"], report["verdict"]
    assert all(f["passed"] for f in report["findings"] if f["name"] in FROM_ONE_MATRIX)


def test_a_formula_of_basix_passes_on_other_shapes_and_meshes(hypercircle):
    def quadratic(nodes, young, poisson):
        return stiffness("P2", nodes, young, poisson)

    report = examined(hypercircle, quadratic, nodes_of("P2", CORNERS["usual"]), claim=["reference"])
    assert report["passed"], report["verdict"]
    assert all(f["passed"] for f in report["findings"])


@pytest.mark.parametrize("corners", CORNERS.values(), ids=CORNERS)
@pytest.mark.parametrize("name", ["P2", "Q4"])
def test_one_point_is_named(hypercircle, name, corners):
    nodes = nodes_of(name, corners)
    report = examined(hypercircle, stiffness(name, nodes, YOUNG, POISSON, quadrature=1), nodes)
    assert not report["passed"] and "rank" in missing(report)
    assert report["diagnosis"]["cause"] == "one-point-quadrature"


@pytest.mark.parametrize(
    ("name", "order"),
    # Gmsh and VTK have the middles of (0, 1), (1, 2), (2, 0) where Basix has those opposite to 0, 1, 2, and go round a quadrilateral.
    [("P2", [0, 1, 2, 5, 3, 4]), ("Q4", [0, 1, 3, 2])],
)
def test_nodes_in_the_order_of_other_programs_are_named(hypercircle, name, order):
    nodes = nodes_of(name, CORNERS["usual"])
    k = stiffness(name, nodes, YOUNG, POISSON)
    report = examined(hypercircle, k, nodes[order])
    assert not report["passed"] and "patch-forces" in missing(report)
    assert report["diagnosis"]["cause"] == "node-order", report["diagnosis"]
    unknowns = np.ravel(2 * np.array(order)[:, None] + [0, 1])
    assert examined(hypercircle, k[np.ix_(unknowns, unknowns)], nodes[order])["passed"]
