//! Complementary energy: −Π(λ) = −½∫ a λ:λ − ∫ λ:ε0 + ∫_{Γu} T·u0 + ∫_{ΓK} T_n g.

use rayon::prelude::*;

use super::{absolute, shape};
use crate::bounds::rounding::counted::Counted;
use crate::bounds::rounding::sum::Sum;
use crate::bounds::springs::complementary_of_springs;
use crate::dual::equilibrium::contact_traction;
use crate::element::geometry::sub_corners;
use crate::element::polynomial::side;
use crate::element::{Material, Samples, Section, StressField, contraction};
use crate::load::BodyForce;
use crate::problem::{ContactPair, Problem};

/// Complementary energy of a stress field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Complementary {
    /// 𝒮(λ) = ½∫ a λ:λ.
    pub strain: f64,
    /// ∫ λ:ε0.
    pub initial: f64,
    /// ∫_{Γu} T·u0.
    pub support_work: f64,
    /// ∫_{ΓK} T_n g ≤ 0.
    pub gap_work: f64,
    /// ∫ t²/2k of springs and elastic layers.
    pub springs: f64,
    /// Sum of the absolute values of all terms.
    pub magnitude: f64,
    /// Largest change caused by a relative error of one in every number that enters: Σ |∂/∂x| |x|.
    pub sensitivity: f64,
}

impl Complementary {
    /// 𝒮(λ) and what springs store.
    pub fn stored(&self) -> f64 {
        self.strain + self.springs
    }

    /// −Π(λ), the lower bound.
    pub fn lower(&self) -> f64 {
        (self.support_work + self.gap_work) - self.stored() - self.initial
    }
}

/// ‖σ‖²_a on triangle `t`, a third of which has the area `third`.
pub fn square_on(stress: &StressField, t: usize, material: &Material, third: f64) -> f64 {
    let shapes = Samples::of_stress(stress.degree(t), 0);
    let mut sum = 0.0;
    for sub in 0..3 {
        for (q, (_, weight)) in shapes.points.iter().enumerate() {
            let value = stress.sample(t, sub, shapes, q);
            sum += weight * third * material.product(value, value);
        }
    }
    sum
}

/// ∫ σ:ε0 on triangle `t`, a third of which has the area `third`, and the integral of its absolute value.
pub fn initial_on(stress: &StressField, t: usize, material: &Material, corners: [[f64; 2]; 3], third: f64) -> [f64; 2] {
    let initial = material.initial();
    if initial.is_none() {
        return [0.0; 2];
    }
    let shapes = Samples::of_stress(stress.degree(t), 1);
    let (mut sum, mut size) = (0.0, 0.0);
    for sub in 0..3 {
        let q = sub_corners(corners, sub);
        for (i, (l, weight)) in shapes.points.iter().enumerate() {
            let value = stress.sample(t, sub, shapes, i);
            let strain = initial.at([0, 1].map(|c| (0..3).map(|k| l[k] * q[k][c]).sum()));
            sum += weight * third * contraction(value, strain);
            size += weight.abs() * third * absolute(value) * absolute(strain);
        }
    }
    [sum, size]
}

/// ‖σ‖²_a of the stress of triangle `t`, per unit thickness; without body forces in a body of revolution, and enclosed from above there.
pub fn square_of_section(
    section: Section,
    stress: &StressField,
    t: usize,
    corners: [[f64; 2]; 3],
    material: &Material,
) -> f64 {
    match section.revolved() {
        None => square_on(stress, t, material, section.volume(corners) / 3.0),
        Some(revolved) => revolved.square(stress, t, corners, material, &BodyForce::NONE)[0],
    }
}

/// ‖σ‖²_a, per unit thickness; of a stress without body forces in a body of revolution.
pub fn square(problem: &Problem, stress: &StressField) -> f64 {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let of = |t: usize| square_of_section(problem.section(), stress, t, mesh.corners(t), &materials[mesh.body[t]]);
    let terms: Vec<f64> = (0..mesh.triangles.len()).into_par_iter().with_min_len(256).map(of).collect();
    terms.into_iter().collect::<Sum>().value()
}

/// Computes the complementary energy of `stress`, thickness included.
pub fn complementary(problem: &Problem, stress: &StressField) -> Complementary {
    complementary_of(problem, stress, Counted::ALL)
}

