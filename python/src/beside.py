"""Parts of the module that are written in Python: fields of other programs, tables, pages in notebooks, pictures, jobs."""

import html
import json
import os
import pathlib
import shutil
import subprocess
import sysconfig

import numpy as np


# Names that programs give a displacement, in lower case; the first has precedence, as in files.
USUAL = ("displacement", "u", "disp")


def field(of, values=None, name=None):
    """Points, triangles and displacement of an object of another program."""
    if hasattr(of, "function_space") and hasattr(of, "x"):
        _alone("a dolfinx.fem.Function", values=values, name=name)
        return _of_dolfinx(of)
    if hasattr(of, "doflocs") and hasattr(of, "nodal_dofs"):
        _alone("a skfem basis", name=name)
        return _of_skfem(of, values)
    if hasattr(of, "cells_dict") and hasattr(of, "point_data"):
        _alone("a meshio.Mesh", values=values)
        return _of_meshio(of, name)
    kinds = "a dolfinx.fem.Function, a skfem basis with its values, or a meshio.Mesh"
    raise TypeError(f"a field is {kinds}, not {type(of).__name__}; give points, triangles and displacement as arrays")


def _alone(of, **others):
    """Refuses arguments that would do nothing."""
    for argument, given in others.items():
        if given is not None:
            raise ValueError(f"{of} has no use for {argument}; leave it out")


def _real(values, of):
    """The values, where they are real."""
    values = np.asarray(values)
    if np.iscomplexobj(values):
        if np.any(values.imag != 0.0):
            raise ValueError(f"the values of {of} are complex; give their real part as arrays")
        values = values.real
    return values


def _of_dolfinx(function):
    space = function.function_space
    dofmap, size = space.dofmap, space.dofmap.index_map_bs
    mesh = space.mesh
    local = mesh.topology.index_map(mesh.topology.dim).size_local
    if mesh.comm.size > 1:
        raise ValueError("the function is divided among MPI ranks; gather it, or solve on one")
    cells = np.array([dofmap.cell_dofs(c) for c in range(local)])
    # Edges of a triangle are counted by the corner that they lie opposite to.
    order = {3: [0, 1, 2], 6: [0, 1, 2, 5, 3, 4]}.get(cells.shape[1] if mesh.topology.dim == 2 else 0)
    if size != 2 or order is None:
        raise ValueError("the function is no Lagrange vector of degree 1 or 2 on triangles; interpolate it into one")
    points = _plane(space.tabulate_dof_coordinates())
    return points, cells[:, order], _real(function.x.array, "the function").reshape(-1, 2)[: len(points)]


def _of_skfem(basis, values):
    if values is None:
        raise TypeError("a basis needs its values: field(basis, u)")
    values, cells = _real(values, "the basis"), basis.mesh.t.T
    if cells.shape[1] != 3 or basis.nodal_dofs.shape[0] != 2 or basis.interior_dofs.size:
        raise ValueError("the basis is no vector of degree 1 or 2 on triangles; interpolate into one")
    if values.shape != (basis.N,):
        raise ValueError(f"the values have the shape {values.shape}; give {basis.N} numbers, one for each unknown of the basis")
    corners = basis.nodal_dofs.shape[1]
    points, displacement = basis.mesh.p.T[:corners], values[basis.nodal_dofs].T
    middles = points[basis.mesh.facets].mean(axis=0)
    own = basis.mesh.p.T[corners:]
    if own.size and (own.shape != middles.shape or np.abs(own - middles).max() > 1e-12 * np.abs(points).max()):
        raise ValueError("the mesh of the basis has curved sides; give a field on a mesh with straight ones")
    if basis.facet_dofs.size:
        if basis.facet_dofs.shape[0] != 2:
            raise ValueError("the basis is no vector of degree 1 or 2 on triangles; interpolate into one")
        # Facets of a triangle: (0, 1), (1, 2), (0, 2).
        cells = np.hstack([cells, corners + basis.mesh.t2f.T])
        points = np.vstack([points, middles])
        displacement = np.vstack([displacement, values[basis.facet_dofs].T])
    return points, cells, displacement


