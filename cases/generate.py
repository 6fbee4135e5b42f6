#!/usr/bin/env python3
"""Writes the meshes of this folder again from their .geo files, that of quadrilaterals, and the gap tables of two Hertz scenes and
of the pin.

Needs gmsh 4 (apt install gmsh), but for `python3 generate.py quadrilaterals`. The break points of the gaps are the vertices that the .geo files put on the contact,
every 0.05 from 0 to 2, so that scene and bounds speak of the same gap: g = s²/(2 R), linear in between.
"""

import math
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
RADIUS = 50
ROWS_PER_LINE = 6


def meshes() -> None:
    for geometry in sorted(HERE.glob("*.geo")):
        mesh = geometry.with_suffix(".msh")
        subprocess.run(["gmsh", "-v", "2", "-2", "-bin", "-format", "msh41", geometry, "-o", mesh], check=True)


def quadrilaterals(n: int = 10) -> None:
    """Two unit squares side by side, n × n quadrilaterals each, as MSH 2.2: plain enough to be read and written by hand."""
    boundaries = {"left_bottom": 3, "left_face": 4, "left_load": 5, "wall": 6, "right_face": 7}
    names = [(2, 1, "left"), (2, 2, "right")] + [(1, tag, name) for name, tag in boundaries.items()]
    nodes, lines, cells = [], [], []
    for body, sides in ((1, ("left_bottom", "left_face", "left_load")), (2, ("", "wall", "right_face"))):
        first = len(nodes) + 1
        nodes += [(body - 1 + i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
        row = [[first + j * (n + 1) + i for i in range(n + 1)] for j in range(n + 1)]
        along = (row[0], [r[-1] for r in row], [r[0] for r in row])
        for name, side in zip(sides, along):
            if name:
                lines += [f"1 2 {boundaries[name]} {boundaries[name]} {a} {b}" for a, b in zip(side, side[1:])]
        for low, high in zip(row, row[1:]):
            cells += [f"3 2 {body} {body} {low[i]} {low[i + 1]} {high[i + 1]} {high[i]}" for i in range(n)]
    sections = {
        "PhysicalNames": [f'{dimension} {tag} "{name}"' for dimension, tag, name in names],
        "Nodes": [f"{k} {x!r} {y!r} 0" for k, (x, y) in enumerate(nodes, 1)],
        "Elements": [f"{k} {element}" for k, element in enumerate(lines + cells, 1)],
    }
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    for section, entries in sections.items():
        text += f"${section}\n{len(entries)}\n" + "\n".join(entries) + f"\n$End{section}\n"
    (HERE / "quadrilaterals.msh").write_text(text)


def gap_table(beyond: list[str]) -> str:
    # s = k/20, so that g = k²/(800 R) comes out of exact integers, rounded once.
    rows = [f"[{k / 20}, {k * k / (800 * RADIUS)}]" for k in range(41)] + beyond
    lines = [", ".join(rows[i : i + ROWS_PER_LINE]) for i in range(0, len(rows), ROWS_PER_LINE)]
    return "gap = [\n" + "".join(f"    {line},\n" for line in lines) + "]\n"


def write(scene: str, table: str) -> None:
    """Puts a gap table in place of the one in a scene."""
    path = HERE / f"{scene}.toml"
    path.write_text(re.sub(r"gap = \[\n.*?\n\]\n", lambda _: table, path.read_text(), flags=re.S))


def pin_table() -> str:
    """Distance 0.01 (1 - cos phi) from the hole at the ends of 60 facets of 1.5 degrees."""
    facet = 2 * math.sin(math.radians(0.75))
    rows = [f"[{k * facet!r}, {0.01 * (1 - math.cos(math.radians(1.5 * k)))!r}]" for k in range(61)]
    return "gap = [\n" + "".join(f"    {', '.join(rows[i : i + 3])},\n" for i in range(0, len(rows), 3)) + "]\n"


def main() -> None:
    quadrilaterals()
    if sys.argv[1:] == ["quadrilaterals"]:
        return
    meshes()
    write("pin", pin_table())
    for scene, beyond in (("hertz_rigid", []), ("hertz_elastic", ["[30, 9]"]), ("hertz_orthotropic", ["[30, 9]"])):
        write(scene, gap_table(beyond))


if __name__ == "__main__":
    main()
