//! Vertex values: the average of a local fit over the triangles at each vertex.
//!
//! On each triangle the strain of degree p nearest to aλ_h in the plain L² norm, integrated along straight lines from the
//! centroid (Cesàro), which for p = 1 is the displacement that has this strain:
//!
//! u_i(x) = ∫ (E_ij + (x_k − y_k)(∂_k E_ij − ∂_i E_kj)) dy_j.
//!
//! Its rigid part is that of the mean displacements of the three edges. The norm knows no material, so ν plays no part.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::element::displacement::MOST;
use crate::element::geometry::{from_centroid, gradients, sub_corners};
use crate::element::polynomial::quadrature::{segment_rule, triangle_rule};
use crate::element::polynomial::triangle;
use crate::element::revolved::{Held, Tensor};
use crate::element::{Material, Samples, SideValues, StressField, weighed};
use crate::load::BodyForce;
use crate::problem::Problem;

/// Strains beside that of a stress.
#[derive(Debug, Clone, Copy)]
pub enum Added<'a> {
    /// The initial strains of the scene, and what its forces add to the hoop.
    Scene,
    /// Constant ones (rr, zz, tt, rz) of triangles of a body of revolution, in their order.
    Constant(&'a [(usize, Tensor)]),
}

/// Averages of the local fits; where triangles of several degrees meet, of those of the highest.
///
/// `moments` are those of the displacement of every edge, `stress` is λ_h or what stands in its place; the strain is aλ_h with what is
/// `added`.
pub fn vertex_values(
    problem: &Problem,
    stress: &StressField,
    moments: &SideValues<[f64; 2]>,
    added: Added<'_>,
) -> Vec<[f64; 2]> {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let local: Vec<[[f64; 2]; 3]> = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| corner_values(problem, stress, moments, (&materials[mesh.body[t]], added), t))
        .collect();
    let degree = |t: usize| stress.degree(t);
    let mut highest = vec![0; mesh.points.len()];
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        triangle.iter().for_each(|&v| highest[v] = highest[v].max(degree(t)));
    }
    let mut sum = vec![[0.0; 2]; mesh.points.len()];
    let mut count = vec![0.0; mesh.points.len()];
    for (t, (triangle, values)) in mesh.triangles.iter().zip(&local).enumerate() {
        for (&v, value) in triangle.iter().zip(values).filter(|(v, _)| highest[**v] == degree(t)) {
            sum[v][0] += value[0];
            sum[v][1] += value[1];
            count[v] += 1.0;
        }
    }
    sum.into_iter().zip(count).map(|([x, y], n): ([f64; 2], f64)| [x / n.max(1.0), y / n.max(1.0)]).collect()
}

