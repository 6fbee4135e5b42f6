//! The mid-field: half-way between λ_h and the stress of an admissible displacement, and half the bound.
//!
//! For the exact stress τ, an equilibrated λ and an admissible v
//!
//! ½‖τ − λ‖²_a ≤ 𝓛(u) + Π(λ) and ½‖τ − c e(v)‖²_a ≤ 𝓛(v) − 𝓛(u), hence ½‖τ − λ‖²_a + ½‖τ − c e(v)‖²_a ≤ gap,
//!
//! and by the parallelogram law, with m = (λ + c e(v))/2,
//!
//! ‖τ − m‖²_a ≤ gap − ½ · ½‖c e(v) − λ‖²_a.
//!
//! Where no complementarity term takes part, ½‖c e(v) − λ‖²_a is the whole gap, τ lies on the hypercircle of Prager and
//! Synge about m, and the bound is √(gap/2): half of the √(2·gap) that holds for λ and c e(v).

use rayon::prelude::*;

use super::UpperBound;
use crate::element::polynomial::triangle;
use crate::element::{Displacement, StressField};
use crate::element::{Strains, elastic_degree};
use crate::problem::Problem;

/// m = (λ + c e(v))/2, of the higher degree of the two; `None` where they are on different meshes.
pub fn mid_field(problem: &Problem, stress: &StressField, v: &Displacement) -> Option<StressField> {
    // Weighted stresses and those of a displacement have no common space.
    if stress.len() != v.len() || problem.section().is_revolved() {
        return None;
    }
    let own = degrees(problem, v);
    let degree = |t: usize| stress.degree(t).max(own(t));
    let mut mean = with_stresses(problem, v, degree);
    for t in 0..stress.len() {
        let own = stress.in_degree(t, degree(t));
        mean.block_mut(t).iter_mut().zip(own.iter()).for_each(|(m, own)| *m = [0, 1, 2].map(|c| 0.5 * (own[c] + m[c])));
    }
    Some(mean)
}

/// The degrees of the stresses of a displacement.
fn degrees<'a>(problem: &'a Problem, v: &'a Displacement) -> impl Fn(usize) -> usize + Sync + 'a {
    let materials = problem.materials();
    move |t| elastic_degree(v.degree(t), &materials[problem.mesh.body[t]])
}

/// The stress of a displacement, of its degree less one, or linear where the initial strain is.
pub fn stress_of(problem: &Problem, v: &Displacement) -> StressField {
    with_stresses(problem, v, degrees(problem, v))
}

/// The stress of a displacement in the given degrees, which are no lower than its own.
fn with_stresses(problem: &Problem, v: &Displacement, degree: impl Fn(usize) -> usize + Sync) -> StressField {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let mut field = StressField::of_degrees((0..v.len()).map(&degree));
    field.blocks_mut().into_par_iter().enumerate().with_min_len(128).for_each(|(t, block)| {
        let (corners, material, degree) = (mesh.corners(t), &materials[mesh.body[t]], degree(t));
        let mut strains = Strains::default();
        for (sub, values) in block.chunks_exact_mut(triangle::len(degree)).enumerate() {
            strains.elastic(corners, v, t, sub, material);
            for (value, node) in values.iter_mut().zip(triangle::indices(degree)) {
                let l = node.map(|i| if degree == 0 { 1.0 / 3.0 } else { i as f64 / degree as f64 });
                *value = material.stress(strains.at(l));
            }
        }
    });
    field
}

impl UpperBound {
    /// Largest ‖τ(u) − m‖_a for the mid-field of this displacement, where `gap` is the guaranteed gap to λ_h.
    pub fn mid_error(&self, gap: f64) -> f64 {
        let constitutive: f64 = self.local.triangles.iter().sum();
        // The constitutive error is a part of the gap; rounding must not make it more.
        (gap - 0.5 * (constitutive - self.widening).clamp(0.0, gap.max(0.0))).max(0.0).sqrt()
    }
}
