"""Writes one plate as the files of many programs: `decks.py FOLDER`; prints as JSON what was written.

The plate is [0, 2] x [0, 1]. Each deck has a file, who made it, its cells, and how a scene finds its body and its two ends: by names of the file,
or with nothing where they are to be found by their place. What a program that is missing would write is left out.
"""

import json
import pathlib
import shutil
import subprocess
import sys

import meshio
import numpy as np

NX, NY = 4, 2
ENDS = ["WALL", "LOAD"]


def grid(shape):
    """Points, cells of meshio's order, and lines at both ends."""
    order = 1 if shape in ("quad", "triangle") else 2
    nx, ny = order * NX, order * NY
    points = np.array([[2 * i / nx, j / ny, 0.0] for j in range(ny + 1) for i in range(nx + 1)])

    def n(i, j):
        return i + j * (nx + 1)

    cells = []
    for j in range(0, ny, order):
        for i in range(0, nx, order):
            a, b, c, d = n(i, j), n(i + order, j), n(i + order, j + order), n(i, j + order)
            ab, bc, cd, da, m = n(i + 1, j), n(i + 2, j + 1), n(i + 1, j + 2), n(i, j + 1), n(i + 1, j + 1)
            cells += {"quad": [[a, b, c, d]], "triangle": [[a, b, c], [a, c, d]], "quad8": [[a, b, c, d, ab, bc, cd, da]],
                      "quad9": [[a, b, c, d, ab, bc, cd, da, m]], "triangle6": [[a, b, c, ab, bc, m], [a, c, d, m, cd, da]]}[shape]
    cells = np.array(cells)
    used = np.unique(cells)
    now = np.full(len(points), -1)
    now[used] = np.arange(len(used))
    ends = [[now[[n(i, j), n(i, j + order)]] for j in range(0, ny, order)] for i in (0, nx)]
    return points[used], now[cells], ends


def by_meshio(folder, told):
    for name, form, shape, key, options in [
        ("zlib.vtu", "vtu", "quad", "materials", {"compression": "zlib"}),
        ("text.vtu", "vtu", "quad8", "materials", {"binary": False}),
        ("old.vtk", "vtk42", "triangle6", "mat", {}),
        ("new.vtk", "vtk51", "quad", "mat", {"binary": False}),
        ("nastran.bdf", "nastran", "quad", "nastran:ref", {}),
        ("medit.mesh", "medit", "quad", "medit:ref", {}),
        ("medit.meshb", "medit", "triangle", "medit:ref", {}),
        ("netgen.vol", "netgen", "triangle", "netgen:index", {}),
        ("avs.avs", "avsucd", "quad", "avsucd:material", {}),
        ("gmsh22.msh", "gmsh22", "quad9", "gmsh:physical", {}),
    ]:
        points, cells, ends = grid(shape)
        lines = np.array(ends[0] + ends[1])
        tags = [np.full(len(cells), 1), np.repeat([2, 3], NY)]
        data = {key: tags}
        if form == "gmsh22":
            data["gmsh:geometrical"] = tags
        mesh = meshio.Mesh(points, [(shape, cells), ("line", lines)], cell_data=data)
        meshio.write(folder / name, mesh, file_format=form, **options)
        told.append({"file": name, "maker": "meshio", "cells": shape, "body": "1", "ends": ["2", "3"]})
    for name, shape in (("rigid.inp", "triangle"), ("plain.xml", "triangle"), ("plain.off", "triangle")):
        points, cells, ends = grid(shape)
        form = {"rigid.inp": "abaqus", "plain.xml": "dolfin-xml", "plain.off": "off"}[name]
        sets = {end: np.unique(edges) for end, edges in zip(ENDS, ends)} if form == "abaqus" else {}
        points = points[:, :2] if form == "dolfin-xml" else points
        meshio.write(folder / name, meshio.Mesh(points, [(shape, cells)], point_sets=sets), file_format=form)
        told.append({"file": name, "maker": "meshio", "cells": shape, "ends": ENDS if sets else None})


def by_scikit_fem(folder, told):
    try:
        import skfem
        from skfem.io.json import to_file
    except ImportError:
        return
    plain = skfem.MeshQuad.init_tensor(np.linspace(0, 2, NX + 1), np.linspace(0, 1, NY + 1))
    for kind, mesh in (("quad", plain), ("triangle", plain.to_meshtri())):
        named = mesh.with_boundaries({"WALL": lambda x: x[0] < 1e-9, "LOAD": lambda x: x[0] > 2 - 1e-9})
        named = named.with_subdomains({"PLATE": lambda x: x[0] < 9})
        to_file(named, str(folder / f"skfem_{kind}.json"))
        told.append({"file": f"skfem_{kind}.json", "maker": "scikit-fem", "cells": kind, "body": "PLATE", "ends": ENDS})
        for ending in ("msh", "vtu"):
            mesh.save(str(folder / f"skfem_{kind}.{ending}"))
            told.append({"file": f"skfem_{kind}.{ending}", "maker": "scikit-fem", "cells": kind})


