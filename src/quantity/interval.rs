//! Guaranteed intervals for quantities, of second order (Prager and Synge's hypercircle, for contact).
//!
//! The exact stress τ lies within ‖τ − m‖² = H − X of m = (λ + σ(v))/2, where X ≥ 0 is what the contact conditions leave of
//! the gap G = 𝓛(v) + Π(λ) with the exact solution, and H = (G + C)/2 with the contact part C of G. An adjoint pair (σ_z, z)
//! with the normal traction s on Γ_K and k = j(z) + φ gives
//!
//! Q = Q_h + ∫ (σ_z − σ(z)) : a (τ − m) + ∫ t k + ∫ s (g − j(u)), Q_h = constant + F(z) − ∫ s g − ∫_{Γu} T(σ̂)·u0 + ∫ (σ_z − σ(z)) : a m,
//!
//! and with s ≥ ρ t(λ) and k ≤ ρ (g − j(v)), both by coefficients, Q ≥ Q_h − B(ρ), where B(ρ) is the largest
//! D √(H − X) + ρ X with D = ‖σ_z − σ(z)‖_a. The upper end is the lower one of −Q. Every pair gives a bound, good or poor.

use super::adjoint::end::End;
use super::adjoint::pass::{strained, uncancelled};
use super::adjoint::revolved;
use super::adjoint::revolved::Of;
use super::adjoint::search::Search;
use super::adjoint::springs::{middle_of, square_of, uncancelled_of};
use super::ends::{clipped, outside};
use super::functional::Functional;
use super::functional::value::{displaced, value_of};
use crate::bounds::energy::square;
use crate::bounds::{Bracket, Nearest, OnSprings, UpperBound, excess_work, mid_field, openings_within};
use crate::dual::{Bounds, DualError, DualSolution, Factorised, Loaded, Options, Response, Responses, ShapedStrain};
use crate::element::polynomial::side;
use crate::element::{Material, Samples, StressField};
use crate::problem::{ContactPair, Problem, Scales};

/// Ends that are closer than this, relative to the value, are one but for rounding.
const ONE: f64 = 1e-9;

/// Rounding error of a computed value, relative to the largest effect of the data.
const ROUNDED: f64 = 1e-11;

/// Rounding error of projections and of means, relative to the largest that they can be.
const ROUNDED_MEAN: f64 = 1e-12;

/// Contacts of up to so many jumps have a dense Schur complement.
const LONGEST_DENSE: usize = 6000;

/// Why no multiple of the pressure is enough.
const NOT_HELD: &str = "no multiple of the pressure in the contacts balances what is asked: something is not held in that \
                        direction, or by contact alone that carries nothing";

/// Pressures below this part of the largest are none.
const NO_PRESSURE: f64 = 1e-9;

/// An interval that holds the exact value.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Its ends; infinite where nothing is guaranteed.
    pub ends: [f64; 2],
    /// The interval that the stresses alone give, of first order.
    pub first_order: [f64; 2],
    /// The value of λ for forces and stresses, of v for displacements: nearer to the truth than the middle.
    pub value: f64,
    /// True if equilibrium alone determines the value: every equilibrium has it, whatever its contact pressures, and the ends
    /// differ by rounding.
    pub exact_by_statics: bool,
    /// How far outside rounding may put a correct value that was computed.
    pub rounding: f64,
    /// Why an end is infinite.
    pub reasons: [Option<String>; 2],
    /// Contribution of each triangle to the width.
    pub shares: Vec<f64>,
}

impl Interval {
    /// Nothing is known, for this reason.
    pub fn unknown(reason: &str) -> Self {
        let ends = [f64::NEG_INFINITY, f64::INFINITY];
        Interval {
            ends,
            first_order: ends,
            value: f64::NAN,
            exact_by_statics: false,
            rounding: 0.0,
            reasons: [Some(reason.to_string()), Some(reason.to_string())],
            shares: Vec::new(),
        }
    }

    /// True if any end is guaranteed.
    pub fn has_an_end(&self) -> bool {
        self.ends.iter().any(|end| end.is_finite())
    }

    /// By how much `x` lies outside; zero inside, and where rounding may have put it there.
    pub fn outside(&self, x: f64) -> f64 {
        outside(self.ends, self.rounding, x)
    }

