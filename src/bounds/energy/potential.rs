//! Potential energy: 𝓛(v) = ½∫ c (e(v) − ε0):(e(v) − ε0) + ∫_{ΓK} τ̄ |j_t| − ∫F·v − ∫_{Γτ} P·v.

use rayon::prelude::*;

use super::work::counted_work;
use super::{absolute, initial_on, shape};
use crate::bounds::friction::potential_of_friction;
use crate::bounds::mid::stress_of;
use crate::bounds::rounding::counted::Counted;
use crate::bounds::rounding::sum::Sum;
use crate::bounds::springs::potential_of_springs;
use crate::element::geometry::sub_area;
use crate::element::{Displacement, Material, Samples, Section, Strains, elastic_degree};
use crate::problem::Problem;

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
