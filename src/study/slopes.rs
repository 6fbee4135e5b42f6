//! Intervals of quantities from energies alone: where contact has friction or is elastic, and where a traction is a polynomial.
//!
//! The exact energy E is a concave function of the loads and a convex one of gaps and initial strains, with the slopes −∫ q·u along a load
//! q, ∫ φ t along a gap φ and −∫ χ:τ along an initial strain χ. Two brackets enclose a slope: a concave E(w) has
//! E(w) − E(0) ≤ w E'(0) ≤ E(0) − E(−w), a convex one the same with ≥. The width is of first order, about √(2 C G) with the gap G of the
//! bracket and the curvature C of E, at the w that makes it least.

use std::collections::HashMap;

use super::Certified;
use super::certify;
use crate::bounds::Sum;
use crate::dual::{Condensed, Options};
use crate::element::Elements;
use crate::element::polynomial::side;
use crate::problem::{Condition, Problem, Scales};
use crate::quantity::{Form, Functional, Interval, Local, clipped, displaced, strained};
use crate::scene::{Draft, Scene};

/// Part of the energy that the first change of the data is to cause where nothing is known of the curvature.
const FIRST: f64 = 0.05;

/// Part of the size of a quantity below which its value says nothing of that change.
const SMALL: f64 = 1e-3;

/// Steps that are tried, and by what factor one may differ from the one before.
const MOST_STEPS: usize = 4;
const LARGEST: f64 = 8.0;

/// Rounding error of a slope, relative to it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Rounding error of the integral of a stress, relative to the integral over all of the triangles.
const ROUNDED_MEAN: f64 = 1e-12;

/// Reason why a quantity has no interval of this kind.
const NO_SLOPE: &str = "with friction, elastic contact or polynomial tractions only mean displacements of free and loaded boundaries and of \
                        bodies, mean stresses, stresses at points, and forces of contacts and of supports that meet no spring have an interval, and this is none of them";

/// The same of a body of revolution.
const NO_SLOPE_REVOLVED: &str = "on bodies of revolution with friction or elastic contact only mean displacements of free and loaded boundaries \
                                 and of bodies and normal forces of contacts have an interval, and this is none of them";

fn no_slope(problem: &Problem) -> &'static str {
    if problem.section().is_revolved() { NO_SLOPE_REVOLVED } else { NO_SLOPE }
}

/// Why there is none all the same.
const UNSOLVED: &str = "the problem with other data, from whose energy the interval would come, could not be bounded";

/// Refuses a quantity that has no interval of this kind.
///
/// # Errors
/// A sentence on the quantities that have one.
pub fn refuse(problem: &Problem, form: &Form) -> Result<(), &'static str> {
    let has_one = |functional: &Functional| {
        Simplified::of(problem, functional).is_some_and(|simplified| Change::of(problem, &simplified.means).is_some())
    };
    let all = match form {
        Form::Linear(functional) => has_one(functional),
        Form::Invariant { components, .. } => components.iter().all(has_one),
    };
    if all { Ok(()) } else { Err(no_slope(problem)) }
}

/// The interval of a quantity of a problem that was solved.
pub fn interval(certified: &Certified, form: &Form, options: &Options) -> Interval {
    match form {
        Form::Linear(functional) => of_functional(certified, functional, options),
        Form::Invariant { components, of } => {
            of.interval(components.each_ref().map(|own| of_functional(certified, own, options)))
        }
    }
}

fn of_functional(certified: &Certified, functional: &Functional, options: &Options) -> Interval {
    let problem = &certified.problem;
    let found = Simplified::of(problem, functional)
        .and_then(|simplified| Change::of(problem, &simplified.means).map(|change| (simplified, change)));
    let Some((simplified, change)) = found else { return Interval::unknown(no_slope(problem)) };
    let stress = &certified.dual.stress;
    let degrees = (0..stress.len()).map(|t| stress.degree(t) as u8).collect();
    let options = Options { elements: Elements::Blocks(degrees), ..options.clone() };
    Slope { certified, functional, simplified, options, change }
        .interval()
        .unwrap_or_else(|| Interval::unknown(UNSOLVED))
}

/// A quantity with its strains as means over triangles.
struct Simplified {
    means: Functional,
    /// ∫ c(χ − mean):(χ − mean).
    rest: f64,
}

impl Simplified {
    /// None of a quantity that has other terms near a point.
    fn of(problem: &Problem, functional: &Functional) -> Option<Self> {
        let mut means = Functional { region: None, local: None, ..functional.clone() };
        let mut rest = Sum::default();
        match (&functional.region, functional.local.as_deref()) {
            (Some((chi, cuts)), _) => {
                let materials = problem.materials();
                for cut in cuts {
                    let square = materials[problem.mesh.body[cut.triangle]].strain_product(*chi, *chi);
                    rest.add(problem.mesh.area(cut.triangle) * cut.part * (1.0 - cut.part) * square);
                }
            }
            (None, None) => {}
            (None, Some(Local::Point(point))) => {
                for (t, chi, left) in point.means(problem)? {
                    means.load.strains.push((t, chi));
                    rest.add(left);
                }
            }
            (None, Some(Local::Tip(_))) => return None,
        }
        Some(Simplified { means, rest: rest.value().max(0.0) })
    }
}

