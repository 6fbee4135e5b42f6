"""Dual solutions of the library against the same problem solved in stresses by numpy."""

import numpy as np
import pytest

from saddle import Program
from scenes import RICH, two_blocks


def compare(found, program, expected=None):
    """Energy, stresses and contact tractions, with what the program found where it was solved before."""
    s, energy, pressing = expected or program.solve()
    assert found.energy == pytest.approx(energy, rel=1e-11)
    expected = program.nodal_stress(s)
    assert np.abs(found.stress.reshape(expected.shape) - expected).max() < 1e-10 * np.abs(expected).max()
    contact = np.concatenate([np.ravel(interface) for interface in found.contact_traction] or [[]])
    assert np.abs(contact - pressing).max(initial=0.0) < 1e-10 * np.abs(expected).max()
    closed = pressing < -1e-9 * np.abs(expected).max()
    assert np.array_equal(found.closed, closed)
    assert found.lower <= energy + 1e-12 * abs(energy) and energy < found.upper


@pytest.mark.parametrize("n, open_ends", [(2, 1), (4, 3)])
def test_two_blocks_that_come_apart(hypercircle, tmp_path, n, open_ends):
    scene, problem = two_blocks(tmp_path, n)
    program = Program(problem)
    expected = program.solve()
    for method in ("condensed", "active-set"):
        found = hypercircle.Scene(scene).solve(method=method)
        compare(found, program, expected)
        assert (~found.closed).sum() == open_ends
        # Forces balance: the contact carries the load, 4 - 7/2.
        traction = np.array(found.contact_traction[0])
        assert traction.mean() == pytest.approx(-0.5, rel=1e-10)


def test_two_blocks_that_stay_together(hypercircle, tmp_path):
    scene, problem = two_blocks(tmp_path, 4, load=(1.5, -1.8))
    found = hypercircle.Scene(scene).solve()
    compare(found, Program(problem))
    assert found.closed.all()


def test_the_program_reads_the_mesh_it_is_given(hypercircle, tmp_path):
    scene, expected = two_blocks(tmp_path, 3)
    found = hypercircle.Scene(scene).problem()
    assert np.array_equal(found["points"], expected["points"])
    assert [sorted(t) for t in found["triangles"]] == [sorted(t) for t in expected["triangles"]]
    assert list(found["body"]) == expected["body"]
    conditions = {frozenset(e): c for e, c in zip(found["edges"], found["conditions"])}
    for vertices, condition in zip(expected["edges"], expected["conditions"]):
        other = conditions[frozenset(vertices)]
        assert other["kind"] == condition["kind"]
        if "values" in condition:
            assert np.allclose(other["values"], condition["values"], atol=1e-15)
    pairs = found["interfaces"][0]["pairs"]
    for pair, other in zip(pairs, expected["interfaces"][0]["pairs"]):
        assert (pair["first"], pair["second"]) == (other["first"], other["second"])
        assert np.allclose(pair["normal"], [1, 0])


def test_everything_at_once(hypercircle, tmp_path):
    scene = tmp_path / "rich.toml"
    scene.write_text(RICH)
    found = hypercircle.Scene(scene).solve()
    compare(found, Program(hypercircle.Scene(scene).problem()))
    assert 0 < (~found.closed).sum() < len(found.closed), "contact somewhere, and not everywhere"


def test_moments_are_conjugate_to_tractions(hypercircle, tmp_path):
    """Clapeyron: twice the energy is the work of the boundary tractions on the moments, triangle by triangle."""
    scene, problem = two_blocks(tmp_path, 4)
    found, mesh = hypercircle.Scene(scene).solve(), hypercircle.Scene(scene).problem()
    program = Program(problem)
    stress, work, energy = found.stress.reshape(-1, 9, 3), 0.0, 0.0
    for t, (corners, edges) in enumerate(zip(mesh["triangles"], mesh["triangle_edges"])):
        block = program.blocks[t]
        s = np.linalg.lstsq(block.nodes(), stress[t].ravel(), rcond=None)[0]
        tractions = (block.side_traction() @ s).reshape(3, 2, 2)
        own = 0.0
        for i, e in enumerate(edges):
            for end in (0, 1):
                v = corners[(i + 1 + end) % 3]
                moment = found.moments[e][list(mesh["edges"][e]).index(v)]
                own += tractions[i, end] @ np.array(moment)
        twice = s @ block.energy() @ s
        assert own == pytest.approx(twice, abs=1e-10)
        work, energy = work + own, energy + twice
    assert work == pytest.approx(2 * found.complementary, rel=1e-11)
