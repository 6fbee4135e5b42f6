"""Prints the cells and the point data of a file as JSON. Needs meshio."""

import contextlib
import io
import json
import math
import sys

try:
    meshio = load_meshio()
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(44)

packed, target = sys.argv[1:]
source = unpacked(packed, target)


def missing(error):
    """Ends with the name of a package that meshio needs for this format."""
    print(error.name, file=sys.stderr)
    sys.exit(45)


def given(mesh):
    """The mesh and the displacements that fields.vtu keeps beside what it shows; nothing in other files."""
    arrays = dict(mesh.field_data)
    nodes, triangles = arrays.pop("nodes", None), arrays.pop("nodes_of_triangles", None)
    if "scene_sha256" not in arrays:
        return None
    if nodes is None or triangles is None or nodes.ndim != 2 or triangles.ndim != 2:
        sys.exit("it shows fields and keeps no linear or quadratic displacement to be handed in again, or has 10,000 triangles or more")
    fields = {name: values for name, values in arrays.items() if name.startswith("displacement_")}
    return nodes, [meshio.CellBlock("triangle6", triangles)], fields, True


def given_on_quadrilaterals(mesh):
    """Points, cells and fields of the same file that stand on quadrilaterals; nothing where it has none."""
    begin = "quadrilateral_"
    fields = {name.removeprefix(begin): values for name, values in mesh.field_data.items() if name.startswith(begin + "displacement_")}
    if not fields:
        return None
    points, cells = mesh.field_data["nodes"].copy(), mesh.field_data["nodes_of_quadrilaterals"]
    # Their last node, in the place of the middle of a diagonal, is the centre.
    points[cells[:, 8]] = points[cells[:, :4]].mean(axis=1)
    return {"points": rows(points), "cells": cells.tolist(), "fields": as_data(fields)}


def read():
    """Points, cell blocks, point data, whether it is a file of this program, and its fields on quadrilaterals; of a time series the last step."""
    own = own_fields(source)
    if own is not None:
        return *own, None
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = read_with_meshio(by_node(source, target), target)
    except ModuleNotFoundError as error:
        missing(error)
    except Unreadable as error:
        refuse(str(error))
    except (Exception, SystemExit) as error:
        lines = [line.strip() for line in said.getvalue().splitlines() if line.strip()]
        sys.exit(str(error) if isinstance(error, Exception) and str(error) else (lines or ["no message"])[0])
    own = given(mesh)
    return (*own, given_on_quadrilaterals(mesh)) if own else (mesh.points, mesh.cells, mesh.point_data, False, None)


def rows(array):
    """Lists of numbers, with null for what is not finite."""
    return [[float(x) if math.isfinite(x) else None for x in row] for row in array]


def scalars_joined(data):
    """The arrays, and one of vectors for the components of a displacement that are arrays of their own, such as disp_x and disp_y, or Ux and Uy."""
    found = {}
    for name, values in data.items():
        match = re.fullmatch(r"(displacement|disp|u)[ _]?([xyz])", name, re.IGNORECASE)
        if match and values.size == len(values):
            parts = found.setdefault(match[1], {})
            if match[2].lower() in parts:
                sys.exit(f"several arrays may be the {match[2]} component of '{match[1]}': {', '.join(other for other in data if other.lower().startswith(match[1].lower()))}")
            parts[match[2].lower()] = values.reshape(-1)
    import numpy

    joined = {name: numpy.stack([parts[axis] for axis in "xyz" if axis in parts], axis=1) for name, parts in found.items() if "x" in parts and "y" in parts}
    return {**joined, **data}


def as_data(arrays):
    """What is told of arrays at points: rows of those of two or three components, and which have single precision."""
    told = {}
    for name, values in arrays.items():
        vector = values.ndim == 2 and values.shape[1] in (2, 3) and values.dtype.kind in "fiu"
        told[name] = {
            "values": rows(values) if vector else None,
            "single": values.dtype.kind == "f" and values.dtype.itemsize < 8,
        }
    return told


points, cells, data, own, on_quadrilaterals = read()
# Nodes of a cell: corners, the middles of the sides from corner to corner, the centre of a quadrilateral.
shapes = {"triangle": 3, "triangle6": 6, "quad": 4, "quad8": 8, "quad9": 9}
kept, others = [], []
for block in cells:
    nodes = block.data
    if nodes.ndim == 2 and nodes.shape[1] == shapes.get(block.type):
        kept.extend(nodes.tolist())
    elif block.type not in ("vertex", "line", "line3"):
        others.append(block.type)
with open(target, "w", encoding="utf-8") as out:
    json.dump({
        "points": rows(points),
        "single": points.dtype.itemsize < 8,
        "own": own,
        "cells": kept,
        "others": others,
        "fields": as_data(scalars_joined(data)),
        "on_quadrilaterals": on_quadrilaterals,
    }, out)
