"""Writes fields of contact in the mean by scikit-fem and GetFEM on sides that do not match: `contact_of_others.py FOLDER`.

Two blocks, [0, 1] x [0, 1] on 5 and [1, 2] x [0, 1] on 4 divisions, plane strain, pressed together on x = 0 so that the upper part of
their faces opens. scikit-fem: a mortar method with multipliers on the trace of the first block, and Nitsche's method, both with the active
set sought at quadrature points of the common refinement. GetFEM: its integral and its penalized contact brick between meshes that do not match. `modulus` has a modulus 5 % too large on the left.
Writes mesh.msh, scene.toml and one file a field; prints their names.
"""

import pathlib
import sys

import meshio
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

YOUNG, POISSON = [3e4, 1e4], [0.3, 0.2]
DIVISIONS = [5, 4]
PUSH, SLOPE = 40.0, -70.0

SCENE = """
[model]
kinematics = "plane-strain"
[mesh]
file = "mesh.msh"
[bodies.left]
tag = 1
young = 3e4
poisson = 0.3
[bodies.right]
tag = 2
young = 1e4
poisson = 0.2
[[boundaries]]
name = "load"
line = [[0, 0], [0, 1]]
[[boundaries]]
name = "below"
line = [[0, 0], [1, 0]]
[[boundaries]]
name = "face"
body = "left"
line = [[1, 0], [1, 1]]
[[boundaries]]
name = "facing"
body = "right"
line = [[1, 0], [1, 1]]
[[boundaries]]
name = "wall"
line = [[2, 0], [2, 1]]
[[supports]]
on = "below"
type = "roller"
[[supports]]
on = "wall"
type = "clamped"
[[tractions]]
on = "load"
value = [40.0, 0.0]
gradient = [[0.0, -70.0], [0.0, 0.0]]
[[contacts]]
between = ["face", "facing"]
"""


def grids():
    """Points and triangles of the two blocks."""
    for k, n in enumerate(DIVISIONS):
        line = np.linspace(0, 1, n + 1)
        x, y = np.meshgrid(k + line, line, indexing="ij")
        number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
        a, b, c, d = (number[i : n + i, j : n + j].ravel() for i, j in [(0, 0), (1, 0), (1, 1), (0, 1)])
        yield np.array([x.ravel(), y.ravel()]), np.hstack([[a, b, c], [a, c, d]])


def lame(k, factor=1.0):
    shear = factor * YOUNG[k] / (2 * (1 + POISSON[k]))
    return 2 * shear * POISSON[k] / (1 - 2 * POISSON[k]), shear


def written(folder, name, degree, parts):
    """`parts`: of each block a function from points to displacements at them, shape (2, N)."""
    points, cells, values, tags, known = [], [], [], [], 0
    for k, (p, t) in enumerate(grids()):
        own = p
        if degree == 2:
            edges = np.sort(np.stack([t[[0, 1, 2]].T, t[[1, 2, 0]].T], 2).reshape(-1, 2), axis=1)
            edges, inverse = np.unique(edges, axis=0, return_inverse=True)
            own = np.hstack([p, 0.5 * (p[:, edges[:, 0]] + p[:, edges[:, 1]])])
            t = np.vstack([t, p.shape[1] + inverse.reshape(-1, 3).T])
        points.append(own)
        values.append(parts[k](own))
        cells.append(t.T + known)
        tags.append(np.full(t.shape[1], k + 1))
        known += own.shape[1]
    flat = lambda a: np.vstack([np.hstack(a), np.zeros(known)]).T
    shape = {1: "triangle", 2: "triangle6"}[degree]
    mesh = meshio.Mesh(flat(points), [(shape, np.vstack(cells))], point_data={"u": flat(values)})
    meshio.write(folder / f"{name}.vtu", mesh)
    if not (folder / "mesh.msh").exists():
        tags = np.hstack(tags).astype(int)
        plain = meshio.Mesh(mesh.points, [("triangle", np.vstack(cells)[:, :3])],
                            cell_data={"gmsh:physical": [tags], "gmsh:geometrical": [tags]})
        meshio.write(folder / "mesh.msh", plain, file_format="gmsh22", binary=False)
    print(name)


