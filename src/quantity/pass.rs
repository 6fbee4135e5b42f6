//! Integrals over all triangles of σ_z − σ(z), of m = (λ + σ(v))/2, and of their product.

use rayon::prelude::*;

use super::functional::Functional;
use super::region::{Cut, Piece};
use crate::bounds::Sum;
use crate::bounds::energy::shape;
use crate::bounds::strain::{Strains, sub_area};
use crate::dual::modes::materials;
use crate::element::quadrature::triangle_rule;
use crate::element::{Compliance, Displacement, StressField};
use crate::problem::Problem;

/// The fields of the problem that was solved, and of an adjoint pair.
#[derive(Clone, Copy)]
pub struct Fields<'a> {
    /// λ.
    pub stress: &'a StressField,
    /// v.
    pub displacement: &'a Displacement,
    /// σ̂.
    pub adjoint: &'a StressField,
    /// z, nothing where it is zero.
    pub lifted: Option<&'a Displacement>,
}

/// The integrals, per unit thickness.
#[derive(Debug, Clone, Default)]
pub struct Pass {
    /// ‖σ_z − σ(z)‖²_a on each triangle.
    pub squares: Vec<f64>,
    /// Its sum.
    pub square: f64,
    /// ∫ (σ_z − σ(z)) : a m.
    pub work: f64,
    /// ‖σ̂‖²_a.
    pub balanced: f64,
    /// ‖m‖²_a.
    pub middle: f64,
    /// The squares of the norms that σ_z − σ(z) and m would have if nothing cancelled in them.
    pub uncancelled: [f64; 2],
}

/// Computes them.
pub fn pass(problem: &Problem, functional: &Functional, fields: Fields<'_>) -> Pass {
    let mesh = &problem.mesh;
    let materials = materials(problem);
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
    let terms: Vec<[f64; 6]> = (0..count)
        .into_par_iter()
        .with_min_len(128)
        .map(|t| triangle(problem, &materials[mesh.body[t]], t, strain[t], fields))
        .collect();
    let sum = |i: usize| terms.iter().map(|t| t[i]).collect::<Sum>().value();
    Pass {
        squares: terms.iter().map(|t| t[0]).collect(),
        square: sum(0),
        work: sum(1),
        balanced: sum(2),
        middle: sum(3),
        uncancelled: [sum(4), sum(5)],
    }
}

/// χ on a triangle.
#[derive(Clone, Copy)]
enum Strain<'a> {
    None,
    Whole([f64; 3]),
    Part([f64; 3], &'a Cut),
}

/// The sums of one triangle, in the order of the fields of [`Pass`].
fn triangle(problem: &Problem, material: &Compliance, t: usize, strain: Strain<'_>, fields: Fields<'_>) -> [f64; 6] {
    let Fields { stress, displacement, adjoint, lifted } = fields;
    let corners = problem.mesh.corners(t);
    let area = sub_area(corners);
    let initial = match strain {
        Strain::Whole(chi) => material.stress(chi),
        _ => [0.0; 3],
    };
    let of_lifted = lifted.map_or(1, |z| z.degree(t));
    let k = displacement.degree(t).max(of_lifted) - 1;
    let rule = triangle_rule(2 * k.max(stress.degree(t)).max(adjoint.degree(t)));
    let (mut of_v, mut of_z) = (Strains::default(), Strains::default());
    let mut out = [0.0; 6];
    let modulus = material.strain_product([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    for sub in 0..3 {
        of_v.on(corners, displacement, t, sub);
        if let Some(z) = lifted {
            of_z.on(corners, z, t, sub);
            out[4] += area * modulus * of_z.largest_spread().powi(2);
        }
        out[5] += area * modulus * of_v.largest_spread().powi(2);
        for (l, weight) in rule {
            let (balanced, lambda) = (adjoint.at(t, sub, *l), stress.at(t, sub, *l));
            let sigma = plus(balanced, initial);
            let (e_v, e_z) = (of_v.at(*l), if lifted.is_some() { of_z.at(*l) } else { [0.0; 3] });
            // In strains: a σ_z − e(z), and a m.
            let a_sigma = material.strain(sigma);
            let off = minus(a_sigma, e_z);
            let middle = plus(material.strain(lambda), e_v).map(|e| 0.5 * e);
            let by = weight * area;
            out[0] += by * material.strain_product(off, off);
            out[1] += by * material.strain_product(off, middle);
            out[2] += by * material.product(balanced, balanced);
            out[3] += by * material.strain_product(middle, middle);
            out[4] += by * material.product(sigma, sigma);
            out[5] += by * material.product(lambda, lambda);
        }
    }
    if let Strain::Part(chi, cut) = strain {
        for piece in &cut.pieces {
            of_v.on(corners, displacement, t, piece.sub);
            if let Some(z) = lifted {
                of_z.on(corners, z, t, piece.sub);
            }
            for (l, by) in points(piece, 2 * k.max(stress.degree(t)).max(adjoint.degree(t))) {
                let sigma = adjoint.at(t, piece.sub, l);
                let e_z = if lifted.is_some() { of_z.at(l) } else { [0.0; 3] };
                let off = minus(material.strain(sigma), e_z);
                let middle = plus(material.strain(stress.at(t, piece.sub, l)), of_v.at(l)).map(|e| 0.5 * e);
                // ‖A + cχ‖² = ‖A‖² + 2 A:χ + χ:cχ inside the region.
                let own = material.strain_product(chi, chi);
                out[0] += by * (2.0 * material.strain_product(off, chi) + own);
                out[1] += by * material.strain_product(chi, middle);
                out[4] += by.abs() * own;
            }
        }
    }
    let shape = shape(corners);
    [out[0], out[1], out[2], out[3], shape * out[4], shape * out[5]]
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
    let mut sum = Sum::default();
    let mut add = |t: usize, sub: usize, l: [f64; 3], by: f64, chi: &[f64; 3]| {
        let s = at(t, sub, l);
        sum.add(by * (chi[0] * s[0] + chi[1] * s[1] + 2.0 * chi[2] * s[2]));
    };
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