/// Values of the fit on triangle `t` at its corners.
fn corner_values(
    problem: &Problem,
    stress: &StressField,
    moments: &SideValues<[f64; 2]>,
    (material, added): (&Material, Added<'_>),
    t: usize,
) -> [[f64; 2]; 3] {
    let mesh = &problem.mesh;
    let corners = mesh.corners(t);
    let p = from_centroid(corners);
    let reference = Reference::of(stress.degree(t));
    let shapes = Samples::of_stress(stress.degree(t), stress.degree(t));
    let initial = material.initial();
    let with_initial = matches!(added, Added::Scene);
    let in_plane = |sub: usize, q: usize, l: [f64; 3]| {
        let own = material.strain(stress.sample(t, sub, shapes, q));
        if initial.is_none() || !with_initial {
            return own;
        }
        let corners = sub_corners(corners, sub);
        let added = initial.at([0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum()));
        [0, 1, 2].map(|c| own[c] + added[c])
    };
    let strain = match problem.section().revolved() {
        None => reference.strain(in_plane),
        Some(revolved) => {
            let force = if with_initial { problem.body_force(t) } else { &BodyForce::NONE };
            let of = revolved.plane_strain_of(stress, t, corners, material, force);
            let held = Held::on(material, corners).filter(|_| with_initial);
            let constant = match added {
                Added::Constant(strains) => strains.binary_search_by_key(&t, |(t, _)| *t).ok().map(|at| strains[at].1),
                Added::Scene => None,
            };
            reference.strain(|sub, _, l| {
                let own = of(sub, l);
                let Some([rr, zz, _, rz]) = held.map(|held| held.at(sub, l)).or(constant) else { return own };
                [own[0] + rr, own[1] + zz, own[2] + rz]
            })
        }
    };
    let local = Local { p, gradients: gradients(p), strain };
    // Rigid part: least squares between the edge means of the fit and those of the dual solution.
    let (mut shift, mut turn, mut inertia) = ([0.0; 2], 0.0, 0.0);
    for side in 0..3 {
        let (a, b) = (p[(side + 1) % 3], p[(side + 2) % 3]);
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let e = mesh.triangle_edges[t][side];
        let (length, _) = mesh.edge_frame(e);
        let mut off = [0, 1].map(|c| moments.of(e).iter().map(|m| m[c]).sum::<f64>() / length);
        for (path, weight) in &reference.sides[side] {
            let u = local.displacement(path);
            off = [0, 1].map(|c| off[c] - weight * u[c]);
        }
        shift[0] += off[0] / 3.0;
        shift[1] += off[1] / 3.0;
        // The three midpoints have the centroid as their mean, so shift and turn decouple.
        turn += middle[0] * off[1] - middle[1] * off[0];
        inertia += middle[0] * middle[0] + middle[1] * middle[1];
    }
    let turn = turn / inertia;
    [0, 1, 2].map(|i| {
        let (u, q) = (local.displacement(&reference.corners[i]), p[i]);
        [u[0] + shift[0] - turn * q[1], u[1] + shift[1] + turn * q[0]]
    })
}

/// A strain on one triangle.
struct Local {
    /// Corners about the centroid.
    p: [[f64; 2]; 3],
    /// Gradients of the barycentric coordinates.
    gradients: [[f64; 2]; 3],
    /// Bernstein coefficients (xx, yy, xy).
    strain: Vec<[f64; 3]>,
}

impl Local {
    /// The displacement at the end of a path from the centroid, where it and its rotation are zero.
    fn displacement(&self, path: &Path) -> [f64; 2] {
        let [x, y] = [0, 1].map(|c| (0..3).map(|i| path.end[i] * self.p[i][c]).sum::<f64>());
        let mut u = [0.0; 2];
        for point in &path.points {
            let e = weighed(&self.strain, point.value.iter().copied());
            let slopes = point.slopes.each_ref().map(|slope| weighed(&self.strain, slope.iter().copied()));
            let slope = |c: usize, d: usize| (0..3).map(|i| slopes[i][c] * self.gradients[i][d]).sum::<f64>();
            // By how much the rotation grows along the line.
            let turn = (slope(0, 1) - slope(2, 0)) * x + (slope(2, 1) - slope(1, 0)) * y;
            u[0] += point.weight * (e[0] * x + e[2] * y + point.left * y * turn);
            u[1] += point.weight * (e[2] * x + e[1] * y - point.left * x * turn);
        }
        u
    }
}

/// Parts of the fit that are the same for all triangles.
struct Reference {
    /// Points of each subtriangle: which, the number of the point in its rule, and where it is in its own barycentric coordinates.
    samples: Vec<(usize, usize, [f64; 3])>,
    /// Coefficients of the nearest polynomial from the values there.
    projection: DMatrix<f64>,
    /// To each corner.
    corners: [Path; 3],
    /// To points of each side, with weights that make the mean.
    sides: [Vec<(Path, f64)>; 3],
}

/// The straight line from the centroid to a point.
struct Path {
    /// Barycentric coordinates of the point.
    end: [f64; 3],
    /// Quadrature along the line.
    points: Vec<Along>,
}

/// A point on the line.
struct Along {
    weight: f64,
    /// The part of the line that is still to go.
    left: f64,
    /// Bernstein polynomials.
    value: Vec<f64>,
    /// Their derivatives for each barycentric coordinate.
    slopes: [Vec<f64>; 3],
}

impl Reference {
    /// For strains of degree `p`.
    fn of(p: usize) -> &'static Reference {
        static KNOWN: [OnceLock<Reference>; MOST] = [const { OnceLock::new() }; MOST];
        KNOWN[p].get_or_init(|| Reference::new(p))
    }

    fn new(p: usize) -> Self {
        let size = triangle::len(p);
        let mass = DMatrix::from_fn(size, size, |i, j| {
            let index = |n: usize| triangle::indices(p).nth(n).unwrap_or([p, 0, 0]);
            triangle::product(index(i), index(j))
        });
        let rule = triangle_rule(2 * p);
        let of_sub = |sub| rule.iter().enumerate().map(move |(q, (m, _))| (sub, q, *m));
        let samples: Vec<(usize, usize, [f64; 3])> = (0..3).flat_map(of_sub).collect();
        let weights = rule.iter().map(|(_, weight)| weight / 3.0).cycle();
        let columns: Vec<f64> = samples
            .iter()
            .zip(weights)
            .flat_map(|((sub, _, m), weight)| triangle::basis(p, in_triangle(*sub, *m)).map(move |b| weight * b))
            .collect();
        let moments = DMatrix::from_column_slice(size, samples.len(), &columns);
        let projection = mass.cholesky().map_or_else(|| moments.clone(), |mass| mass.solve(&moments));
        let unit = |i: usize| [0, 1, 2].map(|j| f64::from(i == j));
        let side = |i: usize| {
            let point = |&(s, weight): &(f64, f64)| {
                let mut l = [0.0; 3];
                (l[(i + 1) % 3], l[(i + 2) % 3]) = (1.0 - s, s);
                (Path::new(p, l), weight)
            };
            segment_rule(p + 1).iter().map(point).collect()
        };
        Reference { samples, projection, corners: [0, 1, 2].map(|i| Path::new(p, unit(i))), sides: [0, 1, 2].map(side) }
    }

    /// Coefficients of the nearest strain in L².
    fn strain(&self, value: impl Fn(usize, usize, [f64; 3]) -> [f64; 3]) -> Vec<[f64; 3]> {
        let mut strain = vec![[0.0; 3]; self.projection.nrows()];
        for ((sub, q, l), column) in self.samples.iter().zip(self.projection.column_iter()) {
            let e = value(*sub, *q, *l);
            for (s, w) in strain.iter_mut().zip(column.iter()) {
                (0..3).for_each(|c| s[c] += w * e[c]);
            }
        }
        strain
    }
}