def by_skfem(folder, degree, method, factor=1.0):
    import skfem
    from skfem.helpers import ddot, dot, eye, sym_grad, trace
    from skfem.supermeshing import elementwise_quadrature, intersect

    element = skfem.ElementVector({1: skfem.ElementTriP1, 2: skfem.ElementTriP2}[degree]())
    meshes = [skfem.MeshTri(p, t) for p, t in grids()]
    bases = [skfem.CellBasis(m, element, intorder=2 * degree) for m in meshes]
    strain = lambda w: sym_grad(w)

    def stress(k, w):
        la, mu = lame(k, factor if k == 0 else 1.0)
        return 2 * mu * strain(w) + la * eye(trace(strain(w)), 2)

    blocks = [skfem.BilinearForm(lambda u, v, w, k=k: ddot(stress(k, u), strain(v))).assemble(bases[k]) for k in (0, 1)]
    sizes = [basis.N for basis in bases]
    stiffness = sp.block_diag(blocks).tocsr()
    load = skfem.FacetBasis(meshes[0], element, facets=meshes[0].facets_satisfying(lambda x: x[0] < 1e-9), intorder=4)
    force = np.zeros(sum(sizes))
    force[: sizes[0]] = skfem.LinearForm(lambda v, w: (PUSH + SLOPE * w.x[1]) * v[0]).assemble(load)
    held = np.concatenate([
        bases[0].get_dofs(lambda x: x[1] < 1e-9).all(["u^2"]),
        sizes[0] + bases[1].get_dofs(lambda x: x[0] > 2 - 1e-9).all(),
    ])

    def trace_of(m):
        facets = m.facets_satisfying(lambda x: np.abs(x[0] - 1) < 1e-9)
        facets = facets[np.argsort(m.p[1, m.facets[:, facets]].mean(0))]
        ends = np.sort(m.p[1, m.facets[:, facets]], axis=0)
        return facets, (np.append(ends[0], ends[1, -1])[None], np.array([np.arange(len(facets)), np.arange(1, len(facets) + 1)]))

    (facets1, line1), (facets2, line2) = map(trace_of, meshes)
    common, to1, to2 = intersect(line1, line2)
    points, weights = skfem.quadrature.get_quadrature(common.elem, 2 * degree)
    y = (common.p[0][common.t[0]][:, None] * (1 - points[0]) + common.p[0][common.t[1]][:, None] * points[0]).ravel()
    weight = (np.diff(common.p[0])[:, None] * weights).ravel()
    at = np.array([np.ones_like(y), y])
    rows = []
    for k, (m, basis) in enumerate(zip(meshes, bases)):
        # The block that the points belong to is asked a hair inside it: derivatives of its own triangles.
        cells = m.element_finder()(*(at + np.array([[(-1e-9 if k == 0 else 1e-9)], [0.0]])))
        inside = m.mapping().invF(at[:, :, None], tind=cells)
        there = skfem.CellBasis(m, element, elements=cells, quadrature=(inside, np.ones((len(y), 1))))
        normal, pull = (sp.lil_matrix((len(y), basis.N)) for _ in range(2))
        for i in range(there.Nbfun):
            value = there.basis[i][0]
            sigma = stress(k, value)[0, 0]
            dofs = basis.dofs.element_dofs[i, cells]
            for q in range(len(y)):
                normal[q, dofs[q]] += np.asarray(value)[0, q, 0]
                pull[q, dofs[q]] += sigma[q, 0]
        rows.append((normal.tocsr(), pull.tocsr()))
    jump = sp.hstack([rows[0][0], -rows[1][0]]).tocsr()
    mean = sp.hstack([0.5 * rows[0][1], 0.5 * rows[1][1]]).tocsr()
    free = np.setdiff1d(np.arange(sum(sizes)), held)
    found = np.zeros(sum(sizes))
    if method == "nitsche":
        gamma = max(YOUNG) * 20 * degree**2 * max(DIVISIONS)
        closed = np.ones(len(y), bool)
        for _ in range(60):
            on, off = sp.diags(weight * closed), sp.diags(weight * ~closed)
            matrix = stiffness + gamma * jump.T @ on @ jump - jump.T @ on @ mean - mean.T @ on @ jump - (mean.T @ off @ mean) / gamma
            found[free] = sla.spsolve(matrix[free][:, free].tocsc(), force[free])
            now = mean @ found - gamma * (jump @ found) < 0
            if (now == closed).all():
                break
            closed = now
    else:
        # Multipliers: continuous hats on the trace of the first block, each free or zero.
        knots = line1[0][0]
        hats = np.array([np.interp(y, knots, np.eye(len(knots))[i]) for i in range(len(knots))])
        coupling = sp.csr_matrix(hats * weight) @ jump
        closed = np.ones(len(knots), bool)
        for _ in range(60):
            rows = coupling[closed][:, free]
            system = sp.bmat([[stiffness[free][:, free], rows.T], [rows, None]]).tocsc()
            answer = sla.spsolve(system, np.append(force[free], np.zeros(rows.shape[0])))
            found[free] = answer[: len(free)]
            pressure = np.zeros(len(knots))
            pressure[closed] = answer[len(free) :]
            now = np.where(closed, pressure > 0, coupling @ found > 0)
            if (now == closed).all():
                break
            closed = now
    parts = np.split(found, [sizes[0]])
    value = lambda k: lambda x: np.array(bases[k].probes(x) @ parts[k]).reshape(2, -1)
    name = f"skfem_{method}{'' if factor == 1.0 else '_modulus'}_P{degree}"
    written(folder, name, degree, [value(0), value(1)])


