//! Bounds of friction from pressures: linear on every pair, with the force and the moment of μ times the pressure there.
//!
//! On a body of revolution pressures are weighted with the distance r from the axis, and force and moment are those of r τ̄.

use crate::bounds::absolute;
use crate::compare::BoundDistance;
use crate::compare::contact::pressure::{Piece, unweighted};
use crate::dual::DualSolution;
use crate::dual::equilibrium::contact_traction;
use crate::element::polynomial::{side, subdivision};
use crate::problem::{ContactPair, EdgeWeight, Interface, Problem, Scales};

/// τ̄ at the two ends of each pair, contact by contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds(pub Vec<Vec<[f64; 2]>>);

impl Bounds {
    /// One bound for all contacts with Coulomb friction.
    pub fn constant(problem: &Problem, bound: f64) -> Self {
        Bounds(problem.interfaces.iter().map(|interface| vec![[bound; 2]; interface.pairs.len()]).collect())
    }

    /// μ times the pressures of a solution of `problem`.
    pub fn of_pressure(problem: &Problem, dual: &DualSolution) -> Self {
        let all = problem.interfaces.iter().enumerate();
        let none = Scales::new(problem).round_off.stress;
        Bounds(
            all.map(|(index, interface)| {
                let mu = problem.coefficient(index).unwrap_or(0.0);
                let of = |pair: &ContactPair| linear(&most(problem, dual, pair, (mu, none)), &weight(problem, pair));
                interface.pairs.iter().map(of).collect()
            })
            .collect(),
        )
    }

    /// All values, pair by pair.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.0.iter().flatten().flatten().copied()
    }

    /// As many others in their places.
    pub fn with_values(&self, mut values: impl Iterator<Item = f64>) -> Bounds {
        let mut filled = self.clone();
        filled.0.iter_mut().flatten().flatten().for_each(|place| *place = values.next().unwrap_or(0.0));
        filled
    }

    /// A part of the way from these to others.
    pub fn towards(&self, other: &Bounds, part: f64) -> Bounds {
        let between = |(own, other): (&[f64; 2], &[f64; 2])| [0, 1].map(|k| own[k] + part * (other[k] - own[k]));
        Bounds(self.0.iter().zip(&other.0).map(|(own, other)| own.iter().zip(other).map(between).collect()).collect())
    }
}

/// μ |t| of a pair, by its coefficients, of which those of pressures up to `none` are zero.
fn most(problem: &Problem, dual: &DualSolution, pair: &ContactPair, (mu, none): (f64, f64)) -> Vec<f64> {
    let t = contact_traction(problem, &dual.stress, pair);
    let of = |t: f64| if -t > none { mu * -t } else { 0.0 };
    if t.is_empty() { vec![0.0] } else { t.into_iter().map(of).collect() }
}

/// The end values of the linear function that has, times the weight, force and moment of `p` ≥ 0; where that falls below zero, the one that
/// is zero at this end and has its force.
fn linear(p: &[f64], weight: &EdgeWeight) -> [f64; 2] {
    match (p, weight.ends()) {
        ([constant], [a, b]) if a == b => return [*constant / a; 2],
        ([first, last], [a, b]) if a == b => return [*first / a, *last / b],
        _ => {}
    }
    let force = side::integral(p, &[1.0]);
    match weight.linear(p) {
        [a, _] if a < 0.0 => [0.0, force / weight.of_hat(1)],
        [_, b] if b < 0.0 => [force / weight.of_hat(0), 0.0],
        ends => ends,
    }
}

/// Integral of the difference of two bounds, relative to the larger one of theirs; zero where both vanish.
pub fn apart(problem: &Problem, one: &Bounds, other: &Bounds) -> f64 {
    let (mut between, mut sizes) = (0.0, [0.0; 2]);
    for (index, interface) in problem.interfaces.iter().enumerate().filter(|(i, _)| problem.coefficient(*i).is_some()) {
        for (k, pair) in interface.pairs.iter().enumerate() {
            let [a, b] = [one.0[index][k], other.0[index][k]];
            between += pair.length * absolute(&[a[0] - b[0], a[1] - b[1]], &[1.0; 2]);
            sizes[0] += 0.5 * pair.length * (a[0] + a[1]);
            sizes[1] += 0.5 * pair.length * (b[0] + b[1]);
        }
    }
    if between == 0.0 { 0.0 } else { between / sizes[0].max(sizes[1]) }
}

/// How far the bounds of `problem` are from μ times the pressures of its solution.
pub fn distances(problem: &Problem, dual: &DualSolution) -> Vec<Option<BoundDistance>> {
    let none = Scales::new(problem).round_off.stress;
    let of = |(index, interface): (usize, &Interface)| {
        let mu = problem.coefficient(index)?;
        let weighted = interface.pairs.iter().map(|pair| Piece::polynomial(most(problem, dual, pair, (mu, none))));
        let weighted: Vec<Piece> = weighted.collect();
        let plain = unweighted(problem, interface, &weighted);
        let (mut largest, mut peak, mut between, mut force) = (0.0_f64, 0.0_f64, 0.0, 0.0);
        for ((pair, weighted), plain) in interface.pairs.iter().zip(&weighted).zip(&plain) {
            let bound = pair.friction.map_or([0.0; 2], |friction| friction.bound);
            let [weighted, plain] = [weighted, plain].map(|piece| piece.coefficients().collect::<Vec<f64>>());
            let off = difference(&bound, &plain);
            for off in [&off, &difference(&plain, &bound)] {
                largest = largest.max(subdivision::largest(off).0);
            }
            peak = peak.max(subdivision::largest(&plain).0);
            let off = difference(&weight(problem, pair).times(&bound), &weighted);
            between += pair.length * absolute(&off, &[1.0; 2]);
            force += pair.length * side::integral(&weighted, &[1.0]);
        }
        let part = |x: f64, whole: f64| if x == 0.0 { 0.0 } else { x / whole };
        Some(BoundDistance { largest, largest_relative: part(largest, peak), relative: part(between, force) })
    };
    problem.interfaces.iter().enumerate().map(of).collect()
}

fn weight(problem: &Problem, pair: &ContactPair) -> EdgeWeight {
    EdgeWeight::of_pair(problem.section(), &problem.mesh, pair)
}

/// Coefficients of f − g.
fn difference(f: &[f64], g: &[f64]) -> Vec<f64> {
    let degree = f.len().max(g.len()) - 1;
    let [f, g] = [f, g].map(|own| side::elevate(own, degree));
    f.iter().zip(&g).map(|(f, g)| f - g).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_bounds_have_the_force_of_the_pressure_and_are_nowhere_negative() {
        for p in
            [vec![2.0], vec![1.0, 3.0], vec![0.0, 1.0, 0.5], vec![0.0, 0.0, 0.0, 5.0], vec![3.0, 0.0, 0.0, 0.0, 0.1]]
        {
            let bound = linear(&p, &EdgeWeight::default());
            let force = side::integral(&p, &[1.0]);
            assert!((0.5 * (bound[0] + bound[1]) - force).abs() < 1e-14 * force && bound[0] >= 0.0 && bound[1] >= 0.0);
        }
        // s(1 − s)·2 + s²: force and moment are those of 1/6 + s.
        let [a, b] = linear(&[0.0, 1.0, 1.0], &EdgeWeight::default());
        let moment = side::integral(&[0.0, 1.0, 1.0], &[0.0, 1.0]);
        assert!(((a + 2.0 * b) / 6.0 - moment).abs() < 1e-15);
    }
}