/// The part of the data that changes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Change {
    /// Nothing: the quantity is known.
    Nothing,
    /// Tractions and body forces.
    Loads,
    /// Gaps and initial strains.
    GapsAndStrains,
}

impl Change {
    /// The change whose slope the quantity is.
    fn of(problem: &Problem, functional: &Functional) -> Option<Self> {
        let load = &functional.load;
        let weighted = load.weights.iter().any(|weights| !weights.is_empty());
        let linear = load.weights.iter().all(|weights| matches!(weights.len(), 0 | 2));
        let loaded = !load.tractions.is_empty() || load.force.iter().any(|force| !force.is_none());
        // In a body of revolution no initial strains are changed: they have none around the axis.
        let without_strains = load.strains.is_empty() && functional.region.is_none();
        let plain = functional.local.is_none()
            && load.turned.is_empty()
            && load.shaped.is_empty()
            && load.edges.is_empty()
            && (!problem.section().is_revolved() || without_strains);
        let free = |(e, _): &(usize, _)| matches!(problem.conditions[*e], Condition::Traction(_));
        match (loaded, weighted || !load.strains.is_empty()) {
            _ if !plain => None,
            (false, false) => Some(Change::Nothing),
            (true, false) => load.tractions.iter().all(free).then_some(Change::Loads),
            (false, true) => linear.then_some(Change::GapsAndStrains),
            (true, true) => None,
        }
    }
}

struct Slope<'a> {
    certified: &'a Certified,
    functional: &'a Functional,
    simplified: Simplified,
    options: Options,
    change: Change,
}

