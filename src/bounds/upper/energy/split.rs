//! The energy of one triangle whose displacement is of degree k on each of its three subtriangles.
//!
//! Unknowns are the coefficients in the order of [`SplitNodes`], the boundary first; x and y of each follow one another.
//! The gradients of Bernstein polynomials of degree k are combinations of those of degree k − 1 with the gradients of the
//! barycentric coordinates, so that
//!
//! ∫ c e(B_a x̂_p) : e(B_b x̂_q) = Σ_ij k² (mean of B_{a − e_i} B_{b − e_j}) ∫ c e(l_i x̂_p) : e(l_j x̂_q).
//!
//! The first factors are the same for all triangles ([`Reference`]).

use std::sync::OnceLock;

use super::cholesky::{column, packed};
use crate::element::displacement::{MOST, SplitNodes, split_len};
use crate::element::geometry::{sub_area, sub_corners, sub_gradients};
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::polynomial::triangle;
use crate::element::revolved::{Tensor, Weighted};
use crate::element::{Material, Samples, Section, StressField};
use crate::load::BodyForce;

/// K of the strain energy ½ uᵀKu, per unit thickness.
#[derive(Debug, Clone)]
pub struct Split {
    /// Unknowns on the boundary, 6k.
    pub boundary: usize,
    /// Unknowns inside.
    pub inside: usize,
    matrix: Vec<f64>,
}

impl Split {
    /// That of a counter-clockwise triangle for displacements of degree `k`.
    pub fn new(k: usize, corners: [[f64; 2]; 3], material: &Material) -> Self {
        let all = 2 * split_len(k);
        let mut split = Split { boundary: 6 * k, inside: all - 6 * k, matrix: vec![0.0; all * all] };
        let area = sub_area(corners);
        let reference = Reference::of(k);
        for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
            let pairs = pairs(sub_gradients(corners, sub), area, material);
            for entry in &reference.entries {
                let mut sum = [0.0; 4];
                for (weight, i, j) in &reference.terms[entry.terms.clone()] {
                    let pair = &pairs[*i][*j];
                    (0..4).for_each(|c| sum[c] += weight * pair[c]);
                }
                split.put(nodes[entry.nodes[0]], nodes[entry.nodes[1]], sum);
            }
        }
        split
    }

    /// As [`Self::new`], for a triangle of the given section.
    pub fn of(section: Section, k: usize, corners: [[f64; 2]; 3], material: &Material) -> Self {
        let Some(revolved) = section.revolved() else { return Self::new(k, corners, material) };
        let all = 2 * split_len(k);
        let mut split = Split { boundary: 6 * k, inside: all - 6 * k, matrix: vec![0.0; all * all] };
        for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
            revolved.stiffness(k, corners, sub, material, |a, b, pair| split.put(nodes[a], nodes[b], pair));
        }
        split
    }

    /// A row of K.
    pub fn row(&self, i: usize) -> &[f64] {
        let all = self.boundary + self.inside;
        &self.matrix[i * all..(i + 1) * all]
    }

    /// The lower triangle of the unknowns inside, as [`super::cholesky`] takes it.
    pub fn inside(&self) -> Vec<f64> {
        let mut block = vec![0.0; packed(self.inside)];
        for j in 0..self.inside {
            let row = &self.row(self.boundary + j)[self.boundary + j..];
            block[column(self.inside, j)..][..row.len()].copy_from_slice(row);
        }
        block
    }

    /// Adds the stiffness between two nodes, which are given in one of the two orders.
    fn put(&mut self, a: usize, b: usize, [xx, xy, yx, yy]: Pair) {
        let all = self.boundary + self.inside;
        let mut add = |i: usize, j: usize, value: f64| self.matrix[i * all + j] += value;
        for (i, j, value) in [(0, 0, xx), (0, 1, xy), (1, 0, yx), (1, 1, yy)] {
            add(2 * a + i, 2 * b + j, value);
            if a != b {
                add(2 * b + j, 2 * a + i, value);
            }
        }
    }
}

