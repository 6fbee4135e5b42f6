"""Twenty kinds of broken elements: planted by seed, named by the workbench. Right ones pass and get no name, noise gets none."""

import numpy as np
import pytest
from planted_elements import REFERENCE, RULES, Element, corners_of, elastic, gauss, incompatible, nodes_of

YOUNG, POISSON = 1.7, 0.3
POINTS = {"T3": 1, "T6": 3, "Q4": 4, "Q8": 9}
EVERY = ("T3", "T6", "Q4", "Q8")
QUADS = ("Q4", "Q8")
SEVERAL_POINTS = ("T6", "Q4", "Q8")


def weights(kind, random):
    return random.uniform(0.6, 1.4, POINTS[kind])


def one(kind, random, value):
    all_right = np.ones(POINTS[kind])
    all_right[random.integers(POINTS[kind])] = value
    return all_right


def derivative(kind, random, change):
    """One derivative of one shape function along one local direction; not one that is zero everywhere."""
    while True:
        node, along = random.integers(len(REFERENCE[kind])), random.integers(2)
        if kind[0] == "Q" or (node, along) not in [(1, 1), (2, 0)]:
            break

    def local(xi, eta, slopes):
        slopes[node, along] *= change
        return slopes

    return local


def gradient(kind, random, change):
    node, along = random.integers(len(REFERENCE[kind])), random.integers(2)

    def changed(gradients):
        gradients[node, along] *= change
        return gradients

    return changed


def axes_of_first_side(nodes):
    a, b = nodes[:2]
    c, s = (b - a) / np.linalg.norm(b - a)
    return np.kron(np.eye(len(nodes)), [[c, s], [-s, c]])


def in_local_axes(k, nodes):
    q = axes_of_first_side(nodes)
    return q @ k @ q.T


def blocked(k, _):
    n = len(k) // 2
    order = [*range(0, 2 * n, 2), *range(1, 2 * n, 2)]
    return k[np.ix_(order, order)]


def over_one_minus(young, poisson):
    return young / (1 - poisson) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])


def other_shear(young, poisson):
    d = elastic(young, poisson)
    d[2, 2] *= 2
    return d


def turned_first(nodes):
    """The coordinates of the first two corners exchanged."""
    return nodes[[1, 0, *range(2, len(nodes))]]


