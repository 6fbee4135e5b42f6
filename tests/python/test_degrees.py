"""Dual solutions of higher degree, held against their own stresses by numpy, and against each other."""

import numpy as np
import pytest

from block import compliance, outward, traction_of
from scenes import RICH, two_blocks

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)
POINTS, WEIGHTS = 0.5 * (POINTS + 1), 0.5 * WEIGHTS


def nodes(p):
    """Barycentric coordinates of the lattice, in the order of the stresses."""
    return np.array([[i, j, p - i - j] for i in range(p, -1, -1) for j in range(p - i, -1, -1)]) / p


def monomials(l, p):
    l = np.atleast_2d(l)
    return np.array([l[:, 0] ** i * l[:, 1] ** j for i in range(p + 1) for j in range(p + 1 - i)]).T


def at(values, l, p):
    """Stresses at barycentric coordinates of a subtriangle, from those at its nodes."""
    return monomials(l, p) @ np.linalg.solve(monomials(nodes(p), p), values)


def blocks(found):
    """For every triangle its degree and the stresses at the nodes of its three parts."""
    for p, first, end in zip(found.degrees, found.stress_start, found.stress_start[1:]):
        yield p, found.stress[first:end].reshape(3, (p + 1) * (p + 2) // 2, 3)


def energy(found, mesh):
    """1/2 integral of a s:s, by a Gauss rule on the square, collapsed."""
    l = np.array([[1 - s, s * (1 - t), s * t] for s in POINTS for t in POINTS])
    w = np.array([2 * s * v * u for s, v in zip(POINTS, WEIGHTS) for u in WEIGHTS])
    total = 0.0
    for corners, number, (p, stress) in zip(mesh["triangles"], mesh["body"], blocks(found)):
        body = mesh["bodies"][number]
        a = compliance(body["young"], body["poisson"], mesh["kinematics"])
        (x0, y0), (x1, y1), (x2, y2) = np.array(mesh["points"])[corners]
        size = 0.5 * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)) / 3
        for values in stress:
            s = at(values, l, p)
            total += 0.5 * size * w @ np.einsum("ki,ij,kj->k", s, a, s)
    return mesh["thickness"] * total


def largest_jump(found, mesh):
    """Largest difference of tractions across interior edges, at points that are no nodes."""
    points, sides, worst = np.array(mesh["points"]), {}, 0.0
    s = np.array([0.07, 0.31, 0.5, 0.83])
    for t, (corners, (p, stress)) in enumerate(zip(mesh["triangles"], blocks(found))):
        for i, e in enumerate(mesh["triangle_edges"][t]):
            a, b = corners[(i + 1) % 3], corners[(i + 2) % 3]
            values = at(stress[i], np.array([1 - s, s, 0 * s]).T, p) @ traction_of(outward(points[a], points[b])).T
            if tuple(mesh["edges"][e]) != (a, b):
                values = at(stress[i], np.array([s, 1 - s, 0 * s]).T, p) @ traction_of(outward(points[a], points[b])).T
            if e in sides and mesh["conditions"][e]["kind"] == "interior":
                worst = max(worst, np.abs(values + sides[e]).max())
            sides[e] = values
    return worst


@pytest.mark.parametrize("p", [1, 2, 3, 5])
def test_two_blocks_of_a_degree(hypercircle, tmp_path, p):
    scene, problem = two_blocks(tmp_path, 3)
    found, mesh = hypercircle.Scene(scene).solve(degree=p), hypercircle.Scene(scene).problem()
    assert set(found.degrees) == {p}
    assert energy(found, mesh) == pytest.approx(found.complementary, rel=1e-10)
    assert largest_jump(found, mesh) < 1e-10
    traction = np.array(found.contact_traction[0])
    assert traction.shape == (3, p + 1) and traction.max() <= 1e-12
    assert traction.mean() == pytest.approx(-0.5, rel=1e-10), "the mean of the coefficients is that of the traction"
    assert {len(m) for m in found.moments} == {p + 1}
    assert found.lower < found.upper


def test_energies_rise_with_the_degree(hypercircle, tmp_path):
    """Stresses of one degree are among those of the next, so the best of them is no worse."""
    scene, _ = two_blocks(tmp_path, 2)
    all_degrees = [hypercircle.Scene(scene).solve(degree=p) for p in range(1, 6)]
    energies = [found.energy for found in all_degrees]
    assert all(b > a for a, b in zip(energies, energies[1:]))
    assert max(energies) < min(found.upper for found in all_degrees)


def test_degrees_triangle_by_triangle(hypercircle, tmp_path):
    scene = tmp_path / "rich.toml"
    scene.write_text(RICH)
    mesh = hypercircle.Scene(scene).problem()
    count = len(mesh["triangles"])
    low, high = (hypercircle.Scene(scene).solve(degree=p) for p in (1, 3))
    degrees = [1 + t % 3 for t in range(count)]
    mixed = hypercircle.Scene(scene).solve(degrees=degrees)
    assert mixed.degrees == degrees
    assert list(np.diff(mixed.stress_start)) == [3 * (p + 1) * (p + 2) // 2 for p in degrees]
    assert low.energy < mixed.energy < high.energy
    assert energy(mixed, mesh) == pytest.approx(mixed.complementary, rel=1e-10)
    assert largest_jump(mixed, mesh) < 1e-9 * np.abs(mixed.stress).max()
    same = hypercircle.Scene(scene).solve(degrees=[3] * count)
    assert same.energy == pytest.approx(high.energy, rel=1e-12)


@pytest.mark.parametrize(
    "wrong, words",
    [
        ({"degree": 0}, "degree = 0: 0 is not in 1..=8"),
        ({"degree": 9}, "degree = 9: 9 is not in 1..=8"),
        ({"degrees": [1, 2]}, "2 degrees for"),
        ({"degrees": [0]}, "0 is not in 1..=8"),
        ({"degrees": [1], "tolerance": 0.1}, "belong to one mesh"),
        ({"degree": 1, "degrees": [1]}, "not both"),
        ({"degree": 2, "method": "uzawa"}, ""),
    ],
)
def test_degrees_that_cannot_be(hypercircle, tmp_path, wrong, words):
    scene, _ = two_blocks(tmp_path, 2)
    with pytest.raises(ValueError, match=words):
        hypercircle.Scene(scene).solve(**wrong)
