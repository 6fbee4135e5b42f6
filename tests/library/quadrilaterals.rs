//! Fields on quadrilaterals: their energies against quadrature that shares no code, and their certificates against errors that are
//! known exactly.

use std::path::Path;

use crate::support::random::Random;
use hypercircle::bounds::{strain_energy, strain_energy_by};
use hypercircle::compare::Judged;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Material, Quadrilateral};
use hypercircle::problem::Problem;
use hypercircle::scene::{Kinematics, Scene};
use hypercircle::study::{self, Certified, FieldArrays, ForeignField};

const NODES: [[f64; 2]; 9] =
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, 0.0]];

/// The textbook's function of node `i` of four, eight or nine, at (s, t).
fn shape(nodes: usize, i: usize, [s, t]: [f64; 2]) -> f64 {
    let [x, y] = NODES[i];
    match (nodes, i) {
        (4, _) => 0.25 * (1.0 + x * s) * (1.0 + y * t),
        (8, 0..=3) => 0.25 * (1.0 + x * s) * (1.0 + y * t) * (x * s + y * t - 1.0),
        (8, _) if x == 0.0 => 0.5 * (1.0 - s * s) * (1.0 + y * t),
        (8, _) => 0.5 * (1.0 + x * s) * (1.0 - t * t),
        _ => {
            let along = |x: f64, s: f64| if x == 0.0 { 1.0 - s * s } else { 0.5 * s * (s + x) };
            along(x, s) * along(y, t)
        }
    }
}

/// ½∫ σ(v):e(v) in plane stress, E = 1, ν = 0.3, by central differences and three points on many small squares.
fn energy(corners: [[f64; 2]; 4], values: &[[f64; 2]], squares: usize) -> f64 {
    let d = 1e-4;
    let slope = |f: &dyn Fn([f64; 2]) -> f64, at: [f64; 2]| {
        // Exact for the polynomials of degree 2 that these are.
        let [s, t] = at;
        [(f([s + d, t]) - f([s - d, t])) / (2.0 * d), (f([s, t + d]) - f([s, t - d])) / (2.0 * d)]
    };
    let interpolated = |nodes: usize, values: &[[f64; 2]], c: usize, at: [f64; 2]| -> f64 {
        values.iter().enumerate().map(|(i, v)| shape(nodes, i, at) * v[c]).sum()
    };
    let step = 2.0 / squares as f64;
    let gauss = [(-(0.6_f64.sqrt()), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)];
    let mut sum = 0.0;
    for cell in 0..squares * squares {
        let middle = [cell % squares, cell / squares].map(|k| -1.0 + (k as f64 + 0.5) * step);
        for (x, v) in gauss {
            for (y, w) in gauss {
                let at = [middle[0] + 0.5 * step * x, middle[1] + 0.5 * step * y];
                let [a, b] = [0, 1].map(|c| slope(&|at| interpolated(4, &corners, c, at), at));
                let determinant = a[0] * b[1] - a[1] * b[0];
                let [p, q] = [0, 1].map(|c| {
                    let [ds, dt] = slope(&|at| interpolated(values.len(), values, c, at), at);
                    [(ds * b[1] - dt * b[0]) / determinant, (dt * a[0] - ds * a[1]) / determinant]
                });
                let (xx, yy, xy) = (p[0], q[1], 0.5 * (p[1] + q[0]));
                let density = 0.5 / 0.91 * (xx * xx + yy * yy + 0.6 * xx * yy) + xy * xy / 1.3;
                sum += 0.25 * step * step * v * w * determinant * density;
            }
        }
    }
    sum
}

/// A convex quadrilateral of any shape, and values at its nodes.
fn any(random: &mut Random, nodes: usize) -> Option<Quadrilateral> {
    let corners =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|p: [f64; 2]| p.map(|x| x + random.between(-0.45, 0.45)));
    let values: Vec<[f64; 2]> = (0..nodes).map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]).collect();
    Quadrilateral::new(corners, &values)
}

#[test]
fn energies_by_few_and_many_points_differ_by_no_more_than_the_proven_error() {
    let material = Material::isotropic(Kinematics::PlaneStress, 1.0, 0.3);
    let mut random = Random::new(45);
    let (mut tried, mut bounded) = (0, 0);
    while tried < 300 {
        let Some(cell) = any(&mut random, [4, 8, 9][tried % 3]) else { continue };
        tried += 1;
        let [few, many] = [4, 12].map(|points| strain_energy_by(&cell, &material, points));
        let best = strain_energy(&cell, &material);
        let rounding = 1e-13 * best.sensitivity;
        assert!((few.value - many.value).abs() <= few.error + many.error + rounding, "{cell:?}");
        for other in [few, many] {
            assert!((other.value - best.value).abs() <= other.error + best.error + rounding, "{cell:?}");
        }
        assert!(best.error <= 1e-12 * best.sensitivity, "{best:?} of {cell:?}");
        bounded += usize::from(many.error < 1e-6 * many.value);
    }
    // The bound says something, too.
    assert!(bounded > tried / 2, "{bounded} of {tried}");
}