# By planted bug: the elements that can have it, the name to be found, and the arguments of `Element` that plant it.
BROKEN = {
    "weights": (SEVERAL_POINTS, "weights", lambda k, r: {"weights": weights(k, r)}),
    "lost point": (SEVERAL_POINTS, "lost-point", lambda k, r: {"weights": one(k, r, 0)}),
    "sign of one det J": (SEVERAL_POINTS, "det-sign", lambda k, r: {"weights": one(k, r, -1)}),
    "det J omitted": (QUADS, "det-omitted", lambda k, r: {"measure": lambda det, middle: 1.0}),
    "det J squared": (QUADS, "det-squared", lambda k, r: {"measure": lambda det, middle: det * det}),
    "det J of the middle": (QUADS, "det-of-centre", lambda k, r: {"measure": lambda det, middle: middle}),
    "reduced shear": (QUADS, "reduced-shear", lambda k, r: {"shear_rule": gauss(1)}),
    "one point": (SEVERAL_POINTS, "one-point", lambda k, r: {"rule": gauss(1) if k[0] == "Q" else RULES["T3"]}),
    "E/(1 − ν)": (EVERY, "plane-stress-factor", lambda k, r: {"hooke": over_one_minus, "state": "plane-stress"}),
    "plane stress": (EVERY, "plane-state", lambda k, r: {"hooke": lambda e, v: elastic(e, v, "plane-stress")}),
    "shear counts twice": (EVERY, "shear", lambda k, r: {"hooke": other_shear}),
    "local axes": (EVERY, "local-axes", lambda k, r: {"after": in_local_axes}),
    "∂N/∂ξ lost": (EVERY, "shape-derivative", lambda k, r: {"local": derivative(k, r, 0)}),
    "∂N/∂ξ of the wrong sign": (EVERY, "shape-derivative", lambda k, r: {"local": derivative(k, r, -1)}),
    "∂N/∂ξ lost in J too": (SEVERAL_POINTS, "shape-derivative", lambda k, r: {"local": derivative(k, r, 0), "in_jacobian": True}),
    "∂N/∂x lost": (EVERY, "shape-derivative", lambda k, r: {"gradients": gradient(k, r, 0)}),
    "∂N/∂y of the wrong sign": (EVERY, "shape-derivative", lambda k, r: {"gradients": gradient(k, r, -1)}),
    "upper triangle": (EVERY, "triangle-only", lambda k, r: {"after": lambda k, _: np.triu(k)}),
    "no correction by Taylor": (("Q4",), "taylor-correction", lambda k, r: {"modes": incompatible(taylor=False)}),
    "B-bar in xx only": (("Q4",), "b-bar-rows", lambda k, r: {"b_bar": (1 / 3, 0, 0)}),
    "half B-bar in yy only": (("Q4",), "b-bar-rows", lambda k, r: {"b_bar": (0, 1 / 2, 0)}),
    "B-bar without zz": (("Q4",), "b-bar-rows", lambda k, r: {"b_bar": (1 / 3, 1 / 3, 0)}),
    "reference element": (EVERY, "other-coordinates", lambda k, r: {"nodes": lambda _: REFERENCE[k]}),
    "another element": (EVERY, "other-coordinates", lambda k, r: {"nodes": lambda _, x=nodes_of(k, corners_of(k, r.integers(1000))): x}),
    "coordinates in another order": (("Q4",), "node-order", lambda k, r: {"nodes": turned_first}),
    "transposed Jacobian": (EVERY, "transposed-jacobian", lambda k, r: {"transposed": True}),
    "blocked unknowns": (EVERY, "component-order", lambda k, r: {"after": blocked}),
}
CASES = [(what, kind) for what, (kinds, *_) in BROKEN.items() for kind in kinds]
RIGHT = {
    "T3": ("T3", {}),
    "T6": ("T6", {}),
    "T6 by the middles of its sides": ("T6", {"rule": [(0.5, 0, 1 / 6), (0.5, 0.5, 1 / 6), (0, 0.5, 1 / 6)]}),
    "Q4": ("Q4", {}),
    "Q4 by 3 × 3 points": ("Q4", {"rule": gauss(3)}),
    "Q4 with incompatible modes": ("Q4", {"modes": incompatible(taylor=True)}),
    "Q4 with B-bar": ("Q4", {"b_bar": (1 / 3, 1 / 3, 1 / 3)}),
    "Q4 with B-bar of the plane": ("Q4", {"b_bar": (1 / 2, 1 / 2, 0)}),
    "Q8": ("Q8", {}),
    "Q8 by 2 × 2 points": ("Q8", {"rule": gauss(2)}),
}


def examined(hypercircle, what, kind, arguments, nodes, **more):
    state = arguments.get("state", "plane-strain")
    return hypercircle.workbench(what, nodes, young=YOUNG, poisson=POISSON, kinematics=state, **more)


def planted(what, kind, seed):
    _, cause, arguments = BROKEN[what]
    return cause, arguments(kind, np.random.default_rng([seed, len(what)]))


@pytest.mark.parametrize(("what", "kind"), CASES)
def test_a_planted_mistake_is_named_from_one_matrix(hypercircle, what, kind):
    for seed in range(1 if kind == "Q8" else 3):
        cause, arguments = planted(what, kind, seed)
        nodes = nodes_of(kind, corners_of(kind, seed))
        k = Element(kind, **arguments).stiffness(nodes, YOUNG, POISSON)
        report = examined(hypercircle, k, kind, arguments, nodes)
        assert report["diagnosis"] and report["diagnosis"]["cause"].startswith(cause), (seed, report["diagnosis"])
        assert report["diagnosis"]["explained"] > 0.999_999


@pytest.mark.parametrize(("what", "kind"), [(what, kinds[i % len(kinds)]) for i, (what, (kinds, *_)) in enumerate(BROKEN.items())])
def test_a_planted_mistake_is_named_from_a_formula(hypercircle, what, kind):
    cause, arguments = planted(what, kind, seed=7)
    # On the reference element many mistakes do not show, and some have no matrix.
    elsewhere = what in ("reference element", "coordinates in another order")
    nodes = nodes_of(kind, corners_of(kind, 3)) if elsewhere else REFERENCE[kind]
    # B-bar in some rows only is wrong in that it locks.
    claim = ["incompressible"] if "B-bar" in what else []
    report = examined(hypercircle, Element(kind, **arguments), kind, arguments, nodes, claim=claim)
    assert not report["passed"], report["verdict"]
    assert report["diagnosis"] and report["diagnosis"]["cause"].startswith(cause), report["diagnosis"]
    assert report["untold"] is None


