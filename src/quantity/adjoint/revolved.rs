//! The integrals of adjoint pairs over bodies of revolution, where stresses are weighted and strains have a hoop.

use super::pass::{BALANCED, Fields, INITIAL, PAIR, TERMS};
use crate::bounds::Sum;
use crate::bounds::energy::shape;
use crate::element::revolved::{Held, Sampled, Strained, Tensor, work};
use crate::element::{Displacement, Material, Revolved, StressField};
use crate::load::BodyForce;
use crate::problem::Problem;
use crate::quantity::functional::Functional;
use crate::quantity::functional::region::{Cut, Piece};

/// χ on a triangle: constant on all of it, or on a part.
#[derive(Clone, Copy)]
pub enum Strain<'a> {
    /// On all of it, or nothing.
    Whole(Tensor),
    /// On what of it lies in a region.
    Part(Tensor, &'a [Piece]),
}

impl Functional {
    /// χ on triangle `t` of a body of revolution.
    pub(in crate::quantity) fn turned_on(&self, t: usize) -> Strain<'_> {
        if let Some((chi, cuts)) = &self.turned {
            return match cuts.binary_search_by_key(&t, |cut| cut.triangle) {
                Ok(at) if cuts[at].pieces.is_empty() => Strain::Whole(*chi),
                Ok(at) => Strain::Part(*chi, &cuts[at].pieces),
                Err(_) => Strain::Whole([0.0; 4]),
            };
        }
        let load = &self.load.turned;
        let found = load.binary_search_by_key(&t, |(t, _)| *t).map(|at| load[at].1);
        Strain::Whole(found.unwrap_or_default())
    }

    /// ∫ χ : c χ r of the load, χ by its mean where a triangle is cut.
    pub(in crate::quantity) fn turned_square(&self, problem: &Problem) -> f64 {
        let pairs = self.load.turned.iter().zip(&self.beside);
        pairs
            .map(|((t, chi), (_, stress))| problem.section().volume(problem.mesh.corners(*t)) * work(*chi, *stress))
            .sum()
    }
}

/// ∫ r over all parts of triangles.
pub fn volume(problem: &Problem, revolved: Revolved, cuts: &[Cut]) -> f64 {
    let of = |cut: &Cut| {
        let corners = problem.mesh.corners(cut.triangle);
        let of_piece = |piece: &Piece| points(revolved, corners, piece, 0).map(|at| at.by).sum::<f64>();
        if cut.pieces.is_empty() { problem.section().volume(corners) } else { cut.pieces.iter().map(of_piece).sum() }
    };
    cuts.iter().map(of).collect::<Sum>().value()
}

fn points(
    revolved: Revolved,
    corners: [[f64; 2]; 3],
    piece: &Piece,
    degree: usize,
) -> impl Iterator<Item = Sampled> + use<> {
    revolved.points_of_part(corners, (piece.sub, piece.corners, piece.area), degree)
}