    /// Combines this interval with one of the same value from sharper stresses, keeping the shares of this one.
    pub fn and(self, sharper: &Interval) -> Self {
        let both =
            |[a, b]: [f64; 2], [c, d]: [f64; 2]| if a.max(c) <= b.min(d) { [a.max(c), b.min(d)] } else { [c, d] };
        let ends = both(self.ends, sharper.ends);
        let value = if sharper.value.is_nan() { self.value } else { sharper.value };
        let reason = |k: usize| if ends[k].is_finite() { None } else { sharper.reasons[k].clone() };
        Interval {
            ends,
            first_order: both(self.first_order, sharper.first_order),
            value: value.max(ends[0]).min(ends[1]),
            exact_by_statics: self.exact_by_statics || sharper.exact_by_statics,
            rounding: self.rounding.max(sharper.rounding),
            reasons: [reason(0), reason(1)],
            shares: self.shares,
        }
    }

    /// Half of the width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.ends[1] - self.ends[0])
    }

    /// Half of the width relative to the value; zero where only rounding is between the ends, and no mesh brings them closer.
    pub fn relative_half_width(&self) -> f64 {
        if self.half_width() <= self.rounding { 0.0 } else { self.half_width() / self.value.abs() }
    }
}

impl Functional {
    /// How far outside of an interval with these `ends` rounding may put a value: bounded by what the data can cause, whatever the ends are.
    pub fn rounding(&self, problem: &Problem, ends: [f64; 2]) -> f64 {
        let scales = Scales::new(problem);
        let [data, zero] = [&scales.data, &scales.round_off].map(|sizes| self.kind.size(problem, sizes));
        let largest = ends.iter().filter(|end| end.is_finite()).fold(0.0_f64, |m, end| m.max(end.abs()));
        (ROUNDED * data).min((ONE * largest).max(zero))
    }
}

/// The solved problem, with its stress, its upper bound and quantities derived from them.
pub struct Known<'a> {
    pub(super) problem: &'a Problem,
    pub(super) dual: &'a DualSolution,
    pub(super) upper: &'a UpperBound,
    /// H, per unit thickness.
    pub(super) square: f64,
    /// G, per unit thickness.
    gap: f64,
    responses: Responses<'a>,
    pub(super) nearest: Nearest<'a>,
    /// Coefficients of g − j(v) on every pair, not negative, in the degree of the bounds of z.
    pub(super) openings: Vec<Vec<f64>>,
    /// m, λ in a body of revolution, and ‖m‖_a at most.
    pub(super) middle: StressField,
    pub(super) size: f64,
    /// m on springs.
    pub(super) springs: OnSprings,
    /// The square of the norm that m would have if nothing cancelled in it.
    pub(super) uncancelled: f64,
    /// Coefficients of t(λ) one after the other, zero where nothing presses.
    pub(super) pressure: Vec<f64>,
}

impl<'a> Known<'a> {
    /// Gathers what all quantities need; `upper` is the bound of `bracket` that was built from `dual`.
    ///
    /// # Errors
    /// A sentence on what is missing.
    pub fn new(
        problem: &'a Problem,
        dual: &'a DualSolution,
        bracket: &Bracket,
        upper: &'a UpperBound,
        factorised: &'a Factorised,
        options: &Options,
    ) -> Result<Self, String> {
        let nearest = Nearest::new(problem, &dual.moments, &upper.prepared).map_err(|error| error.to_string())?;
        let gap = (upper.upper() - bracket.lower()).max(0.0);
        let tractions = dual.contact_traction.iter().flat_map(|of| of.iter());
        let of_excess: f64 = problem.pairs().zip(tractions).map(|(pair, t)| excess_work(pair, t)).sum();
        let of_contact = upper.local.pairs.iter().flatten().map(|p| p.max(0.0)).sum::<f64>()
            + upper.widening
            + problem.scene.thickness * of_excess;
        let ball = 0.5 * (gap + of_contact.min(gap)) / problem.scene.thickness;
        let open = |(pair, count): (&ContactPair, usize)| {
            let found = openings_within(problem, &upper.displacement, pair, count.max(1) - 1);
            found.unwrap_or_else(|| vec![0.0; count.max(1)]).into_iter().map(|o| o.max(0.0)).collect()
        };
        let (middle, in_bodies, uncancelled) = match problem.section().revolved() {
            None => {
                let middle = mid_field(problem, &dual.stress, &upper.displacement);
                let middle = middle.ok_or("λ and v are on different meshes")?;
                let square = square(problem, &middle);
                (middle, square, uncancelled(problem, &dual.stress, &upper.displacement))
            }
            // λ stands for m where that only guides.
            Some(of) => {
                let [both, uncancelled] = revolved::squares(problem, of, &dual.stress, &upper.displacement);
                (dual.stress.clone(), 0.5 * both, uncancelled)
            }
        };
        let springs = middle_of(problem, &dual.stress, &upper.displacement);
        Ok(Known {
            problem,
            dual,
            upper,
            square: ball,
            gap: gap / problem.scene.thickness,
            responses: factorised.responses(problem, &dual.moments, LONGEST_DENSE, options),
            openings: problem.pairs().zip(nearest.counts()).map(open).collect(),
            nearest,
            size: (in_bodies + square_of(problem, &springs)).sqrt(),
            springs,
            uncancelled: uncancelled + uncancelled_of(problem, &dual.stress, &upper.displacement),
            middle,
            pressure: pressing(dual),
        })
    }

