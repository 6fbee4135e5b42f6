//! `fields.vtu`: the fields for ParaView, discontinuities kept.
//!
//! Every subtriangle of every triangle has points of its own, so that a field that jumps between triangles, or has kinks at the
//! inner segments, is drawn as it is. Where stresses have degree p these are the nodes of the lattice of degree p, and p² plain
//! triangles between them: every program reads them, and what they show is exact at the nodes.

mod friction;
mod sheet;

use super::Dossier;
use super::data::Given;
use super::lattice::Lattice;
use crate::compare::von_mises_of;
use crate::element::displacement::on_quadrilaterals;
use crate::element::geometry::sub_corners;
use crate::mesh::Quadrilateral;
use crate::problem::Problem;
use friction::OnTriangles;
pub(super) use sheet::shortened;
use sheet::{Precision, Sheet};

/// From this many triangles on fields keep four digits: the file would otherwise be tens of megabytes, and is for looking at.
const FOR_LOOKING_FROM: usize = 10_000;
/// Stresses are then multiples of this part of the largest in their triangle, or of up to twice that.
const STEP: f64 = 1.0 / 2048.0;
/// The components of a symmetric tensor in the order of VTK.
const TENSOR: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
/// Components of a stress in the axes of the material, the third of them out of the plane.
const MATERIAL_AXES: [&str; 6] = ["11", "22", "33", "12", "23", "13"];
/// Those of a vector.
const VECTOR: [&str; 3] = ["X", "Y", "Z"];

/// The VTK unstructured grid: for every triangle of degree p three times p² cells.
///
/// Point data: `dual_stress`, `mid_stress`, `stress_…` of every displacement model and `stress_difference_…`, λ_h less that, as
/// symmetric tensors with six named components; `von_mises` and `mean_stress` (tr σ / 3) of λ_h; `displacement_…` of every model
/// and the rigid `motion` where there is one. Cell data: `triangle`, `body`, `degree` of the stresses where it is not one
/// everywhere, `cell` where the mesh file has quadrilaterals, `friction_state`, `tangential_traction` and `friction_bound` where contacts have friction, and the maps. Field data: `scene` and `scene_sha256`, as UTF-8; and of linear and quadratic models what can be handed in again:
/// `nodes`, vertices and edge middles of the mesh, `nodes_of_triangles`, three corners and the middles between them, `nodes_of_quadrilaterals`, and the
/// values of `displacement_…`, or on quadrilaterals `quadrilateral_displacement_…`, at as many of these nodes as it has; not in files for
/// looking at.
pub fn vtu(dossier: &Dossier) -> std::io::Result<Vec<u8>> {
    let mesh = &dossier.problem.mesh;
    let run = format!(" run {} ", dossier.report.run);
    let precision = if mesh.triangles.len() >= FOR_LOOKING_FROM { Precision::ForLooking } else { Precision::Whole };
    let lattice = Lattice::new(dossier);
    let cells: usize = (0..mesh.triangles.len()).map(|t| lattice.cells(t)).sum();
    let points = lattice.values(|t, sub, l| {
        let [x, y] = dossier.problem.scene.as_written(within(mesh.corners(t), sub, l));
        [x, y, 0.0]
    });
    let mut out = Sheet::new(&run, precision)?;
    out.open("UnstructuredGrid", &[])?;
    out.open("FieldData", &[])?;
    out.text("scene", &dossier.report.scene)?;
    out.text("scene_sha256", &dossier.report.provenance.scene_sha256)?;
    if precision == Precision::Whole && !dossier.given.is_empty() {
        given(&mut out, dossier)?;
    }
    out.close("FieldData")?;
    out.open("Piece", &[("NumberOfPoints", &(points.len() / 3).to_string()), ("NumberOfCells", &cells.to_string())])?;
    point_data(&mut out, dossier, &lattice)?;
    cell_data(&mut out, dossier, &lattice)?;
    out.open("Points", &[])?;
    out.array("Points", "Float64", &VECTOR, points.iter().flat_map(|x| x.to_le_bytes()).collect())?;
    out.close("Points")?;
    out.open("Cells", &[])?;
    out.array("connectivity", "Int64", &[], lattice.connectivity().flat_map(i64::to_le_bytes).collect())?;
    out.array("offsets", "Int64", &[], (1..=cells as i64).flat_map(|k| (3 * k).to_le_bytes()).collect())?;
    const VTK_TRIANGLE: u8 = 5;
    out.array("types", "UInt8", &[], vec![VTK_TRIANGLE; cells])?;
    for name in ["Cells", "Piece", "UnstructuredGrid"] {
        out.close(name)?;
    }
    out.finish()
}

