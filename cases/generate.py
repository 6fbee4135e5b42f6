#!/usr/bin/env python3
"""Writes the meshes of this folder again from their .geo files, and the gap tables of the two Hertz scenes.

Needs gmsh 4 (apt install gmsh). The break points of the gaps are the vertices that the .geo files put on the contact,
every 0.05 from 0 to 2, so that scene and bounds speak of the same gap: g = s²/(2 R), linear in between.
"""

import re
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
RADIUS = 50
ROWS_PER_LINE = 6


def meshes() -> None:
    for geometry in sorted(HERE.glob("*.geo")):
        mesh = geometry.with_suffix(".msh")
        subprocess.run(["gmsh", "-v", "2", "-2", "-bin", "-format", "msh41", geometry, "-o", mesh], check=True)


def gap_table(beyond: list[str]) -> str:
    # s = k/20, so that g = k²/(800 R) comes out of exact integers, rounded once.
    rows = [f"[{k / 20}, {k * k / (800 * RADIUS)}]" for k in range(41)] + beyond
    lines = [", ".join(rows[i : i + ROWS_PER_LINE]) for i in range(0, len(rows), ROWS_PER_LINE)]
    return "gap = [\n" + "".join(f"    {line},\n" for line in lines) + "]\n"


def main() -> None:
    meshes()
    for scene, beyond in (("hertz_rigid", []), ("hertz_elastic", ["[30, 9]"])):
        path = HERE / f"{scene}.toml"
        text = re.sub(r"gap = \[\n.*?\n\]\n", gap_table(beyond), path.read_text(), flags=re.S)
        path.write_text(text)


if __name__ == "__main__":
    main()
