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

use super::UpperBound;
use super::strain::strains;
use crate::dual::modes::materials;
use crate::element::{Displacement, StressField};
use crate::problem::Problem;

/// m = (λ + c e(v))/2, linear on each subtriangle; `None` for stresses of higher degree, which that could not hold.
pub fn mid_field(problem: &Problem, stress: &StressField, v: &Displacement) -> Option<StressField> {
    if stress.largest_degree() != 1 || stress.len() != v.values.len() {
        return None;
    }
    let mesh = &problem.mesh;
    let materials = materials(problem);
    let mut mid = stress.clone();
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        for (sub, values) in mid.block_mut(t).chunks_exact_mut(3).enumerate() {
            let at_midpoints = strains(corners, sub, &v.sub(t, sub)).map(|e| materials[mesh.body[t]].stress(e));
            for (corner, value) in values.iter_mut().enumerate() {
                for c in 0..3 {
                    // A linear function at a corner, from the midpoints of the sides.
                    let [p, q, r] = [0, 1, 2].map(|k| at_midpoints[(corner + k) % 3][c]);
                    value[c] = 0.5 * (value[c] + q + r - p);
                }
            }
        }
    }
    Some(mid)
}

impl UpperBound {
    /// Largest ‖τ(u) − m‖_a for the mid-field of this displacement, where `gap` is the guaranteed gap to λ_h.
    pub fn mid_error(&self, gap: f64) -> f64 {
        let constitutive: f64 = self.local.triangles.iter().sum();
        // The constitutive error is a part of the gap; rounding must not make it more.
        (gap - 0.5 * (constitutive - self.widening).clamp(0.0, gap.max(0.0))).max(0.0).sqrt()
    }
}
