"""Scenes with meshes of their own, written as files and described for the numpy model without the Rust reader."""

import numpy as np


def two_blocks(folder, n, load=(4.0, -7.0)):
    """Scene file and problem of two unit blocks, n x n squares each, cut along alternating diagonals."""
    points, triangles, body, lines = [], [], [], []
    for block in range(2):
        base = len(points)
        points += [[block + i / n, j / n] for j in range(n + 1) for i in range(n + 1)]
        at = lambda i, j: base + j * (n + 1) + i
        for j in range(n):
            for i in range(n):
                a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
                cut = [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
                triangles += cut
                body += [block, block]
        side = [("roller", [at(k, 0) for k in range(n + 1)])] if block == 0 else []
        side += [("load" if block == 0 else "right_face", [at(0, k) for k in range(n + 1)])]
        side += [("left_face" if block == 0 else "wall", [at(n, k) for k in range(n + 1)])]
        lines += side
    scene = folder / "scene.toml"
    scene.write_text(f"""
[model]
kinematics = "plane-strain"
[mesh]
file = "mesh.msh"
[bodies.left]
young = 1.0
poisson = 0.3
[bodies.right]
young = 1.0
poisson = 0.3
[[supports]]
on = "wall"
type = "clamped"
[[supports]]
on = "roller"
type = "roller"
[[tractions]]
on = "load"
value = [{load[0]}, 0.0]
gradient = [[0.0, {load[1]}], [0.0, 0.0]]
[[contacts]]
between = ["left_face", "right_face"]
""")
    (folder / "mesh.msh").write_text(gmsh(points, triangles, body, lines))
    return scene, described(np.array(points), triangles, body, dict(lines), load)


def gmsh(points, triangles, body, lines):
    """MSH 2.2."""
    names = ["left", "right"] + [name for name, _ in lines]
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    text += [f'{2 if k < 2 else 1} {k + 1} "{name}"' for k, name in enumerate(names)]
    text += ["$EndPhysicalNames", "$Nodes", str(len(points))]
    text += [f"{k + 1} {x!r} {y!r} 0" for k, (x, y) in enumerate(points)]
    cells = [f"1 2 {k + 3} {k + 3} {a + 1} {b + 1}" for k, (_, line) in enumerate(lines) for a, b in zip(line, line[1:])]
    cells += [f"2 2 {b + 1} {b + 1} " + " ".join(str(v + 1) for v in t) for t, b in zip(triangles, body)]
    text += ["$EndNodes", "$Elements", str(len(cells))]
    text += [f"{k + 1} {cell}" for k, cell in enumerate(cells)] + ["$EndElements", ""]
    return "\n".join(text)


def described(points, triangles, body, lines, load):
    """The problem in the form of `hypercircle.problem`."""
    seen = {}
    for t in triangles:
        for i in range(3):
            a, b = t[(i + 1) % 3], t[(i + 2) % 3]
            seen.setdefault(frozenset((a, b)), []).append((a, b))
    of = {frozenset(pair): name for name, line in lines.items() for pair in zip(line, line[1:])}
    edges, conditions = [], []
    for key, ways in seen.items():
        edges.append(ways[0])
        name = of.get(key)
        if len(ways) == 2:
            conditions.append({"kind": "interior"})
        elif name in ("left_face", "right_face"):
            conditions.append({"kind": "contact"})
        elif name == "wall":
            conditions.append({"kind": "clamped", "displacement": [0.0, 0.0]})
        elif name == "roller":
            conditions.append({"kind": "roller"})
        else:
            value = lambda v: [load[0] + load[1] * points[v][1], 0.0] if name == "load" else [0.0, 0.0]
            conditions.append({"kind": "traction", "values": [value(v) for v in ways[0]]})
    left, right = lines["left_face"], lines["right_face"]
    pairs = [
        {"first": [left[k], left[k + 1]], "second": [right[k], right[k + 1]], "gap": [0.0, 0.0]}
        for k in range(len(left) - 1)
    ]
    material = {"young": 1.0, "poisson": 0.3, "body_force": [0.0, 0.0]}
    return {
        "kinematics": "plane-strain",
        "thickness": 1.0,
        "bodies": [material, material],
        "points": points,
        "triangles": triangles,
        "body": body,
        "edges": edges,
        "conditions": conditions,
        "interfaces": [{"name": "left_face|right_face", "pairs": pairs}],
    }


# Everything at once: plane stress, thickness, weight, two materials, a gap that opens, a wall that moves, an inclined roller.
RICH = """
[model]
kinematics = "plane-stress"
thickness = 0.7
[geometry]
size = 0.5
[[geometry.polygons]]
body = "upper"
points = [[0, 1], [1.5, 1], [1.5, 2], [0.25, 2.25]]
edges = ["upper_face", "", "load", "slant"]
[[geometry.polygons]]
body = "lower"
points = [[0, 0], [1.5, 0], [1.5, 1], [0, 1]]
edges = ["foot", "side", "lower_face", "wall"]
[bodies.upper]
young = 3.0
poisson = 0.2
body_force = [0.3, -0.4]
[bodies.lower]
young = 0.8
poisson = -0.3
body_force = [0.1, -0.2]
[[supports]]
on = "wall"
type = "clamped"
displacement = [0.02, -0.03]
[[supports]]
on = "side"
type = "roller"
[[supports]]
on = "slant"
type = "roller"
[[tractions]]
on = "load"
value = [-0.35, -0.5]
gradient = [[0.0, 0.0], [0.25, 0.0]]
[[contacts]]
between = ["upper_face", "lower_face"]
gap = [[0.0, 0.0], [0.75, 0.05], [1.5, 0.2]]
[[contacts]]
on = "foot"
gap = 0.1
"""
