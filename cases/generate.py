#!/usr/bin/env python3
"""Writes the meshes of this folder again from their .geo files, and the gap tables of two Hertz scenes and of the pin.

Needs gmsh 4 (apt install gmsh). The break points of the gaps are the vertices that the .geo files put on the contact,
every 0.05 from 0 to 2, so that scene and bounds speak of the same gap: g = s²/(2 R), linear in between.
"""

import math
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
    meshes()
    write("pin", pin_table())
    for scene, beyond in (("hertz_rigid", []), ("hertz_elastic", ["[30, 9]"])):
        write(scene, gap_table(beyond))


if __name__ == "__main__":
    main()
