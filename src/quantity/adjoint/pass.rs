//! Integrals over all triangles of σ_z − σ(z), and of its product with m = (λ + σ(v))/2.

use rayon::prelude::*;

use super::{revolved, springs};
use crate::bounds::energy::{initial_on, shape, square_on};
use crate::bounds::{OnSprings, Sum};
use crate::dual::ShapedStrain;
use crate::element::Strains;
use crate::element::geometry::sub_area;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::{Displacement, Material, Samples, StressField, contraction};
use crate::problem::Problem;
use crate::quantity::functional::Functional;
use crate::quantity::functional::region::{Cut, Piece};

/// m, and the fields of an adjoint pair.
#[derive(Clone, Copy)]
pub struct Fields<'a> {
    /// m, in a body of revolution anything.
    pub middle: &'a StressField,
    /// λ and v.
    pub known: (&'a StressField, &'a Displacement),
    /// σ̂.
    pub adjoint: &'a StressField,
    /// z over `factor`.
    pub lifted: &'a Displacement,
    pub factor: f64,
    /// m and σ_z on springs.
    pub springs: (&'a OnSprings, &'a OnSprings),
}

/// The integrals, per unit thickness.
#[derive(Debug, Clone, Default)]
pub struct Pass {
    /// ‖σ_z − σ(z)‖²_a on each triangle.
    pub squares: Vec<f64>,
    /// Those of the pair.
    pub pair: Integrals,
    /// The integrals of the pair with z = 0.
    pub alone: Integrals,
    /// ‖σ̂‖²_a.
    pub balanced: f64,
    /// ∫ σ̂:ε0, and what rounding of it is relative to.
    pub initial: [f64; 2],
}

/// Integrals of an adjoint pair over all triangles.
#[derive(Debug, Clone, Copy, Default)]
pub struct Integrals {
    /// ‖σ_z − σ(z)‖²_a.
    pub square: f64,
    /// ∫ (σ_z − σ(z)) : a m.
    pub work: f64,
    /// The square of the norm that σ_z − σ(z) would have if nothing cancelled in it.
    pub uncancelled: f64,
}

impl Integrals {
    fn add(&mut self, other: &Integrals) {
        self.square += other.square;
        self.work += other.work;
        self.uncancelled += other.uncancelled;
    }
}

/// Computes them.
pub fn pass(problem: &Problem, functional: &Functional, fields: Fields<'_>) -> Pass {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let count = mesh.triangles.len();
    let mut strain: Vec<Strain<'_>> = vec![Strain::None; count];
    for (t, chi) in &functional.load.strains {
        strain[*t] = Strain::Whole(*chi);
    }
    if let Some((chi, cuts)) = &functional.region {
        for cut in cuts.iter().filter(|cut| !cut.pieces.is_empty()) {
            strain[cut.triangle] = Strain::Part(*chi, cut);
        }
    }
    for (shaped, rest) in functional.load.shaped.iter().zip(&functional.rests) {
        strain[shaped.triangle] = Strain::Shaped(&shaped.strain, *rest);
    }
    let terms: Vec<[f64; TERMS]> = (0..count)
        .into_par_iter()
        .with_min_len(128)
        .map(|t| match problem.section().revolved() {
            Some(revolved) => {
                let strain = functional.turned_on(t);
                let of_load = (strain, &functional.load.force[mesh.body[t]]);
                revolved::triangle(problem, revolved, &materials[mesh.body[t]], t, (fields, of_load))
            }
            None => triangle(problem, &materials[mesh.body[t]], t, strain[t], fields),
        })
        .collect();
    let sum = |i: usize| terms.iter().map(|t| t[i]).collect::<Sum>().value();
    let integrals = |first: usize| Integrals { square: sum(first), work: sum(first + 1), uncancelled: sum(first + 2) };
    let mut pass = Pass {
        squares: terms.iter().map(|t| t[PAIR]).collect(),
        pair: integrals(PAIR),
        alone: integrals(ALONE),
        balanced: sum(BALANCED),
        initial: [INITIAL, INITIAL + 1].map(sum),
    };
    let on_springs = springs::terms(problem, fields.springs, (fields.lifted, fields.factor));
    for ((pair, _), own) in problem.bed_pairs().zip(on_springs) {
        if let Some(t) = mesh.edges[pair.edge].triangles[0] {
            pass.squares[t] += own.pair.square;
        }
        pass.pair.add(&own.pair);
        pass.alone.add(&own.alone);
        pass.balanced += own.balanced;
    }
    pass
}

