"""Prints a mesh file as JSON: points, and cells with their group names. Needs meshio."""

import json
import sys

try:
    import meshio
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(44)

source, target = sys.argv[1:]
try:
    mesh = meshio.read(source)
except ModuleNotFoundError as error:
    print(error.name, file=sys.stderr)
    sys.exit(45)
shapes = {"line": "line", "line3": "line", "triangle": "triangle", "triangle6": "triangle"}

# The integers that group cells, by the name each format gives them.
known = ["gmsh:physical", "cell_tags", "medit:ref", "CellEntityIds", "name_to_read"]
whole = [name for name, blocks in mesh.cell_data.items() if all(b.dtype.kind in "iu" and b.ndim == 1 for b in blocks)]
whole = [name for name in whole if name != "gmsh:geometrical"]
chosen = next((name for name in known if name in whole), whole[0] if len(whole) == 1 else None)

names = {(int(dim), int(tag)): name for name, (tag, dim) in mesh.field_data.items()}
families = getattr(mesh, "cell_tags", {}) or {}


def groups(block, shape):
    """Names of each cell of a block."""
    cells = mesh.cells[block].data
    result = [[] for _ in cells]
    for name, sets in mesh.cell_sets.items():
        if not name.startswith("gmsh:") and sets[block] is not None:
            for cell in sets[block]:
                result[int(cell)].append(name)
    if chosen is not None:
        for found, tag in zip(result, mesh.cell_data[chosen][block]):
            tag = int(tag)
            more = families.get(tag) or [names.get((1 if shape == "line" else 2, tag), str(tag) if tag else None)]
            if not found:
                found.extend(name for name in more if name is not None)
    return result


blocks = []
for number, block in enumerate(mesh.cells):
    shape = shapes.get(block.type, block.type)
    if shape in ("vertex", "point"):
        continue
    kept = shape in ("line", "triangle")
    blocks.append({
        "shape": shape,
        "nodes": block.data.tolist() if kept else [],
        "groups": groups(number, shape) if kept else [],
    })
points = [[float(x) for x in point] for point in mesh.points]
with open(target, "w", encoding="utf-8") as out:
    json.dump({"points": points, "blocks": blocks}, out)
