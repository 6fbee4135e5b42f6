//! The search for the best adjoint pair for one end of an interval.

use std::borrow::Cow;

use super::end::End;
use super::springs::{adjoint_of, combined, square_of};
use super::tried::Tried;
use crate::bounds::energy::square;
use crate::bounds::{Beside, NoUpperBound, NodalValues, OnSprings, Pull, Until};
use crate::dual::{Load, Loaded, Response, ShapedStrain};
use crate::element::StressField;
use crate::problem::Problem;
use crate::quantity::functional::Functional;
use crate::quantity::interval::{Known, in_degree};

/// How often, and by what factor, the ratio is raised where it gives nothing.
const MOST_RAISES: usize = 8;
const RAISE: f64 = 4.0;

/// How far beyond the ratio that costs nothing the first one may be.
const FAR: f64 = 10.0;

/// Tries at most after the first that gives a bound.
const MOST_TRIES: usize = 3;

/// The largest weight of the stress of the scene in the pull at z, relative to that of the adjoint stress.
const HEAVIEST: f64 = 100.0;

/// Part of a sum below which its terms have cancelled: it is measured instead.
const CANCELLED: f64 = 1e-8;

/// Part of the width that a remainder of equilibrium may add where the stress is known to this part of its norm, and so the
/// displacement that remainders are weighed with nearly the exact one …
const UNSEEN: f64 = 1e-4;
const NEAR: f64 = 0.1;

/// … and elsewhere, where that displacement says little of the exact one.
const UNSEEN_FAR: f64 = 1e-6;

/// Part of the width that a sweep over z has to gain for another one to follow.
const WORTH_A_SWEEP: f64 = 1e-3;

/// Relative squares of stresses that are none.
const NO_STRESS: f64 = 1e-18;

/// Relative square below which the computed difference between an adjoint stress and the stress of its displacement is zero.
const NO_STRAIN: f64 = 1e-15;

/// Jumps that are none, relative to the largest displacement and weight.
const NO_JUMP: f64 = 1e-8;

/// The search for one end.
pub(in crate::quantity) struct Search<'s, 'a> {
    pub known: &'s Known<'a>,
    pub functional: &'s Functional,
    pub loaded: &'s Loaded<'s>,
}

/// The common starting point of the search for either end.
pub(in crate::quantity) struct Begun {
    response: Response,
    /// Values of z at nodes.
    nodes: NodalValues,
    /// ‖σ̂‖_a, and ‖σ_z‖_a.
    balanced: f64,
    size: f64,
    /// D.
    distance: f64,
}

impl Search<'_, '_> {
    /// Prepares the search for either end: the unconstrained response, and a displacement close to it.
    pub fn begin(&self, neutral: Response) -> Begun {
        let Known { problem, nearest, .. } = self.known;
        let sigma = self.stress(&neutral.stress);
        let nodes = nearest.start(&sigma, &neutral.moments, &self.functional.load.turned);
        let springs = adjoint_of(problem, self.functional, &neutral.stress);
        let of_springs = square_of(problem, &springs);
        let balanced = square(problem, &neutral.stress) + of_springs;
        let load = &self.functional.load;
        let strained = !load.strains.is_empty() || !load.shaped.is_empty();
        let beside = self.beside(1.0);
        let rests: f64 = self.functional.rests.iter().sum();
        let square = if strained { square(problem, &sigma) + of_springs + rests } else { balanced };
        // D² = ‖σ_z‖² + 2 (½‖σ(z)‖² − ∫ σ_z : e(z)).
        let pull = Pull { scene: 0.0, initial: false, stress: Some(&sigma), springs: Some(&springs), beside };
        let square = square + self.functional.turned_square(problem);
        let rest = square + 2.0 * nearest.energy(&nodes, pull);
        // In a body of revolution no products of σ̂ with what is beside it are at hand.
        let distance = if rest > CANCELLED * square && beside.is_none() {
            rest.sqrt()
        } else {
            self.measured(&neutral, (&nearest.filled(&nodes, pull), 1.0), 1.0).distance
        };
        let [balanced, size] = [balanced, square].map(f64::sqrt);
        Begun { response: neutral, nodes, balanced, size, distance }
    }