/// Where the sums of a triangle stand: three of the pair, three without z, one of the stress in balance, two of initial strains.
pub(in crate::quantity) const PAIR: usize = 0;
const ALONE: usize = 3;
pub(in crate::quantity) const BALANCED: usize = 6;
pub(in crate::quantity) const INITIAL: usize = 7;
pub(in crate::quantity) const TERMS: usize = 9;

/// χ on a triangle.
#[derive(Clone, Copy)]
enum Strain<'a> {
    None,
    Whole([f64; 3]),
    Part([f64; 3], &'a Cut),
    /// A projection, and the square of what it leaves, which is orthogonal to all else.
    Shaped(&'a StressField, f64),
}

/// The sums of one triangle.
fn triangle(problem: &Problem, material: &Material, t: usize, strain: Strain<'_>, fields: Fields<'_>) -> [f64; TERMS] {
    let Fields { middle, adjoint, lifted, factor, .. } = fields;
    let corners = problem.mesh.corners(t);
    let area = sub_area(corners);
    let initial = match strain {
        Strain::Whole(chi) => material.stress(chi),
        _ => [0.0; 3],
    };
    let (k, p, r) = (lifted.degree(t) - 1, middle.degree(t), adjoint.degree(t));
    let half = k.max(p).max(r);
    let at_z = Samples::of(k, half);
    let (at_middle, at_adjoint) = (Samples::of_stress(p, half), Samples::of_stress(r, half));
    let mut of_z = Strains::default();
    let mut out = [0.0; TERMS];
    let modulus = largest_modulus(material);
    let shaped = match strain {
        Strain::Shaped(chi, rest) => {
            [PAIR, PAIR + 2, ALONE, ALONE + 2].into_iter().for_each(|i| out[i] += rest);
            Some((chi, Samples::of_stress(chi.degree(0), half)))
        }
        _ => None,
    };
    for sub in 0..3 {
        of_z.on(corners, lifted, t, sub);
        out[PAIR + 2] += area * modulus * (factor * of_z.largest_spread()).powi(2);
        for (q, (_, weight)) in at_z.points.iter().enumerate() {
            let (balanced, m) = (adjoint.sample(t, sub, at_adjoint, q), middle.sample(t, sub, at_middle, q));
            let initial = shaped.map_or(initial, |(chi, samples)| material.stress(chi.sample(0, sub, samples, q)));
            let sigma = plus(balanced, initial);
            // In strains: a σ_z − e(z).
            let a_sigma = material.strain(sigma);
            let off = minus(a_sigma, of_z.sample(at_z, q).map(|e| factor * e));
            let by = weight * area;
            for (first, strain) in [(PAIR, off), (ALONE, a_sigma)] {
                out[first] += by * material.strain_product(strain, strain);
                out[first + 1] += by * contraction(strain, m);
                out[first + 2] += by * material.product(sigma, sigma);
            }
            out[BALANCED] += by * material.product(balanced, balanced);
        }
    }
    out[INITIAL..].copy_from_slice(&initial_on(adjoint, t, material, corners, area));
    if let Strain::Part(chi, cut) = strain {
        for piece in &cut.pieces {
            of_z.on(corners, lifted, t, piece.sub);
            for (l, by) in points(piece, 2 * half) {
                let a_sigma = material.strain(adjoint.at(t, piece.sub, l));
                let off = minus(a_sigma, of_z.at(l).map(|e| factor * e));
                let m = middle.at(t, piece.sub, l);
                // ‖A + cχ‖² = ‖A‖² + 2 A:χ + χ:cχ inside the region.
                let own = material.strain_product(chi, chi);
                for (first, strain) in [(PAIR, off), (ALONE, a_sigma)] {
                    out[first] += by * (2.0 * material.strain_product(strain, chi) + own);
                    out[first + 1] += by * contraction(chi, m);
                    out[first + 2] += by.abs() * own;
                }
            }
        }
    }
    [PAIR + 2, ALONE + 2].into_iter().for_each(|i| out[i] *= shape(corners));
    out
}

/// The square of the norm that m would have if nothing cancelled in it.
pub fn uncancelled(problem: &Problem, stress: &StressField, displacement: &Displacement) -> f64 {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let of = |t: usize| {
        let (corners, material) = (mesh.corners(t), &materials[mesh.body[t]]);
        let (area, modulus) = (sub_area(corners), largest_modulus(material));
        let mut of_v = Strains::default();
        let spread = |sub: usize| of_v.elastic(corners, displacement, t, sub, material).largest_spread().powi(2);
        let strains = area * modulus * (0..3).map(spread).sum::<f64>();
        shape(corners) * (strains + square_on(stress, t, material, area))
    };
    let terms: Vec<f64> = (0..mesh.triangles.len()).into_par_iter().with_min_len(128).map(of).collect();
    terms.into_iter().collect::<Sum>().value()
}

/// c χ : χ for a strain of one along x, of the size of the largest that there is.
fn largest_modulus(material: &Material) -> f64 {
    material.strain_product([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])
}

/// Points of a piece, in the barycentric coordinates of its subtriangle, with weights for polynomials up to `degree`.
fn points(piece: &Piece, degree: usize) -> impl Iterator<Item = ([f64; 3], f64)> {
    triangle_rule(degree).iter().map(move |(m, weight)| {
        let l = [0, 1, 2].map(|c| (0..3).map(|i| m[i] * piece.corners[i][c]).sum());
        (l, weight * piece.area)
    })
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// ∫ χ:σ with the stress that `at` gives at points of subtriangles, of degree `degree` on each triangle; the points of a
/// subtriangle come one after the other.
pub fn strained(
    problem: &Problem,
    functional: &Functional,
    degree: impl Fn(usize) -> usize,
    mut at: impl FnMut(usize, usize, [f64; 3]) -> [f64; 3],
) -> f64 {
    if let Some(local) = &functional.local {
        return local.strained(problem, degree, at);
    }
    let mut sum = Sum::default();
    let mut add = |t: usize, sub: usize, l: [f64; 3], by: f64, chi: &[f64; 3]| {
        let s = at(t, sub, l);
        sum.add(by * contraction(*chi, s));
    };
    for ShapedStrain { triangle: t, strain } in &functional.load.shaped {
        let area = problem.mesh.area(*t) / 3.0;
        for sub in 0..3 {
            for (l, weight) in triangle_rule(degree(*t) + strain.degree(0)) {
                add(*t, sub, *l, weight * area, &strain.at(0, sub, *l));
            }
        }
    }
    let mut whole = |t: usize, chi: &[f64; 3]| {
        let area = problem.mesh.area(t) / 3.0;
        for sub in 0..3 {
            triangle_rule(degree(t)).iter().for_each(|(l, weight)| add(t, sub, *l, weight * area, chi));
        }
    };
    match &functional.region {
        None => functional.load.strains.iter().for_each(|(t, chi)| whole(*t, chi)),
        Some((chi, cuts)) => {
            cuts.iter().filter(|cut| cut.pieces.is_empty()).for_each(|cut| whole(cut.triangle, chi));
            for cut in cuts {
                for piece in &cut.pieces {
                    points(piece, degree(cut.triangle)).for_each(|(l, by)| add(cut.triangle, piece.sub, l, by, chi));
                }
            }
        }
    }
    sum.value()
}
