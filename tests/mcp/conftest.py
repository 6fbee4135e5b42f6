"""A folder with a mesh, the scene of it, and the client of the SDK that talks to the program."""

import os
import pathlib

import anyio
import pytest
from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client

ROOT = pathlib.Path(__file__).parents[2]
PROGRAM = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "hypercircle"

# A square of plane stress that is pulled to the right: u = (x/E, -nu y/E), which every displacement method represents.
SCENE = """
model.kinematics = "plane-stress"
mesh.file = "plate.msh"
bodies.plate = { young = 2.0, poisson = 0.25 }
supports = [{ on = "left", type = "roller" }, { on = "bottom", type = "roller" }]
tractions = [{ on = "right", value = [1.0, 0.0] }]
quantities = [{ name = "pull", displacement = "right", direction = [1, 0] }]
"""
POINTS = [[x / 2, y / 2] for y in range(3) for x in range(3)]
TRIANGLES = [t for a in (0, 1, 3, 4) for t in ([a, a + 1, a + 4], [a, a + 4, a + 3])]
SIDES = {"bottom": [[0, 1], [1, 2]], "right": [[2, 5], [5, 8]], "left": [[6, 3], [3, 0]]}


def exact(young=2.0, poisson=0.25):
    """The displacement at every point."""
    return [[x / young, -poisson * y / young] for x, y in POINTS]


def mesh():
    """The square as Gmsh writes it."""
    names = ["bottom", "right", "left"]
    cells = [f"1 2 {n + 1} {n + 1} {a + 1} {b + 1}" for n, name in enumerate(names) for a, b in SIDES[name]]
    cells += [f"2 2 9 9 {a + 1} {b + 1} {c + 1}" for a, b, c in TRIANGLES]
    physical = [f'1 {n + 1} "{name}"' for n, name in enumerate(names)] + ['2 9 "plate"']
    blocks = {
        "MeshFormat": ["2.2 0 8"],
        "PhysicalNames": [len(physical), *physical],
        "Nodes": [len(POINTS), *(f"{i + 1} {x} {y} 0" for i, (x, y) in enumerate(POINTS))],
        "Elements": [len(cells), *(f"{i + 1} {cell}" for i, cell in enumerate(cells))],
    }
    return "".join(f"${name}\n" + "".join(f"{line}\n" for line in lines) + f"$End{name}\n" for name, lines in blocks.items())


def field(displacement):
    """The displacement in VTK's oldest format."""
    rows = [*(f"{x} {y} 0" for x, y in POINTS), f"CELLS {len(TRIANGLES)} {4 * len(TRIANGLES)}", *(f"3 {a} {b} {c}" for a, b, c in TRIANGLES)]
    rows += [f"CELL_TYPES {len(TRIANGLES)}", *("5" for _ in TRIANGLES), f"POINT_DATA {len(POINTS)}", "VECTORS displacement double"]
    rows += [f"{x!r} {y!r} 0" for x, y in displacement]
    return "\n".join(["# vtk DataFile Version 3.0", "field", "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(POINTS)} double", *rows, ""])


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """The folder that the server may read."""
    folder = tmp_path_factory.mktemp("mcp") / "folder"
    folder.mkdir()
    (folder / "plate.msh").write_text(mesh())
    (folder / "field.vtk").write_text(field(exact()))
    (folder.parent / "outside.msh").write_text(mesh())
    return folder


@pytest.fixture(scope="session")
def session(folder):
    """Runs an async function of a client that is connected to a server of that folder."""

    def connected(work, *words):
        async def main():
            server = StdioServerParameters(command=str(PROGRAM), args=["mcp", "--folder", str(folder), *words], env=dict(os.environ))
            async with Client(stdio_client(server)) as client:
                return await work(client)

        return anyio.run(main)

    return connected