def by_getfem(folder, degree, method):
    import getfem as gf

    gf.util_trace_level(0)
    meshes, fems, lines = [], [], []
    for k, (p, t) in enumerate(grids()):
        m = gf.Mesh("empty", 2)
        for corners in t.T:
            m.add_convex(gf.GeoTrans("GT_PK(2,1)"), p[:, corners])
        inner = 1.0 if k == 0 else -1.0
        for region, normal in enumerate([[inner, 0.0], [-inner, 0.0], [0.0, -1.0]], 1):
            m.set_region(region, m.outer_faces_with_direction(normal, 0.01))
        fem = gf.MeshFem(m, 2)
        fem.set_fem(gf.Fem(f"FEM_PK(2,{degree})"))
        meshes.append(m), fems.append(fem)
    model = gf.Model("real")
    integrals = [gf.MeshIm(m, gf.Integ("IM_TRIANGLE(6)")) for m in meshes]
    for k in (0, 1):
        la, mu = lame(k)
        u = f"u{k + 1}"
        model.add_fem_variable(u, fems[k])
        model.add_initialized_data(f"la{k}", la)
        model.add_initialized_data(f"mu{k}", mu)
        model.add_isotropic_linearized_elasticity_brick(integrals[k], u, f"la{k}", f"mu{k}")
    model.add_source_term(integrals[0], f"[{PUSH}+({SLOPE})*X(2); 0].Test_u1", 2)
    model.add_Dirichlet_condition_with_simplification("u2", 2)
    model.add_initialized_data("H", [[0.0, 0.0], [0.0, 1.0]])
    model.add_initialized_data("zero", [0.0, 0.0])
    model.add_generalized_Dirichlet_condition_with_multipliers(integrals[0], "u1", fems[0], 3, "zero", "H")
    model.add_initialized_data("r", max(YOUNG))
    if method == "integral":
        whole = gf.MeshFem(meshes[0], 1)
        whole.set_fem(gf.Fem("FEM_PK(2,1)"))
        pressures = gf.MeshFem("partial", whole, whole.basic_dof_on_region(1))
        model.add_fem_variable("pressure", pressures)
        model.add_integral_contact_between_nonmatching_meshes_brick(integrals[0], "u1", "u2", "pressure", "r", 1, 1, 1)
    else:
        model.add_penalized_contact_between_nonmatching_meshes_brick(integrals[0], "u1", "u2", "r", 1, 1)
    model.solve("max_res", 1e-11, "max_iter", 100)
    nodes = [fem.basic_dof_nodes() for fem in fems]

    def value(k):
        known = {tuple(np.round(x, 9)): [] for x in nodes[k].T}
        for i, x in enumerate(nodes[k].T):
            known[tuple(np.round(x, 9))].append(model.variable(f"u{k + 1}")[i])
        return lambda points: np.array([known[tuple(np.round(x, 9))] for x in points.T]).T

    written(folder, f"getfem_{method}_P{degree}", degree, [value(0), value(1)])


def main():
    folder = pathlib.Path(sys.argv[1])
    (folder / "scene.toml").write_text(SCENE)
    for degree in (1, 2):
        for method in ("mortar", "nitsche"):
            by_skfem(folder, degree, method)
            by_skfem(folder, degree, method, 1.05)
        for method in ("integral", "penalty"):
            by_getfem(folder, degree, method)


main()