/// With a corner of nearly 180 degrees, a side of nearly no length, and values that overflow.
#[test]
fn quadrilaterals_that_are_nearly_none_cost_no_more_than_others() {
    let material = Material::isotropic(Kinematics::PlaneStress, 1.0, 0.3);
    let values = [[0.1, 0.2], [-0.3, 0.5], [0.4, 0.1], [0.0, -0.2]];
    for small in [1e-2, 1e-5, 1e-8] {
        for corners in [
            [[0.0, 0.0], [1.0, 0.0], [0.5 + small, 0.5 + small], [0.0, 1.0]],
            [[0.0, 0.0], [small, 0.0], [1.0, 1.0], [0.0, 1.0]],
            [[0.0, 0.0], [1.0, 0.0], [1.0, small], [0.0, small]],
        ] {
            let cell = Quadrilateral::new(corners, &values).expect("convex");
            let found = strain_energy(&cell, &material);
            assert!(found.error <= 1e-12 * found.sensitivity, "{found:?} of {corners:?}");
        }
    }
    let huge =
        Quadrilateral::new([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.1, 1.0]], &values.map(|u| u.map(|x| 1e300 * x)));
    assert!(!strain_energy(&huge.expect("convex"), &material).value.is_finite());
}

#[test]
fn energies_are_those_of_other_quadrature() {
    let material = Material::isotropic(Kinematics::PlaneStress, 1.0, 0.3);
    let mut random = Random::new(8);
    let mut tried = 0;
    while tried < 12 {
        let Some(cell) = any(&mut random, [4, 8, 9][tried % 3]) else { continue };
        tried += 1;
        let [d0, d1, d2] = cell.determinant();
        if d0 - d1.abs() - d2.abs() < 0.2 * d0 {
            continue;
        }
        let (found, other) = (strain_energy(&cell, &material).value, energy(cell.corners(), cell.values(), 12));
        assert!((found - other).abs() < 1e-6 * found, "{found} and {other}");
    }
}

/// A strip of n by m quadrilaterals on the square, distorted at random, on a roller at x = 0 and a rigid obstacle at y = 0, pressed by 1
/// on the right and 2 from above: σ_xx = −1 and σ_yy = −2 alone.
struct Pressed {
    points: Vec<[f64; 2]>,
    cells: Vec<Vec<usize>>,
}

impl Pressed {
    fn new(random: &mut Random, n: usize, nodes: usize) -> Option<Self> {
        let side = 1.0 / n as f64;
        let mut points = Vec::new();
        for i in 0..(n + 1) * (n + 1) {
            let at = [i % (n + 1), i / (n + 1)];
            let moved = |k: usize, random: &mut Random| {
                let by = random.between(-0.4, 0.4) * side;
                k as f64 * side + if k == 0 || k == n { 0.0 } else { by }
            };
            points.push(at.map(|k| moved(k, random)));
        }
        let mut cells: Vec<Vec<usize>> = (0..n * n)
            .map(|c| {
                let a = c % n + (n + 1) * (c / n);
                let mut nodes = vec![a, a + 1, a + n + 2, a + n + 1];
                // In any of the eight orders.
                nodes.rotate_left(random.below(4));
                if random.chance(0.5) {
                    nodes.reverse();
                }
                nodes
            })
            .collect();
        let values = vec![[0.0; 2]; 4];
        let convex = |cell: &Vec<usize>| {
            let corners: Vec<[f64; 2]> = cell.iter().map(|n| points[*n]).collect();
            Quadrilateral::new([corners[0], corners[1], corners[2], corners[3]], &values).is_some()
        };
        if !cells.iter().all(convex) {
            return None;
        }
        if nodes > 4 {
            let mut between = std::collections::HashMap::new();
            for cell in &mut cells {
                let corners = cell.clone();
                for i in 0..4 {
                    let [a, b] = [corners[i], corners[(i + 1) % 4]];
                    let node = *between.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        points.push([0, 1].map(|c| 0.5 * (points[a][c] + points[b][c])));
                        points.len() - 1
                    });
                    cell.push(node);
                }
                if nodes == 9 {
                    points.push([0, 1].map(|c| 0.25 * corners.iter().map(|n| points[*n][c]).sum::<f64>()));
                    cell.push(points.len() - 1);
                }
            }
        }
        Some(Pressed { points, cells })
    }

    /// The mesh in a file of Gmsh, and the scene beside it.
    fn problem(&self, folder: &Path) -> Problem {
        let kind = [(4, 3), (8, 16), (9, 10)].iter().find(|(n, _)| *n == self.cells[0].len()).map_or(3, |k| k.1);
        let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n");
        text += &format!("{}\n", self.points.len());
        for (i, [x, y]) in self.points.iter().enumerate() {
            text += &format!("{} {x:?} {y:?} 0\n", i + 1);
        }
        text += &format!("$EndNodes\n$Elements\n{}\n", self.cells.len());
        for (i, nodes) in self.cells.iter().enumerate() {
            let list: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
            text += &format!("{} {kind} 2 1 1 {}\n", i + 1, list.join(" "));
        }
        std::fs::write(folder.join("mesh.msh"), text + "$EndElements\n").expect("writable");
        std::fs::write(folder.join("scene.toml"), SCENE).expect("writable");
        Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh")
    }
}

