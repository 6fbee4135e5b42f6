"""Writes solutions of scikit-fem for two blocks of quadrilaterals in contact: `quadrilateral_blocks.py FOLDER SEED CELLS NAME...`.

CELLS is Q4, Q8 or Q9. The blocks are [0, 2] x [0, 1] and [0, 2] x [1, 2], distorted at random by SEED, with other vertices on either side
of y = 1; plane strain, E = 1 and 2, nu = 0.3. The lower one is clamped at its foot, the upper one on a roller at x = 0 and pressed down
mostly on one end. Nodes of the upper block stay above the lower one. NAME is `right`, or one of the mistakes of `MISTAKES`. Writes the mesh to
blocks.msh and the fields to NAME.vtu.
"""

import pathlib
import sys

import meshio
import numpy as np
import scipy.sparse
import skfem
from skfem.helpers import ddot, sym_grad

ELEMENTS = {"Q4": skfem.ElementQuad1, "Q8": skfem.ElementQuadS2, "Q9": skfem.ElementQuad2}
SHAPES = {"Q4": "quad", "Q8": "quad8", "Q9": "quad9"}
FULL = {"Q4": 3, "Q8": 5, "Q9": 5}
REDUCED = {"Q4": 1, "Q8": 3, "Q9": 3}
YOUNG, POISSON = [1.0, 2.0], 0.3
MISTAKES = {
    "right": {},
    "young": {"young": [1.0, 2.1]},
    "load": {"top": 1.1},
    "reduced": {"reduced": True},
    "tied": {"tied": True},
    "value": {"value": 0.01},
    "open": {"contact": False},
}


def mesh(random, low, high, cells):
    """Distorted inside and along its sides."""
    grid = skfem.MeshQuad.init_tensor(*(np.linspace(low[c], high[c], cells[c] + 1) for c in range(2)))
    p = grid.p.copy()
    for c in range(2):
        step = (high[c] - low[c]) / cells[c]
        inside = (p[c] > low[c] + 1e-9) & (p[c] < high[c] - 1e-9)
        p[c, inside] += random.uniform(-0.25 * step, 0.25 * step, inside.sum())
    return skfem.MeshQuad(p, grid.t)


