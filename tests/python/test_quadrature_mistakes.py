"""Mistakes at the quadrature points of a bilinear quadrilateral, planted here and named by the workbench."""

import numpy as np
import pytest

YOUNG, POISSON = 1.7, 0.3
ELASTIC = YOUNG / ((1 + POISSON) * (1 - 2 * POISSON)) * np.array(
    [[1 - POISSON, POISSON, 0], [POISSON, 1 - POISSON, 0], [0, 0, 0.5 - POISSON]]
)
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
GAUSS = 1 / np.sqrt(3)
POINTS = [(-GAUSS, -GAUSS), (GAUSS, -GAUSS), (GAUSS, GAUSS), (-GAUSS, GAUSS)]


def distorted(seed):
    """Corners (4 × 2) of a convex quadrilateral that is no parallelogram."""
    return SQUARE + np.random.default_rng(seed).uniform(-0.2, 0.2, (4, 2))


def stiffness(corners, weights=(1, 1, 1, 1), measure=lambda det: det):
    """K (8 × 8) by the two-by-two rule; the right one without further arguments."""
    k = np.zeros((8, 8))
    for weight, (xi, eta) in zip(weights, POINTS):
        slopes = 0.25 * np.array(
            [[eta - 1, xi - 1], [1 - eta, -1 - xi], [1 + eta, 1 + xi], [-1 - eta, 1 - xi]]
        )
        jacobian = slopes.T @ corners
        x, y = (slopes @ np.linalg.inv(jacobian).T).T
        b = np.zeros((3, 8))
        b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = x, y, y, x
        k += weight * measure(np.linalg.det(jacobian)) * b.T @ ELASTIC @ b
    return k


def examined(hypercircle, k, corners):
    return hypercircle.workbench(k, corners, young=YOUNG, poisson=POISSON, kinematics="plane-strain")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("cause", "arguments"),
    [
        ("lost-point", {"weights": (1, 0, 1, 1)}),
        ("det-sign", {"weights": (1, 1, -1, 1)}),
        ("weights", {"weights": (1, 1.2, 0.9, 0.8)}),
        ("det-omitted", {"measure": lambda det: 1.0}),
        ("det-squared", {"measure": lambda det: det * det}),
    ],
)
def test_planted_mistakes_are_named(hypercircle, seed, cause, arguments):
    corners = distorted(seed)
    diagnosis = examined(hypercircle, stiffness(corners, **arguments), corners)["diagnosis"]
    assert diagnosis["cause"].startswith(cause), diagnosis["sentence"]


@pytest.mark.parametrize("seed", range(6))
def test_noise_is_no_mistake_that_has_a_name(hypercircle, seed):
    corners = distorted(seed)
    right = stiffness(corners)
    assert examined(hypercircle, right, corners)["diagnosis"] is None
    noise = np.random.default_rng(100 + seed).standard_normal((8, 8))
    noisy = right + 0.02 * np.abs(right).max() * (noise + noise.T)
    assert "None of" in examined(hypercircle, noisy, corners)["diagnosis"]["sentence"]
