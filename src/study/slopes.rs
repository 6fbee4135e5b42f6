//! Intervals of quantities from energies alone, where contact is elastic or a traction is a polynomial.
//!
//! The exact energy E is a concave function of the loads and a convex one of the gaps, with the slopes −∫q·u along a load q and ∫ φ t along a gap φ.
//! Two brackets enclose a slope: a concave E(w) has E(w) − E(0) ≤ w E'(0) ≤ E(0) − E(−w). The width is of first order, about √(2 C G) with the gap
//! G of the bracket and the curvature C of E, at the w that makes it least.

use super::Certified;
use super::certify;
use crate::dual::{Condensed, Options};
use crate::element::Elements;
use crate::problem::{Condition, Problem};
use crate::quantity::{Form, Functional, Interval, displaced};
use crate::scene::Scene;

/// Part of the energy that the first change of the loads or gaps is to cause.
const FIRST: f64 = 0.05;

/// Steps that are tried, and by what factor one may differ from the one before.
const MOST_STEPS: usize = 4;
const LARGEST: f64 = 8.0;

/// What there is no interval of.
const NO_SLOPE: &str = "with elastic contact or polynomial tractions only mean displacements of free and loaded boundaries and of bodies, and forces of \
                        contacts, have an interval, and this is none of them";

/// Why there is none all the same.
const UNSOLVED: &str =
    "the problem with a little more load or gap, from whose energy the interval would come, could not be bounded";

/// The interval of a quantity of a problem that was solved.
pub fn interval(certified: &Certified, form: &Form, options: &Options) -> Interval {
    let Form::Linear(functional) = form else { return Interval::unknown(NO_SLOPE) };
    let Some(slope) = Slope::new(certified, functional, options) else { return Interval::unknown(NO_SLOPE) };
    slope.interval().unwrap_or_else(|| Interval::unknown(UNSOLVED))
}

struct Slope<'a> {
    certified: &'a Certified,
    functional: &'a Functional,
    options: Options,
    /// Whether it is the gaps that change.
    of_gaps: bool,
}

impl<'a> Slope<'a> {
    fn new(certified: &'a Certified, functional: &'a Functional, options: &Options) -> Option<Self> {
        let (problem, load) = (&certified.problem, &functional.load);
        let of_gaps = functional.is_of_contact_alone();
        let plain = functional.local.is_none()
            && functional.region.is_none()
            && load.strains.is_empty()
            && load.turned.is_empty()
            && load.shaped.is_empty()
            && load.edges.is_empty();
        let free = |(e, _): &(usize, _)| matches!(problem.conditions[*e], Condition::Traction(_));
        let weights = || load.weights.iter().filter(|weights| !weights.is_empty());
        let known = if of_gaps {
            weights().count() > 0 && weights().all(|weights| weights.len() == 2)
        } else {
            weights().count() == 0 && load.tractions.iter().all(free)
        };
        let stress = &certified.dual.stress;
        let degrees = (0..stress.len()).map(|t| stress.degree(t) as u8).collect();
        let options = Options { elements: Elements::Blocks(degrees), ..options.clone() };
        (plain && known).then_some(Slope { certified, functional, options, of_gaps })
    }

    /// The problem with `by` times the load or the gap of the quantity added.
    fn changed(&self, by: f64) -> Problem {
        let (mut problem, load) = (self.certified.problem.clone(), &self.functional.load);
        if self.of_gaps {
            let pairs = problem.interfaces.iter_mut().flat_map(|interface| &mut interface.pairs);
            for (pair, weights) in pairs.zip(&load.weights).filter(|(_, weights)| weights.len() == 2) {
                (0..2).for_each(|end| pair.gap[end] += by * weights[end]);
            }
            return problem;
        }
        for (e, ends) in &load.tractions {
            if let Condition::Traction(own) = &mut problem.conditions[*e] {
                (0..2).for_each(|end| (0..2).for_each(|c| own[end][c] += by * ends[end][c]));
            }
        }
        let mut draft = (*problem.scene).clone();
        for (body, more) in draft.bodies.iter_mut().zip(&load.force).filter(|(_, more)| !more.is_none()) {
            body.body_force = body.body_force.plus(more.at([0.0; 2]).map(|f| by * f));
        }
        problem.scene = Scene::unchecked(draft);
        problem
    }

    /// The bracket of its energy.
    fn energy(&self, by: f64) -> Option<[f64; 2]> {
        let solved = certify(self.changed(by), &Condensed::default(), &self.options).ok()?;
        bracket(&solved)
    }

    fn interval(&self) -> Option<Interval> {
        let thickness = self.certified.problem.scene.thickness;
        let [low, high] = bracket(self.certified)?;
        let v = &self.certified.bracket.free.as_ref().ok()?.displacement;
        let value = if self.of_gaps { self.force() } else { displaced(&self.certified.problem, self.functional, v) };
        let first = FIRST * self.certified.bracket.complementary.stored() / (thickness * value.abs());
        let mut best = [f64::NEG_INFINITY, f64::INFINITY];
        let mut step = first;
        for _ in 0..MOST_STEPS {
            if !(step.is_finite() && step > 0.0) {
                break;
            }
            // Much more load or gap may have no equilibrium.
            let (Some(down), Some(up)) = (self.energy(-step), self.energy(step)) else { break };
            let ends = if self.of_gaps {
                [(low - down[1]) / step, (up[1] - low) / step]
            } else {
                [(up[0] - high) / step, (high - down[0]) / step]
            };
            best = [best[0].max(ends[0]), best[1].min(ends[1])];
            let middle = |ends: [f64; 2]| 0.5 * (ends[0] + ends[1]);
            let curvature = (middle(up) + middle(down) - 2.0 * middle([low, high])).abs() / (step * step);
            let next = (2.0 * (high - low).max(0.0) / curvature).sqrt().clamp(step / LARGEST, step * LARGEST);
            if (next / step - 1.0).abs() < 0.1 {
                break;
            }
            step = next;
        }
        if !best.iter().all(|end| end.is_finite()) {
            return None;
        }
        let slope = if self.of_gaps { best } else { [-best[1], -best[0]] };
        let ends = slope.map(|end| self.functional.scale * (self.functional.constant + end / thickness));
        let value = self.functional.scale * (self.functional.constant + value);
        let triangles = &self.certified.bracket.free.as_ref().ok()?.local.triangles;
        Some(Interval {
            ends,
            first_order: ends,
            value: value.max(ends[0]).min(ends[1]),
            exact_by_statics: false,
            rounding: 0.0,
            reasons: [None, None],
            shares: triangles.iter().map(|share| share.max(0.0)).collect(),
        })
    }

    /// ∫ φ t of the stresses.
    fn force(&self) -> f64 {
        let tractions = self.certified.dual.contact_traction.iter().flat_map(|of| of.iter());
        let pairs = self.certified.problem.pairs().zip(&self.functional.load.weights).zip(tractions);
        pairs.map(|((pair, weights), t)| pair.length * crate::element::polynomial::side::integral(weights, t)).sum()
    }
}

fn bracket(certified: &Certified) -> Option<[f64; 2]> {
    Some([certified.bracket.lower(), certified.bracket.free.as_ref().ok()?.upper()])
}
