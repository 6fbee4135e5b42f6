"""A square plate on rollers under a traction: a scene with its mesh, as a file of another program."""

PLATE = """
model.kinematics = "plane-stress"
mesh.file = "plate.msh"
bodies.plate = { young = 2.0, poisson = 0.25 }
supports = [{ on = "left", type = "roller" }, { on = "bottom", type = "roller" }]
tractions = [{ on = "right", value = [1.0, 0.5], gradient = [[0.0, 0.3], [0.0, 0.0]] }]
"""


def written(folder):
    """The scene of a square, and its mesh."""
    n = 4
    at = lambda i, j: 1 + i + (n + 1) * j
    nodes = [f"{at(i, j)} {i / n} {j / n} 0" for j in range(n + 1) for i in range(n + 1)]
    sides = {"left": [(at(0, k), at(0, k + 1)) for k in range(n)], "bottom": [(at(k, 0), at(k + 1, 0)) for k in range(n)]}
    sides["right"] = [(at(n, k), at(n, k + 1)) for k in range(n)]
    cells = [f"1 2 {tag} {tag} {a} {b}" for tag, name in enumerate(sides, 1) for a, b in sides[name]]
    squares = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(n) for i in range(n)]
    cells += [f"2 2 9 9 {a} {b} {c}" for p, q, r, s in squares for a, b, c in ((p, q, r), (p, r, s))]
    names = [f'1 {tag} "{name}"' for tag, name in enumerate(sides, 1)] + ['2 9 "plate"']
    parts = {"MeshFormat": ["2.2 0 8"], "PhysicalNames": [len(names), *names], "Nodes": [len(nodes), *nodes]}
    parts["Elements"] = [len(cells), *(f"{k} {cell}" for k, cell in enumerate(cells, 1))]
    text = "".join(f"${part}\n" + "".join(f"{line}\n" for line in lines) + f"$End{part}\n" for part, lines in parts.items())
    (folder / "plate.msh").write_text(text)
    (folder / "plate.toml").write_text(PLATE)
    return folder / "plate.toml"
