"""The block element of the library against the null space of the continuity conditions."""

import numpy as np
import pytest

from block import Block, compliance

SHAPES = {
    "right": [[0, 0], [1, 0], [0, 1]],
    "general": [[0.3, -0.2], [2.1, 0.4], [0.9, 1.7]],
    "flat": [[0, 0], [1, 0], [0.45, 0.02]],
    "small and far": [[100, 50], [100.004, 50.001], [100.001, 50.003]],
    "large": [[-3e5, 0], [4e5, 1e5], [1e4, 6e5]],
}
MATERIALS = [(1.0, 0.3, "plane-strain"), (210e3, 0.29, "plane-stress"), (2.5, 0.49, "plane-strain"), (1.0, -0.5, "plane-stress")]


def both(hypercircle, shape, material, force=(0.0, 0.0)):
    young, poisson, kinematics = material
    model = Block(SHAPES[shape], compliance(young, poisson, kinematics))
    found = hypercircle.element(SHAPES[shape], young, poisson, kinematics, list(force))
    return model, {key: np.array(value) for key, value in found.items()}


@pytest.mark.parametrize("shape", SHAPES)
def test_the_continuity_matrix_has_full_rank(shape):
    _, values = Block(SHAPES[shape], np.eye(3)).balanced()
    assert values[-1] > 1e-6 * values[0]


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("shape", SHAPES)
def test_stiffness(hypercircle, shape, material):
    model, found = both(hypercircle, shape, material)
    basis, _ = model.balanced()
    traction = model.side_traction() @ basis
    expected = traction @ np.linalg.solve(basis.T @ model.energy() @ basis, traction.T)
    stiffness = found["traction"] @ found["traction"].T
    tolerance = 1e-8 if shape in ("flat", "small and far") else 1e-11
    assert np.abs(stiffness - expected).max() < tolerance * np.abs(expected).max()


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("shape", ["right", "general", "large"])
def test_modes_span_the_null_space_and_are_orthonormal_in_energy(hypercircle, shape, material):
    model, found = both(hypercircle, shape, material)
    stress = found["stress"].reshape(27, 9)
    nodes = model.nodes()
    parameters = np.linalg.lstsq(nodes, stress, rcond=None)[0]
    size = np.abs(stress).max()
    assert np.abs(nodes @ parameters - stress).max() < 1e-12 * size, "not self-equilibrated linear stresses"
    jump = model.continuity() @ parameters
    assert np.abs(jump).max() < 1e-11 * size, "traction jumps inside the block"
    assert np.abs(parameters.T @ model.energy() @ parameters - np.eye(9)).max() < 1e-10
    traction = model.side_traction() @ parameters
    assert np.abs(traction - found["traction"]).max() < 1e-11 * np.abs(found["traction"]).max()


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("shape", ["right", "general", "large"])
def test_the_particular_field_balances_the_force_with_the_least_energy(hypercircle, shape, material):
    force = np.array([0.7, -1.3])
    model, found = both(hypercircle, shape, material, force)
    basis, _ = model.balanced()
    overlap = model.integrate(lambda i, p: model.stress(i, p).T @ model.material @ model.particular(force, p))
    s = -basis @ np.linalg.solve(basis.T @ model.energy() @ basis, basis.T @ overlap)
    nodes = np.array([model.particular(force, p) for i in range(3) for p in model.sub(i)])
    expected = (model.nodes() @ s).reshape(9, 3) + nodes
    assert np.abs(found["particular_stress"] - expected).max() < 1e-10 * np.abs(nodes).max()
    whole = lambda i, p: model.stress(i, p) @ s + model.particular(force, p)
    energy = model.integrate(lambda i, p: whole(i, p) @ model.material @ whole(i, p))
    assert found["particular_energy"] == pytest.approx(energy, rel=1e-9)
    # The tractions of any such field carry the weight: sum over the sides of length times mean.
    corners = model.corners
    lengths = [np.hypot(*(corners[(i + 2) % 3] - corners[(i + 1) % 3])) for i in range(3)]
    ends = found["particular_traction"].reshape(3, 2, 2)
    total = sum(length * ends[i].mean(axis=0) for i, length in enumerate(lengths))
    assert np.allclose(total, -force * model.size**2, rtol=1e-10)


def test_flexibility_is_the_integral_of_the_energy(hypercircle):
    corners = np.array([[0.1, 0.2], [1.3, 0.1], [0.4, 0.9]])
    for constants in ([1.0, -0.3, 2.6], [0.91, -0.39, 2.6], [1, 1, 0], [0.25, -0.25, 1]):
        alpha, beta, gamma = constants
        a = np.array([[alpha, beta, 0], [beta, alpha, 0], [0, 0, gamma]])
        centre = corners.mean(axis=0)
        expected = np.zeros((7, 7))
        for w in ([0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]):
            x, y = np.array(w) @ corners - centre
            # (3.1) of the paper.
            m = np.array([[1, 0, 0, 0, x, 0, y], [0, 1, 0, x, 0, y, 0], [0, 0, 1, 0, -y, -x, 0]])
            expected += 0.5 * np.linalg.det(np.diff(corners, axis=0)) / 3 * m.T @ a @ m
        assert np.allclose(hypercircle.flexibility(corners.tolist(), constants), expected, atol=1e-14)


def test_side_map_is_the_traction(hypercircle):
    a, b = np.array([0.7, -0.2]), np.array([0.1, 1.1])
    d = b - a
    n = np.array([d[1], -d[0]]) / np.hypot(*d)
    c = np.array(hypercircle.side_map(a.tolist(), b.tolist()))
    for p in (-1, -0.3, 1):
        x, y = 0.5 * (a + b) + 0.5 * p * d
        m = np.array([[1, 0, 0, 0, x, 0, y], [0, 1, 0, x, 0, y, 0], [0, 0, 1, 0, -y, -x, 0]])
        expected = np.array([[n[0], 0, n[1]], [0, n[1], n[0]]]) @ m
        assert np.allclose([c[0] + p * c[1], c[2] + p * c[3]], expected, atol=1e-14)


def test_what_cannot_be_computed_is_an_input_error(hypercircle):
    good, bad = SHAPES["right"], [[0, 0], [0, 1], [1, 0]]
    nan = float("nan")
    calls = [
        lambda: hypercircle.element(bad, 1.0, 0.3, "plane-strain"),
        lambda: hypercircle.element(good, -1.0, 0.3, "plane-strain"),
        lambda: hypercircle.element(good, 1.0, 0.5, "plane-strain"),
        lambda: hypercircle.element(good, 1.0, 0.3, "solid"),
        lambda: hypercircle.element(good, nan, 0.3, "plane-strain"),
        lambda: hypercircle.element([[0, 0], [1, nan], [0, 1]], 1.0, 0.3, "plane-strain"),
        lambda: hypercircle.flexibility(bad, [1, 0, 1]),
        lambda: hypercircle.side_map([1, 1], [1, 1]),
    ]
    for call in calls:
        with pytest.raises(hypercircle.InputError, match="."):
            call()