/// The forces of a body force on every coefficient of degree `k`, x and y of each.
pub fn load(section: Section, k: usize, corners: [[f64; 2]; 3], force: &BodyForce) -> Vec<f64> {
    let mut out = vec![0.0; 2 * split_len(k)];
    for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
        if let Some(revolved) = section.revolved() {
            for (node, [x, y]) in nodes.iter().zip(revolved.body_forces(corners, sub, k, force)) {
                out[2 * node] += x;
                out[2 * node + 1] += y;
            }
            continue;
        }
        let force = force.on(sub_corners(corners, sub)).of_area(sub_area(corners));
        for (node, alpha) in nodes.iter().zip(triangle::indices(k)) {
            let [x, y] = force.against(alpha);
            out[2 * node] += x;
            out[2 * node + 1] += y;
        }
    }
    out
}

/// Adds to them the forces ∫ σ : e(φ) of a stress on triangle `t`, which has these corners.
pub fn pull(k: usize, corners: [[f64; 2]; 3], stress: &StressField, t: usize, out: &mut [f64]) {
    let area = sub_area(corners);
    let samples = Samples::of(k - 1, stress.degree(t));
    let shapes = Samples::of_stress(stress.degree(t), k - 1);
    for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
        let g = sub_gradients(corners, sub);
        for (q, (_, weight)) in samples.points.iter().enumerate() {
            let s = stress.sample(t, sub, shapes, q);
            let forces = g.map(|g| [s[0] * g[0] + s[2] * g[1], s[2] * g[0] + s[1] * g[1]]);
            for (beta, b) in triangle::indices(k - 1).zip(samples.basis(q)) {
                let by = k as f64 * area * weight * b;
                for (i, force) in forces.iter().enumerate() {
                    let node = nodes[triangle::number(triangle::raised(beta, i))];
                    out[2 * node] += by * force[0];
                    out[2 * node + 1] += by * force[1];
                }
            }
        }
    }
}

/// Adds to them the forces ∫ σ : e(φ) r of a weighted stress, given on the three subtriangles, on the coefficients of degree `k`.
pub fn pull_revolved(k: usize, corners: [[f64; 2]; 3], stress: &[Weighted; 3], out: &mut [f64]) {
    let area = sub_area(corners);
    for (sub, (nodes, stress)) in SplitNodes::of(k).subs.iter().zip(stress).enumerate() {
        let g = sub_gradients(corners, sub);
        for &(l, weight) in triangle_rule(stress.degree() + k) {
            let (s, hoop, weight) = (stress.sigma(l), stress.hoop(l), area * weight);
            let forces = g.map(|g| [s[0] * g[0] + s[2] * g[1], s[2] * g[0] + s[1] * g[1]]);
            for (beta, b) in triangle::indices(k - 1).zip(triangle::basis(k - 1, l)) {
                for (i, force) in forces.iter().enumerate() {
                    let node = nodes[triangle::number(triangle::raised(beta, i))];
                    (0..2).for_each(|c| out[2 * node + c] += k as f64 * weight * b * force[c]);
                }
            }
            // λ_θθ φ_r/r · r.
            for (node, b) in nodes.iter().zip(triangle::basis(k, l)) {
                out[2 * node] += weight * b * hoop;
            }
        }
    }
}

/// Adds to them the forces ∫ σ : e(φ) r of a constant or linear stress (rr, zz, tt, rz) of a body of revolution, given at points of
/// subtriangles.
pub fn pull_linear(
    section: Section,
    k: usize,
    corners: [[f64; 2]; 3],
    stress: impl Fn(usize, [f64; 3]) -> Tensor,
    out: &mut [f64],
) {
    let area = sub_area(corners);
    for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
        let (g, places) = (sub_gradients(corners, sub), sub_corners(corners, sub));
        for &(l, weight) in triangle_rule(k + 1) {
            let [rr, zz, tt, rz] = stress(sub, l);
            let radius: f64 = (0..3).map(|i| l[i] * section.weight(places[i])).sum();
            let weight = area * weight;
            for (beta, b) in triangle::indices(k - 1).zip(triangle::basis(k - 1, l)) {
                for (i, [gr, gz]) in g.iter().enumerate() {
                    let node = nodes[triangle::number(triangle::raised(beta, i))];
                    let by = k as f64 * weight * b * radius;
                    out[2 * node] += by * (rr * gr + rz * gz);
                    out[2 * node + 1] += by * (rz * gr + zz * gz);
                }
            }
            for (node, b) in nodes.iter().zip(triangle::basis(k, l)) {
                out[2 * node] += weight * b * tt;
            }
        }
    }
}