def by_getfem(folder, told):
    try:
        import getfem
    except ImportError:
        return
    x, y = np.linspace(0, 2, NX + 1), np.linspace(0, 1, NY + 1)
    for kind, maker in (("quad", "cartesian"), ("triangle", "regular simplices"), ("triangle6", "regular simplices")):
        more = ("degree", 2) if kind == "triangle6" else ()
        mesh = getfem.Mesh(maker, x, y, *more)
        faces = mesh.outer_faces()
        normals = mesh.normal_of_faces(faces)
        mesh.set_region(2, faces[:, normals[0] < -0.9])
        mesh.set_region(3, faces[:, normals[0] > 0.9])
        mesh.save(str(folder / f"getfem_{kind}.mesh"))
        told.append({"file": f"getfem_{kind}.mesh", "maker": "GetFEM", "cells": kind, "ends": ["2", "3"]})
        mesh.export_to_vtu(str(folder / f"getfem_{kind}.vtu"))
        told.append({"file": f"getfem_{kind}.vtu", "maker": "GetFEM", "cells": kind})


def by_calculix(folder, told):
    kinds = {"CPE3": "triangle", "CPE4": "quad", "CPE6": "triangle6", "CPE8": "quad8", "CPE8R": "quad8"}
    for kind, shape in kinds.items():
        points, cells, ends = grid(shape)
        rows = ["** written by hand", "*HEADING", "plate", "*NODE, NSET=ALL"]
        rows += [f"{i + 1}, {x!r}, {y!r}, 0." for i, (x, y, _) in enumerate(points.tolist())]
        rows.append(f"*Element, type={kind}, elset=Plate")
        rows += [", ".join(str(n) for n in [i + 1, *(cell + 1)]) for i, cell in enumerate(cells)]
        for name, edges in zip(ENDS, ends):
            rows += [f"*NSET, NSET={name}", ", ".join(str(n + 1) for n in np.unique(edges))]
        rows += ["*MATERIAL, NAME=M", "*ELASTIC", "1., 0.3", "*SOLID SECTION, ELSET=Plate, MATERIAL=M", "1.",
                 "*BOUNDARY", "WALL, 1, 2", "*STEP", "*STATIC", "*CLOAD", f"{np.argmax(points.sum(axis=1)) + 1}, 2, -0.1"]
        (folder / f"{kind}.inp").write_text("\n".join([*rows, "*NODE FILE", "U", "*END STEP", ""]), encoding="utf-8")
        told.append({"file": f"{kind}.inp", "maker": "hand", "cells": kind, "body": "Plate", "ends": ENDS})
        if shutil.which("ccx") is None:
            continue
        for name, output in (("flat", "*NODE FILE, OUTPUT=2D"), ("space", "*NODE FILE, OUTPUT=3D"), ("binary", "*NODE OUTPUT, OUTPUT=3D")):
            job = f"{kind}_{name}"
            (folder / f"{job}.inp").write_text("\n".join([*rows, output, "U", "*END STEP", ""]), encoding="utf-8")
            subprocess.run(["ccx", job], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            told.append({"file": f"{job}.frd", "maker": "CalculiX", "cells": f"{kind} {name}"})


def by_abaqus(folder, told):
    """In the manner of Abaqus/CAE: a part whose sets have the names of the assembly's, and a reference point; and shells with surfaces."""
    points, cells, ends = grid("quad")
    rows = [", ".join(str(n) for n in [i + 1, *(cell + 1)]) for i, cell in enumerate(cells)]
    part = ["*Heading", "*Part, name=Plate", "*Node", *(f"{i + 1}, {x - 5!r}, {y!r}" for i, (x, y, _) in enumerate(points.tolist())),
            "*Element, type=CPE4R", *rows, "*Nset, nset=WALL, generate", f"1, {len(points)}, 1", "*Elset, elset=Set-1, generate",
            f"1, {len(cells)}, 1", "*End Part", "*Assembly, name=Assembly", "*Instance, name=Plate-1, part=Plate", "5., 0., 0.",
            "*End Instance", "*Node", "1, 9., 9., 0.", "*Nset, nset=RP-1", "1,", "*Nset, nset=WALL, instance=Plate-1",
            ", ".join(str(n + 1) for n in np.unique(ends[0])), "*Nset, nset=_right, internal, instance=Plate-1",
            ", ".join(str(n + 1) for n in np.unique(ends[1])), "*Nset, nset=LOAD", "_right", "*End Assembly", "*Step", "*Static", "*End Step", ""]
    (folder / "cae.inp").write_text("\n".join(part), encoding="utf-8")
    told.append({"file": "cae.inp", "maker": "hand", "cells": "CPE4R of an instance", "body": "Plate-1", "ends": ENDS})
    shells = ["*NODE", *(f"{i + 1}, {x!r}, {y!r}, 0." for i, (x, y, _) in enumerate(points.tolist())), "*ELEMENT, TYPE=S4, ELSET=Plate", *rows,
              "*ELSET, ELSET=left, GENERATE", f"1, {len(cells)}, {NX}", "*ELSET, ELSET=right, GENERATE", f"{NX}, {len(cells)}, {NX}",
              "*SURFACE, NAME=WALL", "left, S6", "*SURFACE, NAME=LOAD", "right, E2", ""]
    (folder / "shells.inp").write_text("\n".join(shells), encoding="utf-8")
    told.append({"file": "shells.inp", "maker": "hand", "cells": "S4", "body": "Plate", "ends": ENDS})


def main():
    folder = pathlib.Path(sys.argv[1])
    told = []
    for make in (by_meshio, by_scikit_fem, by_getfem, by_calculix, by_abaqus):
        make(folder, told)
    print(json.dumps(told))


main()
