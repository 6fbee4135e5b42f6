"""The package as users of notebooks and scripts need it: verify, jobs, tables, pictures, fields of other programs, ctrl-C."""

import os
import signal
import subprocess
import sys
import textwrap
import time
import tomllib
import types
from pathlib import Path

import numpy as np
import pytest

CASES = Path(__file__).resolve().parents[2] / "cases"
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


def test_a_scene_of_dictionaries_is_that_of_its_file(hypercircle, tmp_path):
    tables = tomllib.loads((CASES / "two_blocks.toml").read_text())
    tables["title"] = 'a "title" with \\ and 摩擦 \x7f'
    tables["model"]["thickness"] = None
    for polygon in tables["geometry"]["polygons"]:
        polygon["points"] = np.array(polygon["points"], dtype=float)
    scene = hypercircle.Scene.from_dict(tables)
    assert scene.title == tables["title"]
    assert scene.solve().lower == hypercircle.Scene(CASES / "two_blocks.toml").solve().lower
    with pytest.raises(hypercircle.InputError, match="poisson"):
        hypercircle.Scene.from_dict(tables | {"bodies": {"left": {"young": 1, "poisson": 0.7}}})
    with pytest.raises(hypercircle.InputError, match="bodies.left.young has the type object"):
        hypercircle.Scene.from_dict({"bodies": {"left": {"young": object()}}})
    itself = {}
    itself["model"] = itself
    with pytest.raises(hypercircle.InputError, match="more than 16 levels deep.*does it contain itself"):
        hypercircle.Scene.from_dict(itself)
    with pytest.raises(hypercircle.InputError, match=r"^model.kinematics has half of a pair of UTF-16.*'plane-\\ud800'"):
        hypercircle.Scene.from_dict({"model": {"kinematics": "plane-\ud800"}})
    with pytest.raises(hypercircle.InputError, match=r"^bodies.\\ud800 has half of a pair"):
        hypercircle.Scene.from_dict({"bodies": {"\ud800": {}}})
    path = written(tmp_path)
    meshed = tomllib.loads(path.read_text()) | {"mesh": {"file": tmp_path / "plate.msh"}}
    assert hypercircle.Scene.from_dict(meshed).problem()["points"].shape == (25, 2)


def test_verify_compares_with_fenicsx(hypercircle, tmp_path):
    scene = hypercircle.Scene(CASES / "two_blocks.toml")
    found = scene.verify(primal_degree=[2], out=tmp_path / "out")
    assert found.passed and found.lower <= found.upper and (tmp_path / "out/report.html").is_file()
    (model,) = found.report["primal"]
    assert model["name"] == "FEniCSx P2" and found.relative_error_bound == model["relative_error_bound"]
    with pytest.raises(hypercircle.InputError, match="primal_degree"):
        scene.verify(primal_degree=[0])


TUBE = """
model.kinematics = "axisymmetric"
geometry = { size = 0.25, polygons = [{ body = "tube", points = [[1, 0], [2, 0], [2, 1], [1, 1]], edges = ["foot", "out", "top", "bore"] }] }
bodies.tube = { young = 1.0, poisson = 0.3 }
supports = [{ on = "foot", type = "roller" }, { on = "top", type = "roller" }]
tractions = [{ on = "bore", pressure = 1.0 }]
"""


def test_a_body_of_revolution_has_four_stresses(hypercircle):
    solution = hypercircle.Scene.from_text(TUBE).solve(degree=3)
    # Lamé: radial and hoop stress A ± B/r² with A = 1/3, B = 4/3, and along the axis, where nothing moves, ν of their sum.
    lame = lambda r: np.stack([(1 - 4 / r**2) / 3, np.full_like(r, 0.3 * 2 / 3), np.zeros_like(r), (1 + 4 / r**2) / 3], axis=1)
    r = solution.stress_points[:, 0]
    assert solution.stress.shape == (len(r), 4) and np.abs(solution.stress - lame(r)).max() < 0.02
    centroids = solution.points[solution.triangles].mean(axis=1)[:, 0]
    assert np.abs(solution.mean_stress - lame(centroids)).max() < 0.1
    assert len(solution.maps["von_mises_dual"]) == len(solution.triangles)
    # The energy is −½ ∫ p u_r, and u_r = (1 + ν)((1 − 2ν) A r + B/r).
    exact = -0.5 * 2 * np.pi * 1.3 * (0.4 / 3 + 4 / 3)
    assert solution.lower <= exact <= solution.upper and solution.relative_error_bound < 1e-3
    with pytest.raises(hypercircle.InputError, match="revolution"):
        hypercircle.Scene.from_text(TUBE).solve(element=object())


