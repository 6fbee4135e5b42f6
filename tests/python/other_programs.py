"""The scene of two blocks in CalculiX: its own elements, contact and solver."""

import re
import subprocess

import numpy as np


def nodal_forces(problem):
    """Consistent forces of the tractions on linear elements, (vertices, 2)."""
    forces = np.zeros_like(problem["points"])
    for edge, condition in zip(problem["edges"], problem["conditions"]):
        if condition["kind"] == "traction":
            length = np.linalg.norm(np.subtract(*problem["points"][edge]))
            a, b = np.array(condition["values"])
            forces[edge[0]] += length / 6 * (2 * a + b)
            forces[edge[1]] += length / 6 * (a + 2 * b)
    return forces


def held(problem, kind):
    """Vertices of all edges of one kind of condition."""
    chosen = [edge for edge, condition in zip(problem["edges"], problem["conditions"]) if condition["kind"] == kind]
    return sorted(set(np.ravel(chosen).tolist()))


def calculix(problem, folder, stiffness=None, young=(1.0, 1.0)):
    """Displacements (vertices, 2) of CalculiX with linear plane strain elements.

    Contact is of nodes with faces, a linear law of ``stiffness`` N/mm³; without one the two sides are tied node to node.
    """
    points, triangles, body = problem["points"], problem["triangles"], problem["body"]
    deck = ["*NODE, NSET=ALL"] + [f"{k + 1}, {x!r}, {y!r}, 0." for k, (x, y) in enumerate(points.tolist())]
    for number, name in enumerate(("LEFT", "RIGHT")):
        deck += [f"*ELEMENT, TYPE=CPE3, ELSET={name}"]
        deck += [f"{k + 1}, " + ", ".join(str(v + 1) for v in t) for k, t in enumerate(triangles) if body[k] == number]
        deck += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young[number]!r}, {problem['bodies'][number]['poisson']!r}"]
        deck += [f"*SOLID SECTION, ELSET={name}, MATERIAL={name}", "1."]
    pairs = problem["interfaces"][0]["pairs"]
    slaves = sorted({v for pair in pairs for v in pair["first"]})
    if stiffness is None:
        twins = dict(zip([v for p in pairs for v in p["first"]], [v for p in pairs for v in p["second"]]))
        for axis in (1, 2):
            for slave, master in twins.items():
                # The first of the two follows, and a support may hold the slave.
                deck += ["*EQUATION", "2", f"{master + 1}, {axis}, 1., {slave + 1}, {axis}, -1."]
    else:
        deck += ["*SURFACE, NAME=SLAVE, TYPE=NODE"] + [f"{v + 1}," for v in slaves]
        deck += ["*SURFACE, NAME=MASTER"]
        for pair in pairs:
            number = next(k for k, t in enumerate(triangles) if set(pair["second"]) <= set(t.tolist()))
            opposite = triangles[number].tolist().index((set(triangles[number].tolist()) - set(pair["second"])).pop())
            deck += [f"{number + 1}, S{(opposite + 1) % 3 + 1}"]
        deck += ["*CONTACT PAIR, INTERACTION=PUSH, TYPE=NODE TO SURFACE", "SLAVE, MASTER", "*SURFACE INTERACTION, NAME=PUSH"]
        deck += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness!r}, 1e-12"]
    deck += ["*BOUNDARY"] + [f"{v + 1}, 1, 2" for v in held(problem, "clamped")]
    deck += [f"{v + 1}, 2, 2" for v in held(problem, "roller")]
    deck += ["*STEP", "*STATIC", "1., 1."]
    forces = nodal_forces(problem)
    deck += ["*CLOAD"] + [f"{v + 1}, {i + 1}, {forces[v, i]:.12e}" for v, i in zip(*np.nonzero(forces))]
    deck += ["*NODE PRINT, NSET=ALL", "U", "*END STEP", ""]
    (folder / "job.inp").write_text("\n".join(deck))
    ended = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True, timeout=120)
    printed = (folder / "job.dat").read_text() if (folder / "job.dat").exists() else ""
    rows = re.findall(r"^\s+(\d+)\s+(\S+)\s+(\S+)\s+\S+$", printed, re.MULTILINE)
    assert ended.returncode == 0 and len(rows) >= len(points), ended.stdout[-2000:]
    field = np.zeros((len(points), 2))
    for number, x, y in rows[-len(points):]:
        field[int(number) - 1] = float(x), float(y)
    return field
