//! The search for the best adjoint pair for one end of an interval.

use std::cell::RefCell;

use super::end::End;
use super::functional::Functional;
use super::interval::{Known, in_degree};
use super::tried::Tried;
use crate::bounds::{NoUpperBound, NodalValues, Pull, Until};
use crate::dual::modes::materials;
use crate::dual::{Loaded, Response};
use crate::element::{SideValues, StressField, triangle};

/// How often, and by what factor, the ratio is raised where it gives nothing.
const MOST_RAISES: usize = 8;
const RAISE: f64 = 4.0;

/// How far beyond the ratio that costs nothing the first one may be.
const FAR: f64 = 10.0;

/// Tries at most after the first that gives a bound.
const MOST_TRIES: usize = 3;

/// The largest weight of the stress of the scene in the pull at z, relative to that of the adjoint stress.
const HEAVIEST: f64 = 100.0;

/// Part of the width that a sweep over z has to gain for another one to follow.
const WORTH_A_SWEEP: f64 = 0.01;

/// The search for one end.
pub(super) struct Search<'s, 'a> {
    pub known: &'s Known<'a>,
    pub functional: &'s Functional,
    pub loaded: &'s Loaded<'s>,
}

impl Search<'_, '_> {
    /// The best end for sign · Q that a few ratios give.
    pub fn best(&self, neutral: &Response, sign: f64) -> Result<End, String> {
        let known = self.known;
        let sigma = self.stress(&neutral.stress, sign);
        let moments = if sign < 0.0 { negated(neutral.moments.clone()) } else { neutral.moments.clone() };
        let mut start = known.nearest.start(&sigma, &moments);
        let begun = known.nearest.filled(&start, Pull { scene: 0.0, stress: Some(&sigma) });
        let begun = self.measured(neutral, Some((&begun, sign)), sign);
        // Beyond that the stress of the scene leaves no digits of the adjoint one.
        let most = HEAVIEST * (begun.pass.uncancelled[0] / begun.pass.middle).sqrt();
        let most = if most > 0.0 { most } else { f64::INFINITY };
        let mut best: Option<(End, Response)> = None;
        let tried = RefCell::new(Tried::default());
        let mut attempt = |ratio: f64, best: &mut Option<(End, Response)>| -> Result<(), String> {
            let floor: Vec<f64> = known.pressure.iter().map(|t| ratio * t).collect();
            let response = known.respond(self.loaded, &floor, sign)?;
            let end = self.end(&response, sign, [ratio, ratio.min(most)], start.clone())?;
            if end.bound.is_finite() && end.ratio > 0.0 {
                tried.borrow_mut().add([ratio, end.ratio], end.distance);
            }
            if best.as_ref().is_none_or(|(best, _)| end.bound > best.bound) {
                start.clone_from(&end.nodes);
                *best = Some((end, response));
            }
            Ok(())
        };
        // As if what is clipped, D² = c/ρ, had the size of the stresses; where D is far smaller than they, what costs nothing.
        let [size, middle] = [begun.pass.balanced, begun.pass.middle].map(f64::sqrt);
        let clipped = size / (2.0 * middle * known.square).cbrt();
        let first = clipped.min(FAR * begun.distance / (2.0 * known.square.sqrt()));
        let first = if first.is_finite() && first > 0.0 { first } else { 1.0 };
        let mut reason = attempt(first, &mut best).err();
        // A body that contact alone holds needs a pressure to take off from.
        let finite = |best: &Option<(End, Response)>| best.as_ref().is_some_and(|(end, _)| end.bound.is_finite());
        let needed = known.needed(neutral, sign);
        let mut ratio = first.max(needed);
        for _ in 0..MOST_RAISES {
            if finite(&best) {
                break;
            }
            ratio *= RAISE;
            reason = attempt(ratio, &mut best).err().or(reason);
        }
        for _ in 0..MOST_TRIES {
            let Some(next) = tried.borrow().next(known.square) else { break };
            if let Err(why) = attempt(next, &mut best) {
                reason = Some(why);
                break;
            }
        }
        match best.filter(|(best, _)| best.bound.is_finite()) {
            Some((best, response)) => {
                let lift = self.functional.lift.as_ref().map(|lift| (lift, 1.0));
                let first = self.measured(&response, lift, sign);
                let first_order = Some((first.bound, first.centre)).filter(|(bound, _)| bound.is_finite());
                Ok(End { first_order, ..best })
            }
            None => Err(reason.unwrap_or_else(unbounded)),
        }
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

    /// sign · (σ̂ + cχ), χ by its mean where a triangle is cut.
    fn stress(&self, adjoint: &StressField, sign: f64) -> StressField {
        let problem = self.known.problem;
        let materials = materials(problem);
        let mut sigma = adjoint.clone();
        for (t, chi) in &self.functional.load.strains {
            let add = materials[problem.mesh.body[*t]].stress(*chi);
            sigma.block_mut(*t).iter_mut().for_each(|s| (0..3).for_each(|c| s[c] += add[c]));
        }
        if sign < 0.0 {
            sigma.values_mut().as_flattened_mut().iter_mut().for_each(|s| *s = -*s);
        }
        sigma
    }

    /// The bound of `response` with the best z for `ratio`: the one that makes Q_h − ρH − D²/(4ρ) largest, which has the least
    /// energy under the pull of σ_z − 2ρm and of the loads of the scene times 2ρ; with another `weight` in the place of ρ it
    /// is nearly as good.
    fn end(
        &self,
        response: &Response,
        sign: f64,
        [ratio, weight]: [f64; 2],
        start: NodalValues,
    ) -> Result<End, String> {
        let known = self.known;
        let stress = less(self.stress(&response.stress, sign), 2.0 * weight, &known.middle);
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
        let pull = Pull { scene: 2.0 * weight, stress: Some(&stress) };
        let until = Until::Gains(WORTH_A_SWEEP * 4.0 * weight * weight * known.square);
        let (z, nodes) = known.nearest.to(pull, &bounds, vec![start], until).map_err(|error| match error {
            NoUpperBound::ForcedPenetration { x, y, .. } | NoUpperBound::SupportsDisagree { x, y } => format!(
                "how contact and support share the force at ({x}, {y}), where they meet, is no bounded functional"
            ),
        })?;
        Ok(End { nodes, ..self.measured(response, Some((&z, sign)), sign) })
    }
}

/// σ − factor · m, of the degree of m, which is no lower.
fn less(sigma: StressField, factor: f64, middle: &StressField) -> StressField {
    let mut out = middle.clone();
    for t in 0..out.len() {
        let degree = middle.degree(t);
        let nodes: Vec<[f64; 3]> = if degree == sigma.degree(t) {
            sigma.block(t).to_vec()
        } else {
            let points = || triangle::indices(degree).map(|i| i.map(|i| i as f64 / degree as f64));
            (0..3).flat_map(|sub| points().map(move |l| (sub, l))).map(|(sub, l)| sigma.at(t, sub, l)).collect()
        };
        for (value, sigma) in out.block_mut(t).iter_mut().zip(nodes) {
            *value = [0, 1, 2].map(|c| sigma[c] - factor * value[c]);
        }
    }
    out
}

fn negated(mut moments: SideValues<[f64; 2]>) -> SideValues<[f64; 2]> {
    moments.values_mut().as_flattened_mut().iter_mut().for_each(|m| *m = -*m);
    moments
}

fn unbounded() -> String {
    "no adjoint stress and displacement fit the contact as it is".to_string()
}