    /// The interval of a quantity.
    pub fn interval(&self, functional: &Functional) -> Interval {
        let value = self.value(functional);
        let unloaded = functional;
        let degrees = (|t: usize| self.middle.degree(t), |e: usize| self.dual.moments.of(e).len() - 1);
        let functional = &*unloaded.loaded(self.problem, degrees.0, degrees.1);
        let loaded = self.responses.to(&functional.load);
        let neutral = loaded.held_by_all(self.dual.closed.values()).map_err(not_held);
        let search = Search { known: self, functional, loaded: &loaded };
        let (mut ends, mut reasons) = ([f64::NEG_INFINITY, f64::INFINITY], [None, None]);
        let mut first_order = ends;
        let mut shares = vec![0.0; self.problem.mesh.triangles.len()];
        let mut exact = false;
        match neutral {
            Err(reason) => reasons = [Some(reason.clone()), Some(reason)],
            Ok(neutral) => {
                let begun = search.begin(neutral);
                exact = search.is_static(&begun);
                let mut found: [Option<End>; 2] = [None, None];
                for (end, sign) in [(0, 1.0), (1, -1.0)] {
                    let best = match &found[0] {
                        // Without contact one pair serves both ends.
                        Some(lower) if self.pressure.is_empty() => Ok(search.turned(lower)),
                        Some(lower) => search.best(&begun, sign, Some(&lower.nodes)),
                        None => search.best(&begun, sign, None),
                    };
                    match best {
                        Ok(best) => {
                            ends[end] = sign * best.bound;
                            if let Some(first) = best.first_order {
                                first_order[end] = sign * first.0;
                            }
                            found[end] = Some(best);
                        }
                        Err(reason) => reasons[end] = Some(reason),
                    }
                }
                for end in found.iter().flatten() {
                    self.add_shares(end, &mut shares);
                }
            }
        }
        let remainder = self.remainder(unloaded, functional, &mut shares);
        let [ends, first_order] = [ends, first_order].map(|[lower, upper]| {
            [lower + remainder.centre - remainder.radius, upper + remainder.centre + remainder.radius]
        });
        let of_one_sign = functional.cannot_be();
        let [ends, first_order] = [ends, first_order].map(|interval| clipped(interval, of_one_sign));
        reasons.iter_mut().zip(of_one_sign).filter(|(_, is)| *is).for_each(|(reason, _)| *reason = None);
        let scaled = |v: f64| functional.scale * v;
        let exact = exact && self.are_one(functional, ends);
        Interval {
            ends: ends.map(scaled),
            first_order: first_order.map(scaled),
            value: scaled(value.max(ends[0]).min(ends[1])),
            exact_by_statics: exact,
            rounding: functional.rounding(self.problem, ends.map(scaled)),
            reasons,
            shares: shares.into_iter().map(|s| functional.scale * s).collect(),
        }
    }

    /// True if the ends differ by rounding alone: relative to the value, or to its rounding error where it is zero.
    fn are_one(&self, functional: &Functional, [lower, upper]: [f64; 2]) -> bool {
        let zero = functional.kind.size(self.problem, &Scales::new(self.problem).round_off) / functional.scale;
        upper - lower <= (ONE * lower.abs().max(upper.abs())).max(zero)
    }

    /// Enclosure, on the exact displacement, of the part of a value at a point that the load does not represent: its value for v, give or
    /// take a radius whose contributions are added to `shares`.
    fn remainder(&self, exact: &Functional, loaded: &Functional, shares: &mut [f64]) -> Remainder {
        if exact.local.is_none() {
            return Remainder { centre: 0.0, radius: 0.0 };
        }
        let (v, problem) = (&self.upper.displacement, self.problem);
        let materials = problem.materials();
        let known =
            [exact, loaded].map(|functional| value_of(problem, functional, v).unwrap_or(f64::NAN) / functional.scale);
        // ‖u − v‖² ≤ 2 G.
        let parts = || {
            loaded
                .oscillation
                .iter()
                .map(|(t, b)| (*t, b / materials[problem.mesh.body[*t]].softest().unwrap_or(0.0).sqrt()))
        };
        let square: f64 = parts().map(|(_, b)| b * b).sum();
        let radius = (2.0 * self.gap * square).sqrt();
        for (t, b) in parts().filter(|_| square > 0.0) {
            shares[t] += radius * b * b / square;
        }
        let strains = loaded
            .load
            .shaped
            .iter()
            .zip(&loaded.rests)
            .map(|(shaped, rest)| rest + shaped_square(problem, &materials, shaped));
        let rounding = ROUNDED_MEAN * (strains.sum::<f64>().sqrt() * self.size + known[0].abs());
        Remainder { centre: known[0] - known[1], radius: radius + rounding }
    }

