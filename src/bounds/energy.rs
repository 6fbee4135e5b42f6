//! Complementary and potential energy: −Π(λ) = −½∫ a λ:λ + ∫_{Γu} T·u0 + ∫_{ΓK} T_n g and 𝓛(v) = ½∫ c e(v):e(v) − ∫F·v − ∫_{Γτ} P·v.

use rayon::prelude::*;

use super::counted::Counted;
use super::jump::side_coefficients;
use super::sum::Sum;
use crate::dual::equilibrium::contact_traction;
use crate::element::Strains;
use crate::element::geometry::sub_area;
use crate::element::{Displacement, Material, Samples, Section, StressField, side, triangle};
use crate::problem::{ContactPair, Problem};

/// Complementary energy of a stress field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Complementary {
    /// 𝒮(λ) = ½∫ a λ:λ.
    pub strain: f64,
    /// ∫_{Γu} T·u0.
    pub support_work: f64,
    /// ∫_{ΓK} T_n g ≤ 0.
    pub gap_work: f64,
    /// Sum of the absolute values of all terms.
    pub magnitude: f64,
    /// What a relative error of one in every number that enters could change: Σ |∂/∂x| |x|.
    pub sensitivity: f64,
}

impl Complementary {
    /// −Π(λ), the lower bound.
    pub fn lower(&self) -> f64 {
        (self.support_work + self.gap_work) - self.strain
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

/// ‖σ‖²_a, per unit thickness.
pub fn square(problem: &Problem, stress: &StressField) -> f64 {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let of = |t: usize| square_on(stress, t, &materials[mesh.body[t]], mesh.area(t) / 3.0);
    let terms: Vec<f64> = (0..mesh.triangles.len()).into_par_iter().with_min_len(256).map(of).collect();
    terms.into_iter().collect::<Sum>().value()
}

/// Computes the complementary energy of `stress`, thickness included.
pub fn complementary(problem: &Problem, stress: &StressField) -> Complementary {
    complementary_of(problem, stress, Counted::ALL)
}

/// What `counted` has of it.
pub fn complementary_of(problem: &Problem, stress: &StressField, counted: Counted<'_>) -> Complementary {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let terms: Vec<(f64, f64)> = (0..mesh.triangles.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|t| {
            if !counted.triangle(t) {
                return (0.0, 0.0);
            }
            let material = &materials[mesh.body[t]];
            let third = mesh.area(t) / 3.0;
            if let Some(revolved) = problem.section().revolved() {
                let force = problem.scene.bodies[mesh.body[t]].body_force[0];
                let [square, sensitivity] = revolved.square(stress, t, mesh.corners(t), material, force);
                return (0.5 * square, sensitivity * shape(mesh.corners(t)));
            }
            let sum = 0.5 * square_on(stress, t, material, third);
            let nodes = stress.block(t);
            let product = |value: &[f64; 3]| material.spread(*value);
            let sensitivity = 3.0 * third / nodes.len() as f64 * nodes.iter().map(product).sum::<f64>();
            (sum, sensitivity * shape(mesh.corners(t)))
        })
        .collect();
    let strain: Sum = terms.iter().map(|t| t.0).collect();
    let sensitivity: f64 = terms.iter().map(|t| t.1).sum();
    let support = support_work_of(problem, stress, counted);
    let mut gap = Sum::default();
    for (_, pair) in problem.pairs().enumerate().filter(|(p, _)| counted.pair(*p)) {
        let t = contact_traction(problem, stress, pair);
        gap.add(pair.length * side::integral(&t, &pair.gap_polynomial()));
    }
    let t = problem.scene.thickness;
    Complementary {
        strain: t * strain.value(),
        support_work: t * support.value(),
        gap_work: t * gap.value(),
        magnitude: t * (strain.magnitude() + support.magnitude() + gap.magnitude()),
        sensitivity: t * (sensitivity + support.magnitude() + gap.magnitude()),
    }
}

/// What the pressures of `stress` do at most on the part of the gaps that lies above their polynomials, thickness included.
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
    /// ½∫ c e(v):e(v).
    pub strain: f64,
    /// ∫F·v + ∫P·v.
    pub work: f64,
    /// Sum of the absolute values of all terms.
    pub magnitude: f64,
    /// What a relative error of one in every number that enters could change: Σ |∂/∂x| |x|.
    pub sensitivity: f64,
}

