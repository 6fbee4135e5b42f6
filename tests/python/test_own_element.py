"""An equilibrium element as a Python class: the block as a null space in numpy, right and spoilt."""

from pathlib import Path

import numpy as np
import pytest
from block import Block, compliance

CASES = Path(__file__).resolve().parents[2] / "cases"


class NullSpace:
    """Linear stresses whose tractions are continuous inside, found by a singular value decomposition."""

    degree = 1

    def stresses(self, corners):
        block = Block(corners, compliance(1.0, 0.0, "plane-stress"))
        space, _ = block.balanced()
        parts = [np.array([block.stress(i, p) @ space for p in block.sub(i)]) for i in range(3)]
        return np.moveaxis(np.array(parts), 3, 0)


class Unbalanced(NullSpace):
    def stresses(self, corners):
        fields = super().stresses(corners)
        centre = corners.mean(axis=0)
        for i in range(3):
            for node, p in enumerate((corners[(i + 1) % 3], corners[(i + 2) % 3], centre)):
                fields[4, i, node, 0] += p[0] - centre[0]
        return fields


class Torn(NullSpace):
    def stresses(self, corners):
        fields = super().stresses(corners)
        fields[2, 0, :, 2] += 1.0
        return fields


def finding(report, name):
    return next(f for f in report["findings"] if f["name"] == name)


@pytest.mark.parametrize("case", ("two_blocks", "gravity"))
def test_a_scene_is_solved_with_it_as_with_the_block(hypercircle, case):
    scene = hypercircle.Scene(CASES / f"{case}.toml")
    usual, own = scene.solve(), scene.solve(element=NullSpace())
    assert own.lower == pytest.approx(usual.lower, rel=1e-9)
    assert own.upper == pytest.approx(usual.upper, rel=1e-6)
    size = np.abs(usual.mean_stress).max()
    assert np.allclose(own.mean_stress, usual.mean_stress, rtol=0, atol=1e-7 * size)


def test_the_workbench_finds_nothing_wrong_with_it(hypercircle, tmp_path):
    report = hypercircle.workbench(NullSpace(), out=tmp_path / "out")
    assert report["passed"], [f["sentence"] for f in report["findings"] if not f["passed"]]
    assert finding(report, "dimension")["value"] == 0, "none of the nine is missing"
    assert (tmp_path / "out/report.html").is_file()


@pytest.mark.parametrize(("element", "name"), ((Unbalanced, "divergence"), (Torn, "inner-continuity")))
def test_stresses_that_do_not_balance_are_named_and_give_no_bound(hypercircle, element, name):
    report = hypercircle.workbench(element())
    assert not report["passed"] and not finding(report, name)["passed"]
    what = {"divergence": "divergence", "inner-continuity": "jump"}[name]
    with pytest.raises(hypercircle.InputError, match=f"{element.__name__} has stresses with a {what}.*no bound"):
        hypercircle.Scene(CASES / "two_blocks.toml").solve(element=element())


def test_a_particular_field_of_its_own_is_taken(hypercircle):
    class Heavy(NullSpace):
        """Balances a weight by another field of the space more."""

        name = "heavy"

        def particular(self, corners, body_force):
            about = corners - corners.mean(axis=0)
            points = np.array([[about[(i + 1) % 3], about[(i + 2) % 3], 0 * about[0]] for i in range(3)])
            field = np.zeros((3, 3, 3))
            field[..., 0], field[..., 1] = -body_force[0] * points[..., 0], -body_force[1] * points[..., 1]
            return field + 0.3 * self.stresses(corners)[1]

    scene = hypercircle.Scene(CASES / "gravity.toml")
    assert scene.solve(element=Heavy()).lower == pytest.approx(scene.solve().lower, rel=1e-9)


def test_what_is_no_element_is_told(hypercircle):
    scene = hypercircle.Scene(CASES / "patch.toml")

    class Raising(NullSpace):
        def stresses(self, corners):
            raise ZeroDivisionError("an own mistake")

    class Flat(NullSpace):
        def stresses(self, corners):
            return np.zeros((9, 3, 3))

    class Quartic(NullSpace):
        degree = 2

    class Ninth(NullSpace):
        degree = 9

    for element, said in (
        (object(), "a method stresses"),
        (Raising(), "an own mistake"),
        (Flat(), "fields × 3 subtriangles"),
        (Quartic(), "field 0 has 9 nodes, and degree 2 has 18"),
        (Ninth(), "degree 9"),
    ):
        with pytest.raises(hypercircle.InputError, match=said):
            scene.solve(element=element)
    with pytest.raises(hypercircle.InputError, match="give element, or these"):
        scene.solve(element=NullSpace(), tolerance=0.1)
    with pytest.raises(hypercircle.InputError, match="leave out nodes"):
        hypercircle.workbench(NullSpace(), [[0, 0], [1, 0], [0, 1]])
    with pytest.raises(hypercircle.InputError, match="has nodes"):
        hypercircle.workbench(np.eye(6))
