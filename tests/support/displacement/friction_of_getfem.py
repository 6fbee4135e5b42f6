"""Writes displacement fields of GetFEM for a block on a rigid floor with Coulomb friction: `friction_of_getfem.py problem.json FOLDER MU...`.

Contact and friction hold at the nodes of the side y = 0, as GetFEM's basic contact brick has them; the side y = 1 is moved.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from model import Model  # noqa: E402

import getfem as gf  # noqa: E402
import numpy as np  # noqa: E402

gf.util_trace_level(0)


def solved(problem, mu):
    """Displacements of the vertices."""
    points, body = np.array(problem["points"]), problem["bodies"][0]
    mesh = gf.Mesh("empty", 2)
    for triangle in problem["triangles"]:
        mesh.add_convex(gf.GeoTrans("GT_PK(2,1)"), points[triangle].T)
    field = gf.MeshFem(mesh, 2)
    field.set_fem(gf.Fem("FEM_PK(2,1)"))
    rule = gf.MeshIm(mesh, gf.Integ("IM_TRIANGLE(4)"))
    mesh.set_region(1, mesh.outer_faces_in_box([-1.0, 1.0 - 1e-9], [9.0, 2.0]))
    young, nu = 3.0, 0.25
    model = gf.Model("real")
    model.add_fem_variable("u", field)
    model.add_initialized_data("lambda", [young * nu / (1 + nu) / (1 - 2 * nu)])
    model.add_initialized_data("shear", [young / 2 / (1 + nu)])
    model.add_isotropic_linearized_elasticity_brick(rule, "u", "lambda", "shear")
    model.add_initialized_data("moved", [0.06, -0.05])
    model.add_Dirichlet_condition_with_multipliers(rule, "u", field, 1, "moved")
    places = field.basic_dof_nodes()
    foot = [i for i in range(0, field.nbdof(), 2) if places[1, i] < 1e-9]
    normal, tangent = (gf.Spmat("empty", len(foot), field.nbdof()) for _ in range(2))
    for row, i in enumerate(foot):
        normal.add(row, i + 1, -1.0)
        tangent.add(row, i, 1.0)
    model.add_variable("pressure", len(foot))
    model.add_variable("friction", len(foot))
    for name, value in [("r", [1.0]), ("mu", [mu]), ("gap", np.zeros(len(foot))), ("alpha", np.ones(len(foot)))]:
        model.add_initialized_data(name, value)
    model.add_basic_contact_brick("u", "pressure", "friction", "r", normal, tangent, "mu", "gap", "alpha")
    model.solve("max_res", 1e-13, "max_iter", 300, "lsearch", "simplest")
    u = {tuple(np.round(places[:, i], 9)): model.variable("u")[i : i + 2] for i in range(0, field.nbdof(), 2)}
    return np.array([u[tuple(np.round(x, 9))] for x in points])


def main():
    problem, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
    for mu in sys.argv[3:]:
        (folder / f"getfem-{mu}.vtk").write_text(Model(problem, 1).vtk(solved(problem, float(mu))))


main()
