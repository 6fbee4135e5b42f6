//! Springs and elastic layers in an adjoint pair: one more stress, with the compliance 1/k.
//!
//! The exact traction q = k j(u) of a spring belongs to τ as the stress of a triangle does, k j(z) to σ(z), and to σ_z what the
//! load of the quantity leaves of the traction of σ̂ on the first side: q_z = p − T(σ̂)·d. Products are ∫ q₁ q₂/k.
//!
//! On a body of revolution tractions are weighted with the distance r from the axis, q = r p − T(σ̂)·d, and products are ∫ q₁ q₂/kr.

use super::pass::Integrals;
use crate::bounds::{OnSprings, spring_jumps, spring_tractions};
use crate::element::polynomial::side;
use crate::element::{Displacement, StressField};
use crate::problem::{BedPair, Problem};
use crate::quantity::functional::Functional;
use crate::vector::dot;

/// Integrals of an adjoint pair over one pair of springs.
#[derive(Debug, Clone, Copy, Default)]
pub struct SpringTerms {
    pub pair: Integrals,
    pub alone: Integrals,
    /// ∫ q_z²/k.
    pub balanced: f64,
}

/// q_z of the response `adjoint`.
pub fn adjoint_of(problem: &Problem, functional: &Functional, adjoint: &StressField) -> OnSprings {
    let applied = |e: usize| functional.load.tractions.iter().filter(move |(on, _)| *on == e);
    let of = |pair: &BedPair| {
        let mut own = spring_tractions(problem, adjoint, pair);
        for (axis, own) in pair.axes.iter().zip(&mut own) {
            own.iter_mut().for_each(|t| *t = -*t);
            for (_, ends) in applied(pair.edge) {
                *own = combined(1.0, own, 1.0, &pair.weight.times(&ends.map(|p| dot(p, *axis))));
            }
            for (_, load) in functional.load.edges.iter().filter(|(on, _)| *on == pair.edge) {
                let load: Vec<f64> = load.iter().map(|p| dot(*p, *axis)).collect();
                *own = combined(1.0, own, 1.0, &pair.weight.times(&load));
            }
        }
        own
    };
    problem.bed_pairs().map(|(pair, _)| of(pair)).collect()
}

/// ½ (q(λ) + k j(v)), weighted.
pub fn middle_of(problem: &Problem, stress: &StressField, v: &Displacement) -> OnSprings {
    let of = |(pair, stiffness): (&BedPair, [f64; 2])| {
        let (tractions, (jumps, _)) = (spring_tractions(problem, stress, pair), spring_jumps(problem, v, pair));
        let along = tractions.iter().zip(&jumps).zip(stiffness);
        let mut along = along.map(|((t, j), k)| combined(-0.5, t, 0.5 * k, &pair.weight.times(j)));
        [along.next().unwrap_or_default(), along.next().unwrap_or_default()]
    };
    problem.bed_pairs().map(of).collect()
}

/// a f + b g.
pub fn combined(a: f64, f: &[f64], b: f64, g: &[f64]) -> Vec<f64> {
    let degree = f.len().max(g.len()) - 1;
    let [f, g] = [side::elevate(f, degree), side::elevate(g, degree)];
    f.iter().zip(&g).map(|(f, g)| a * f + b * g).collect()
}

/// Σ ∫ q²/k.
pub fn square_of(problem: &Problem, q: &OnSprings) -> f64 {
    let of = |((pair, stiffness), q): ((&BedPair, [f64; 2]), &[Vec<f64>; 2])| {
        let along = q.iter().zip(stiffness).filter(|(_, k)| *k > 0.0);
        along.map(|(q, k)| pair.length * pair.weight.square_over(q) / k).sum::<f64>()
    };
    problem.bed_pairs().zip(q).map(of).sum()
}

/// Σ ∫ k j(v) j(w).
pub fn product_of(problem: &Problem, v: &Displacement, w: &Displacement) -> f64 {
    let of = |(pair, stiffness): (&BedPair, [f64; 2])| {
        let [(v, _), (w, _)] = [spring_jumps(problem, v, pair), spring_jumps(problem, w, pair)];
        let along = v.iter().zip(&w).zip(stiffness);
        along.map(|((v, w), k)| k * pair.length * side::integral(v, &pair.weight.times(w))).sum::<f64>()
    };
    problem.bed_pairs().map(of).sum()
}

/// The square of the size of springs in m if nothing cancelled in it.
pub fn uncancelled_of(problem: &Problem, stress: &StressField, v: &Displacement) -> f64 {
    let of = |(pair, stiffness): (&BedPair, [f64; 2])| {
        let (tractions, (_, sizes)) = (spring_tractions(problem, stress, pair), spring_jumps(problem, v, pair));
        let along = tractions.iter().zip(sizes).zip(stiffness).filter(|(_, k)| *k > 0.0);
        let square = |((t, size), k): ((&Vec<f64>, f64), f64)| {
            pair.length * (pair.weight.square_over(t) / k + k * pair.weight.mean() * size * size)
        };
        along.map(square).sum::<f64>()
    };
    problem.bed_pairs().map(of).sum()
}

/// The terms of every pair of springs: `adjoint` is q_z, `middle` that of m, and z is `lifted` times `factor`.
pub fn terms(
    problem: &Problem,
    (middle, adjoint): (&OnSprings, &OnSprings),
    (lifted, factor): (&Displacement, f64),
) -> Vec<SpringTerms> {
    type Sides = [Vec<f64>; 2];
    let of = |((pair, stiffness), (m, q)): ((&BedPair, [f64; 2]), (&Sides, &Sides))| {
        let (jumps, sizes) = spring_jumps(problem, lifted, pair);
        let mut out = SpringTerms::default();
        for (c, k) in stiffness.into_iter().enumerate().filter(|(_, k)| *k > 0.0) {
            let off = combined(1.0, &q[c], -factor * k, &pair.weight.times(&jumps[c]));
            let by = pair.length / k;
            let whole = by * pair.weight.square_over(&q[c]);
            for (into, own) in [(&mut out.pair, &off), (&mut out.alone, &q[c])] {
                into.square += by * pair.weight.square_over(own);
                into.work += by * pair.weight.product_over(own, &m[c]);
                into.uncancelled += whole;
            }
            out.pair.uncancelled += pair.length * k * pair.weight.mean() * (factor * sizes[c]).powi(2);
            out.balanced += whole;
        }
        out
    };
    problem.bed_pairs().zip(middle.iter().zip(adjoint)).map(of).collect()
}
