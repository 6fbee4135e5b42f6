"""Fields of other programs as they hand them over: of scikit-fem, DOLFINx and meshio."""

import types
from pathlib import Path

import numpy as np
import pytest

from plate import written

CASES = Path(__file__).resolve().parents[2] / "cases"


def test_fields_of_scikit_fem_are_taken(hypercircle, tmp_path):
    import skfem
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    scene = hypercircle.Scene(written(tmp_path))
    problem = scene.problem()
    mesh = skfem.MeshTri(np.ascontiguousarray(problem["points"].T), np.ascontiguousarray(problem["triangles"].T))
    # Plane stress is plane strain with other constants.
    young, poisson = 2.0, 0.25
    lame = lame_parameters(young * (1 + 2 * poisson) / (1 + poisson) ** 2, poisson / (1 + poisson))
    for element in (skfem.ElementTriP1(), skfem.ElementTriP2()):
        basis = skfem.Basis(mesh, skfem.ElementVector(element))
        right = basis.boundary(mesh.facets_satisfying(lambda x: x[0] > 1 - 1e-9, boundaries_only=True))
        load = skfem.LinearForm(lambda v, w: (1.0 + 0.3 * w.x[1]) * v[0] + 0.5 * v[1]).assemble(right)
        held = np.concatenate([
            basis.get_dofs(lambda x: x[0] < 1e-9).all(["u^1"]),
            basis.get_dofs(lambda x: x[1] < 1e-9).all(["u^2"]),
        ])  # fmt: skip
        u = skfem.solve(*skfem.condense(linear_elasticity(*lame).assemble(basis), load, D=held))
        certificate = scene.certify(*hypercircle.field(basis, u), solution=True)
        assert certificate.passed, certificate.verdict
        assert scene.diagnose(*hypercircle.field(basis, 1.1 * u)) is not None
        # A mesh of second order with straight sides has the middles of its edges among its points.
        second = skfem.MeshTri2.from_mesh(mesh)
        same = hypercircle.field(skfem.Basis(second, skfem.ElementVector(element)), u)
        assert all((a == b).all() for a, b in zip(same, hypercircle.field(basis, u)))
        bent = second.doflocs.copy()
        bent[0, -1] += 1e-3
        for values, of, reason in ((u[1:], basis, "shape"), (u + 1e-9j, basis, "complex"), (u, skfem.Basis(skfem.MeshTri2(bent, second.t), skfem.ElementVector(element)), "curved")):
            with pytest.raises(hypercircle.InputError, match=reason):
                hypercircle.field(of, values)
    with pytest.raises(TypeError, match="field"):
        hypercircle.field(basis)
    with pytest.raises(hypercircle.InputError, match="degree 1 or 2 on triangles"):
        hypercircle.field(skfem.Basis(mesh, skfem.ElementTriP1()), np.zeros(len(mesh.p.T)))


@pytest.mark.parametrize("kinematics", ["plane-strain", "axisymmetric"])
def test_claims_are_held_against_polynomial_tractions(hypercircle, tmp_path, kinematics):
    """As another program integrates them: exactly, with too few points, or interpolated between its nodes."""
    import skfem
    from skfem.helpers import ddot, sym_grad
    from skfem.models.elasticity import lame_parameters

    file = tmp_path / "scene.toml"
    file.write_text(f"""
model = {{ kinematics = "{kinematics}" }}
geometry.size = 0.25
bodies.block = {{ young = 2.0, poisson = 0.25 }}
supports = [{{ on = "foot", type = "clamped" }}]
tractions = [{{ on = "top", value = [0, -1], terms = [{{ powers = [3, 0], value = [0.5, 2.0] }}] }}]
[[geometry.polygons]]
body = "block"
points = [[0.5, 0], [1.5, 0], [1.5, 1], [0.5, 1]]
edges = ["foot", "", "top", ""]
""")
    scene = hypercircle.Scene(file)
    problem = scene.problem()
    mesh = skfem.MeshTri(np.ascontiguousarray(problem["points"].T), np.ascontiguousarray(problem["triangles"].T))
    lame, shear = lame_parameters(2.0, 0.25)
    turned = kinematics == "axisymmetric"

    @skfem.BilinearForm
    def stiffness(u, v, w):
        r, weight = w.x[0], w.x[0] if turned else 1.0
        trace = lambda u: u.grad[0, 0] + u.grad[1, 1] + turned * u[0] / r
        hoop = turned * u[0] * v[0] / r**2
        return weight * (2 * shear * (ddot(sym_grad(u), sym_grad(v)) + hoop) + lame * trace(u) * trace(v))

    def solved(element, scale=1.0, order=8, at_nodes=False):
        basis = skfem.Basis(mesh, skfem.ElementVector(element), intorder=4)
        top = skfem.FacetBasis(mesh, skfem.ElementVector(element), facets=mesh.facets_satisfying(lambda x: x[1] > 1 - 1e-9), intorder=order)
        given = lambda x: (0.5 * x**3, 2.0 * x**3 - scale)
        values = np.zeros(basis.N)
        for dofs in (basis.nodal_dofs, basis.facet_dofs):
            for numbers, c in zip(dofs, (0, 1)):
                values[numbers] = given(basis.doflocs[0, numbers])[c]
        traction = lambda w: w["known"] if at_nodes else given(w.x[0])
        form = lambda v, w: (traction(w)[0] * v[0] + traction(w)[1] * v[1]) * (w.x[0] if turned else 1.0)
        load = skfem.LinearForm(form).assemble(top, known=top.interpolate(values))
        held = basis.get_dofs(lambda x: x[1] < 1e-9)
        u = skfem.solve(*skfem.condense(stiffness.assemble(basis), load, D=held))
        return hypercircle.field(basis, u)

    for element in (skfem.ElementTriP1(), skfem.ElementTriP2()):
        right = scene.certify(*solved(element), solution=True)
        assert right.passed, right.verdict
        assert not scene.certify(*solved(element, scale=1.05), solution=True).passed
        for mistake, name in ((dict(order=2), "loads/points"), (dict(at_nodes=True), "loads/at-nodes")):
            wrong = scene.certify(*solved(element, **mistake), solution=True)
            [finding] = wrong.report["diagnosis"][0]["findings"]
            assert not wrong.passed and finding["name"] == name, wrong.report["diagnosis"]