    /// The response with s at least `floor`, with a remainder of at most `enough` where that can be had.
    pub(super) fn respond(
        &self,
        loaded: &Loaded<'_>,
        floor: &[f64],
        sign: f64,
        enough: f64,
    ) -> Result<Response, String> {
        let bounds = Bounds { closed: self.dual.closed.values(), floor, sign };
        loaded.respond(bounds, enough).map_err(not_held)
    }

    /// The ratio that the traction of `response` asks for where the contact presses.
    pub(super) fn needed(&self, response: &Response, sign: f64) -> f64 {
        let pressing = self.pressure.iter().zip(response.contact.values()).filter(|(t, _)| **t < 0.0);
        pressing.map(|(t, s)| sign * s / t).fold(0.0, f64::max)
    }

    /// The quantity of λ and v.
    fn value(&self, functional: &Functional) -> f64 {
        let stress = &self.dual.stress;
        let mut sum = functional.constant
            + match self.problem.section().revolved() {
                Some(of) => revolved::strained(self.problem, of, functional, Of::Stress(stress)),
                None => strained(self.problem, functional, |t| stress.degree(t), |t, s, l| stress.at(t, s, l)),
            };
        let pressures = self.dual.contact_traction.iter().flat_map(|of| of.iter());
        for ((pair, weights), t) in self.problem.pairs().zip(&functional.load.weights).zip(pressures) {
            sum += pair.length * side::integral(weights, t);
        }
        sum + displaced(self.problem, functional, &self.upper.displacement)
    }

    /// Adds what each triangle contributes to ρH + D²/(4ρ).
    fn add_shares(&self, end: &End, shares: &mut [f64]) {
        let ratio = end.weight(self.square);
        let thickness = self.problem.scene.thickness;
        for ((share, square), gap) in shares.iter_mut().zip(&end.pass.squares).zip(&self.upper.local.triangles) {
            *share += 0.5 * (ratio * 0.5 * gap.max(0.0) / thickness + square.max(0.0) / (4.0 * ratio));
        }
    }
}

/// Enclosure of the part of a quantity that the load of its adjoint problem does not represent.
struct Remainder {
    centre: f64,
    radius: f64,
}

/// ∫ Πχ : c Πχ.
fn shaped_square(
    problem: &Problem,
    materials: &[Material],
    ShapedStrain { triangle: t, strain }: &ShapedStrain,
) -> f64 {
    let material = &materials[problem.mesh.body[*t]];
    let samples = Samples::of_stress(strain.degree(0), strain.degree(0));
    let at = |sub: usize, q: usize| strain.sample(0, sub, samples, q);
    let of_point = |(q, (_, weight)): (usize, &([f64; 3], f64))| {
        (0..3).map(|sub| weight * material.strain_product(at(sub, q), at(sub, q))).sum::<f64>()
    };
    problem.mesh.area(*t) / 3.0 * samples.points.iter().enumerate().map(of_point).sum::<f64>()
}

/// The reason for that a response has no stress.
fn not_held(error: DualError) -> String {
    match error {
        DualError::NotConverged { .. } | DualError::ContactUndetermined => NOT_HELD.to_string(),
        other => other.to_string(),
    }
}

/// The coefficients of t(λ), zero where there is no pressure: rounding holds nothing.
fn pressing(dual: &DualSolution) -> Vec<f64> {
    let all = || dual.contact_traction.iter().flat_map(|of| of.values());
    let most = all().fold(0.0_f64, |m, t| m.max(-t));
    all().map(|t| if -t > NO_PRESSURE * most { *t } else { 0.0 }).collect()
}

/// The coefficients of degree `degree` of a polynomial of no higher degree.
pub(super) fn in_degree(coefficients: &[f64], degree: usize) -> Vec<f64> {
    match (coefficients.len() - 1).cmp(&degree) {
        std::cmp::Ordering::Equal => coefficients.to_vec(),
        std::cmp::Ordering::Less => side::elevate(coefficients, degree),
        std::cmp::Ordering::Greater => side::from_moments(&side::moments(coefficients, degree)),
    }
}