impl Potential {
    /// 𝓛(v).
    pub fn total(&self) -> f64 {
        self.strain - self.work
    }
}

/// Computes the potential energy of `v`, thickness included.
pub fn potential(problem: &Problem, v: &Displacement) -> Potential {
    potential_of(problem, v, Counted::ALL)
}

/// What `counted` has of it.
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
    let t = problem.scene.thickness;
    Potential {
        strain: t * strain.value(),
        work: t * work.value(),
        magnitude: t * (strain.magnitude() + work.magnitude()),
        sensitivity: t * (sensitivity + work.magnitude()),
    }
}

/// ½∫ c e(v):e(v) on triangle `t`, per unit thickness, and what a relative error of one in every number could change.
pub fn strain_on(problem: &Problem, v: &Displacement, t: usize) -> [f64; 2] {
    strain_of(problem, v, t, t)
}

/// The same for the displacement that `v` has as its triangle `own`, on triangle `t`.
pub fn strain_of(problem: &Problem, v: &Displacement, own: usize, t: usize) -> [f64; 2] {
    strain_with(problem.section(), &problem.material(problem.mesh.body[t]), problem.mesh.corners(t), v, own)
}

fn strain_with(section: Section, material: &Material, corners: [[f64; 2]; 3], v: &Displacement, t: usize) -> [f64; 2] {
    if let Some(revolved) = section.revolved() {
        let [energy, sensitivity] = revolved.strain_energy(v, t, corners, material);
        return [energy, sensitivity * shape(corners)];
    }
    let area = sub_area(corners);
    let samples = Samples::of(v.degree(t) - 1, 0);
    let (mut strain, mut sensitivity) = (0.0, 0.0);
    let mut strains = Strains::default();
    for sub in 0..3 {
        strains.on(corners, v, t, sub);
        for (q, (_, weight)) in samples.points.iter().enumerate() {
            let e = strains.sample(samples, q);
            strain += 0.5 * weight * area * material.strain_product(e, e);
            sensitivity += weight * area * absolute(material.stress(e)) * strains.spread(samples, q);
        }
    }
    [strain, sensitivity * shape(corners)]
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
    force: impl Fn(usize) -> [f64; 2],
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
) -> Sum {
    counted_work(problem, v, force, tractions, Counted::ALL)
}

fn counted_work(
    problem: &Problem,
    v: &Displacement,
    force: impl Fn(usize) -> [f64; 2],
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
    counted: Counted<'_>,
) -> Sum {
    let (mesh, section) = (&problem.mesh, problem.section());
    let mut work = Sum::default();
    for t in (0..mesh.triangles.len()).filter(|t| counted.triangle(*t)) {
        let force = force(mesh.body[t]);
        if force != [0.0; 2] {
            if section.is_revolved() {
                for sub in 0..3 {
                    let forces = section.body_forces(mesh.corners(t), sub, v.degree(t), force);
                    for c in 0..2 {
                        work.add(v.sub(t, sub).zip(&forces).map(|(u, f)| u[c] * f[c]).sum());
                    }
                }
                continue;
            }
            // Every Bernstein polynomial has the same mean.
            let share = sub_area(mesh.corners(t)) / triangle::len(v.degree(t)) as f64;
            // Component by component: what cancels between them is rounded all the same.
            for (sub, c) in (0..3).flat_map(|sub| [0, 1].map(|c| (sub, c))) {
                work.add(v.sub(t, sub).map(|u| share * force[c] * u[c]).sum());
            }
        }
    }
    let tractions = tractions.filter(|(e, _)| counted.boundary_edge(mesh, *e));
    tractions.for_each(|(e, ends)| work.extend(work_on_edge(problem, v, e, ends)));
    work
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

/// What relative errors of the edge vectors do to the area, relative to it: one for a good triangle, its aspect ratio
/// for a sliver.
pub fn shape(corners: [[f64; 2]; 3]) -> f64 {
    let square = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2);
    let [a, b, c] = corners;
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    (longest / (6.0 * sub_area(corners))).max(1.0)
}