/// Stiffness between two nodes: xx, xy, yx, yy with x and y of the first before those of the second.
type Pair = [f64; 4];

/// Coefficients of the gradient products in the stiffness of a subtriangle.
struct Reference {
    entries: Vec<Entry>,
    /// Weight, i and j of a product.
    terms: Vec<(f64, usize, usize)>,
}

/// Two coefficients of a subtriangle, each pair in one order.
struct Entry {
    nodes: [usize; 2],
    terms: std::ops::Range<usize>,
}

impl Reference {
    fn of(k: usize) -> &'static Reference {
        static KNOWN: [OnceLock<Reference>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
        KNOWN[k].get_or_init(|| Reference::new(k))
    }

    fn new(k: usize) -> Self {
        let (mut entries, mut terms) = (Vec::new(), Vec::new());
        for (a, alpha) in triangle::indices(k).enumerate() {
            for (b, beta) in triangle::indices(k).enumerate().take(a + 1) {
                let start = terms.len();
                for i in 0..3 {
                    for j in 0..3 {
                        let lowered = triangle::lowered(alpha, i).zip(triangle::lowered(beta, j));
                        terms.extend(lowered.map(|(p, q)| ((k * k) as f64 * triangle::product(p, q), i, j)));
                    }
                }
                entries.push(Entry { nodes: [a, b], terms: start..terms.len() });
            }
        }
        Reference { entries, terms }
    }
}

/// ∫ c e(l_i x̂_p) : e(l_j x̂_q) for barycentric coordinates l with gradients `g`.
fn pairs(g: [[f64; 2]; 3], area: f64, material: &Material) -> [[Pair; 3]; 3] {
    let stiffness = material.stiffness(area);
    g.map(|a| g.map(|b| stiffness.between(a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Displacement;
    use crate::element::Strains;
    use crate::scene::Kinematics;

    const CORNERS: [[f64; 2]; 3] = [[0.3, -0.2], [1.9, 0.1], [0.7, 1.4]];

    #[test]
    fn agrees_with_the_energy_of_the_strains_by_quadrature() {
        for (kinematics, nu) in
            [(Kinematics::PlaneStrain, 0.3), (Kinematics::PlaneStrain, 0.499), (Kinematics::PlaneStress, 0.2)]
        {
            let material = Material::isotropic(kinematics, 3.0, nu);
            for k in 1..=MOST {
                let split = Split::new(k, CORNERS, &material);
                let value = |n: usize| f64::from((20 * k as u32 + n as u32 + 1) * 7919 % 1009) / 1009.0 - 0.5;
                let mut u = Displacement::zeros([k]);
                u.block_mut(0).iter_mut().enumerate().for_each(|(n, u)| *u = [value(2 * n), value(2 * n + 1)]);
                let flat = u.block(0).as_flattened();
                let row = |i: usize| split.row(i).iter().zip(flat).map(|(k, u)| k * u).sum::<f64>();
                let form: f64 = flat.iter().enumerate().map(|(i, u)| u * row(i)).sum();
                let (mut exact, mut strains) = (0.0, Strains::default());
                let samples = Samples::of(k - 1, k);
                for sub in 0..3 {
                    strains.on(CORNERS, &u, 0, sub);
                    for (q, (_, weight)) in samples.points.iter().enumerate() {
                        let e = strains.sample(samples, q);
                        exact += sub_area(CORNERS) * weight * material.strain_product(e, e);
                    }
                }
                assert!((form - exact).abs() < 1e-11 * exact, "degree {k}: {form} is not {exact}");
            }
        }
    }

    #[test]
    fn the_load_is_the_work_of_the_body_force() {
        for k in 1..=MOST {
            let forces = load(Section::Slice, k, CORNERS, &BodyForce::constant([2.0, -3.0]));
            // A unit translation does the work of the whole force.
            let work = |c: usize| forces.iter().skip(c).step_by(2).sum::<f64>();
            let area = 3.0 * sub_area(CORNERS);
            assert!((work(0) - 2.0 * area).abs() < 1e-13 && (work(1) + 3.0 * area).abs() < 1e-13);
        }
    }
}
