//! The bound that one adjoint pair gives.

use super::pass::{Fields, Integrals, Pass, pass};
use super::search::Search;
use super::springs::adjoint_of;
use crate::bounds::{NodalValues, ROUNDING_PER_TERM, Sum, excess_work, jumps, openings, support_work, work};
use crate::dual::Response;
use crate::element::Displacement;
use crate::element::polynomial::side;
use crate::quantity::interval::Known;

/// Jumps beyond their bound by this part of the largest displacement are rounding, and enclosed as such.
const BEYOND: f64 = 1e-11;

/// A bound from one pair.
pub(in crate::quantity) struct End {
    /// Lower bound of sign · Q, per unit scale.
    pub bound: f64,
    /// sign · Q_h.
    pub centre: f64,
    /// Bound and Q_h from z = 0, or a lift, where that has a finite one.
    pub first_order: Option<(f64, f64)>,
    /// D, rounding included.
    pub distance: f64,
    /// The ratio that s and k ask for.
    pub ratio: f64,
    /// The largest |k| relative to the largest displacement and weight: zero where the pair needs no opening, for either sign.
    pub beyond: f64,
    pub pass: Pass,
    /// sign · z.
    pub nodes: NodalValues,
}

impl End {
    /// The ρ that makes ρH + D²/(4ρ) the width: at least the one that costs nothing.
    pub fn weight(&self, square: f64) -> f64 {
        let free = self.distance / (2.0 * square.sqrt());
        let ratio = self.ratio.max(free);
        if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
    }
}

impl Search<'_, '_> {
    /// The bound of a pair; z is `lifted` times a factor.
    pub fn measured(&self, response: &Response, lifted: (&Displacement, f64), sign: f64) -> End {
        let Known { problem, middle, springs, dual, upper, .. } = self.known;
        let adjoint = adjoint_of(problem, self.functional, &response.stress);
        let springs = (springs, &adjoint);
        let known = (&dual.stress, &upper.displacement);
        let fields = Fields { middle, known, adjoint: &response.stress, lifted: lifted.0, factor: lifted.1, springs };
        let pass = pass(problem, self.functional, fields);
        let Bound { bound, centre, distance, ratio, beyond } = self.bounded(response, Some(lifted), &pass, sign);
        End { bound, centre, first_order: None, distance, ratio, beyond, pass, nodes: NodalValues::none() }
    }

    /// Bound and Q_h of a stress alone, z being zero; `pass` is that of a pair with this stress.
    pub fn alone(&self, response: &Response, pass: &Pass, sign: f64) -> (f64, f64) {
        let Bound { bound, centre, .. } = self.bounded(response, None, pass, sign);
        (bound, centre)
    }

    /// The bound of a pair with z = `lifted` times a factor, or with z = 0.
    fn bounded(&self, response: &Response, lifted: Option<(&Displacement, f64)>, pass: &Pass, sign: f64) -> Bound {
        let integrals: Integrals = if lifted.is_some() { pass.pair } else { pass.alone };
        let Known { problem, dual, upper, square, size, uncancelled, pressure, .. } = self.known;
        let slip = [integrals.uncancelled, *uncancelled].map(|square| ROUNDING_PER_TERM * square.sqrt());
        let distance = integrals.square.max(0.0).sqrt() + slip[0];
        let mut rounding = distance * slip[1] + slip[0] * size + response.remainder;

        let mut sum = Sum::default();
        sum.add(self.functional.constant);
        sum.add(integrals.work);
        let [initial, size_of_initial] = pass.initial;
        sum.add(initial);
        rounding += ROUNDING_PER_TERM * size_of_initial;
        if let Some((z, factor)) = lifted {
            let work = work(problem, z);
            sum.add(factor * work.value());
            rounding += ROUNDING_PER_TERM * work.magnitude();
        }
        for (pair, s) in problem.pairs().zip(response.contact.iter()) {
            sum.add(-pair.length * side::integral(s, &pair.gap_polynomial()));
            rounding += excess_work(pair, s);
        }
        let supports = support_work(problem, &response.stress);
        sum.add(-supports.value());
        rounding += ROUNDING_PER_TERM * supports.magnitude();
        rounding += ROUNDING_PER_TERM * sum.magnitude();

        let ratio = |over: f64, of: f64| {
            if over <= 0.0 {
                0.0
            } else if of > 0.0 {
                over / of
            } else {
                f64::INFINITY
            }
        };
        let mut asked = 0.0_f64;
        for (s, t) in response.contact.values().iter().zip(pressure) {
            asked = asked.max(ratio(-sign * s, -t));
        }
        // Jumps beyond their bound by rounding do work on the exact pressure, of the size of that of λ.
        let size = lifted.map_or(0.0, |(z, _)| (0..z.len()).map(|t| z.largest(t)).fold(0.0, f64::max));
        let mut excess = Vec::with_capacity(pressure.len());
        let mut beyond = 0.0_f64;
        let pressures = dual.contact_traction.iter().flat_map(|of| of.iter());
        for ((pair, weights), t) in problem.pairs().zip(&self.functional.load.weights).zip(pressures) {
            let jumps = lifted.map_or_else(
                || vec![0.0],
                |(z, factor)| jumps(problem, z, pair).into_iter().map(|j| factor * j).collect(),
            );
            let open = openings(problem, &upper.displacement, pair);
            let degree = jumps.len().max(open.len()).max(weights.len()) - 1;
            let [jumps, open] = [jumps, open].map(|c| side::elevate(&c, degree));
            let weights = if weights.is_empty() { vec![0.0; degree + 1] } else { side::elevate(weights, degree) };
            let largest = weights.iter().fold(size, |m, w| m.max(w.abs()));
            let slack = BEYOND * largest;
            let force = 2.0 * pair.length * t.iter().map(|t| t.abs()).sum::<f64>() / t.len().max(1) as f64;
            for ((j, w), o) in jumps.iter().zip(&weights).zip(&open) {
                let (k, o) = (sign * (j + w), o.max(0.0));
                asked = asked.max(ratio(k - slack, o));
                beyond = beyond.max(ratio(k.abs(), largest));
                excess.push((k, o, force));
            }
        }
        if asked.is_finite() {
            // Of the coefficients of a pair the largest excess counts; their sum is more.
            rounding += excess.iter().map(|(k, o, force)| (k - asked * o).max(0.0) * force).sum::<f64>();
        }
        let centre = sign * sum.value();
        let bound = centre - width(distance, *square, asked) - rounding;
        Bound { bound, centre, distance, ratio: asked, beyond }
    }
}

/// The bound that a pair gives, in the fields of [`End`] of these names.
struct Bound {
    bound: f64,
    centre: f64,
    distance: f64,
    ratio: f64,
    beyond: f64,
}

/// The largest D √(H − X) + ρX for 0 ≤ X ≤ H.
pub(in crate::quantity) fn width(distance: f64, square: f64, ratio: f64) -> f64 {
    if square == 0.0 {
        return if ratio.is_finite() { 0.0 } else { f64::INFINITY };
    }
    if 2.0 * ratio * square.sqrt() <= distance {
        return distance * square.sqrt();
    }
    ratio * square + distance * distance / (4.0 * ratio)
}
