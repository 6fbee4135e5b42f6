//! The gap between both energies, term by term:
//!
//! 𝓛(v) + Π(λ) = ½‖c e(v) − λ‖²_a + ∫_{ΓK} (−t(λ)) (g − (v' − v'')·n̂) ds
//!
//! (with friction also ∫ (τ̄ |j_t| + t_t j_t), see [`super::friction`]) for equilibrated λ with T' = t n̂ on Γ_K and admissible v; t is T_n where the direction of contact n̂ is the normal n'. It
//! shares no arithmetic with the energies.

use rayon::prelude::*;

use super::friction::friction_error;
use super::jump::openings;
use super::rounding::counted::Counted;
use super::rounding::sum::Sum;
use super::springs::{elastic_contact_error, spring_error};
use crate::dual::equilibrium::contact_traction;
use crate::element::geometry::sub_area;
use crate::element::polynomial::side;
use crate::element::{Displacement, Samples, Strains, StressField, elastic_degree};
use crate::problem::{ContactPair, Problem};

/// The gap between 𝓛(v) and −Π(λ), in local non-negative terms.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalGap {
    /// ½‖c e(v) − λ‖²_a on each triangle.
    pub triangles: Vec<f64>,
    /// ∫ (−t)(g − (v' − v'')·n̂) ds on each contact pair, interface by interface, and ∫ (τ̄ |j_t| + t_t j_t) ds where there is friction.
    pub pairs: Vec<Vec<f64>>,
    /// ½ ∫ (k j + t)²/k on each pair of springs and elastic layers, one after the other.
    pub springs: Vec<f64>,
    /// Their sum.
    pub total: f64,
}

impl LocalGap {
    /// Of the terms of all triangles, of all contact pairs, one interface after the other, and of all springs.
    pub fn of(problem: &Problem, triangles: Vec<f64>, pairs: Vec<f64>, springs: Vec<f64>) -> Self {
        let total: Sum = triangles.iter().chain(&pairs).chain(&springs).copied().collect();
        let mut pairs = pairs.into_iter();
        let pairs = problem.interfaces.iter().map(|of| pairs.by_ref().take(of.pairs.len()).collect()).collect();
        LocalGap { triangles, pairs, springs, total: total.value() }
    }
}

/// Integrates the local terms of the gap, thickness included.
pub fn local_gap(problem: &Problem, stress: &StressField, v: &Displacement) -> LocalGap {
    let triangles = constitutive_error(problem, stress, v, Counted::ALL);
    let contact = contact_error(problem, stress, v, Counted::ALL);
    LocalGap::of(problem, triangles, contact, spring_error(problem, stress, v, Counted::ALL))
}

/// ∫ (−t)(g − (v' − v'')·n̂) ds and what friction has of the gap on each contact pair, the part of an elastic one in its place, thickness
/// included; zero where it is not counted.
pub fn contact_error(problem: &Problem, stress: &StressField, v: &Displacement, counted: Counted<'_>) -> Vec<f64> {
    let of = |(p, pair): (usize, &ContactPair)| {
        if !counted.pair(p) {
            return 0.0;
        }
        if pair.stiffness.is_some() {
            return elastic_contact_error(problem, stress, v, pair);
        }
        let t = contact_traction(problem, stress, pair);
        let contact = -problem.scene.thickness * pair.length * side::integral(&t, &openings(problem, v, pair));
        contact + friction_error(problem, stress, v, pair)
    };
    problem.pairs().enumerate().map(of).collect()
}

/// ½‖c e(v) − λ‖²_a on each triangle, thickness included; zero where it is not counted.
pub fn constitutive_error(problem: &Problem, stress: &StressField, v: &Displacement, counted: Counted<'_>) -> Vec<f64> {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let thickness = problem.scene.thickness;
    (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| {
            if !counted.triangle(t) {
                return 0.0;
            }
            let material = &materials[mesh.body[t]];
            let corners = mesh.corners(t);
            if let Some(revolved) = problem.section().revolved() {
                let force = problem.body_force(t);
                return thickness * revolved.constitutive_error(stress, v, t, corners, material, force);
            }
            let (of_v, own) = (elastic_degree(v.degree(t), material), stress.degree(t));
            let (samples, shapes) = (Samples::of(of_v, own), Samples::of_stress(own, of_v));
            let mut sum = 0.0;
            let mut strains = Strains::default();
            for sub in 0..3 {
                strains.elastic(corners, v, t, sub, material);
                for (q, (_, weight)) in samples.points.iter().enumerate() {
                    let e = strains.sample(samples, q);
                    let of_stress = material.strain(stress.sample(t, sub, shapes, q));
                    let d = [e[0] - of_stress[0], e[1] - of_stress[1], e[2] - of_stress[2]];
                    sum += 0.5 * weight * sub_area(corners) * material.strain_product(d, d);
                }
            }
            thickness * sum
        })
        .collect()
}
