//! Energy of friction, and its share of the gap.
//!
//! With the jump j = (v' − v'')·t̂ along a pair and the traction t along t̂ on the first side, |t| ≤ τ̄, friction adds ∫ τ̄ |j| to the
//! potential energy, nothing to the complementary energy, and ∫ (τ̄ |j| + t j), which is never negative, to the gap. Where the jump changes
//! its sign along a pair the integral of its absolute value is bounded from above, so that 𝓛(v) is no less than the energy. On bodies of
//! revolution τ̄ and t are multiplied by the distance from the axis.

use super::jump::jumps_along;
use super::rounding::counted::Counted;
use super::rounding::sum::Sum;
use super::springs::SpringEnergy;
use crate::dual::equilibrium::contact_tractions;
use crate::element::polynomial::side;
use crate::element::{Displacement, StressField};
use crate::problem::{ContactPair, Friction, Problem};

/// Jumps up to this part of the displacements that they are the difference of are rounding: what they are worth is counted with that
/// of the displacements.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Halvings of a pair along which a jump changes its sign.
const HALVINGS: usize = 12;

/// The coefficients of the sliding (v' − v'')·t̂ along a pair with friction, zero where the sides stick to all digits, and the size of the
/// displacements that they are the difference of.
pub fn slides(problem: &Problem, v: &Displacement, pair: &ContactPair, friction: &Friction) -> (Vec<f64>, f64) {
    let (mut jump, size) = jumps_along(problem, v, pair, &friction.tangent);
    jump.iter_mut().filter(|j| j.abs() <= ROUNDING * size).for_each(|j| *j = 0.0);
    (jump, size)
}

/// Σ ∫ τ̄ |j|.
pub fn potential_of_friction(problem: &Problem, v: &Displacement, counted: Counted<'_>) -> SpringEnergy {
    let (mut value, mut sensitivity) = (Sum::default(), 0.0);
    for (pair, friction) in with_friction(problem, counted) {
        let (jump, size) = slides(problem, v, pair, &friction);
        let bound = friction.weighted();
        value.add(pair.length * absolute(&jump, &bound));
        if jump.iter().any(|j| *j != 0.0) {
            sensitivity += pair.length * size * side::integral(&bound, &[1.0]);
        }
    }
    let t = problem.scene.thickness;
    SpringEnergy { value: t * value.value(), sensitivity: t * (sensitivity + value.magnitude()) }
}

/// ∫ (τ̄ |j| + t j) on a pair, thickness included; zero without friction.
pub fn friction_error(problem: &Problem, stress: &StressField, v: &Displacement, pair: &ContactPair) -> f64 {
    let Some(friction) = pair.friction else { return 0.0 };
    let (jump, _) = slides(problem, v, pair, &friction);
    let [_, t] = contact_tractions(problem, stress, pair);
    problem.scene.thickness * pair.length * (absolute(&jump, &friction.weighted()) + side::integral(&t, &jump))
}

fn with_friction<'a>(
    problem: &'a Problem,
    counted: Counted<'a>,
) -> impl Iterator<Item = (&'a ContactPair, Friction)> + 'a {
    let pairs = problem.pairs().enumerate().filter(move |(p, _)| counted.pair(*p));
    pairs.filter_map(|(_, pair)| Some((pair, pair.friction?)))
}

/// ∫₀¹ w |f| for a w ≥ 0 by its Bernstein coefficients, from above where f changes its sign.
pub fn absolute(f: &[f64], weight: &[f64]) -> f64 {
    bounded(f, weight, HALVINGS)
}

fn bounded(f: &[f64], weight: &[f64], halvings: usize) -> f64 {
    let one_sign = f.iter().all(|c| *c >= 0.0) || f.iter().all(|c| *c <= 0.0);
    if one_sign || halvings == 0 {
        let sizes: Vec<f64> = f.iter().map(|c| c.abs()).collect();
        return side::integral(&sizes, weight);
    }
    let ([left, right], [of_left, of_right]) = (halves(f), halves(weight));
    0.5 * (bounded(&left, &of_left, halvings - 1) + bounded(&right, &of_right, halvings - 1))
}

/// The coefficients on both halves of the interval (de Casteljau).
fn halves(f: &[f64]) -> [Vec<f64>; 2] {
    let mut rest = f.to_vec();
    let (mut left, mut right) = (Vec::with_capacity(f.len()), vec![0.0; f.len()]);
    for last in (0..f.len()).rev() {
        left.push(rest[0]);
        right[last] = rest[last];
        rest = rest.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    }
    [left, right]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absolute_values_are_bounded_from_above_and_closely() {
        // |s − 0.3| times 1 + s; (s − 0.25)(s − 0.7) has two changes of sign.
        let linear: f64 = absolute(&[-0.3, 0.7], &[1.0, 2.0]);
        let integral = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| {
            let n = 100_000;
            let h = (to - from) / n as f64;
            (0..n).map(|i| f(from + (i as f64 + 0.5) * h)).sum::<f64>() * h
        };
        let exact = integral(0.0, 1.0, &|s| (s - 0.3).abs() * (1.0 + s));
        assert!(linear >= exact - 1e-9 && linear - exact < 1e-6, "{linear} {exact}");
        let quadratic = absolute(&[0.175, 0.175 - 0.475, 0.225], &[1.0, 0.0]);
        let exact = integral(0.0, 1.0, &|s| ((s - 0.25) * (s - 0.7)).abs() * (1.0 - s));
        assert!(quadratic >= exact - 1e-9 && quadratic - exact < 1e-6, "{quadratic} {exact}");
        assert_eq!(absolute(&[-1.0, -2.0], &[1.0, 1.0]), 1.5);
    }
}