def test_a_chart_is_what_the_command_leaves(hypercircle, tmp_path):
    scene = hypercircle.Scene(CASES / "patch.toml")
    found = scene.chart(out=tmp_path / "out", methods=["condensed"], refine=1, repeats=1)
    (patch,) = found["scenes"]
    assert [run["level"] for run in patch["runs"]] == [0, 1] and (tmp_path / "out/chart.html").is_file()
    assert all(run["plot"]["lower"] <= patch["reference"]["Ok"]["upper"] for run in patch["runs"])
    with pytest.raises(hypercircle.InputError, match="no method"):
        scene.chart(out=tmp_path / "out", methods=["fast"])
    with pytest.raises(hypercircle.InputError, match="write it"):
        hypercircle.Scene.from_text(TUBE).chart(out=tmp_path)


def test_a_job_is_many_scenes(hypercircle, tmp_path):
    (tmp_path / "bad.toml").write_text("nonsense")
    found = hypercircle.job([CASES / "patch.toml", CASES / "gap.toml", tmp_path / "bad.toml"], "solve", out=tmp_path / "out", jobs=2)
    assert found["exit"] == 2 and found["counts"]["agree"] == 2 and found["counts"]["scenes"] == 3
    with pytest.raises(hypercircle.InputError, match="--refine"):
        hypercircle.job(CASES / "patch.toml", "solve", out=tmp_path / "out", options=["--refine", "99"])
    with pytest.raises(hypercircle.InputError, match="use one of"):
        hypercircle.job([], "chart", out=tmp_path)


def test_tables_are_columns(hypercircle):
    text = (CASES / "two_blocks.toml").read_text() + '\n[[quantities]]\nname = "tip"\ndisplacement = "left_load"\ndirection = [1, 0]\n'
    solution = hypercircle.Scene.from_text(text).solve(tolerance=0.01)
    table = solution.table("quantities")
    assert table["name"] == ["tip"] and table["lower"][0] == solution.quantities["tip"].lower
    history = solution.table("history")
    assert {len(column) for column in history.values()} == {len(solution.report["history"])} and min(history["triangles"]) > 0
    (force,) = solution.table("contacts")["resultant.dual.0"]
    assert force == solution.contacts["left_face|right_face"].force[0]
    assert solution.table("checks")["passed"] == [True] * len(solution.report["checks"])
    with pytest.raises(hypercircle.InputError, match="contacts"):
        solution.table("no such")


def test_a_notebook_shows_verdict_and_intervals(hypercircle):
    text = (CASES / "two_blocks.toml").read_text() + '\n[[quantities]]\nname = "<tip>"\ndisplacement = "left_load"\ndirection = [1, 0]\n'
    scene = hypercircle.Scene.from_text(text)
    page = scene.solve()._repr_html_()
    assert "agree" in page and "&lt;tip&gt;" in page and "<tip>" not in page
    assert "quantity/&lt;tip&gt;/given" in scene.certify(values={"<tip>": 7.0})._repr_html_()


