//! Widening of the bracket by tractions of a higher degree than one.
//!
//! With r the difference between the traction and its nearest affine one on the edges, and σ_r the stress of least energy that balances r
//! on the triangles beside them, v is admissible for both loads, and λ + σ_r for the polynomial one. So the exact energy lies above −Π(λ) −
//! ∫ r·v − Σ √(2 gap_T) ‖σ_r‖_T − ½ ‖σ_r‖², because ∫ (aλ + ε0 − e(v)):σ_r is no larger than the third term and ∫ e(v):σ_r = ∫ r·v, and
//! below 𝓛(v) − ∫ r·v, both with 𝓛 and Π of the affine loads.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::energy::{square_of_section, work_on_edges};
use crate::element::{Displacement, StressField, block};
use crate::load::BodyForce;
use crate::problem::{Oscillation, Problem};

/// Round-off allowed in the balance of r, relative to the traction.
const BALANCED: f64 = 1e-9;

/// Amount by which r raises the upper bound of `v`, thickness included.
pub fn above(problem: &Problem, v: &Displacement) -> f64 {
    if problem.has_polynomial_tractions() { (-work(problem, &problem.oscillations(), v)).max(0.0) } else { 0.0 }
}

/// Amount by which r lowers the lower bound; `free` has a displacement and its gap on every triangle. Infinite without `free`.
pub fn below(problem: &Problem, free: Option<(&Displacement, &[f64])>) -> f64 {
    if !problem.has_polynomial_tractions() {
        return 0.0;
    }
    let Some((v, gaps)) = free else { return f64::INFINITY };
    work(problem, &problem.oscillations(), v).max(0.0) + balanced(problem, gaps).values().sum::<f64>()
}

/// Contributions of r to the width of the bracket, by the triangles beside its edges.
pub fn shares(problem: &Problem, v: &Displacement, gaps: &[f64]) -> Vec<(usize, f64)> {
    if !problem.has_polynomial_tractions() {
        return Vec::new();
    }
    let beside = |rest: Oscillation| {
        let t = problem.mesh.edges[rest.edge].triangles[0]?;
        Some((t, work(problem, &[rest], v).abs()))
    };
    let works = problem.oscillations().into_iter().filter_map(beside);
    works.chain(balanced(problem, gaps)).collect()
}

/// √(2 gap_T) ‖σ_r‖_T + ½ ‖σ_r‖²_T of the triangles beside loaded edges, thickness included.
fn balanced(problem: &Problem, gaps: &[f64]) -> BTreeMap<usize, f64> {
    let mut beside = BTreeMap::<usize, Vec<Oscillation>>::new();
    for rest in problem.oscillations() {
        if let Some(t) = problem.mesh.edges[rest.edge].triangles[0] {
            beside.entry(t).or_default().push(rest);
        }
    }
    let of_triangle = |(t, rests): (usize, Vec<Oscillation>)| {
        let square = problem.scene.thickness * least_square(problem, t, &rests);
        (t, (2.0 * gaps[t].max(0.0) * square).sqrt() + 0.5 * square)
    };
    beside.into_iter().map(of_triangle).collect()
}

/// ∫ r·v.
fn work(problem: &Problem, rests: &[Oscillation], v: &Displacement) -> f64 {
    let tractions: Vec<_> = rests.iter().map(|rest| (rest.edge, rest.rest.clone())).collect();
    problem.scene.thickness * work_on_edges(problem, v, &tractions)
}

/// ‖σ_r‖²_a of the stress of least energy on triangle `t`; of a block of the degree of the rest, which has every self-equilibrated traction.
fn least_square(problem: &Problem, t: usize, rests: &[Oscillation]) -> f64 {
    let degree = rests.iter().map(|rest| rest.rest.len() - 1).max().unwrap_or(1);
    let element = block(degree);
    let material = problem.material(problem.mesh.body[t]).without_initial();
    let (section, corners) = (problem.section(), problem.mesh.corners(t));
    let modes = section.modes(element, corners, &material);
    let count = element.tractions();
    let mut wanted = DVector::<f64>::zeros(count);
    for rest in rests {
        let Some(side) = problem.mesh.triangle_edges[t].iter().position(|e| *e == rest.edge) else { continue };
        for (k, value) in rest.rest.iter().enumerate() {
            (0..2).for_each(|c| wanted[2 * (degree + 1) * side + 2 * k + c] = value[c]);
        }
    }
    // Tractions of modes are independent.
    let tractions = DMatrix::from_row_slice(modes.parameters(), count, modes.traction());
    let normal = &tractions * tractions.transpose();
    let parameters = normal.cholesky().map(|factor| factor.solve(&(&tractions * &wanted)));
    let Some(parameters) = parameters else { return f64::INFINITY };
    // A rest is in balance but for rounding.
    let left = (tractions.transpose() * &parameters - &wanted).norm();
    let size = rests.iter().fold(0.0_f64, |m, rest| m.max(rest.size));
    if left > BALANCED * size {
        return f64::INFINITY;
    }
    let mut stress = StressField::of_degrees([degree]);
    section.stresses(element, corners, &BodyForce::NONE, &modes, parameters.as_slice(), stress.block_mut(0));
    square_of_section(section, &stress, 0, corners, &material) * (1.0 + BALANCED)
}
