"""The scene of two blocks in CalculiX and in GetFEM: their own elements, contact and solvers."""

import re
import subprocess

import numpy as np


def edge_forces(problem, degree=1):
    """Edges under tractions, and consistent forces of these at the two ends and, of degree 2, the middle."""
    for edge, condition in zip(problem["edges"], problem["conditions"]):
        if condition["kind"] == "traction" and np.any(condition["values"]):
            length = np.linalg.norm(np.subtract(*problem["points"][edge]))
            a, b = np.array(condition["values"])
            shares = [2 * a + b, a + 2 * b] if degree == 1 else [a, b, 2 * (a + b)]
            yield edge, [length / 6 * share for share in shares]


def nodal_forces(problem):
    """Consistent forces of the tractions on linear elements, (vertices, 2)."""
    forces = np.zeros_like(problem["points"])
    for edge, shares in edge_forces(problem):
        for vertex, share in zip(edge, shares):
            forces[vertex] += share
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


class Body:
    """One body in GetFEM: continuous elements of degree 1 or 2, a variable of its own, contact rows to come."""

    def __init__(self, getfem, problem, number, degree, young):
        self.points, self.degree, self.name = problem["points"], degree, f"u{number}"
        self.triangles = problem["triangles"][problem["body"] == number]
        self.mesh = getfem.Mesh("empty", 2)
        for corners in self.triangles:
            self.mesh.add_convex(getfem.GeoTrans("GT_PK(2,1)"), self.points[corners].T)
        self.space = getfem.MeshFem(self.mesh, 2)
        self.space.set_fem(getfem.Fem(f"FEM_PK(2,{degree})"))
        self.rule = getfem.MeshIm(self.mesh, getfem.Integ("IM_TRIANGLE(4)"))
        self.nodes = self.space.basic_dof_nodes()[:, ::2].T
        self.number = {self.key(x): k for k, x in enumerate(self.nodes)}
        poisson = problem["bodies"][number]["poisson"]
        self.shear = young / (2 + 2 * poisson)
        self.lame = 2 * self.shear * poisson / (1 - 2 * poisson)

    @staticmethod
    def key(point):
        return tuple(np.round(point, 9).tolist())

    def along(self, *corners):
        """Nodes at the corners of an edge or a triangle, then in the middles of its sides."""
        at = self.points[list(corners)]
        sides = {2: [(0, 1)], 3: [(0, 1), (1, 2), (2, 0)]}[len(at)] if self.degree == 2 else []
        return [self.number[self.key(x)] for x in [*at, *(0.5 * (at[i] + at[j]) for i, j in sides)]]


def getfem(problem, degree, young=(1.0, 1.0)):
    """Points, triangles and displacements of GetFEM, contact by multipliers at the nodes that are pushed or free."""
    import getfem

    model = getfem.Model("real")
    bodies = [Body(getfem, problem, number, degree, young[number]) for number in range(2)]
    held = [set(), set()]
    for edge, condition in zip(problem["edges"].tolist(), problem["conditions"]):
        if condition["kind"] == "clamped":
            held[1] |= {2 * k + axis for k in bodies[1].along(*edge) for axis in range(2)}
        elif condition["kind"] == "roller":
            held[0] |= {2 * k + 1 for k in bodies[0].along(*edge)}
    for body, fixed in zip(bodies, map(sorted, held)):
        model.add_fem_variable(body.name, body.space)
        model.add_initialized_data(f"lame_{body.name}", body.lame)
        model.add_initialized_data(f"shear_{body.name}", body.shear)
        model.add_isotropic_linearized_elasticity_brick(body.rule, body.name, f"lame_{body.name}", f"shear_{body.name}")
        rows = getfem.Spmat("empty", len(fixed), body.space.nbdof())
        for row, unknown in enumerate(fixed):
            rows.add(row, unknown, 1.0)
        model.add_variable(f"hold_{body.name}", len(fixed))
        model.add_constraint_with_multipliers(body.name, f"hold_{body.name}", rows, np.zeros(len(fixed)))
    load = np.zeros(bodies[0].space.nbdof())
    for edge, shares in edge_forces(problem, degree):
        for k, share in zip(bodies[0].along(*edge), shares):
            load[2 * k : 2 * k + 2] += share
    model.add_explicit_rhs(bodies[0].name, load)
    pairs = problem["interfaces"][0]["pairs"]
    sites = sorted({site for p in pairs for site in zip(bodies[0].along(*p["first"]), bodies[1].along(*p["second"]))})
    jump = [getfem.Spmat("empty", len(sites), body.space.nbdof()) for body in bodies]
    for row, site in enumerate(sites):
        for side, sign in enumerate((1.0, -1.0)):
            # The blocks meet at x = 1.
            jump[side].add(row, 2 * site[side], sign)
    model.add_variable("pressure", len(sites))
    model.add_initialized_data("augmentation", [1.0])
    names = [body.name for body in bodies]
    model.add_basic_contact_brick_two_deformable_bodies(*names, "pressure", "augmentation", *jump)
    model.solve("max_res", 1e-13, "max_iter", 100)
    first = [0, len(bodies[0].nodes)]
    triangles = [[f + k for k in body.along(*t)] for f, body in zip(first, bodies) for t in body.triangles]
    values = [model.variable(body.name).reshape(-1, 2) for body in bodies]
    return np.concatenate([body.nodes for body in bodies]), np.array(triangles), np.concatenate(values)
