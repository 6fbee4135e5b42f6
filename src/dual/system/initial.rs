//! Initial strains in the dual problem: what ∫ λ:ε0 asks of the modes.
//!
//! An affine ε0 is the strain of a quadratic displacement w, and modes are in equilibrium: ∫ τ_k:ε0 = ∫ T(τ_k)·w over the boundary of the
//! triangle. So ε0 acts like moments of the displacement that come on top: S = Tᵀ(m − m_w), whatever the degree and exactly.

use rayon::prelude::*;

use crate::dual::modes::ModeTable;
use crate::element::polynomial::side;
use crate::element::revolved::Motion;
use crate::problem::Problem;

/// −∫ τ_k:ε0 of every mode of every triangle; empty where no body has an initial strain. In a body of revolution
/// only of the part of it that is the strain of a displacement: the element has the rest with what it balances.
pub fn initial_parameters(problem: &Problem, modes: &ModeTable) -> Vec<f64> {
    let materials = problem.materials();
    if materials.iter().all(|material| material.initial().is_none()) {
        return Vec::new();
    }
    let mesh = &problem.mesh;
    let mut out = vec![0.0; modes.parameters()];
    modes.split_parameters(&mut out).into_par_iter().enumerate().with_min_len(256).for_each(|(t, own)| {
        let initial = materials[mesh.body[t]].initial();
        if !initial.is_none() {
            let (corners, degree) = (mesh.corners(t), modes.degree(t));
            let moments = match problem.section().axis() {
                None => {
                    let centre = [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0);
                    boundary_moments(corners, |point| initial.displacement(centre, point), degree)
                }
                Some(axis) => match Motion::new(initial, axis, corners) {
                    Some(motion) => boundary_moments(corners, |point| motion.at(point), degree),
                    None => return,
                },
            };
            modes.of(t).parameters_from_moments(&moments, own);
            own.iter_mut().for_each(|s| *s = -*s);
        }
    });
    out
}

/// Moments on the sides of a triangle of a quadratic displacement, conjugate to traction coefficients of degree `p`.
fn boundary_moments(corners: [[f64; 2]; 3], displacement: impl Fn([f64; 2]) -> [f64; 2], p: usize) -> Vec<f64> {
    let mut out = vec![0.0; 6 * (p + 1)];
    for (i, own) in out.chunks_exact_mut(2 * (p + 1)).enumerate() {
        let [a, b] = [i + 1, i + 2].map(|j| corners[j % 3]);
        let middle = [0, 1].map(|c| 0.5 * (a[c] + b[c]));
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let [first, inner, last] = [a, middle, b].map(&displacement);
        for c in 0..2 {
            let coefficients = [first[c], 2.0 * inner[c] - 0.5 * (first[c] + last[c]), last[c]];
            let along = side::moments(&coefficients, p);
            own.iter_mut().skip(c).step_by(2).zip(along).for_each(|(m, v)| *m = length * v);
        }
    }
    out
}