class Block:
    def __init__(self, cells, grid, young, reduced=False):
        space = skfem.ElementVector(ELEMENTS[cells]())
        self.cells, self.grid = cells, grid
        self.basis = skfem.Basis(grid, space, intorder=(REDUCED if reduced else FULL)[cells])
        lame = POISSON * young / ((1 + POISSON) * (1 - 2 * POISSON))
        shear = young / (2 * (1 + POISSON))

        @skfem.BilinearForm
        def form(u, v, w):
            e, d = sym_grad(u), sym_grad(v)
            return lame * (e[0, 0] + e[1, 1]) * (d[0, 0] + d[1, 1]) + 2 * shear * ddot(e, d)

        self.k = form.assemble(self.basis)

    def pressed(self, factor):
        @skfem.LinearForm
        def top(v, w):
            return -factor * (0.02 + 0.05 * w.x[0]) * v[1]

        grid = self.grid
        facets = grid.facets_satisfying(lambda x: x[1] > grid.p[1].max() - 1e-9)
        return top.assemble(skfem.FacetBasis(grid, self.basis.elem, facets=facets, intorder=6))

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

    def trace(self, x):
        """The nodes and weights of the displacement at (x, 1)."""
        points, _, _ = self.nodes()
        count = self.grid.p.shape[1]
        for number, facet in enumerate(self.grid.facets.T):
            ends = self.grid.p[:, facet]
            if np.abs(ends[1] - 1).max() > 1e-9 or not ends[0].min() - 1e-12 <= x <= ends[0].max() + 1e-12:
                continue
            t = (x - ends[0, 0]) / (ends[0, 1] - ends[0, 0])
            if self.cells == "Q4":
                return facet, np.array([1 - t, t])
            return np.append(facet, count + number), np.array([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
        raise SystemExit("nothing below")


def solve(blocks, top=1.0, tied=False, value=0.0, contact=True):
    sizes = [block.basis.N for block in blocks]
    k = scipy.sparse.block_diag([block.k for block in blocks]).tocsr()
    f = np.concatenate([np.zeros(sizes[0]), blocks[1].pressed(top)])
    places = [block.nodes() for block in blocks]
    rows = []
    points, _, dofs = places[1]
    for node in np.flatnonzero(np.abs(points[:, 1] - 1) < 1e-9):
        below, weights = blocks[0].trace(points[node, 0])
        for c in (1, 0) if tied else (1,):
            row = np.zeros(sum(sizes))
            row[sizes[0] + dofs[c, node]] = 1
            row[places[0][2][c, below]] -= weights
            rows.append(row)
    rows = np.array(rows)
    held = [blocks[0].basis.get_dofs(lambda x: x[1] < 1e-9).all()]
    left = blocks[1].basis.get_dofs(lambda x: x[0] < 1e-9)
    held.append(sizes[0] + left.all("u^1"))
    if not contact:
        held.append(sizes[0] + left.all("u^2"))
    free = np.setdiff1d(np.arange(len(f)), np.concatenate(held))
    active = np.ones(len(rows), bool)
    for _ in range(50):
        some = scipy.sparse.csr_matrix(rows[active][:, free]) if contact else scipy.sparse.csr_matrix((0, len(free)))
        whole = scipy.sparse.bmat([[k[free][:, free], some.T], [some, None]]) if contact else k[free][:, free]
        found = scipy.sparse.linalg.spsolve(whole.tocsc(), np.append(f[free], np.zeros(some.shape[0])))
        u = np.zeros(len(f))
        u[free] = found[: len(free)]
        if tied or not contact:
            break
        force = np.zeros(len(rows))
        force[active] = found[len(free):]
        # u + rows' force = f: a force below zero presses.
        now = np.where(active, force < 0, rows @ u < 0)
        if (now == active).all():
            break
        active = now
    else:
        raise SystemExit("no contact state")
    if not contact:
        return u
    if value:
        at = sizes[0] + blocks[1].basis.nodal_dofs[0, np.argmin(np.linalg.norm(blocks[1].grid.p - [[1.1], [1.5]], axis=0))]
        u[at] += value * np.abs(u).max()
    return u


def write(folder, blocks, name, u):
    points, cells, values = [], [], []
    split = [u[: blocks[0].basis.N], u[blocks[0].basis.N:]]
    for block, own in zip(blocks, split):
        p, c, dofs = block.nodes()
        cells.append(c + sum(len(q) for q in points))
        points.append(p)
        values.append(own[dofs].T)
    flat = np.zeros((sum(len(p) for p in points), 1))
    shape = SHAPES[blocks[0].cells]
    whole = np.hstack([np.concatenate(points), flat])
    tags = [np.full(len(c), i + 1) for i, c in enumerate(cells)]
    meshio.write(folder / f"{name}.vtu", meshio.Mesh(whole, [(shape, np.concatenate(cells))],
                                                    point_data={"u": np.hstack([np.concatenate(values), flat])}))
    out = meshio.Mesh(whole, [(shape, c) for c in cells], cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags})
    meshio.write(folder / "blocks.msh", out, file_format="gmsh22", binary=False)


def main():
    folder, seed, cells, *names = sys.argv[1:]
    random = np.random.default_rng(int(seed))
    grids = [mesh(random, [0, 0], [2, 1], [7, 3]), mesh(random, [0, 1], [2, 2], [5, 3])]
    for name in names:
        told = dict(MISTAKES[name])
        young, reduced = told.pop("young", YOUNG), told.pop("reduced", False)
        blocks = [Block(cells, grid, e, reduced) for grid, e in zip(grids, young)]
        write(pathlib.Path(folder), blocks, name, solve(blocks, **told))


main()