/// The mesh as it was solved, and the displacements at its nodes.
fn given(out: &mut Sheet, dossier: &Dossier) -> std::io::Result<()> {
    let mesh = &dossier.problem.mesh;
    let middles = mesh.edges.iter().map(|edge| {
        let [a, b] = edge.vertices.map(|v| mesh.points[v]);
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    });
    let bytes = |rows: &[[f64; 2]]| rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let nodes: Vec<[f64; 2]> =
        mesh.points.iter().copied().chain(middles).map(|p| dossier.problem.scene.as_written(p)).collect();
    out.table("nodes", "Float64", 2, nodes.len(), &bytes(&nodes))?;
    let triangles = mesh.triangles.iter().zip(&mesh.triangle_edges);
    let nodes_of = triangles.flat_map(|(corners, edges)| {
        // Edge i lies opposite vertex i.
        let middles = [2, 0, 1].map(|i| mesh.points.len() + edges[i]);
        corners.iter().copied().chain(middles).collect::<Vec<usize>>()
    });
    let indices: Vec<u8> = nodes_of.flat_map(|n| (n as i32).to_le_bytes()).collect();
    out.table("nodes_of_triangles", "Int32", 6, mesh.triangles.len(), &indices)?;
    if !mesh.cells.is_empty() {
        // Corners, sides and centre, of the nodes row by row.
        const AROUND: [usize; 9] = [0, 2, 8, 6, 1, 5, 7, 3, 4];
        let nodes_of = |cell: Quadrilateral| {
            let rows = on_quadrilaterals::nodes(mesh, 2, &cell);
            AROUND.map(|i| rows[i])
        };
        let nodes: Vec<[usize; 9]> = mesh.quadrilaterals().map(nodes_of).collect();
        let indices: Vec<u8> = nodes.as_flattened().iter().flat_map(|n| (*n as i32).to_le_bytes()).collect();
        out.table("nodes_of_quadrilaterals", "Int32", 9, nodes.len(), &indices)?;
    }
    let mut names = Vec::new();
    for Given { name, on_quadrilaterals, values } in &dossier.given {
        let kind = if *on_quadrilaterals { "quadrilateral_displacement" } else { "displacement" };
        out.table(&unique_key(kind, name, &mut names), "Float64", 2, values.len(), &bytes(values))?;
    }
    Ok(())
}