/// A field whose stress is wanted.
#[derive(Clone, Copy)]
pub enum Of<'a> {
    /// λ.
    Stress(&'a StressField),
    /// σ(v).
    Displacement(&'a Displacement),
}

/// ∫ χ:τ r for the stress of a field.
pub fn strained(problem: &Problem, revolved: Revolved, functional: &Functional, of: Of<'_>) -> f64 {
    let materials = problem.materials();
    let mut sum = Sum::default();
    for (t, _) in &functional.load.turned {
        let (t, corners, law) = (*t, problem.mesh.corners(*t), materials[problem.mesh.body[*t]].revolved());
        let mut of_v = Strained::default();
        let held = Held::on(&materials[problem.mesh.body[t]], corners);
        let own = match of {
            Of::Stress(stress) => Some(revolved.stresses_on(stress, t, corners, problem.body_force(t))),
            Of::Displacement(_) => None,
        };
        let degree = match of {
            Of::Stress(stress) => stress.degree(t).max(3),
            Of::Displacement(v) => v.degree(t),
        };
        let mut add = |chi: Tensor, at: Sampled| {
            let stress = match (&own, of) {
                (Some(own), _) => own[at.sub].stress(&at.point).0,
                (None, Of::Displacement(v)) => law.stress(elastic(of_v.strain(v, t, corners, &at), held, &at)),
                (None, Of::Stress(_)) => [0.0; 4],
            };
            sum.add(at.by * work(chi, stress));
        };
        match functional.turned_on(t) {
            Strain::Whole(chi) => revolved.points(corners, degree + 1).for_each(|at| add(chi, at)),
            Strain::Part(chi, pieces) => {
                pieces
                    .iter()
                    .flat_map(|piece| points(revolved, corners, piece, degree + 1))
                    .for_each(|at| add(chi, at));
            }
        }
    }
    sum.value()
}

/// The sums of triangle `t`, as those of [`super::pass::pass`], with χ of the adjoint load and its body force.
pub fn triangle(
    problem: &Problem,
    revolved: Revolved,
    material: &Material,
    t: usize,
    (fields, (strain, force)): (Fields<'_>, (Strain<'_>, &BodyForce)),
) -> [f64; TERMS] {
    let Fields { known: (stress, displacement), adjoint, lifted, factor, .. } = fields;
    let (law, corners) = (material.revolved(), problem.mesh.corners(t));
    let whole = if let Strain::Whole(chi) = strain { chi } else { [0.0; 4] };
    let of_whole: f64 = law.stress(whole).iter().map(|s| s.abs()).sum();
    let balanced = revolved.stresses_on(adjoint, t, corners, force);
    let own_stress = revolved.stresses_on(stress, t, corners, problem.body_force(t));
    let (mut of_z, mut of_v) = (Strained::default(), Strained::default());
    let held = Held::on(material, corners);
    let modulus = law.strain_product(ALONG, ALONG);
    let degree = lifted.degree(t).max(displacement.degree(t)).max(stress.degree(t)).max(adjoint.degree(t)).max(3);
    let mut out = [0.0; TERMS];
    for at in revolved.points(corners, 2 * degree) {
        let (sigma, spread) = balanced[at.sub].stress(&at.point);
        let (z, spread_of_z) = of_z.at(lifted, t, corners, &at);
        let lambda = own_stress[at.sub].stress(&at.point).0;
        let of_displacement = law.stress(elastic(of_v.strain(displacement, t, corners, &at), held, &at));
        let middle = [0, 1, 2, 3].map(|c| 0.5 * (lambda[c] + of_displacement[c]));
        // What 1/r is in: the majorant adds to its square.
        let [rr, zz, _, rz] = sigma;
        let singular = law.strain([rr, zz, 0.0, rz]);
        let of_sigma = law.strain(sigma);
        let strain = [0, 1, 2, 3].map(|c| of_sigma[c] + whole[c]);
        let size: f64 = sigma.iter().map(|s| s.abs()).sum::<f64>() + spread + of_whole;
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
    if let Strain::Part(chi, pieces) = strain {
        // ‖A + cχ‖² = ‖A‖² + 2 A:χ + χ:cχ inside the region.
        let own = law.strain_product(chi, chi);
        for at in pieces.iter().flat_map(|piece| points(revolved, corners, piece, 2 * degree)) {
            let a_sigma = law.strain(balanced[at.sub].stress(&at.point).0);
            let z = of_z.strain(lifted, t, corners, &at);
            let lambda = own_stress[at.sub].stress(&at.point).0;
            let of_displacement = law.stress(elastic(of_v.strain(displacement, t, corners, &at), held, &at));
            let middle = [0, 1, 2, 3].map(|c| 0.5 * (lambda[c] + of_displacement[c]));
            for (first, factor) in [(PAIR, factor), (PAIR + 3, 0.0)] {
                let off = [0, 1, 2, 3].map(|c| a_sigma[c] - factor * z[c]);
                out[first] += at.by * (2.0 * law.strain_product(off, chi) + own);
                out[first + 1] += at.by * work(chi, middle);
                out[first + 2] += at.by.abs() * own;
            }
        }
    }
    out[INITIAL..].copy_from_slice(&revolved.initial_on(adjoint, t, corners, material, force));
    [PAIR + 2, PAIR + 5].into_iter().for_each(|i| out[i] *= shape(corners));
    out
}

/// e − ε0.
fn elastic(e: Tensor, held: Option<Held>, at: &Sampled) -> Tensor {
    let Some(own) = held.map(|held| held.at(at.sub, at.point.bary)) else { return e };
    [0, 1, 2, 3].map(|c| e[c] - own[c])
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
        let (corners, material) = (problem.mesh.corners(t), &materials[problem.mesh.body[t]]);
        let (law, held) = (material.revolved(), Held::on(material, corners));
        let (mut of_v, mut of_w) = (Strained::default(), Strained::default());
        for at in revolved.points(corners, 2 * v.degree(t).max(w.degree(t))) {
            let e = elastic(of_v.strain(v, t, corners, &at), held, &at);
            let d = of_w.strain(w, t, corners, &at);
            sum.add(at.by * law.strain_product(e, d));
        }
    }
    sum.value()
}
