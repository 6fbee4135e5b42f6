"""Writes displacement fields of a body of revolution by scikit-fem: `revolved.py FOLDER SEED CELLS NAME...`.

CELLS is T3, T6, Q4, Q8 or Q9. The section is [a, a + 1] x [0, 1] on a mesh distorted by SEED; E = 1, nu = 0.3, a body force, a
pressure outside and a traction on top that varies. NAME is `axis` (a = 0) or `hole` (a = 0.4), with `_foot` where a rigid obstacle is
below it in place of rollers, or after a colon one of the mistakes of `MISTAKES`, an order of integration, or an element of CalculiX. The mesh is
mesh.msh of a folder NAME. Prints as JSON the energy of each field by a rule of high order, of the full turn.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np
import skfem

POISSON = 0.3
ELEMENTS = {"T3": skfem.ElementTriP1, "T6": skfem.ElementTriP2, "Q4": skfem.ElementQuad1, "Q8": skfem.ElementQuadS2,
            "Q9": skfem.ElementQuad2}
SHAPES = {"T3": "triangle", "T6": "triangle6", "Q4": "quad", "Q8": "quad8", "Q9": "quad9"}
FULL = {"T3": 2, "T6": 4, "Q4": 3, "Q8": 5, "Q9": 5}
MISTAKES = {
    "young": {"young": 1.05},
    "poisson": {"poisson": 0.35},
    "hoop": {"hoop": 0.0},
    "plane": {"hoop": 0.0, "weighted": False},
    "weight": {"weighted": False},
    "turn": {"load": 2 * np.pi},
    "loads": {"loads_weighted": False},
    "top": {"top": 1.1},
    "weightless": {"pull": (0.0, 0.0)},
    "lifted": {"pull": (-0.02, 0.05)},
    "across": {"pull": (-0.05, 0.02)},
    "uniform": {"slope": 0.0},
    "held": {"held": True},
    "value": {"moved": 1e-3},
    "exact-loads": {"order_of_loads": 12},
    "reduced": {"order": 3},
    "reduced-stiffness": {"order": 3, "order_of_loads": 5},
    "light": {"body_weighted": False},
    "part": {"pull": (0.02 / (2 * np.pi), -0.05 / (2 * np.pi))},
}


def mesh(cells, seed, inner, n):
    grid = skfem.MeshQuad.init_tensor(np.linspace(inner, inner + 1, n + 1), np.linspace(0, 1, n + 1))
    move = np.random.default_rng(seed).uniform(-0.2 / n, 0.2 / n, grid.p.shape)
    for c, ends in ((0, (inner, inner + 1)), (1, (0, 1))):
        move[c, np.isin(grid.p[c], ends)] = 0.0
    grid = skfem.MeshQuad(grid.p + move, grid.t)
    return grid.to_meshtri() if cells[0] == "T" else grid


class Body:
    def __init__(self, cells, grid, inner, young=1.0, poisson=POISSON, hoop=1.0, weighted=True, loads_weighted=True,
                 body_weighted=True, load=1.0, top=1.0, order=None, order_of_loads=None, pull=(0.02, -0.05), slope=1.0, held=False, moved=0.0):
        self.cells, self.grid, self.inner, self.held, self.moved = cells, grid, inner, held, moved
        self.space = skfem.ElementVector(ELEMENTS[cells]())
        self.basis = skfem.Basis(grid, self.space, intorder=order or FULL[cells])
        lame, shear = poisson * young / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))

        def weight(w, on):
            return w.x[0] if on else np.full_like(w.x[0], inner + 0.5)

        @skfem.BilinearForm
        def form(u, v, w):
            def strain(x):
                return x.grad[0, 0], x.grad[1, 1], hoop * x.value[0] / w.x[0], 0.5 * (x.grad[0, 1] + x.grad[1, 0])

            e, d = strain(u), strain(v)
            return weight(w, weighted) * (
                lame * (e[0] + e[1] + e[2]) * (d[0] + d[1] + d[2])
                + 2 * shear * (e[0] * d[0] + e[1] * d[1] + e[2] * d[2] + 2 * e[3] * d[3]))

        @skfem.LinearForm
        def body(v, w):
            return load * weight(w, weighted and loads_weighted and body_weighted) * (pull[0] * v.value[0] + pull[1] * v.value[1])

        @skfem.LinearForm
        def outside(v, w):
            return -load * weight(w, weighted and loads_weighted) * 0.3 * v.value[0]

        @skfem.LinearForm
        def above(v, w):
            r = w.x[0]
            return top * load * weight(w, weighted and loads_weighted) * (-0.8 + slope * r - inner) * v.value[1]

        def side(axis, at):
            return skfem.FacetBasis(grid, self.space, facets=grid.facets_satisfying(lambda x: abs(x[axis] - at) < 1e-9),
                                    intorder=8)

        self.form, self.body = form, body
        self.tractions = outside.assemble(side(0, inner + 1)) + above.assemble(side(1, 1))
        of_loads = skfem.Basis(grid, self.space, intorder=order_of_loads or order or FULL[cells])
        self.k, self.f = form.assemble(self.basis), body.assemble(of_loads) + self.tractions
        self.component = np.zeros(self.basis.N, int)
        self.component[self.basis.nodal_dofs[1]] = 1
        for dofs in (self.basis.facet_dofs, self.basis.interior_dofs):
            if len(dofs):
                self.component[dofs[1]] = 1

    def solve(self, contact):
        r, z = self.basis.doflocs
        held = (abs(r) < 1e-12) & (self.component == 0)
        foot = np.flatnonzero((abs(z) < 1e-12) & (self.component == 1))
        if self.held:
            held |= (abs(z) < 1e-12) & (self.component == 0)
        active = np.ones(len(foot), bool)
        for _ in range(50):
            fixed = np.concatenate([np.flatnonzero(held), foot[active]])
            u = skfem.solve(*skfem.condense(self.k, self.f, D=fixed))
            u[np.argmin((r - self.inner - 0.6) ** 2 + (z - 0.6) ** 2)] += self.moved
            if not contact:
                return u
            reaction = (self.k @ u - self.f)[foot]
            now = np.where(active, reaction > 0, u[foot] < 0)
            if (now == active).all():
                return u
            active = now
        raise SystemExit("no contact state")

    def energy(self, u):
        fine = skfem.Basis(self.grid, self.space, intorder=12 if self.cells[0] == "T" else 24)
        k, f = self.form.assemble(fine), self.body.assemble(fine) + self.tractions
        return 2 * np.pi * (0.5 * u @ (k @ u) - f @ u)

    def nodes(self):
        """Points, cells, and the numbers of their two displacements."""
        b, grid = self.basis, self.grid
        dofs, points, cells = [b.nodal_dofs], [grid.p], [grid.t]
        count = grid.p.shape[1]
        if self.cells not in ("T3", "Q4"):
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
        """The displacements of CalculiX on rollers under the nodal forces of this model, which count for the full turn there."""
        points, cells, dofs = self.nodes()
        corners = 3 if self.cells[0] == "T" else 4
        order = {3: [0, 2, 1], 4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 7, 6, 5, 4], 6: [0, 2, 1, 5, 4, 3]}[cells.shape[1]]
        rows = ["*NODE, NSET=ALL", *(f"{i + 1}, {x:.13e}, {y:.13e}, 0" for i, (x, y) in enumerate(points))]
        rows.append(f"*ELEMENT, TYPE={kind}, ELSET=ALL")
        for i, cell in enumerate(cells):
            x, y = points[cell[:corners]].T
            counter_clockwise = x @ np.roll(y, -1) > y @ np.roll(x, -1)
            rows.append(", ".join(str(n) for n in [i + 1, *((cell if counter_clockwise else cell[order]) + 1)]))
        rows += ["*MATERIAL, NAME=M", "*ELASTIC", f"1.0, {POISSON}", "*SOLID SECTION, ELSET=ALL, MATERIAL=M", "1.0", "*BOUNDARY"]
        rows += [f"{i + 1}, 2, 2" for i, (_, z) in enumerate(points) if z < 1e-9]
        rows += [f"{i + 1}, 1, 1" for i, (r, _) in enumerate(points) if r < 1e-9]
        rows += ["*STEP", "*STATIC", "*CLOAD"]
        rows += [f"{i + 1}, {c + 1}, {2 * np.pi * self.f[dofs[c, i]]:.13e}" for i in range(len(points)) for c in range(2)]
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

    def write(self, folder, u):
        points, cells, dofs = self.nodes()
        flat = np.zeros((len(points), 1))
        out = meshio.Mesh(np.hstack([points, flat]), [(SHAPES[self.cells], cells)],
                          point_data={"u": np.hstack([u[dofs].T, flat])})
        meshio.write(folder / "field.vtu", out)
        out.point_data = {}
        meshio.write(folder / "mesh.msh", out, file_format="gmsh22", binary=False)


def main():
    folder, seed, cells, *names = sys.argv[1:]
    told = {}
    for name in names:
        scene, _, mistake = name.partition(":")
        inner = 0.0 if scene.startswith("axis") else 0.4
        options = {"order": int(mistake)} if mistake.isdigit() else MISTAKES.get(mistake, {})
        made = Body(cells, mesh(cells, int(seed), inner, 3), inner, **options)
        u = made.calculix(mistake) if mistake.startswith("CAX") else made.solve(scene.endswith("_foot"))
        own = pathlib.Path(folder, name.replace(":", "-"))
        own.mkdir()
        made.write(own, u)
        told[name] = Body(cells, made.grid, inner).energy(u)
    print(json.dumps(told))


main()
