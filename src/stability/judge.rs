//! Comparison of the answer of a run with the known facts.

use super::data::{Outcome, Step};
use super::known::Known;
use super::truth::Truth;
use crate::compare::ADMISSIBLE;
use crate::measure::{Answer, End, Ended, Measured, Method};

/// Round-off in the comparison itself, relative to the energy.
const ENERGY: f64 = 1e-12;
/// Resultants of stresses in equilibrium, relative to the loads.
const RESULTANT: f64 = 1e-9;
/// Resultants of the displacement model, which its solver's tolerance limits.
const RESULTANT_PRIMAL: f64 = 1e-6;
/// Deviations that the method's own equilibrium residual accounts for are this many times the residual at most.
const ACCOUNTED: f64 = 1e3;
/// A force that equilibrium does not determine is off by this many times the guaranteed relative error of the stresses at most.
const FROM_STRESSES: f64 = 10.0;
/// Relative errors beyond which an answer is inaccurate …
const INACCURATE: f64 = 0.25;
/// … and beyond which an answer that comes without a bound is wrong.
const MISLEADING: f64 = 0.5;
/// Scaled and renumbered problems: largest relative difference of direct solvers, and of iterative ones.
const SAME: f64 = 1e-12;
const SAME_ITERATIVE: f64 = 1e-6;
/// Variation of the pressure beyond the exact one that counts as oscillation.
const OSCILLATION: f64 = 1.1;

/// The reference that a run is compared with.
#[derive(Debug, Clone, Copy)]
pub struct Claim<'a> {
    /// Facts from outside.
    pub known: &'a Known,
    /// Where the exact energy lies, if that is known.
    pub truth: Option<Truth>,
    /// The method's answer to the first problem of the regime.
    pub first: Option<&'a Answer>,
    /// Its error there: guaranteed where it guarantees one, true elsewhere.
    pub first_error: Option<f64>,
    /// The error may be at most this many times that at the first value.
    pub flat: Option<f64>,
}

/// Judges one run of `method`.
pub fn judge(method: Method, ended: &Ended, claim: &Claim<'_>) -> Step {
    let without =
        |outcome: Outcome, why: &str| Step { outcome, why: why.to_string(), error: None, bound: None, answer: None };
    let results = match ended {
        Ended::Crashed(text) => return without(Outcome::Crash, text),
        Ended::OverBudget => return without(Outcome::NoConvergence, "it was ended after the time allowed"),
        Ended::Told(results) => results,
    };
    let Some(Measured { end, answer, .. }) = results.iter().find(|r| r.method == method.name()) else {
        return without(Outcome::Crash, "the process ended without a result");
    };
    match (end, answer) {
        (End::Solved, Some(answer)) => solved(method, answer, claim),
        (End::Solved, None) => without(Outcome::Crash, "solved, but without numbers"),
        (End::Crashed(why), _) => without(Outcome::Crash, why),
        (End::NotApplicable(why), _) => without(Outcome::NotApplicable, why),
        (End::NoEquilibrium(why), _) if !claim.known.solvable => without(Outcome::Correct, why),
        (End::NoEquilibrium(why), _) => without(Outcome::Wrong, &format!("denies an equilibrium that exists: {why}")),
        (End::Refused(why), _) => without(Outcome::Refused, why),
        (End::NotConverged(why), _) => without(Outcome::NoConvergence, why),
    }
}

fn solved(method: Method, answer: &Answer, claim: &Claim<'_>) -> Step {
    let bound = answer.relative_error_bound;
    let energy = answer.lower.filter(|_| method.has_bracket()).or(answer.upper);
    let error = claim.truth.zip(energy).map(|(truth, energy)| truth.error(energy));
    let mut worst = (Outcome::Correct, String::new());
    let mut found = |outcome: Outcome, why: String| {
        if outcome > worst.0 {
            worst = (outcome, why);
        }
    };
    if !claim.known.solvable {
        found(Outcome::Wrong, "gives numbers where no equilibrium exists".to_string());
    }
    for (outcome, why) in [
        numbers(method, answer),
        bounds(answer, claim),
        resultants(method, answer, claim),
        admissible(answer),
        accuracy(method, answer, error, claim),
        sameness(method, answer, claim),
        oscillation(answer, claim),
    ]
    .into_iter()
    .flatten()
    {
        found(outcome, why);
    }
    Step { outcome: worst.0, why: worst.1, error, bound, answer: Some(answer.clone()) }
}

type Complaint = Option<(Outcome, String)>;

/// Everything that should be there is, and is a number.
fn numbers(method: Method, answer: &Answer) -> Complaint {
    if method.has_bracket() && answer.lower.is_none() {
        return Some((Outcome::Wrong, "the lower bound is no number".to_string()));
    }
    if answer.upper.is_none() {
        // An upper bound that could not be built says so; one that is not a number does not.
        return Some(match &answer.missing {
            Some(why) => (Outcome::Refused, why.clone()),
            None => (Outcome::Wrong, "the upper bound is no number".to_string()),
        });
    }
    None
}

