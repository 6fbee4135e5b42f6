"""Proofs written by hand: fields whose energies are known without a computer."""

import hashlib
import io
import json
import zipfile

import numpy as np
import pytest
from hypercircle_check import Refused
from hypercircle_check.main import check

BLOCKS = """
model = {{ kinematics = "plane-stress", thickness = {thickness} }}
bodies.left = {{ {left} }}
bodies.right = {{ young = {young}, poisson = 0.0 }}
supports = [{{ on = "wall", {wall} }}{held}]
tractions = [{loads}]
{joint}

[[geometry.polygons]]
body = "left"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["{below}", "face", "{above}", "pressed"]

[[geometry.polygons]]
body = "right"
points = [[1, 0], [2, 0], [2, 1], [1, 1]]
edges = ["{below}", "wall", "{above}", "seat"]
"""


ISOTROPIC = "young = 1.0, poisson = 0.0"


def blocks(n=2, gap=0.25, young=1.0, thickness=1.0, degree=1, left=ISOTROPIC, wall=None, elastic=None, layer=None, grown=0.0, bound=None, shear=0.0, moved=None):
    """Two unit blocks, pressed against each other by a unit pressure: stress xx = -1 everywhere. With E = 1 the energy is
    -(1 + gap) times the thickness: half of the work of the pressure on the shortening 2, less its work on the way to the seat.

    `left`: the material of the first, which without stress is longer by `grown` and has E = 1 along x. `wall`, `elastic`, `layer`: a spring
    stiffness of the support, of the contact, or of a layer in its place; each is compressed by its inverse. `bound`: of the friction of the contact, where there is a stress xy = `shear` everywhere, too.
    Blocks shear by 2 `shear` then, and the left one slides along the other if its end is `moved` along y by more than that accounts for."""
    law = f", stiffness = {elastic}" if elastic else f", friction = {{ bound = {bound} }}" if bound is not None else ""
    joint = f'contacts = [{{ between = ["face", "seat"], gap = {gap}{law} }}]'
    joint = f'bonds = [{{ between = ["face", "seat"], stiffness = [{layer}, 3.0] }}]' if layer else joint
    support = f'type = "spring", stiffness = [{wall}, 2.0]' if wall else 'type = "clamped"'
    held = f', {{ on = "pressed", type = "clamped", displacement = [{2 + gap}, {moved}] }}' if moved is not None else ""
    sides = [f'{{ on = "{side}", value = [{s}, 0.0] }}' for side, s in (("above", shear), ("below", -shear)) if shear]
    loads = ", ".join([*sides, *([] if held else [f'{{ on = "pressed", value = [1.0, {-shear}] }}'])])
    around = dict(above="above", below="below") if shear else dict(above="", below="")
    text = BLOCKS.format(young=young, thickness=thickness, left=left, wall=support, joint=joint, held=held, loads=loads, **around).encode()
    gap = 0.0 if layer else gap
    sunk, pressed = 1 / wall if wall else 0.0, sum(1 / k for k in (elastic, layer) if k)
    points, triangles, bodies = [], [], []
    for body, x0 in enumerate((0, 1)):
        base = len(points)
        points += [(x0 + i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
        for j in range(n):
            for i in range(n):
                a = base + j * (n + 1) + i
                triangles += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)]
                bodies += [body, body]
    points = np.array(points, float)
    names = ["face", "pressed", "seat", "wall", *(["below", "above"] if shear else [])]
    edges, owners = {}, {}
    for t, corners in enumerate(triangles):
        for i in range(3):
            a, b = corners[(i + 1) % 3], corners[(i + 2) % 3]
            if (b, a) in edges:
                owners[b, a].append(t)
            else:
                edges[a, b] = len(edges)
                owners[a, b] = [t]
    rows = []
    for (a, b), own in owners.items():
        (x, y), (u, v) = points[[a, b]]
        left = bodies[own[0]] == 0
        at = {0: "pressed", 2: "wall", 1: "face" if left else "seat"}
        name = at.get(x) if x == u else "below" if y == 0 else "above"
        rows.append((a, b, names.index(name) if len(own) == 1 and name in names else -1))
    face = sorted((e for e, r in enumerate(rows) if r[2] == 0), key=lambda e: points[rows[e][0], 1])
    seat = sorted((e for e, r in enumerate(rows) if r[2] == 2), key=lambda e: points[rows[e][1], 1])
    pairs, data = [], []
    for e, f in () if layer else zip(face, seat):
        pairs.append((0, e, f, rows[e][0], rows[e][1], rows[f][1], rows[f][0]))
        data.append([1, 0, 1, 0, 1 / n, points[rows[e][0], 1], points[rows[e][1], 1], gap, gap] + [0] * 11)
    lengths = [np.hypot(*(points[b] - points[a])) for a, b, _ in rows]
    normals = [(points[b] - points[a])[::-1] * [1, -1] / l for (a, b, _), l in zip(rows, lengths)]
    stress = np.array([[-1.0, shear], [shear, 0]])
    slid = 0.0 if moved is None else moved + 4 * shear
    up = lambda x, body: 2 * shear * (x[0] - 2) + (0.0 if body else slid)
    v = lambda x, body: np.array([sunk + ((2 - x[0]) / young if body else 1 / young + gap + pressed + (1 - x[0]) * (1 - grown)), up(x, body)])
    whose = np.zeros(len(points), int)
    for t, corners in enumerate(triangles):
        whose[list(corners)] = bodies[t]
    u = np.array([v(x, body) for x, body in zip(points, whose)])
    inside = []
    for corners in triangles:
        p = u[list(corners)]
        centre = p.mean(0)
        inside += [centre, *((p[i] + centre) / 2 for i in range(3))]
    mesh = {
        "points": points,
        "triangles": np.array(triangles, np.int32),
        "bodies": np.array(bodies, np.int32),
        "edges": np.array(rows, np.int32),
        "names": np.frombuffer("\n".join(names).encode(), np.uint8),
        "pairs": np.array(pairs, np.int32).reshape(-1, 7),
        "pair_data": np.array(data, float).reshape(-1, 20),
    }
    energy = -thickness * (0.5 + 0.5 / young + gap - grown + (sunk + pressed) / 2 + 2 * shear**2)
    if moved is not None:  # no load works, and friction does where it slides
        energy = thickness * (1 + 2 * shear**2 + abs(shear * slid))
    manifest = {
        "format": 1,
        "program": "by hand",
        "scene": "blocks",
        "scene_sha256": hashlib.sha256(text).hexdigest(),
        "origin": [0.0, 0.0],
        "bodies": ["left", "right"],
        "contacts": [] if layer else ["face|seat"],
        "claim": {"lower": energy - 1e-12, "upper": energy + 1e-12, "upper_from": "by hand"},
        "notes": [],
        "mesh_files": [],
    }
    count = degree + 1
    arrays = {"manifest": manifest, "scene": np.frombuffer(text, np.uint8)}
    arrays |= {f"stress_{k}": x for k, x in mesh.items()}
    arrays["stress_degrees"] = np.full(len(triangles), degree, np.uint8)
    arrays["traction_counts"] = np.full(len(rows), count, np.uint8)
    arrays["tractions"] = np.repeat([stress @ n for n in normals], count, 0)
    arrays["pressure_counts"] = np.full(len(pairs), count, np.uint8)
    arrays["pressures"] = np.full(len(pairs) * count, -1.0)
    if bound is not None:
        arrays["friction_counts"] = np.full(len(pairs), count, np.uint8)
        arrays["frictions"] = np.full(len(pairs) * count, shear)
    arrays |= {f"displacement_{k}": x.copy() for k, x in mesh.items()}
    arrays["displacement_degrees"] = np.full(len(triangles), 2, np.uint8)
    arrays["u_vertices"] = u
    arrays["u_edge_counts"] = np.ones(len(rows), np.uint8)
    arrays["u_edges"] = np.array([(u[a] + u[b]) / 2 for a, b, _ in rows])
    arrays["u_inside"] = np.array(inside)
    return arrays