/// As [`complementary`], restricted to the triangles, edges and pairs of `counted`.
pub fn complementary_of(problem: &Problem, stress: &StressField, counted: Counted<'_>) -> Complementary {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let terms: Vec<[f64; 3]> = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| {
            if !counted.triangle(t) {
                return [0.0; 3];
            }
            let material = &materials[mesh.body[t]];
            let third = mesh.area(t) / 3.0;
            if let Some(revolved) = problem.section().revolved() {
                let force = problem.body_force(t);
                let [square, sensitivity] = revolved.square(stress, t, mesh.corners(t), material, force);
                let [initial, size] = revolved.initial_on(stress, t, mesh.corners(t), material, force);
                return [0.5 * square, (sensitivity + 2.0 * size) * shape(mesh.corners(t)), initial];
            }
            let sum = 0.5 * square_on(stress, t, material, third);
            let nodes = stress.block(t);
            let product = |value: &[f64; 3]| material.spread(*value);
            let sensitivity = 3.0 * third / nodes.len() as f64 * nodes.iter().map(product).sum::<f64>();
            let [initial, size] = initial_on(stress, t, material, mesh.corners(t), third);
            [sum, (sensitivity + 2.0 * size) * shape(mesh.corners(t)), initial]
        })
        .collect();
    let strain: Sum = terms.iter().map(|t| t[0]).collect();
    let sensitivity: f64 = terms.iter().map(|t| t[1]).sum();
    let initial: Sum = terms.iter().map(|t| t[2]).collect();
    let support = support_work_of(problem, stress, counted);
    let mut gap = Sum::default();
    for (_, pair) in problem.pairs().enumerate().filter(|(p, _)| counted.pair(*p)) {
        let t = contact_traction(problem, stress, pair);
        gap.add(pair.length * side::integral(&t, &pair.gap_polynomial()));
    }
    let springs = complementary_of_springs(problem, stress, counted);
    let t = problem.scene.thickness;
    Complementary {
        strain: t * strain.value(),
        initial: t * initial.value(),
        support_work: t * support.value(),
        gap_work: t * gap.value(),
        springs: springs.value,
        magnitude: t * (strain.magnitude() + initial.magnitude() + support.magnitude() + gap.magnitude())
            + springs.value,
        sensitivity: t * (sensitivity + support.magnitude() + gap.magnitude()) + springs.sensitivity,
    }
}

/// Upper bound of the work of the pressures of `stress` on the part of the gaps above their polynomials, thickness included.
pub fn work_of_excess(problem: &Problem, stress: &StressField, counted: Counted<'_>) -> f64 {
    let curved = problem.pairs().enumerate().filter(|(p, pair)| pair.bow.excess() > 0.0 && counted.pair(*p));
    let work = curved.map(|(_, pair)| excess_work(pair, &contact_traction(problem, stress, pair)));
    problem.scene.thickness * work.sum::<f64>()
}

/// ∫ |t| (g − P) ds at most, for a traction by its coefficients, per unit thickness.
pub fn excess_work(pair: &ContactPair, t: &[f64]) -> f64 {
    let largest: Vec<f64> = t.iter().map(|t| t.abs()).collect();
    // Like 4 t (1 − t): the two agree at the ends.
    pair.length * pair.bow.excess() * side::integral(&largest, &[0.0, 2.0, 0.0])
}

/// ∫_{Γu} T·u0 of a stress, per unit thickness.
pub fn support_work(problem: &Problem, stress: &StressField) -> Sum {
    support_work_of(problem, stress, Counted::ALL)
}

fn support_work_of(problem: &Problem, stress: &StressField, counted: Counted<'_>) -> Sum {
    let mesh = &problem.mesh;
    let mut work = Sum::default();
    for (e, condition) in problem.conditions.iter().enumerate() {
        if let Some(ends) = condition.prescribed().filter(|ends| *ends != [[0.0; 2]; 2])
            && counted.boundary_edge(mesh, e)
        {
            let (length, _) = mesh.edge_frame(e);
            let degree = mesh.edges[e].triangles[0].map_or(1, |t| stress.degree(t));
            let tractions = stress.edge_traction(&problem.mesh, e, 0, degree);
            let u0 = side::linear_moments(ends, length, degree);
            for (t, u0) in tractions.iter().zip(u0) {
                work.extend([0, 1].map(|c| t[c] * u0[c]));
            }
        }
    }
    work
}
