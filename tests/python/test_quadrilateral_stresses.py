"""The measurement of `examples/quadrilateral_stresses.py`: its two blocks are those of the program, and the rest is what it says."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "quadrilateral_stresses.py"
SCENE = """
model.kinematics = "plane-stress"
mesh.file = "m.msh"
bodies.block = { young = 1.0, poisson = 0.3 }
supports = [{ on = "held", type = "clamped" }]
tractions = [{ on = "pulled", value = [0.0, 1.0] }]
"""


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("quadrilateral_stresses", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def written(folder, points, cells):
    n = int(round(np.sqrt(len(cells))))
    lines = [("held", j * (n + 1), (j + 1) * (n + 1)) for j in range(n)]
    lines += [("pulled", j * (n + 1) + n, (j + 1) * (n + 1) + n) for j in range(n)]
    tags = {"block": 1, "held": 2, "pulled": 3}
    elements = [f"1 2 {tags[name]} {tags[name]} {a + 1} {b + 1}" for name, a, b in lines]
    elements += [f"3 2 1 1 {' '.join(str(v + 1) for v in cell)}" for cell in cells]
    sections = {
        "PhysicalNames": [f'{2 if name == "block" else 1} {tag} "{name}"' for name, tag in tags.items()],
        "Nodes": [f"{k} {x!r} {y!r} 0" for k, (x, y) in enumerate(points.tolist(), 1)],
        "Elements": [f"{k} {element}" for k, element in enumerate(elements, 1)],
    }
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    for section, entries in sections.items():
        text += f"${section}\n{len(entries)}\n" + "\n".join(entries) + f"\n$End{section}\n"
    (folder / "m.msh").write_text(text)
    (folder / "scene.toml").write_text(SCENE)
    return folder / "scene.toml"


@pytest.mark.parametrize("shape", ["cook", "shaken"])
def test_two_blocks_are_those_of_the_program(hypercircle, example, tmp_path, shape):
    place = example.cook if shape == "cook" else example.shaken(0.2, seed=3)(5)
    points, cells = example.grid(5, place)
    energies = [example.strain_energy(points, cells, element, (0.0, 1.0))[0] for element in
                (example.two_blocks, example.both_diagonals, example.four_blocks)]  # fmt: skip
    solution = hypercircle.Scene(written(tmp_path, points, cells)).solve()
    assert -solution.lower == pytest.approx(energies[0], rel=1e-8)
    # All are above the exact one. Four blocks have what one element on both diagonals has, and more.
    assert -solution.upper < energies[2] < energies[1] < energies[0]


def test_every_traction_in_equilibrium_is_met(example):
    corners = [np.array(p) for p in ([0.0, 0.0], [1.3, 0.1], [1.1, 0.9], [-0.2, 1.2])]
    for element, modes in ((example.two_blocks, 14), (example.both_diagonals, 13), (example.four_blocks, 20)):
        K, count = example.stiffness(*element(corners))
        assert count == modes
        assert np.linalg.matrix_rank(K, tol=1e-9 * np.linalg.norm(K)) == 13