def test_a_picture_shows_one_number_a_triangle(hypercircle):
    class Axes:
        figure = None

        def tripcolor(self, *what, **how):
            self.what, self.how = what, how

        def set_aspect(self, aspect):
            self.aspect = aspect

    solution = hypercircle.Scene(CASES / "two_blocks.toml").solve()
    axes = solution.plot("xx", ax=Axes(), deformed=2.0, cmap="magma")
    x, y, triangles = axes.what
    assert np.allclose(np.column_stack([x, y]), solution.points + 2.0 * solution.displacement)
    assert (triangles == solution.triangles).all() and axes.how["cmap"] == "magma"
    assert (axes.how["facecolors"] == solution.mean_stress[:, 0]).all()
    shares = [name for name in solution.maps if name.startswith("gap_share")]
    assert abs(solution.maps[shares[0]].sum() - 1) < 1e-9
    assert (solution.plot(ax=Axes()).how["facecolors"] == solution.maps["von_mises_dual"]).all()
    with pytest.raises(hypercircle.InputError, match="von_mises_dual"):
        solution.plot("zz", ax=Axes())
    with pytest.raises(hypercircle.InputError, match="one number for each"):
        solution.plot([1.0], ax=Axes())


def test_a_grid_of_pyvista_has_what_is_known_of_the_triangles(hypercircle, monkeypatch):
    class Grid:
        def __init__(self, cells, points):
            (self.triangles,), self.points = cells.values(), points
            self.cell_data, self.point_data = {}, {}

    # PyVista asks for a dozen packages: these are the calls that it takes, of 0.49.
    stand_in = types.SimpleNamespace(UnstructuredGrid=Grid, CellType=types.SimpleNamespace(TRIANGLE=5))
    monkeypatch.setitem(sys.modules, "pyvista", stand_in)
    for scene, components in ((CASES / "two_blocks.toml", 3), (CASES / "tube.toml", 4)):
        solution = hypercircle.Scene(scene).solve()
        grid = solution.to_pyvista()
        assert (grid.points[:, :2] == solution.points).all() and not grid.points[:, 2].any()
        assert (grid.triangles == solution.triangles).all() and (grid.cell_data["body"] == solution.body).all()
        stresses = [name for name in grid.cell_data if name.startswith("stress_")]
        assert len(stresses) == components and (grid.cell_data[stresses[1]] == solution.mean_stress[:, 1]).all()
        assert solution.maps.keys() <= grid.cell_data.keys()
        assert (grid.point_data["displacement"][:, :2] == solution.displacement).all()
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match="pip install pyvista"):
        solution.to_pyvista()


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


def test_a_report_that_is_changed_changes_no_verdict(hypercircle):
    scene = hypercircle.Scene(CASES / "patch.toml")
    solution = scene.solve()
    wrong = solution.certify(solution.points, solution.triangles, 0.5 * solution.displacement, solution=True)
    for found in (wrong, solution):
        status, checks = found.status, len(found.report["checks"])
        found.report["status"] = "agree" if status == "disagree" else "disagree"
        found.report["checks"].clear()
        assert found.status == status and len(found.report["checks"]) == checks
    wrong.checks.clear()
    wrong.causes.clear()
    wrong.diagnosis["findings"].clear()
    assert not wrong.passed and wrong.checks and wrong.causes and wrong.diagnosis["findings"]


def test_ctrl_c_ends_a_solve():
    """A solve that would take minutes ends soon after the signal, as an exception, and the next one works."""
    body = f"""
        import hypercircle
        scene = hypercircle.Scene({str(CASES / "two_blocks.toml")!r})
        print("ready", flush=True)
        try:
            scene.solve(tolerance=1e-6, adapt="h")
            print("ended", flush=True)
        except KeyboardInterrupt:
            print("interrupted", scene.solve().status, flush=True)
        """
    # A background process of a shell ignores the signal, and so do all its children.
    heard = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(body)], stdout=subprocess.PIPE, text=True, preexec_fn=heard
    )
    assert process.stdout.readline() == "ready\n"
    time.sleep(1.0)
    began = time.monotonic()
    os.kill(process.pid, signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said == "interrupted agree\n"
    assert time.monotonic() - began < 30


def test_the_command_is_that_of_the_program(hypercircle, tmp_path):
    command = Path(sys.executable).parent / "hypercircle"
    run = lambda *words: subprocess.run([command, *words], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run("--version").stdout.startswith(f"hypercircle {hypercircle.__version__}\n")
    assert run("solve", CASES / "patch.toml", "--quiet").returncode == 0
    assert '"command_line": "hypercircle solve' in (tmp_path / "out/patch/report.json").read_text()
    assert run("solve", "no.toml").returncode == 2 and run("no").returncode == 2
