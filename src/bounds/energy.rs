//! Complementary and potential energy: −Π(λ) = −½∫ a λ:λ − ∫ λ:ε0 + ∫_{Γu} T·u0 + ∫_{ΓK} T_n g and 𝓛(v) = ½∫ c (e(v) − ε0):(e(v) − ε0) + ∫_{ΓK} τ̄ |j_t| − ∫F·v − ∫_{Γτ} P·v.

use rayon::prelude::*;

use super::friction::potential_of_friction;
use super::jump::side_coefficients;
use super::mid::stress_of;
use super::rounding::counted::Counted;
use super::rounding::sum::Sum;
use super::springs::{complementary_of_springs, potential_of_springs};
use crate::dual::equilibrium::contact_traction;
use crate::element::geometry::{sub_area, sub_corners};
use crate::element::polynomial::{side, triangle};
use crate::element::{Displacement, Material, Samples, Section, StressField, contraction};
use crate::element::{Strains, elastic_degree};
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

/// ‖σ‖²_a, per unit thickness; of a stress without body forces in a body of revolution.
pub fn square(problem: &Problem, stress: &StressField) -> f64 {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let of = |t: usize| match problem.section().revolved() {
        None => square_on(stress, t, &materials[mesh.body[t]], mesh.area(t) / 3.0),
        Some(revolved) => revolved.square(stress, t, mesh.corners(t), &materials[mesh.body[t]], &BodyForce::NONE)[0],
    };
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

/// Potential energy of a displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Potential {
    /// ½∫ c (e(v) − ε0):(e(v) − ε0).
    pub strain: f64,
    /// ½∫ k j² of springs and elastic layers.
    pub springs: f64,
    /// ∫ τ̄ |j_t| of contacts with friction.
    pub friction: f64,
    /// ∫F·v + ∫P·v.
    pub work: f64,
    /// Sum of the absolute values of all terms.
    pub magnitude: f64,
    /// Largest change caused by a relative error of one in every number that enters: Σ |∂/∂x| |x|.
    pub sensitivity: f64,
}

impl Potential {
    /// The energy of strains and springs, without friction, which stores none.
    pub fn stored(&self) -> f64 {
        self.strain + self.springs
    }

    /// 𝓛(v).
    pub fn total(&self) -> f64 {
        self.stored() + self.friction - self.work
    }
}

/// Computes the potential energy of `v`, thickness included.
pub fn potential(problem: &Problem, v: &Displacement) -> Potential {
    potential_of(problem, v, Counted::ALL)
}

/// As [`potential`], restricted to the triangles, edges and pairs of `counted`.
pub fn potential_of(problem: &Problem, v: &Displacement, counted: Counted<'_>) -> Potential {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let terms: Vec<[f64; 2]> = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| {
            if !counted.triangle(t) {
                return [0.0; 2];
            }
            strain_with(problem.section(), &materials[mesh.body[t]], mesh.corners(t), v, t)
        })
        .collect();
    let strain: Sum = terms.iter().map(|t| t[0]).collect();
    let sensitivity: f64 = terms.iter().map(|t| t[1]).sum();
    let force = |body: usize| problem.scene.bodies[body].body_force;
    let work = counted_work(problem, v, force, problem.tractions(), counted);
    let springs = potential_of_springs(problem, v, counted);
    let friction = potential_of_friction(problem, v, counted);
    let t = problem.scene.thickness;
    Potential {
        strain: t * strain.value(),
        springs: springs.value,
        friction: friction.value,
        work: t * work.value(),
        magnitude: t * (strain.magnitude() + work.magnitude()) + springs.value + friction.value,
        sensitivity: t * (sensitivity + work.magnitude()) + springs.sensitivity + friction.sensitivity,
    }
}

/// ½∫ c (e(v) − ε0):(e(v) − ε0) on triangle `t`, per unit thickness, and what a relative error of one in every number could change.
pub fn strain_on(problem: &Problem, v: &Displacement, t: usize) -> [f64; 2] {
    strain_with(problem.section(), &problem.material(problem.mesh.body[t]), problem.mesh.corners(t), v, t)
}

/// ½∫ c e(v):e(v), without initial strain, for the displacement that `v` has as its triangle `own`, on triangle `t`.
pub fn strain_of(problem: &Problem, v: &Displacement, own: usize, t: usize) -> [f64; 2] {
    let material = problem.material(problem.mesh.body[t]).without_initial();
    strain_with(problem.section(), &material, problem.mesh.corners(t), v, own)
}

fn strain_with(section: Section, material: &Material, corners: [[f64; 2]; 3], v: &Displacement, t: usize) -> [f64; 2] {
    if let Some(revolved) = section.revolved() {
        let [energy, sensitivity] = revolved.strain_energy(v, t, corners, material);
        return [energy, sensitivity * shape(corners)];
    }
    let area = sub_area(corners);
    let samples = Samples::of(elastic_degree(v.degree(t), material), 0);
    let (mut strain, mut sensitivity) = (0.0, 0.0);
    let mut strains = Strains::default();
    for sub in 0..3 {
        strains.elastic(corners, v, t, sub, material);
        for (q, (_, weight)) in samples.points.iter().enumerate() {
            let e = strains.sample(samples, q);
            strain += 0.5 * weight * area * material.strain_product(e, e);
            sensitivity += weight * area * absolute(material.stress(e)) * strains.spread(samples, q);
        }
    }
    [strain, sensitivity * shape(corners)]
}