def _of_meshio(mesh, name):
    kinds = [kind for kind in mesh.cells_dict if kind not in ("vertex", "line", "line3")]
    if kinds not in (["triangle"], ["triangle6"]):
        raise ValueError(f"the mesh has the cells {', '.join(mesh.cells_dict) or 'none'}; one kind of triangles is taken")
    if name is None:
        found = sorted((USUAL.index(known.lower()), known != known.lower(), known) for known in mesh.point_data if known.lower() in USUAL)
        name = found[0][2] if found else None
    if name not in mesh.point_data:
        raise ValueError(f"the mesh has the point data {', '.join(mesh.point_data) or 'none'}; say which is the displacement with name")
    return _plane(mesh.points), mesh.cells_dict[kinds[0]], _plane(mesh.point_data[name])


def _plane(rows):
    """The rows without third components, where these are zero; others are for who takes the field to refuse."""
    rows = np.asarray(rows)
    return rows[:, :2] if rows.ndim == 2 and rows.shape[1] == 3 and not rows[:, 2].any() else rows


def copied(data):
    """A copy of what JSON can hold: who changes it changes nothing else."""
    return json.loads(json.dumps(data))


DEEPEST = 16
"""Levels of tables and lists; no scene has half as many."""


def toml(data):
    """The text of a scene whose tables are dictionaries; what is None is left out."""
    return "".join(f"{_quoted(str(key), [key])} = {_toml(value, [key])}\n" for key, value in data.items() if value is not None)


def _toml(value, place):
    if len(place) > DEEPEST:
        raise ValueError(f"{_named(place)} lies more than {DEEPEST} levels deep, deeper than any table of a scene: does it contain itself?")
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return _quoted(os.fspath(value), place)
    if isinstance(value, dict):
        entries = (f"{_quoted(str(k), [*place, k])} = {_toml(v, [*place, k])}" for k, v in value.items() if v is not None)
        return "{ " + ", ".join(entries) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, [*place, i]) for i, v in enumerate(value)) + "]"
    raise ValueError(f"{_named(place)} has the type {type(value).__name__}; a scene has numbers, text, lists, arrays and dictionaries")


def _named(place):
    return ".".join(str(part).encode(errors="backslashreplace").decode() for part in place)


def _quoted(text, place):
    """The text as a string of TOML."""
    if any("\ud800" <= letter <= "\udfff" for letter in text):
        raise ValueError(f"{_named(place)} has half of a pair of UTF-16, which is no letter: {ascii(text)}; decode what it was read from")
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _flat(entry, prefix=""):
    """The numbers and words of an entry by name: parts with dots between, x and y of a vector, ends of an interval; no curves."""
    found = {}
    for key, value in entry.items():
        if isinstance(value, dict):
            found |= _flat(value, f"{prefix}{key}.")
        elif isinstance(value, list):
            if len(value) == 2 and all(x is None or isinstance(x, (int, float)) for x in value):
                found |= {f"{prefix}{key}.{i}": x for i, x in enumerate(value)}
        else:
            found[prefix + key] = value
    return found


def table(report, name):
    """A list of the report as columns."""
    named = {"contacts": "contact"}.get(name, name)
    lists = [key for key, value in report.items() if isinstance(value, list)]
    if named not in lists:
        raise ValueError(f"there is no table '{name}'; use one of {', '.join('contacts' if key == 'contact' else key for key in lists)}")
    rows = [_flat(entry) for entry in report[named]]
    columns = list(dict.fromkeys(key for row in rows for key in row))
    return {key: [row.get(key) for row in rows] for key in columns}


def _number(x):
    return "–" if x is None else f"{x:.6g}".replace("-", "−")


def page(report):
    """A verdict and its numbers for a notebook."""
    colour = {"agree": "#1a7f37", "disagree": "#b3261e"}.get(report["status"], "#8a6100")
    verdict = html.escape(report["verdict"])
    text = [f'<div><p><b style="color:{colour}">{html.escape(report["status"])}</b> {verdict}</p>']
    rows = [(q["name"], q["kind"], q["lower"], q["value"], q["upper"]) for q in report["quantities"]]
    if report["energy"]:
        energy = report["energy"]
        rows.insert(0, ("energy", "𝓛(u)", energy["lower"], None, energy["upper"]))
    if rows:
        head = "".join(f"<th>{x}</th>" for x in ("", "", "no less than", "value", "no more than"))
        cell = lambda x: f"<td>{html.escape(x) if isinstance(x, str) else _number(x)}</td>"
        body = "".join("<tr>" + "".join(map(cell, row)) + "</tr>" for row in rows)
        text.append(f"<table><tr>{head}</tr>{body}</table>")
    failed = [check for check in report["checks"] if not check["passed"]]
    if failed:
        items = "".join("<li><code>" + html.escape(check["name"]) + "</code> " + html.escape(check["why"]) + "</li>" for check in failed[:10])
        text.append(f"<ul>{items}</ul>")
    return "".join(text) + "</div>"