impl Slope<'_> {
    /// The problem with `by` times the load of the quantity added to its data.
    fn changed(&self, by: f64) -> Problem {
        let mut problem = self.certified.problem.clone();
        let mut draft = (*problem.scene).clone();
        match self.change {
            Change::Nothing => {}
            Change::Loads => self.add_loads(&mut problem, &mut draft, by),
            Change::GapsAndStrains => {
                self.add_gaps(&mut problem, by);
                self.add_strains(&mut problem, &mut draft, by);
            }
        }
        problem.scene = Scene::unchecked(draft);
        problem
    }

    fn add_loads(&self, problem: &mut Problem, draft: &mut Draft, by: f64) {
        let load = &self.simplified.means.load;
        for (e, ends) in &load.tractions {
            if let Condition::Traction(own) = &mut problem.conditions[*e] {
                (0..2).for_each(|end| (0..2).for_each(|c| own[end][c] += by * ends[end][c]));
            }
        }
        for (body, more) in draft.bodies.iter_mut().zip(&load.force).filter(|(_, more)| !more.is_none()) {
            body.body_force = body.body_force.plus(more.at([0.0; 2]).map(|f| by * f));
        }
    }

    fn add_gaps(&self, problem: &mut Problem, by: f64) {
        let pairs = problem.interfaces.iter_mut().flat_map(|interface| &mut interface.pairs);
        for (pair, weights) in pairs.zip(&self.simplified.means.load.weights).filter(|(_, weights)| weights.len() == 2)
        {
            (0..2).for_each(|end| pair.gap[end] += by * weights[end]);
        }
    }

    /// Takes strains away: triangles with one become bodies of their own, which stay bonded, with the initial stress cχ more.
    fn add_strains(&self, problem: &mut Problem, draft: &mut Draft, by: f64) {
        let materials = problem.materials();
        let mut made: HashMap<(usize, [u64; 3]), usize> = HashMap::new();
        for (t, chi) in &self.simplified.means.load.strains {
            let of = problem.mesh.body[*t];
            problem.mesh.body[*t] = *made.entry((of, chi.map(f64::to_bits))).or_insert_with(|| {
                let mut body = draft.bodies[of].clone();
                let stress = materials[of].stress(*chi);
                (0..3).for_each(|c| body.initial.stress[c] += by * stress[c]);
                draft.bodies.push(body);
                draft.bodies.len() - 1
            });
        }
    }

    /// The bracket of its energy.
    fn energy(&self, by: f64) -> Option<[f64; 2]> {
        let solved = certify(self.changed(by), &Condensed::default(), &self.options).ok()?;
        bracket(&solved)
    }

    fn interval(&self) -> Option<Interval> {
        let (problem, functional) = (&self.certified.problem, self.functional);
        let slope = if self.change == Change::Nothing { [0.0; 2] } else { self.slope()? };
        let slope = slope.map(|end| end / problem.scene.thickness);
        let [centre, radius] = self.remainder();
        let ends = [slope[0] - ROUNDING * slope[0].abs() - radius, slope[1] + ROUNDING * slope[1].abs() + radius];
        let ends = clipped(ends.map(|end| functional.constant + end + centre), functional.cannot_be());
        let [least, most] = functional.within;
        let ends = [ends[0].max(least), ends[1].min(most)].map(|end| functional.scale * end);
        let missing = |end: f64| (!end.is_finite()).then(|| UNSOLVED.to_string());
        let triangles = &self.certified.bracket.free.as_ref().ok()?.local.triangles;
        Some(Interval {
            ends,
            first_order: ends,
            value: (functional.scale * (functional.constant + self.value())).max(ends[0]).min(ends[1]),
            exact_by_statics: self.change == Change::Nothing,
            rounding: functional.rounding(problem, ends),
            reasons: ends.map(missing),
            shares: triangles.iter().map(|share| share.max(0.0)).collect(),
        })
    }

    /// Two numbers that enclose the slope, thickness included.
    fn slope(&self) -> Option<[f64; 2]> {
        let [low, high] = bracket(self.certified)?;
        let mut best = [f64::NEG_INFINITY, f64::INFINITY];
        let mut step = self.first_step(high - low);
        for _ in 0..MOST_STEPS {
            if !(step.is_finite() && step > 0.0) {
                break;
            }
            let [down, up] = [-step, step].map(|by| self.energy(by));
            let ends = match self.change {
                Change::Loads => [down.map(|down| (down[0] - high) / step), up.map(|up| (high - up[0]) / step)],
                _ => [down.map(|down| (low - down[1]) / step), up.map(|up| (up[1] - low) / step)],
            };
            best = [best[0].max(ends[0].unwrap_or(best[0])), best[1].min(ends[1].unwrap_or(best[1]))];
            // Much more load may have no equilibrium.
            let (Some(down), Some(up)) = (down, up) else {
                step /= LARGEST;
                continue;
            };
            let middle = |ends: [f64; 2]| 0.5 * (ends[0] + ends[1]);
            let curvature = (middle(up) + middle(down) - 2.0 * middle([low, high])).abs() / (step * step);
            let next = (2.0 * (high - low).max(0.0) / curvature).sqrt().clamp(step / LARGEST, step * LARGEST);
            if (next / step - 1.0).abs() < 0.1 {
                break;
            }
            step = next;
        }
        best.iter().any(|end| end.is_finite()).then_some(best)
    }

    /// The step that is best for the largest curvature that there can be, or one that changes the energy by a part of it.
    fn first_step(&self, gap: f64) -> f64 {
        let problem = &self.certified.problem;
        let (thickness, materials) = (problem.scene.thickness, problem.materials());
        let of = |(t, chi): &(usize, [f64; 3])| {
            problem.mesh.area(*t) * materials[problem.mesh.body[*t]].strain_product(*chi, *chi)
        };
        let curvature: f64 = thickness * self.simplified.means.load.strains.iter().map(of).sum::<f64>();
        let best = (2.0 * gap.max(0.0) / curvature).sqrt();
        if curvature > 0.0 && best > 0.0 && best.is_finite() {
            return best;
        }
        let size = self.functional.kind.size(problem, &Scales::new(problem).data);
        let value = self.value().abs().max(SMALL * size / self.functional.scale);
        FIRST * self.certified.bracket.complementary.stored() / (thickness * value)
    }

    /// By how much the quantity differs from that of the means of its strains on triangles, and how far that may be off: with
    /// ‖τ − λ‖² ≤ 2G.
    fn remainder(&self) -> [f64; 2] {
        let Certified { problem, dual, .. } = self.certified;
        if self.simplified.rest == 0.0 {
            return [0.0; 2];
        }
        let of = |functional: &Functional| {
            strained(problem, functional, |t| dual.stress.degree(t), |t, sub, l| dual.stress.at(t, sub, l))
        };
        let [exact, mean] = [self.functional, &self.simplified.means].map(of);
        let gap = bracket(self.certified).map_or(f64::INFINITY, |[low, high]| (high - low).max(0.0));
        let radius = (2.0 * gap / problem.scene.thickness * self.simplified.rest).sqrt();
        [exact - mean, radius + ROUNDED_MEAN * exact.abs()]
    }

    /// The quantity of λ and v, without its constant.
    fn value(&self) -> f64 {
        let (Certified { problem, dual, bracket, .. }, functional) = (self.certified, self.functional);
        let tractions = dual.contact_traction.iter().flat_map(|of| of.iter());
        let pairs = problem.pairs().zip(&functional.load.weights).zip(tractions);
        let of_contact: f64 = pairs.map(|((pair, weights), t)| pair.length * side::integral(weights, t)).sum();
        let of_stress = strained(problem, functional, |t| dual.stress.degree(t), |t, sub, l| dual.stress.at(t, sub, l));
        let of_displacement =
            bracket.free.as_ref().map_or(0.0, |free| displaced(problem, functional, &free.displacement));
        of_contact + of_stress + of_displacement
    }
}

fn bracket(certified: &Certified) -> Option<[f64; 2]> {
    Some([certified.bracket.lower(), certified.bracket.free.as_ref().ok()?.upper()])
}