def write(arrays, path, digest=True):
    """The proof file of arrays; `manifest` is a dictionary."""
    sums, files = hashlib.sha256(), []
    for name, array in arrays.items():
        if name == "manifest":
            array = np.frombuffer(json.dumps(array).encode(), np.uint8)
        content = io.BytesIO()
        np.save(content, array)
        files.append((name, content.getvalue()))
        sums.update(name.encode() + content.getvalue())
    content = io.BytesIO()
    np.save(content, np.frombuffer(sums.digest() if digest else bytes(32), np.uint8))
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in [*files, ("digest", content.getvalue())]:
            archive.writestr(f"{name}.npy", content)


def with_scene(arrays, change):
    """Turns the proof into one for the scene whose text is `change` of its own."""
    text = change(bytes(arrays["scene"]).decode())
    arrays["scene"] = np.frombuffer(text.encode(), np.uint8)
    arrays["manifest"]["scene_sha256"] = hashlib.sha256(text.encode()).hexdigest()


def in_scene(old, new):
    """The change of a proof into one for the scene with `new` in the place of `old`."""
    return lambda a: with_scene(a, lambda text: text.replace(old, new))


def refused(path, arrays, change, why):
    """The proof is not accepted once `change` was made to it, for the reason `why`; the file is at `path` then."""
    change(arrays)
    write(arrays, path)
    with pytest.raises(Refused, match=why):
        check(path)


def refused_once_changed(path, arrays, change, why):
    """As `refused`, of a proof that is accepted as it is."""
    write(arrays, path)
    check(path)
    refused(path, arrays, change, why)