/// ½∫ cε0:ε0, thickness included: the energy of bodies that are held as they are.
pub fn initial_energy(problem: &Problem) -> f64 {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    if materials.iter().all(|material| material.initial().is_none()) {
        return 0.0;
    }
    let of = |t: usize| {
        let (material, corners) = (&materials[mesh.body[t]], mesh.corners(t));
        if let Some(revolved) = problem.section().revolved() {
            return 0.5 * revolved.initial_square(corners, material);
        }
        let middles = [0, 1, 2].map(|i| [0, 1].map(|c| 0.5 * (corners[i][c] + corners[(i + 1) % 3][c])));
        let at = |x: [f64; 2]| material.strain_product(material.initial().at(x), material.initial().at(x));
        mesh.area(t) / 6.0 * middles.map(at).iter().sum::<f64>()
    };
    problem.scene.thickness * (0..mesh.triangles.len()).map(of).sum::<f64>()
}

/// ∫ σ(v):ε0, thickness included.
pub fn initial_work(problem: &Problem, v: &Displacement) -> f64 {
    if problem.scene.bodies.iter().all(|body| body.initial.is_none()) {
        return 0.0;
    }
    let (mesh, materials) = (&problem.mesh, problem.materials());
    if let Some(revolved) = problem.section().revolved() {
        let of = |t: usize| revolved.initial_work(v, t, mesh.corners(t), &materials[mesh.body[t]]);
        return problem.scene.thickness * (0..mesh.triangles.len()).map(of).collect::<Sum>().value();
    }
    let stress = stress_of(problem, v);
    let of = |t: usize| initial_on(&stress, t, &materials[mesh.body[t]], mesh.corners(t), mesh.area(t) / 3.0)[0];
    problem.scene.thickness * (0..mesh.triangles.len()).map(of).collect::<Sum>().value()
}

/// The work of the loads on `v`, ∫F·v + ∫P·v, per unit thickness.
pub fn work(problem: &Problem, v: &Displacement) -> Sum {
    work_of(problem, v, |body| problem.scene.bodies[body].body_force, problem.tractions())
}

/// The work on `v` of a body force of each body, and of tractions given by their values at the ends of edges, per unit
/// thickness.
pub fn work_of(
    problem: &Problem,
    v: &Displacement,
    force: impl Fn(usize) -> BodyForce,
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
) -> Sum {
    counted_work(problem, v, force, tractions, Counted::ALL)
}

fn counted_work(
    problem: &Problem,
    v: &Displacement,
    force: impl Fn(usize) -> BodyForce,
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
    counted: Counted<'_>,
) -> Sum {
    let (mesh, section) = (&problem.mesh, problem.section());
    let mut work = Sum::default();
    for t in (0..mesh.triangles.len()).filter(|t| counted.triangle(*t)) {
        let force = force(mesh.body[t]);
        if !force.is_none() {
            if let Some(revolved) = section.revolved() {
                work.extend(revolved.work_inside(&force, mesh.corners(t), v, t));
                continue;
            }
            work.extend(work_inside(&force, mesh.corners(t), v, t));
        }
    }
    let tractions = tractions.filter(|(e, _)| counted.boundary_edge(mesh, *e));
    tractions.for_each(|(e, ends)| work.extend(work_on_edge(problem, v, e, ends)));
    work
}

/// The work on `v` of tractions along edges of any kind, by their Bernstein coefficients, per unit thickness.
pub fn work_on_edges(problem: &Problem, v: &Displacement, tractions: &[(usize, Vec<[f64; 2]>)]) -> f64 {
    let mut work = Sum::default();
    for (e, coefficients) in tractions {
        let (length, _) = problem.mesh.edge_frame(*e);
        let u = side_coefficients(problem, v, *e);
        for c in 0..2 {
            let [t, u]: [Vec<f64>; 2] = [coefficients.iter().map(|t| t[c]).collect(), u.iter().map(|u| u[c]).collect()];
            work.add(length * side::integral(&t, &u));
        }
    }
    work.value()
}

/// The work of a body force on the displacement that `v` has as its triangle `t`, in the terms of a sum.
pub fn work_inside(force: &BodyForce, corners: [[f64; 2]; 3], v: &Displacement, t: usize) -> [f64; 6] {
    let forces = [0, 1, 2].map(|sub| force.on(sub_corners(corners, sub)).of_area(sub_area(corners)));
    // Component by component: what cancels between them is rounded all the same.
    [0, 1, 2, 3, 4, 5].map(|term| {
        let (sub, c) = (term / 2, term % 2);
        let weights = triangle::indices(v.degree(t)).map(|alpha| forces[sub].against(alpha)[c]);
        v.sub(t, sub).zip(weights).map(|(u, weight)| weight * u[c]).sum()
    })
}

/// The work on `v` of a traction with the given values at the ends of edge `e`, per unit thickness, by components.
fn work_on_edge(problem: &Problem, v: &Displacement, e: usize, [a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    if a == [0.0; 2] && b == [0.0; 2] {
        return [0.0; 2];
    }
    let (length, _) = problem.mesh.edge_frame(e);
    let u = side_coefficients(problem, v, e);
    let own = problem.weighted(e, [a, b]);
    let values = |list: &[[f64; 2]], c: usize| list.iter().map(|u| u[c]).collect::<Vec<_>>();
    let along = |c: usize| side::integral(&values(&own, c), &values(&u, c));
    [0, 1].map(|c| length * along(c))
}

fn absolute(s: [f64; 3]) -> f64 {
    s[0].abs() + s[1].abs() + s[2].abs()
}

/// Relative error of the area per relative error of the edge vectors: one for a good triangle, its aspect ratio for a sliver.
pub fn shape(corners: [[f64; 2]; 3]) -> f64 {
    let square = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2);
    let [a, b, c] = corners;
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    (longest / (6.0 * sub_area(corners))).max(1.0)
}