    /// The best end for sign · Q that a few ratios give; `other` is z of the other end, turned as that is.
    pub fn best(&self, begun: &Begun, sign: f64, other: Option<&NodalValues>) -> Result<End, String> {
        let known = self.known;
        // But for what pressure and opening allow, z of one end is that of the other turned around.
        let start = other.map_or_else(|| (begun.nodes.scaled(sign), false), |z| (z.scaled(-1.0), true));
        let mut tries = Tries::new(self, begun, sign, start);
        tries.add(self.first_ratio(begun));
        // A body that contact alone holds needs a pressure to take off from.
        let mut ratio = self.first_ratio(begun).max(known.needed(&begun.response, sign));
        for _ in 0..MOST_RAISES {
            if tries.is_bounded() {
                break;
            }
            ratio *= RAISE;
            tries.add(ratio);
        }
        for _ in 0..MOST_TRIES {
            let Some(next) = tries.tried.next(known.square) else { break };
            if !tries.add(next) {
                break;
            }
        }
        let reason = tries.reason.unwrap_or_else(unbounded);
        let (best, response) = tries.best.filter(|(best, _)| best.bound.is_finite()).ok_or(reason)?;
        let first = match &self.functional.lift {
            Some(lift) => {
                let End { bound, centre, .. } = self.measured(&response, (lift, 1.0), sign);
                (bound, centre)
            }
            None => self.alone(&response, &best.pass, sign),
        };
        let first_order = Some(first).filter(|(bound, _)| bound.is_finite());
        Ok(End { first_order, ..best })
    }

    /// As if what is clipped, D² = c/ρ, had the size of the stresses; where D is far smaller than they, what costs nothing.
    fn first_ratio(&self, begun: &Begun) -> f64 {
        let Known { square, size, .. } = self.known;
        let clipped = begun.balanced / (2.0 * size * square).cbrt();
        let first = clipped.min(FAR * begun.distance / (2.0 * square.sqrt()));
        if first.is_finite() && first > 0.0 { first } else { 1.0 }
    }

    /// The other end of an interval without contact, from the pair of the lower one.
    pub fn turned(&self, lower: &End) -> End {
        let other = |bound: f64, centre: f64| bound - 2.0 * centre;
        End {
            bound: other(lower.bound, lower.centre),
            first_order: lower.first_order.map(|(bound, centre)| (other(bound, centre), -centre)),
            centre: -lower.centre,
            pass: lower.pass.clone(),
            nodes: lower.nodes.clone(),
            ..*lower
        }
    }

    /// True if the pair that ignores the state of contact has neither stress nor k: then every equilibrium,
    /// whatever its contact pressures, has the value Q_h.
    pub fn is_static(&self, begun: &Begun) -> bool {
        let Known { nearest, .. } = self.known;
        let natural = self.functional.natural;
        if natural <= 0.0 {
            return false;
        }
        let sigma = self.stress(&begun.response.stress);
        let filled = nearest.filled(
            &begun.nodes,
            Pull { scene: 0.0, initial: false, stress: Some(&sigma), springs: None, beside: self.beside(1.0) },
        );
        let pair = self.measured(&begun.response, (&filled, 1.0), 1.0);
        pair.pass.balanced <= NO_STRESS * natural
            && pair.pass.pair.square <= NO_STRAIN * natural
            && pair.beyond <= NO_JUMP
    }