def components(solution):
    """The mean stress of each triangle, by component."""
    means = solution.mean_stress
    return dict(zip(("xx", "yy", "xy") if means.shape[1] == 3 else ("rr", "zz", "rz", "tt"), means.T))


def grid(solution):
    """The triangles with what is known of them, for PyVista."""
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("to_pyvista needs PyVista; pip install pyvista") from error
    solid = lambda plane: np.column_stack([plane, np.zeros(len(plane))])
    made = pyvista.UnstructuredGrid({pyvista.CellType.TRIANGLE: np.array(solution.triangles)}, solid(solution.points))
    made.cell_data["body"] = np.array(solution.body)
    for name, numbers in [*((f"stress_{name}", numbers) for name, numbers in components(solution).items()), *solution.maps.items()]:
        made.cell_data[name] = np.array(numbers)
    if solution.displacement is not None:
        made.point_data["displacement"] = solid(solution.displacement)
    return made


def plot(solution, value, ax, deformed, colorbar, options):
    """Draws one number a triangle."""
    if isinstance(value, str):
        known = components(solution)
        maps = solution.maps
        if value in known:
            numbers, label = known[value], f"stress {value}"
        elif value in maps:
            numbers, label = maps[value], value.replace("_", " ")
        else:
            raise ValueError(f"there is no value '{value}'; use one of {', '.join([*known, *maps])}, or an array with a number for each triangle")
    else:
        numbers, label = np.asarray(value, dtype=float), ""
        if numbers.shape != (len(solution.triangles),):
            raise ValueError(f"the array has the shape {numbers.shape}; give one number for each of the {len(solution.triangles)} triangles")
    if ax is None:
        try:
            import matplotlib.pyplot as plt
        except ImportError as error:
            raise ImportError("plot needs matplotlib; pip install matplotlib") from error
        ax = plt.subplots()[1]
    points = np.array(solution.points)
    if deformed:
        if solution.displacement is None:
            raise ValueError("there is no displacement to draw: the scene has no upper bound")
        points = points + deformed * solution.displacement
    drawn = ax.tripcolor(*points.T, solution.triangles, facecolors=numbers, **options)
    ax.set_aspect("equal")
    if colorbar and getattr(ax, "figure", None) is not None:
        ax.figure.colorbar(drawn, ax=ax, label=label)
    return ax


def program():
    """The command that was installed beside this module."""
    beside = pathlib.Path(sysconfig.get_path("scripts")) / "hypercircle"
    found = str(beside) if beside.is_file() else shutil.which("hypercircle")
    if found is None:
        raise FileNotFoundError("the command hypercircle is not installed beside this module; install it with pip")
    return found


def job(scenes, command, out, jobs, options):
    """Exit code, what was said, and the content of job.json, `None` where the command was refused."""
    if isinstance(scenes, (str, os.PathLike)):
        scenes = [scenes]
    return _run([command, "--jobs", str(jobs), "--shard", "1/1", *options], scenes, out, "job.json")


def chart(scene, out, options):
    """Exit code, what was said, and the content of chart.json, `None` where no chart was made."""
    code, said, made = _run(["chart", *options], [scene], out, "chart.json")
    return code, said, made if code == 0 else None


def _run(words, scenes, out, kept):
    """Runs a command on scenes, and reads what it leaves in its folder."""
    kept = pathlib.Path(out) / kept
    before = kept.stat().st_mtime_ns if kept.is_file() else None
    words = [program(), *words, "--out", out, "--quiet", "--", *scenes]
    done = subprocess.run([os.fspath(word) for word in words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    made = kept.is_file() and kept.stat().st_mtime_ns != before
    return done.returncode, done.stderr.strip(), json.loads(kept.read_text(encoding="utf-8")) if made else None