fn point_data(out: &mut Sheet, dossier: &Dossier, lattice: &Lattice) -> std::io::Result<()> {
    let problem = dossier.problem;
    let mesh = &problem.mesh;
    let dual = dossier.dual.map(|dual| &dual.stress).filter(|stress| stress.len() == mesh.triangles.len());
    let place = |t: usize, sub: usize, l: [f64; 3]| {
        let corners = sub_corners(mesh.corners(t), sub);
        [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum())
    };
    let tensor = |t, sub, l, s: [f64; 3]| [s[0], s[1], out_of_plane(problem, t, s, place(t, sub, l)), s[2], 0.0, 0.0];
    let section = problem.section().revolved();
    out.open("PointData", &dual.map(|_| ("Tensors", "dual_stress")).into_iter().collect::<Vec<_>>())?;
    let steps = steps(dossier, lattice);
    if let (Some(dual), Some(revolved)) = (dual, section) {
        let of = |t: usize, sub, l| revolved.stress_at(dual, t, sub, mesh.corners(t), problem.body_force(t), l);
        let tensor = |t, sub, l| {
            let [rr, zz, tt, rz] = of(t, sub, l);
            [rr, zz, tt, rz, 0.0, 0.0]
        };
        let mean = |t, sub, l| {
            let [rr, zz, tt, _] = of(t, sub, l);
            [(rr + zz + tt) / 3.0]
        };
        out.stresses("dual_stress", &TENSOR, &lattice.values(tensor), &steps)?;
        out.stresses("von_mises", &[], &lattice.values(|t, sub, l| [von_mises_of(of(t, sub, l))]), &steps)?;
        out.stresses("mean_stress", &[], &lattice.values(mean), &steps)?;
    }
    if let (Some(dual), None) = (dual, section) {
        let stress = |t, sub, l| dual.at(t, sub, l);
        out.stresses(
            "dual_stress",
            &TENSOR,
            &lattice.values(|t, sub, l| tensor(t, sub, l, stress(t, sub, l))),
            &steps,
        )?;
        out.stresses(
            "von_mises",
            &[],
            &lattice.values(|t, sub, l| [von_mises(problem, t, stress(t, sub, l), place(t, sub, l))]),
            &steps,
        )?;
        out.stresses(
            "mean_stress",
            &[],
            &lattice.values(|t, sub, l| [mean_stress(problem, t, stress(t, sub, l), place(t, sub, l))]),
            &steps,
        )?;
    }
    if let Some(dual) = dual
        && problem.scene.bodies.iter().any(|body| body.elasticity.isotropic().is_none())
    {
        let turned = |t: usize, s: [f64; 3]| match problem.mesh.body.get(t) {
            Some(&body) => problem.scene.bodies[body].elasticity.in_own_axes(s),
            None => s,
        };
        let own = lattice.values(|t, sub, l| {
            let s = dual.at(t, sub, l);
            let [first, second, shear] = turned(t, s);
            [first, second, out_of_plane(problem, t, s, place(t, sub, l)), shear, 0.0, 0.0]
        });
        out.stresses("dual_stress_in_material_axes", &MATERIAL_AXES, &own, &steps)?;
    }
    if let Some(mid) = dossier.mid.filter(|mid| mid.len() == mesh.triangles.len()) {
        out.stresses("mid_stress", &TENSOR, &lattice.values(|t, sub, l| tensor(t, sub, l, mid.at(t, sub, l))), &steps)?;
    }
    let mut names = Vec::new();
    for (name, stress) in dossier.stresses.iter().filter(|(_, stress)| stress.len() == mesh.triangles.len()) {
        let key = unique_key("stress", name, &mut names);
        out.stresses(&key, &TENSOR, &lattice.values(|t, sub, l| tensor(t, sub, l, stress.at(t, sub, l))), &steps)?;
        if let Some(dual) = dual {
            let apart = lattice.values(|t, sub, l| {
                let (own, other) = (dual.at(t, sub, l), stress.at(t, sub, l));
                let apart = [0, 1, 2].map(|c| own[c] - other[c]);
                // What initial strains leave of σ_33 is the same in both.
                let [of_own, of_other] = [own, other].map(|s| out_of_plane(problem, t, s, place(t, sub, l)));
                let zz = if problem.scene.bodies.iter().all(|body| body.initial.is_none()) {
                    out_of_plane(problem, t, apart, [0.0; 2])
                } else {
                    of_own - of_other
                };
                [apart[0], apart[1], zz, apart[2], 0.0, 0.0]
            });
            out.stresses(&unique_key("stress_difference", name, &mut names), &TENSOR, &apart, &steps)?;
        }
    }
    for (name, displacement) in &dossier.displacements {
        if displacement.len() == mesh.triangles.len() {
            let values = lattice.values(|t, sub, l| {
                let [x, y] = displacement.at(t, on_triangle(sub, l));
                [x, y, 0.0]
            });
            out.field(&unique_key("displacement", name, &mut names), &VECTOR, &values)?;
        }
    }
    if let Some(motion) = dossier.motion.as_ref().filter(|motion| motion.len() == mesh.points.len()) {
        let values = lattice.values(|t, sub, l| {
            let [x, y] = within(mesh.triangles[t].map(|v| motion[v]), sub, l);
            [x, y, 0.0]
        });
        out.field("motion", &VECTOR, &values)?;
    }
    out.close("PointData")
}