    /// The part of σ_z in a body of revolution beyond the weighted form of σ̂: the radial load in its hoop stress, and cχ.
    fn beside(&self, factor: f64) -> Option<Beside<'_>> {
        let Functional { load: Load { force, .. }, beside, .. } = self.functional;
        let is_there = !beside.is_empty() || force.iter().any(|force| !force.is_none());
        let is_there = is_there && self.known.problem.section().is_revolved();
        is_there.then_some(Beside { factor, forces: force, stresses: beside })
    }

    /// σ̂ + cχ, χ by its mean where a triangle is cut.
    fn stress<'f>(&self, adjoint: &'f StressField) -> Cow<'f, StressField> {
        let problem = self.known.problem;
        let Load { strains, shaped, .. } = &self.functional.load;
        if strains.is_empty() && shaped.is_empty() {
            return Cow::Borrowed(adjoint);
        }
        let materials = problem.materials();
        let mut sigma = adjoint.clone();
        if !shaped.is_empty() {
            let mut degrees: Vec<usize> = (0..adjoint.len()).map(|t| adjoint.degree(t)).collect();
            for ShapedStrain { triangle: t, strain } in shaped {
                degrees[*t] = degrees[*t].max(strain.degree(0));
            }
            sigma = StressField::of_degrees(degrees);
            for t in 0..adjoint.len() {
                let own = adjoint.in_degree(t, sigma.degree(t));
                sigma.block_mut(t).copy_from_slice(&own);
            }
            for ShapedStrain { triangle: t, strain } in shaped {
                let material = &materials[problem.mesh.body[*t]];
                let own = strain.in_degree(0, sigma.degree(*t));
                for (s, chi) in sigma.block_mut(*t).iter_mut().zip(own.iter()) {
                    let add = material.stress(*chi);
                    (0..3).for_each(|c| s[c] += add[c]);
                }
            }
        }
        for (t, chi) in strains {
            let add = materials[problem.mesh.body[*t]].stress(*chi);
            sigma.block_mut(*t).iter_mut().for_each(|s| (0..3).for_each(|c| s[c] += add[c]));
        }
        Cow::Owned(sigma)
    }

    /// The bound of `response` with the best z for `ratio`: the one that makes Q_h − ρH − D²/(4ρ) largest, which has the least
    /// energy under the pull of σ_z − 2ρm and of the loads of the scene times 2ρ; with another `weight` in the place of ρ it
    /// is nearly as good. `start` may be one that was `relaxed` for another ratio, or for the other end.
    fn end(
        &self,
        response: &Response,
        sign: f64,
        [ratio, weight]: [f64; 2],
        (start, relaxed): (NodalValues, bool),
    ) -> Result<End, String> {
        let known = self.known;
        let stress = less(sign, &self.stress(&response.stress), 2.0 * weight, &known.middle);
        let bounds: Vec<Vec<f64>> = known
            .openings
            .iter()
            .zip(&self.functional.load.weights)
            .map(|(open, weights)| {
                let weights =
                    if weights.is_empty() { vec![0.0; open.len()] } else { in_degree(weights, open.len() - 1) };
                open.iter().zip(weights).map(|(o, w)| ratio * o - sign * w).collect()
            })
            .collect();
        let adjoint = adjoint_of(known.problem, self.functional, &response.stress);
        let less =
            |(q, m): (&[Vec<f64>; 2], &[Vec<f64>; 2])| [0, 1].map(|c| combined(sign, &q[c], -2.0 * weight, &m[c]));
        let springs: OnSprings = adjoint.iter().zip(&known.springs).map(less).collect();
        let beside = self.beside(sign);
        let pull = Pull { scene: 2.0 * weight, initial: false, stress: Some(&stress), springs: Some(&springs), beside };
        let until = Until::Gains { least: WORTH_A_SWEEP * 4.0 * weight * weight * known.square, relaxed };
        let (z, nodes) = known.nearest.to(pull, &bounds, start, until).map_err(|error| match error {
            NoUpperBound::ForcedPenetration { x, y, .. } if is_tip(known.problem, [x, y]) => format!(
                "the contact ends inside a body at ({x}, {y}), and what it carries up to there is no bounded functional; ask for a \
                 window that is zero there"
            ),
            NoUpperBound::ForcedPenetration { x, y, .. }
            | NoUpperBound::PressedInside { x, y, .. }
            | NoUpperBound::SupportsDisagree { x, y } => format!(
                "how contact and support share the force at ({x}, {y}), where they meet, is no bounded functional"
            ),
        })?;
        Ok(End { nodes, ..self.measured(response, (&z, sign), sign) })
    }
}