impl Path {
    fn new(p: usize, end: [f64; 3]) -> Self {
        let along = |&(s, weight): &(f64, f64)| {
            let l = end.map(|l| (1.0 - s) / 3.0 + s * l);
            let slope = |i: usize| {
                let of =
                    |alpha| triangle::lowered(alpha, i).map_or(0.0, |beta| p as f64 * triangle::bernstein(beta, l));
                triangle::indices(p).map(of).collect()
            };
            let value = triangle::basis(p, l).collect();
            Along { weight, left: 1.0 - s, value, slopes: [0, 1, 2].map(slope) }
        };
        Path { end, points: segment_rule(p).iter().map(along).collect() }
    }
}

/// Barycentric coordinates in the triangle of a point of subtriangle `sub`.
fn in_triangle(sub: usize, m: [f64; 3]) -> [f64; 3] {
    let mut l = [m[2] / 3.0; 3];
    l[(sub + 1) % 3] += m[0];
    l[(sub + 2) % 3] += m[1];
    l
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u = (x³y, −2xy³ + x²y), whose strain is of degree three.
    fn field([x, y]: [f64; 2]) -> [f64; 2] {
        [x.powi(3) * y, -2.0 * x * y.powi(3) + x * x * y]
    }

    fn strain([x, y]: [f64; 2]) -> [f64; 3] {
        [3.0 * x * x * y, -6.0 * x * y * y + x * x, 0.5 * (x.powi(3) - 2.0 * y.powi(3) + 2.0 * x * y)]
    }

    #[test]
    fn a_polynomial_comes_back_from_its_strain_up_to_a_rigid_motion() {
        let corners = [[0.4, -0.3], [1.7, 0.2], [0.1, 1.2]];
        let centre = [0, 1].map(|c| corners.iter().map(|q| q[c]).sum::<f64>() / 3.0);
        let place = |l: [f64; 3]| [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum::<f64>());
        for p in 3..=5 {
            let reference = Reference::of(p);
            let found = reference.strain(|sub, _, m| strain(place(in_triangle(sub, m))));
            let local = Local {
                p: corners.map(|q| [q[0] - centre[0], q[1] - centre[1]]),
                gradients: gradients(corners),
                strain: found,
            };
            // Translation and rotation at the centroid.
            let base = field(centre);
            let [x, y] = centre;
            let turn = 0.5 * (-2.0 * y.powi(3) + 2.0 * x * y - x.powi(3));
            let sides = reference.sides.iter().flatten().map(|(path, _)| path);
            for path in reference.corners.iter().chain(sides) {
                let [dx, dy] = [0, 1].map(|c| place(path.end)[c] - centre[c]);
                let u = local.displacement(path);
                let exact = field(place(path.end));
                assert!((u[0] + base[0] - turn * dy - exact[0]).abs() < 1e-12, "degree {p}");
                assert!((u[1] + base[1] + turn * dx - exact[1]).abs() < 1e-12, "degree {p}");
            }
        }
    }
}