/// Bounds are ordered and do not exclude the truth.
fn bounds(answer: &Answer, claim: &Claim<'_>) -> Complaint {
    let strain = claim.truth.map(|t| t.strain).or(answer.strain).unwrap_or(0.0);
    let slack = ENERGY * strain;
    if let (Some(lower), Some(upper)) = (answer.lower, answer.upper)
        && lower > upper + slack
    {
        return Some((Outcome::Wrong, format!("the lower bound {lower:e} is above the upper bound {upper:e}")));
    }
    let truth = claim.truth?;
    if let Some(lower) = answer.lower.filter(|l| *l > truth.upper + slack) {
        let by = (lower - truth.upper) / strain;
        return Some((Outcome::Wrong, format!("the lower bound exceeds the exact energy by {by:.1e} of it")));
    }
    if let Some(upper) = answer.upper.filter(|u| *u < truth.lower - slack) {
        let by = (truth.lower - upper) / strain;
        return Some((Outcome::Wrong, format!("the upper bound falls short of the exact energy by {by:.1e} of it")));
    }
    None
}

fn resultants(method: Method, answer: &Answer, claim: &Claim<'_>) -> Complaint {
    let mut off = 0.0_f64;
    for (found, known) in answer.resultants.iter().zip(&claim.known.resultants) {
        for (found, known) in found.iter().zip(known).filter(|(_, k)| !k.is_nan()) {
            let difference = (found - known).abs();
            off = if difference.is_nan() { f64::INFINITY } else { off.max(difference) };
        }
    }
    let relative = off / claim.known.load;
    let allowed = if method.is_primal() { RESULTANT_PRIMAL } else { RESULTANT };
    // Without any load there is nothing to be relative to, and nothing may be there.
    if off == 0.0 || relative <= allowed {
        return None;
    }
    let why = format!("a contact force is off by {relative:.1e} of the loads");
    let guaranteed = answer.relative_error_bound.filter(|_| claim.known.indeterminate).unwrap_or(0.0);
    let said = match method.is_primal() {
        true => relative <= 1e-2,
        false => relative <= (ACCOUNTED * answer.equilibrium.unwrap_or(0.0)).max(FROM_STRESSES * guaranteed),
    };
    Some((if said { Outcome::Inaccurate } else { Outcome::Wrong }, why))
}

/// A displacement penetrates nowhere, and stays on its supports.
fn admissible(answer: &Answer) -> Complaint {
    let by = answer.violation.filter(|v| v.is_nan() || *v > ADMISSIBLE)?;
    Some((Outcome::Inaccurate, format!("the displacement penetrates or leaves its supports by {by:.1e} of its size")))
}

fn accuracy(method: Method, answer: &Answer, error: Option<f64>, claim: &Claim<'_>) -> Complaint {
    let own = if method.has_bracket() { answer.relative_error_bound } else { error };
    let own = own.filter(|e| e.is_finite())?;
    let kind = if method.has_bracket() { "guaranteed" } else { "true" };
    if own > MISLEADING && !method.has_bracket() {
        return Some((Outcome::Wrong, format!("a true error of {:.0} %, and no bound that says so", 100.0 * own)));
    }
    if own > INACCURATE {
        return Some((Outcome::Inaccurate, format!("the {kind} error is {:.0} %", 100.0 * own)));
    }
    let (flat, first) = (claim.flat?, claim.first_error?);
    // Errors of round-off size may grow by any factor.
    (own > flat * first.max(1e-4)).then(|| {
        (Outcome::Inaccurate, format!("the {kind} error has grown from {:.2} % to {:.2} %", 100.0 * first, 100.0 * own))
    })
}

/// Scaled and renumbered problems have the same answer.
fn sameness(method: Method, answer: &Answer, claim: &Claim<'_>) -> Complaint {
    let ([energy, force], first) = (claim.known.scale?, claim.first?);
    let allowed = match method {
        Method::CLARABEL | Method::UZAWA => SAME_ITERATIVE,
        method if method.is_primal() => SAME_ITERATIVE,
        _ => SAME,
    };
    let strain = first.strain.unwrap_or(0.0) * energy;
    let mut off = 0.0_f64;
    for (a, b) in [(answer.lower, first.lower), (answer.upper, first.upper)] {
        if let (Some(a), Some(b)) = (a, b) {
            let difference = (a - b * energy).abs();
            off = off.max(if strain > 0.0 { difference / strain } else { difference });
        }
    }
    for (a, b) in answer.resultants.iter().zip(&first.resultants) {
        for (a, b) in a.iter().zip(b) {
            let (a, b) = if claim.known.mirrored { (a.abs(), b.abs()) } else { (*a, *b) };
            let difference = (a - b * force).abs();
            off = off.max(if claim.known.load > 0.0 { difference / claim.known.load } else { difference });
        }
    }
    // Where nothing is left of the loads, the first mesh has the answer.
    if answer.triangles != first.triangles && energy > 0.0 {
        let why = format!("{} triangles instead of {}", answer.triangles, first.triangles);
        return Some((Outcome::Inaccurate, why));
    }
    (off.is_nan() || off > allowed)
        .then(|| (Outcome::Inaccurate, format!("it differs from the first answer, scaled, by {off:.1e}")))
}

fn oscillation(answer: &Answer, claim: &Claim<'_>) -> Complaint {
    let pairs = answer.variation.iter().zip(&claim.known.variation);
    let worst = pairs.filter(|(_, known)| **known > 0.0).map(|(found, known)| found / known).fold(0.0, f64::max);
    (worst > OSCILLATION)
        .then(|| (Outcome::Inaccurate, format!("the pressure varies {worst:.2} times as much as the exact one")))
}