def test_functions_of_dolfinx_are_taken(hypercircle, tmp_path):
    """Three lines after a solve in FEniCSx: here the function is that of a known displacement."""
    dolfinx = pytest.importorskip("dolfinx")
    from mpi4py import MPI

    scene = hypercircle.Scene(written(tmp_path))
    import meshio
    import ufl

    points, triangles = (lambda m: (m.points[:, :2], m.cells_dict["triangle"]))(meshio.read(tmp_path / "plate.msh"))
    cell = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.triangle, 1))
    mesh = dolfinx.mesh.create_mesh(MPI.COMM_SELF, triangles.astype(np.int64), points.copy(), cell)
    for degree in (1, 2):
        u = dolfinx.fem.Function(dolfinx.fem.VectorFunctionSpace(mesh, ("Lagrange", degree)))
        u.interpolate(lambda x: np.vstack([0.5 * x[0] * (1 + x[1]), -0.1 * x[1] * x[0]]))
        found, cells, displacement = hypercircle.field(u)
        x, y = found.T
        expected = np.column_stack([0.5 * x * (1 + y), -0.1 * x * y])
        assert np.allclose(displacement, expected, atol=1e-12) and cells.shape == (32, 3 * degree)
        if degree == 2:
            middles = [(found[cells[:, a]] + found[cells[:, b]]) / 2 for a, b in ((0, 1), (1, 2), (2, 0))]
            assert np.allclose(found[cells[:, 3:]], np.stack(middles, axis=1))
        assert scene.certify(found, cells, displacement).relative_error_bound > 0
    # What a build for complex numbers has.
    turned = types.SimpleNamespace(function_space=u.function_space, x=types.SimpleNamespace(array=u.x.array + 1e-12j))
    with pytest.raises(hypercircle.InputError, match="complex"):
        hypercircle.field(turned)
    scalar = dolfinx.fem.Function(dolfinx.fem.FunctionSpace(mesh, ("Lagrange", 1)))
    with pytest.raises(hypercircle.InputError, match="no Lagrange vector"):
        hypercircle.field(scalar)


def test_meshes_of_meshio_are_taken(hypercircle):
    meshio = pytest.importorskip("meshio")
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    mesh = meshio.Mesh(points, [("triangle", [[0, 1, 2]])], point_data={"U": points})
    found, cells, displacement = hypercircle.field(mesh)
    assert (found == points[:, :2]).all() and (displacement == found).all() and (cells == [[0, 1, 2]]).all()
    with pytest.raises(hypercircle.InputError, match="name"):
        hypercircle.field(mesh, name="v")
    with pytest.raises(hypercircle.InputError, match="no use for values"):
        hypercircle.field(mesh, points)
    both = meshio.Mesh(points, mesh.cells, point_data={"u": 2 * points, "displacement": points})
    assert (hypercircle.field(both)[2] == points[:, :2]).all()
    mixed = meshio.Mesh(np.vstack([points, [[1, 1, 0]]]), [("triangle", [[0, 1, 2]]), ("quad", [[0, 1, 3, 2]])], point_data={"u": np.zeros((4, 3))})
    with pytest.raises(hypercircle.InputError, match="cells triangle, quad"):
        hypercircle.field(mixed)
    with pytest.raises(TypeError, match="no|not"):
        hypercircle.field(7)


def test_what_a_mesh_has_out_of_the_plane_is_not_forgotten(hypercircle):
    meshio = pytest.importorskip("meshio")
    scene = hypercircle.Scene(CASES / "patch.toml")
    solution = scene.solve()
    solid = lambda plane, third: np.column_stack([plane, np.zeros(len(plane)) + third])
    points, u = solution.points, solution.displacement
    made = lambda points, u: hypercircle.field(meshio.Mesh(points, [("triangle", np.array(solution.triangles))], point_data={"u": u}))
    assert scene.certify(*made(solid(points, 0), solid(u, 0)), solution=True).passed
    for field in (made(solid(points, 3 * points[:, 0]), solid(u, 0)), made(solid(points, 0), solid(u, 7)), made(solid(points, 0), solid(u, np.nan))):
        with pytest.raises(hypercircle.InputError):
            scene.certify(*field, solution=True)
