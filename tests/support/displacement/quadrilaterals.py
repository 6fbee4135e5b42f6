"""Writes displacement fields of quadrilaterals and six-node triangles by scikit-fem: `quadrilaterals.py FOLDER SEED CELLS NAME...`.

CELLS is Q4, Q8, Q9 or T6. The body is [0, 2] x [0, 1] on a mesh distorted at random by SEED (0: of rectangles); plane strain,
E = 1, nu = 0.3, a weight and a traction on its top. NAME is `clamped` (at x = 0 and there alone) or `foot` (rollers at x = 0, a rigid
obstacle below it), or after a colon one of the mistakes of `MISTAKES`, or for `clamped` an element of CalculiX. The mesh is mesh.msh. Prints as JSON the energy
of each field by a rule of high order; `SCENE:finer` writes nothing and has the energy of a solution on a finer mesh.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np
import scipy.sparse
import skfem
from skfem.helpers import ddot, sym_grad

YOUNG, POISSON = 1.0, 0.3
WEIGHT = np.array([0.02, -0.05])
TOP = np.array([[0.03, -0.10], [0.01, 0.12]])  # at x = 0, and its slope along x
ELEMENTS = {"Q4": skfem.ElementQuad1, "Q8": skfem.ElementQuadS2, "Q9": skfem.ElementQuad2, "T6": skfem.ElementTriP2}
SHAPES = {"Q4": "quad", "Q8": "quad8", "Q9": "quad9", "T6": "triangle6"}
FULL = {"Q4": 3, "Q8": 5, "Q9": 5, "T6": 4}
REDUCED = {"Q4": 1, "Q8": 3, "Q9": 3, "T6": 1}
MISTAKES = {
    "young": {"young": 1.05},
    "poisson": {"poisson": 0.35},
    "load": {"top": 1.1},
    "weight": {"weight": 0.5},
    "lumped": {"lumped": True},
    "reduced": {"reduced": True},
    "selective": {"selective": True},
    "mean": {"element": "mean"},
    "bbar": {"element": "bbar"},
    "incompatible": {"element": "incompatible"},
    "hourglass": {"element": "hourglass"},
    "value": {"value": 0.01},
    "axes": {"axes": True},
    "exact": {"order": 20},
}


def mesh(cells, seed, n):
    """Distorted inside and along its sides by a seed that is not 0."""
    grid = skfem.MeshQuad.init_tensor(np.linspace(0, 2, 2 * n + 1), np.linspace(0, 1, n + 1))
    p = grid.p.copy()
    if seed:
        random = np.random.default_rng(seed)
        move = random.uniform(-0.3 / n, 0.3 / n, p.shape)
        for c, ends in ((0, (0, 2)), (1, (0, 1))):
            at_end = np.isin(p[c], ends)
            move[c, at_end] = 0.0
        p = p + move
    grid = skfem.MeshQuad(p, grid.t)
    return grid.to_meshtri() if cells == "T6" else grid


def four_nodes(basis, grid, kind, lame, shear):
    """The stiffness of elements with four nodes beyond their plain one, put together node by node."""
    sign = np.array([[-1, 1, 1, -1], [-1, -1, 1, 1]])
    gauss = [(s / np.sqrt(3), t / np.sqrt(3)) for s in (-1, 1) for t in (-1, 1)]
    law = np.array([[lame + 2 * shear, lame, lame, 0], [lame, lame + 2 * shear, lame, 0], [lame, lame, lame + 2 * shear, 0],
                    [0, 0, 0, shear]])

    def gradients(x, s, t):
        d = 0.25 * np.array([sign[0] * (1 + sign[1] * t), sign[1] * (1 + sign[0] * s)])
        jacobian = d @ x.T
        return np.linalg.solve(jacobian, d), jacobian

    def strain(g):
        rows = np.zeros((4, 2 * g.shape[1]))
        rows[0, 0::2], rows[1, 1::2], rows[3, 0::2], rows[3, 1::2] = g[0], g[1], g[1], g[0]
        return rows

    out = np.zeros((basis.N, basis.N))
    volume = np.array([1.0, 1.0, 1.0, 0.0])
    for cell in grid.t.T:
        x = grid.p[:, cell]
        at = [(strain(g), abs(np.linalg.det(j)), j, place) for place in gauss for g, j in [gradients(x, *place)]]
        area = sum(w for _, w, _, _ in at)
        mean = sum(w * (volume @ b) for b, w, _, _ in at) / area
        k = np.zeros((8, 8))
        if kind == "bbar":
            for b, w, _, _ in at:
                b = b + np.outer(volume, mean - volume @ b) / 3
                k += w * b.T @ law @ b
        elif kind == "mean":
            k += area * lame * np.outer(mean, mean)
            for b, w, _, _ in at:
                k += w * b.T @ np.diag([2 * shear, 2 * shear, 2 * shear, shear]) @ b
        elif kind == "incompatible":
            _, centre = gradients(x, 0, 0)
            rows = np.zeros((12, 12))
            for b, w, _, (s, t) in at:
                g = np.linalg.solve(centre, np.array([[-2 * s, 0], [0, -2 * t]])) * abs(np.linalg.det(centre)) / w
                whole = np.hstack([b, strain(g)])
                rows += w * whole.T @ law @ whole
            k = rows[:8, :8] - rows[:8, 8:] @ np.linalg.solve(rows[8:, 8:], rows[8:, :8])
        else:
            g, j = gradients(x, 0, 0)
            b, signs = strain(g), np.array([1.0, -1.0, 1.0, -1.0])
            gamma = signs - (x @ signs) @ g
            k = 4 * abs(np.linalg.det(j)) * b.T @ law @ b + 0.2 * shear * np.kron(np.outer(gamma, gamma), np.eye(2))
        dofs = basis.nodal_dofs[:, cell].T.ravel()
        out[np.ix_(dofs, dofs)] += k
    return scipy.sparse.csr_matrix(out)


class Body:
    def __init__(self, cells, grid, young=1.0, poisson=POISSON, top=1.0, weight=1.0, lumped=False, reduced=False,
                 selective=False, value=0.0, axes=False, order=None, element=None):
        space = skfem.ElementVector(ELEMENTS[cells]())
        order = order if order and cells != "T6" else (REDUCED if reduced else FULL)[cells]
        self.cells, self.grid, self.value, self.axes = cells, grid, value, axes
        self.basis = skfem.Basis(grid, space, intorder=order)
        lame = poisson * young * YOUNG / ((1 + poisson) * (1 - 2 * poisson))
        shear = young * YOUNG / (2 * (1 + poisson))

        def stiffness(volume, deviator):
            @skfem.BilinearForm
            def form(u, v, w):
                e, d = sym_grad(u), sym_grad(v)
                return volume * lame * (e[0, 0] + e[1, 1]) * (d[0, 0] + d[1, 1]) + deviator * 2 * shear * ddot(e, d)
            return form

        @skfem.LinearForm
        def body(v, w):
            return weight * (WEIGHT[0] * v[0] + WEIGHT[1] * v[1])

        @skfem.LinearForm
        def traction(v, w):
            p = [TOP[0][c] + TOP[1][c] * w.x[0] for c in range(2)]
            return top * (p[0] * v[0] + p[1] * v[1])

        self.form, self.loads = stiffness(1, 1), (body, traction)
        if selective:
            # One point where scikit-fem takes four.
            few = {"quadrature": (np.full((2, 1), 0.5), np.ones(1))} if cells == "Q4" else {"intorder": REDUCED[cells]}
            soft = skfem.Basis(grid, space, **few)
            self.k = stiffness(1, 0).assemble(soft) + stiffness(0, 1).assemble(self.basis)
        elif element:
            self.k = four_nodes(self.basis, grid, element, lame, shear)
        else:
            self.k = self.form.assemble(self.basis)
        high = skfem.Basis(grid, space, intorder=max(order, FULL[cells]))
        above = skfem.FacetBasis(grid, space, facets=grid.facets_satisfying(lambda x: x[1] > 1 - 1e-9), intorder=6)
        self.f = body.assemble(high) + traction.assemble(above)
        self.above = above
        if lumped:
            at = self.basis.nodal_dofs[:, np.unique(grid.facets[:, above.find])]
            total = traction.assemble(above)
            self.f -= total
            for c in range(2):
                self.f[at[c]] += total[self.basis.nodal_dofs[c]].sum() / at.shape[1] if at.size else 0.0

    def dofs(self, where):
        return self.basis.get_dofs(where)

    def solve(self, name):
        left = self.dofs(lambda x: x[0] < 1e-9)
        u = np.zeros(self.basis.N)
        if name == "clamped":
            u = skfem.solve(*skfem.condense(self.k, self.f, D=left))
        else:
            held = left.all("u^1")
            foot = self.dofs(lambda x: x[1] < 1e-9).all("u^2")
            active = np.ones(len(foot), bool)
            for _ in range(50):
                u = skfem.solve(*skfem.condense(self.k, self.f, D=np.concatenate([held, foot[active]])))
                reaction = (self.k @ u - self.f)[foot]
                now = np.where(active, reaction > 0, u[foot] < 0)
                if (now == active).all():
                    break
                active = now
            else:
                raise SystemExit("no contact state")
        if self.value:
            at = self.basis.nodal_dofs[0, np.argmin(np.linalg.norm(self.grid.p - [[1.1], [0.5]], axis=0))]
            u[at] += self.value * np.abs(u).max()
        return u

    def energy(self, u):
        """By a rule of high order."""
        fine = skfem.Basis(self.grid, self.basis.elem, intorder=8 if self.cells == "T6" else 24)
        k, f = self.form.assemble(fine), self.loads[0].assemble(fine) + self.loads[1].assemble(self.above)
        return 0.5 * u @ (k @ u) - f @ u

    def nodes(self):
        """Points, cells, and the numbers of their two displacements."""
        b, grid = self.basis, self.grid
        dofs, points, cells = [b.nodal_dofs], [grid.p], [grid.t]
        count = grid.p.shape[1]
        if self.cells != "Q4":
            dofs.append(b.facet_dofs)
            points.append(grid.p[:, grid.facets].mean(axis=1))
            cells.append(grid.t2f + count)
            count += grid.facets.shape[1]
        if self.cells == "Q9":
            dofs.append(b.interior_dofs)
            points.append(grid.p[:, grid.t].mean(axis=1))
            cells.append(np.arange(grid.t.shape[1])[None, :] + count)
        return np.concatenate(points, axis=1).T, np.concatenate(cells).T, np.concatenate(dofs, axis=1)

    def calculix(self, kind):
        """The displacements of CalculiX, clamped at x = 0, under the nodal forces of this model."""
        points, cells, dofs = self.nodes()
        corners = 3 if self.cells == "T6" else 4
        order = {4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 7, 6, 5, 4], 6: [0, 2, 1, 5, 4, 3]}[cells.shape[1]]
        rows = ["*NODE, NSET=ALL", *(f"{i + 1}, {x:.13e}, {y:.13e}, 0" for i, (x, y) in enumerate(points))]
        rows.append(f"*ELEMENT, TYPE={kind}, ELSET=ALL")
        for i, cell in enumerate(cells):
            x, y = points[cell[:corners]].T
            counter_clockwise = x @ np.roll(y, -1) > y @ np.roll(x, -1)
            rows.append(", ".join(str(n) for n in [i + 1, *((cell if counter_clockwise else cell[order]) + 1)]))
        rows += ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}", "*SOLID SECTION, ELSET=ALL, MATERIAL=M", "1.0"]
        rows += ["*BOUNDARY", *(f"{i + 1}, 1, 2" for i, (x, _) in enumerate(points) if x < 1e-9), "*STEP", "*STATIC", "*CLOAD"]
        rows += [f"{i + 1}, {c + 1}, {self.f[dofs[c, i]]:.13e}" for i in range(len(points)) for c in range(2)]
        rows += ["*NODE PRINT, NSET=ALL", "U", "*END STEP", ""]
        u = np.zeros(self.basis.N)
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "job.inp").write_text("\n".join(rows), encoding="utf-8")
            subprocess.run(["ccx", "job"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            for line in pathlib.Path(folder, "job.dat").read_text(encoding="utf-8").splitlines():
                words = line.split()
                if len(words) == 4 and words[0].isdigit():
                    u[dofs[:, int(words[0]) - 1]] = [float(word) for word in words[1:3]]
        return u

    def write(self, file, u):
        points, cells, dofs = self.nodes()
        values = u[dofs].T
        if self.axes:
            values = values[:, ::-1]
        flat = np.zeros((len(points), 1))
        out = meshio.Mesh(np.hstack([points, flat]), [(SHAPES[self.cells], cells)],
                          point_data={"u": np.hstack([values, flat])})
        meshio.write(file, out)
        out.point_data = {}
        meshio.write(str(pathlib.Path(file).parent / "mesh.msh"), out, file_format="gmsh22", binary=False)


def main():
    folder, seed, cells, *names = sys.argv[1:]
    n = 4
    grid = mesh(cells, int(seed), n)
    told = {}
    for name in names:
        scene, _, mistake = name.partition(":")
        if mistake == "finer":
            made = Body("Q9", mesh("Q9", 0, 6 * n))
            told[name] = made.energy(made.solve(scene))
            continue
        made = Body(cells, grid, **MISTAKES.get(mistake, {}))
        u = made.calculix(mistake) if mistake.startswith("CP") else made.solve(scene)
        made.write(str(pathlib.Path(folder, f"{name.replace(':', '_')}.vtu")), u)
        told[name] = made.energy(u)
    print(json.dumps(told))


main()