const SCENE: &str = r#"
[model]
kinematics = "plane-stress"
[mesh]
file = "mesh.msh"
[bodies.block]
young = 1.0
poisson = 0.3
[[boundaries]]
name = "left"
line = [[0, 0], [0, 1]]
[[boundaries]]
name = "foot"
line = [[0, 0], [1, 0]]
[[boundaries]]
name = "right"
line = [[1, 0], [1, 1]]
[[boundaries]]
name = "top"
line = [[0, 1], [1, 1]]
[[supports]]
on = "left"
type = "roller"
[[tractions]]
on = "right"
pressure = 1.0
[[tractions]]
on = "top"
pressure = 2.0
[[contacts]]
on = "foot"
"#;
/// 𝒮 of the exact stress: ½ (1 + 4 − 2 · 0.3 · 2).
const STRAIN: f64 = 1.9;

fn exact([x, y]: [f64; 2]) -> [f64; 2] {
    [(-1.0 + 0.6) * x, (-2.0 + 0.3) * y]
}

fn solved(problem: Problem) -> Certified {
    let options = Options { threads: 1, ..Options::default() };
    study::certify(problem, &Condensed::default(), &options).expect("a bracket")
}

/// The dual side has the exact stress, so that the certificate is the error itself, whatever the field: 𝓛(v) − 𝓛(u) is ½a(v − u, v − u)
/// and 2 ∫ v_y along the obstacle.
#[test]
fn the_certificate_of_a_field_on_a_distorted_mesh_is_its_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let material = Material::isotropic(Kinematics::PlaneStress, 1.0, 0.3);
    let mut random = Random::new(2);
    let mut tried = 0;
    while tried < 200 {
        let (n, nodes) = (if tried % 4 == 0 { 3 } else { 2 }, [4, 8, 9][tried % 3]);
        let Some(mesh) = Pressed::new(&mut random, n, nodes) else { continue };
        tried += 1;
        let certified = solved(mesh.problem(folder.path()));
        // Every fifth field is the exact one, of which rounding alone is left.
        let size = if tried % 5 == 0 { 0.0 } else { 0.1 };
        let lifted = size > 0.0 && random.chance(0.5);
        let spoilt: Vec<[f64; 2]> = mesh
            .points
            .iter()
            .map(|p| {
                let [x, y] = [random.between(-size, size), random.between(-size, size)];
                let up = if lifted { 0.02 } else { 0.0 };
                [if p[0] == 0.0 { 0.0 } else { x }, if p[1] == 0.0 { up } else { y }]
            })
            .collect();
        let values = mesh.points.iter().zip(&spoilt).map(|(p, e)| [exact(*p)[0] + e[0], exact(*p)[1] + e[1]]);
        let row = |v: [f64; 2]| v.to_vec();
        let arrays = FieldArrays {
            points: mesh.points.iter().map(|p| row(*p)).collect(),
            triangles: mesh.cells.clone(),
            displacement: values.map(row).collect(),
            single: false,
        };
        let field = ForeignField::of_arrays("field", arrays).expect("a field");
        let candidate = field.candidate(&certified.problem, 0.0).expect("on the mesh");
        let judged = Judged::new(
            &certified.problem,
            &certified.dual,
            candidate,
            hypercircle::compare::Extent::of(&certified.problem, &certified.bracket),
        )
        .expect("admissible");
        let mut error = if lifted { 2.0 * 0.02 } else { 0.0 };
        for nodes in &mesh.cells {
            let corners = [0, 1, 2, 3].map(|i| mesh.points[nodes[i]]);
            let around: f64 =
                (0..4).map(|i| corners[i][0] * corners[(i + 1) % 4][1] - corners[i][1] * corners[(i + 1) % 4][0]).sum();
            let order: [usize; 9] =
                if around > 0.0 { [0, 1, 2, 3, 4, 5, 6, 7, 8] } else { [0, 3, 2, 1, 7, 6, 5, 4, 8] };
            let own: Vec<[f64; 2]> = order.iter().take(nodes.len()).map(|i| spoilt[nodes[*i]]).collect();
            let corners = [0, 1, 2, 3].map(|i| corners[order[i]]);
            error += strain_energy(&Quadrilateral::new(corners, &own).expect("convex"), &material).value;
        }
        let found = judged.relative_error(&certified.bracket);
        let exact = (error / STRAIN).sqrt();
        assert!(found >= exact * (1.0 - 1e-12), "{found} below {exact}, mesh {tried}");
        let rounding = if size > 0.0 { 1e-12 } else { 1e-6 };
        assert!(found <= exact * (1.0 + 1e-9) + rounding, "{found} far above {exact}, mesh {tried}");
        let gap = judged.field.potential.total() - certified.bracket.lower();
        assert!((judged.field.local.total - gap).abs() < 1e-11 * STRAIN, "mesh {tried}");
        assert!(judged.field.local.triangles.iter().all(|t| *t >= 0.0), "squares, mesh {tried}");
    }
}