/// True if both sides of a contact share one vertex at this place of the scene as written.
fn is_tip(problem: &Problem, place: [f64; 2]) -> bool {
    let mut shared = problem.pairs().flat_map(|pair| (0..2).filter_map(|end| pair.shared(end)));
    shared.any(|v| problem.scene.as_written(problem.mesh.points[v]) == place)
}

/// The ratios that were tried for one end, and the best of what they gave.
struct Tries<'t, 's, 'a> {
    search: &'t Search<'s, 'a>,
    sign: f64,
    /// The largest weight of the stress of the scene: beyond it that leaves no digits of the adjoint one.
    heaviest: f64,
    /// Remainders of equilibrium that do not show in the width.
    enough: f64,
    /// The displacement from which relaxation starts, and true if it was relaxed already.
    start: (NodalValues, bool),
    tried: Tried,
    best: Option<(End, Response)>,
    /// Why the last of them gave nothing.
    reason: Option<String>,
}

impl<'t, 's, 'a> Tries<'t, 's, 'a> {
    fn new(search: &'t Search<'s, 'a>, begun: &Begun, sign: f64, start: (NodalValues, bool)) -> Self {
        let heaviest = HEAVIEST * begun.size / search.known.size;
        let heaviest = if heaviest > 0.0 { heaviest } else { f64::INFINITY };
        let radius = search.known.square.sqrt();
        let unseen = if radius <= NEAR * search.known.size { UNSEEN } else { UNSEEN_FAR };
        let enough = unseen * begun.distance * radius;
        Tries { search, sign, heaviest, enough, start, tried: Tried::default(), best: None, reason: None }
    }

    fn is_bounded(&self) -> bool {
        self.best.as_ref().is_some_and(|(end, _)| end.bound.is_finite())
    }

    /// Tries a ratio; `false` where there is no response to it.
    fn add(&mut self, ratio: f64) -> bool {
        match self.attempt(ratio) {
            Ok((end, response)) => {
                if end.bound.is_finite() && end.ratio > 0.0 {
                    self.tried.add([ratio, end.ratio], end.distance);
                }
                if self.best.as_ref().is_none_or(|(best, _)| end.bound > best.bound) {
                    self.start = (end.nodes.clone(), true);
                    self.best = Some((end, response));
                }
                true
            }
            Err(reason) => {
                self.reason = Some(reason);
                false
            }
        }
    }

    fn attempt(&self, ratio: f64) -> Result<(End, Response), String> {
        let Search { known, loaded, .. } = self.search;
        let floor: Vec<f64> = known.pressure.iter().map(|t| ratio * t).collect();
        let response = known.respond(loaded, &floor, self.sign, self.enough)?;
        let weights = [ratio, ratio.min(self.heaviest)];
        let end = self.search.end(&response, self.sign, weights, self.start.clone())?;
        Ok((end, response))
    }
}

/// sign · σ − factor · m, of the degree of m, which is no lower.
fn less(sign: f64, sigma: &StressField, factor: f64, middle: &StressField) -> StressField {
    let mut out = middle.clone();
    for t in 0..out.len() {
        let sigma = sigma.in_degree(t, middle.degree(t));
        let values = out.block_mut(t).iter_mut().zip(sigma.iter());
        values.for_each(|(value, sigma)| *value = [0, 1, 2].map(|c| sign * sigma[c] - factor * value[c]));
    }
    out
}

fn unbounded() -> String {
    "no adjoint stress and displacement fit the contact as it is".to_string()
}