/// The steps of stresses at every node: a power of two for each triangle, from the largest stress in it of any model.
fn steps(dossier: &Dossier, lattice: &Lattice) -> Vec<f64> {
    let all =
        || dossier.dual.map(|dual| &dual.stress).into_iter().chain(dossier.stresses.iter().map(|(_, stress)| *stress));
    let step = |t: usize| {
        let values = all().filter(|stress| t < stress.len()).flat_map(|stress| stress.block(t).as_flattened());
        let largest = values.filter(|x| x.is_finite()).fold(0.0_f64, |m, x| m.max(x.abs()));
        // Weighted stresses have another size than those that are written.
        if largest > 0.0 && !dossier.problem.section().is_revolved() {
            STEP * largest.log2().floor().exp2()
        } else {
            0.0
        }
    };
    let of = |t: usize| std::iter::repeat_n(step(t), lattice.nodes(t));
    (0..lattice.degrees.len()).flat_map(of).collect()
}

fn cell_data(out: &mut Sheet, dossier: &Dossier, lattice: &Lattice) -> std::io::Result<()> {
    let mesh = &dossier.problem.mesh;
    let on_cells = |value: &dyn Fn(usize) -> i64| -> Vec<u8> {
        let of = |t: usize| std::iter::repeat_n(value(t), lattice.cells(t));
        (0..mesh.triangles.len()).flat_map(of).flat_map(i64::to_le_bytes).collect()
    };
    let spread = |values: &[f64]| -> Vec<f64> {
        values.iter().enumerate().flat_map(|(t, v)| std::iter::repeat_n(*v, lattice.cells(t))).collect()
    };
    out.open("CellData", &[])?;
    out.array("triangle", "Int64", &[], on_cells(&|t| t as i64))?;
    out.array("body", "Int64", &[], on_cells(&|t| mesh.body[t] as i64))?;
    if !mesh.cells.is_empty() {
        let cell = mesh.cell_of_triangles();
        out.array("cell", "Int64", &[], on_cells(&|t| cell[t] as i64))?;
    }
    if lattice.degrees.iter().any(|p| *p != 1) {
        out.array("degree", "Int64", &[], on_cells(&|t| lattice.degrees[t] as i64))?;
    }
    if let Some(friction) = OnTriangles::of(dossier) {
        out.array("friction_state", "Int64", &[], on_cells(&|t| friction.state[t]))?;
        for (key, values) in [("tangential_traction", &friction.traction), ("friction_bound", &friction.bound)] {
            out.field(key, &[], &spread(values))?;
        }
    }
    for map in dossier.maps.iter().filter(|map| map.values.len() == mesh.triangles.len()) {
        out.field(&map.key, &[], &spread(&map.values))?;
    }
    out.close("CellData")
}

/// Interpolates linearly on subtriangle `sub`, from values at the corners of the triangle, with their mean at the centroid.
fn within(a: [[f64; 2]; 3], sub: usize, l: [f64; 3]) -> [f64; 2] {
    let centre = [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / 3.0);
    let corners = [a[(sub + 1) % 3], a[(sub + 2) % 3], centre];
    [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum())
}

/// Barycentric coordinates on the triangle, from those on subtriangle `sub`.
fn on_triangle(sub: usize, l: [f64; 3]) -> [f64; 3] {
    let mut all = [l[2] / 3.0; 3];
    all[(sub + 1) % 3] += l[0];
    all[(sub + 2) % 3] += l[1];
    all
}

/// σ_33, nothing in plane stress.
fn out_of_plane(problem: &Problem, t: usize, s: [f64; 3], at: [f64; 2]) -> f64 {
    problem.mesh.body.get(t).map_or(0.0, |&body| problem.material(body).out_of_plane(s, at))
}

/// Von Mises stress of (xx, yy, xy) in triangle `t`.
pub(crate) fn von_mises(problem: &Problem, t: usize, s: [f64; 3], at: [f64; 2]) -> f64 {
    problem.mesh.body.get(t).map_or(0.0, |&body| problem.material(body).von_mises(s, at))
}

/// tr σ / 3.
fn mean_stress(problem: &Problem, t: usize, s: [f64; 3], at: [f64; 2]) -> f64 {
    (s[0] + s[1] + out_of_plane(problem, t, s, at)) / 3.0
}

/// `kind` and the name in letters that every program reads, made unique.
fn unique_key(kind: &str, name: &str, taken: &mut Vec<String>) -> String {
    let mut key = format!("{kind}_{}", plain(name));
    while taken.contains(&key) {
        key.push('_');
    }
    taken.push(key.clone());
    key
}

/// A name in letters that every program reads.
pub fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

#[cfg(test)]
#[path = "vtu_tests.rs"]
mod tests;
