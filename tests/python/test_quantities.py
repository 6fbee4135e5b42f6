"""Intervals of quantities, held against statics and against means that numpy takes of the stresses."""

import numpy as np
import pytest

from scenes import two_blocks

ASKED = """
[[quantities]]
name = "whole"
force = "left_face|right_face"
[[quantities]]
name = "core"
stress = "left"
component = "xx"
[[quantities]]
name = "tip"
displacement = "load"
direction = [1, 0]
"""


def asked(folder, more):
    scene, _ = two_blocks(folder, 4)
    scene.write_text(scene.read_text() + more)
    return str(scene)


def test_a_solution_has_the_quantities_of_its_scene(hypercircle, tmp_path):
    scene = asked(tmp_path, ASKED)
    found, mesh = hypercircle.Scene(scene).solve(), hypercircle.Scene(scene).problem()
    whole, core, tip = found.quantities.values()
    assert list(found.quantities) == ["whole", "core", "tip"]
    assert [q.kind for q in found.quantities.values()] == ["force", "stress", "displacement"]
    # The load is 4 - 7 y over a side of length one.
    assert whole.exact_by_statics and whole.value == pytest.approx(0.5, abs=1e-12)
    assert whole.lower <= 0.5 <= whole.upper and whole.upper - whole.lower < 1e-10
    # Linear on every part, so the mean is that of the nodes; the block has the area one.
    mean = 0.0
    for corners, body, stress in zip(mesh["triangles"], mesh["body"], found.stress.reshape(-1, 9, 3)):
        if mesh["bodies"][body]["name"] == "left":
            (x0, y0), (x1, y1), (x2, y2) = np.array(mesh["points"])[corners]
            mean += 0.5 * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)) * np.mean(stress[:, 0])
    assert core.value == pytest.approx(mean, rel=1e-10)
    # Known from far finer meshes.
    assert tip.lower < 0.801499 < tip.upper
    for q in (core, tip):
        assert q.lower <= q.value <= q.upper and q.reason is None and not q.exact_by_statics
        assert q.first_order[0] < q.lower and q.upper < q.first_order[1]


def test_a_scene_without_quantities_has_none(hypercircle, tmp_path):
    assert hypercircle.Scene(asked(tmp_path, "")).solve().quantities == {}


def test_a_quantity_that_is_not_there_is_a_value_error(hypercircle, tmp_path):
    with pytest.raises(ValueError, match="nowhere"):
        hypercircle.Scene(asked(tmp_path, ASKED.replace('"load"', '"nowhere"'))).solve()