@pytest.mark.parametrize("what", RIGHT)
def test_right_elements_pass_and_get_no_name(hypercircle, what):
    kind, arguments = RIGHT[what]
    waive = ["rank"] if what == "Q8 by 2 × 2 points" else []
    element = Element(kind, **arguments)
    for seed in range(2):
        nodes = nodes_of(kind, corners_of(kind, seed))
        report = examined(hypercircle, element.stiffness(nodes, YOUNG, POISSON), kind, arguments, nodes, waive=waive)
        assert report["passed"] and report["diagnosis"] is None, (report["verdict"], report["diagnosis"])
        assert "cannot tell" in report["untold"]
    report = examined(hypercircle, element, kind, arguments, nodes, waive=waive)
    assert report["passed"] and report["diagnosis"] is None, (report["verdict"], report["diagnosis"])


@pytest.mark.parametrize("kind", EVERY)
def test_noise_and_random_matrices_get_no_name(hypercircle, kind):
    for seed in range(1 if kind == "Q8" else 3):
        random = np.random.default_rng([40, seed])
        nodes = nodes_of(kind, corners_of(kind, seed))
        right = Element(kind).stiffness(nodes, YOUNG, POISSON)
        noise = random.standard_normal(right.shape)
        noise += noise.T
        # Noise that leaves rigid motions without forces, and none that does.
        rigid, _ = np.linalg.qr(np.column_stack([np.tile([1, 0], len(nodes)), np.tile([0, 1], len(nodes)), (nodes @ [[0, 1], [-1, 0]]).ravel()]))
        silent = noise - rigid @ (rigid.T @ noise)
        silent -= silent @ rigid @ rigid.T
        for k in (right + 1e-6 * noise, right + 0.02 * noise, right + 0.02 * silent, noise, silent):
            report = examined(hypercircle, k, kind, {}, nodes)
            assert report["diagnosis"]["cause"] == "unexplained", report["diagnosis"]
            assert "nearest" not in report["diagnosis"]["sentence"], report["diagnosis"]


def rounded(k, digits):
    return np.vectorize(lambda x: float(f"{x:.{digits - 1}e}"))(k)


@pytest.mark.parametrize("kind", EVERY)
def test_few_digits_get_a_hint_and_hide_no_mistake(hypercircle, kind):
    nodes = nodes_of(kind, corners_of(kind, 5))
    k = rounded(Element(kind).stiffness(nodes, YOUNG, POISSON), 4)
    report = examined(hypercircle, k, kind, {}, nodes)
    assert not report["passed"] and "at most 4 digits" in report["hint"] and "--precision 1e-3" in report["hint"]
    report = examined(hypercircle, k, kind, {}, nodes, precision=1e-3)
    assert report["passed"] and report["hint"] is None and report["diagnosis"] is None, report["verdict"]
    wrong = Element(kind, hooke=lambda e, v: elastic(e, v, "plane-stress")).stiffness(nodes, YOUNG, POISSON)
    report = examined(hypercircle, rounded(wrong, 4), kind, {}, nodes, precision=1e-3)
    assert not report["passed"] and report["diagnosis"]["cause"] == "plane-state"
    with pytest.raises(hypercircle.InputError, match="precision of 0.5"):
        examined(hypercircle, k, kind, {}, nodes, precision=0.5)


def test_what_one_shape_cannot_tell_is_said(hypercircle):
    rectangle = np.array([[0, 0], [2, 0], [2, 1], [0, 1]], float)
    for arguments in ({}, {"modes": incompatible(taylor=False)}, {"measure": lambda det, middle: middle}, {"transposed": True}):
        k = Element("Q4", **arguments).stiffness(rectangle, YOUNG, POISSON)
        report = examined(hypercircle, k, "Q4", arguments, rectangle)
        assert report["passed"] and report["diagnosis"] is None, "this shape shows none of these"
        for words in ("other shapes", "where det J is taken", "without Taylor's correction", "J from its transpose", "local axes"):
            assert words in report["untold"], report["untold"]
    nodes = corners_of("Q4", 1)
    report = examined(hypercircle, Element("Q4").stiffness(nodes, YOUNG, POISSON), "Q4", {}, nodes, thickness=1.0)
    assert "where det J" not in report["untold"] and "whether t, which is 1" in report["untold"]


def test_nobody_claims_what_a_bilinear_quadrilateral_cannot_do(hypercircle):
    report = examined(hypercircle, Element("Q4"), "Q4", {}, REFERENCE["Q4"])
    locking = next(f for f in report["findings"] if f["name"] == "incompressible")
    assert report["passed"] and not locking["passed"] and not locking["claim"]
