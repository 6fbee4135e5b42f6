//! The integrals of adjoint pairs over bodies of revolution, where stresses are weighted and strains have a hoop.

use super::pass::{BALANCED, Fields, PAIR, TERMS};
use crate::bounds::Sum;
use crate::bounds::energy::shape;
use crate::element::revolved::{Strained, Tensor, work};
use crate::element::{Displacement, Material, Revolved, StressField};
use crate::load::BodyForce;
use crate::problem::Problem;

/// The sums of triangle `t`, as those of [`super::pass::pass`]; the adjoint load has neither body forces nor strains.
pub fn triangle(
    problem: &Problem,
    revolved: Revolved,
    material: &Material,
    t: usize,
    fields: Fields<'_>,
) -> [f64; TERMS] {
    let Fields { known: (stress, displacement), adjoint, lifted, factor, .. } = fields;
    let (law, corners) = (material.revolved(), problem.mesh.corners(t));
    let balanced = revolved.stresses_on(adjoint, t, corners, &BodyForce::NONE);
    let own = revolved.stresses_on(stress, t, corners, problem.body_force(t));
    let (mut of_z, mut of_v) = (Strained::default(), Strained::default());
    let modulus = law.strain_product(ALONG, ALONG);
    let degree = lifted.degree(t).max(displacement.degree(t)).max(stress.degree(t)).max(adjoint.degree(t)).max(3);
    let mut out = [0.0; TERMS];
    for at in revolved.points(corners, 2 * degree) {
        let (sigma, spread) = balanced[at.sub].stress(&at.point);
        let (z, spread_of_z) = of_z.at(lifted, t, corners, &at);
        let lambda = own[at.sub].stress(&at.point).0;
        let of_displacement = law.stress(of_v.strain(displacement, t, corners, &at));
        let middle = [0, 1, 2, 3].map(|c| 0.5 * (lambda[c] + of_displacement[c]));
        // What 1/r is in: the majorant adds to its square.
        let [rr, zz, _, rz] = sigma;
        let singular = law.strain([rr, zz, 0.0, rz]);
        let strain = law.strain(sigma);
        let size: f64 = sigma.iter().map(|s| s.abs()).sum::<f64>() + spread;
        let strains: f64 = strain.iter().map(|e| e.abs()).sum();
        let by = at.by;
        for (first, factor) in [(PAIR, factor), (PAIR + 3, 0.0)] {
            let off = [0, 1, 2, 3].map(|c| strain[c] - factor * z[c]);
            let mut over = singular;
            over[2] -= factor * z[2];
            out[first] += by * (law.strain_product(off, off) + at.point.excess * law.strain_product(over, over));
            out[first + 1] += by * work(off, middle);
            out[first + 2] += by * (size * strains + modulus * (factor * spread_of_z).powi(2));
        }
        out[BALANCED] += by * law.product(sigma, sigma);
    }
    [PAIR + 2, PAIR + 5].into_iter().for_each(|i| out[i] *= shape(corners));
    out
}

/// A strain of one along r.
const ALONG: Tensor = [1.0, 0.0, 0.0, 0.0];

/// The squares of the norms of λ and of σ(v) together, on all triangles: of the fields, and if nothing cancelled in them.
pub fn squares(problem: &Problem, revolved: Revolved, stress: &StressField, displacement: &Displacement) -> [f64; 2] {
    let materials = problem.materials();
    let mut sums = [Sum::default(), Sum::default()];
    for t in 0..problem.mesh.triangles.len() {
        let (corners, material) = (problem.mesh.corners(t), &materials[problem.mesh.body[t]]);
        let [of_stress, first] = revolved.square(stress, t, corners, material, problem.body_force(t));
        let [half, second] = revolved.strain_energy(displacement, t, corners, material);
        sums[0].add(of_stress + 2.0 * half);
        sums[1].add(shape(corners) * (first + second));
    }
    sums.map(|sum| sum.value())
}

/// ∫ σ(v) : e(w) r.
pub fn product(problem: &Problem, revolved: Revolved, v: &Displacement, w: &Displacement) -> f64 {
    let materials = problem.materials();
    let mut sum = Sum::default();
    for t in (0..problem.mesh.triangles.len()).filter(|t| w.largest(*t) != 0.0) {
        let (corners, law) = (problem.mesh.corners(t), materials[problem.mesh.body[t]].revolved());
        let (mut of_v, mut of_w) = (Strained::default(), Strained::default());
        for at in revolved.points(corners, 2 * v.degree(t).max(w.degree(t))) {
            let [e, d] = [of_v.strain(v, t, corners, &at), of_w.strain(w, t, corners, &at)];
            sum.add(at.by * law.strain_product(e, d));
        }
    }
    sum.value()
}
