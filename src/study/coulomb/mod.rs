//! Coulomb friction: a bound of the tangential traction that goes with the pressure that it leads to.
//!
//! |T_t| ≤ μ |T_n| has no principle of least energy. With the bound τ̄ held it has one, and what is found here is a fixed point of
//! τ̄ → μ |T_n(τ̄)|. Three statements can be made of it (theory.md):
//!
//! 1. Since the least energy grows with τ̄, that of every Coulomb solution lies between the least energies without friction and with sides
//!    that stick. Both ends have a bracket.
//! 2. The fields belong to the exact solution with the bound that was used, within the bracket; how far that bound is from μ |T_n| is
//!    measured on the stresses.
//! 3. How near they are to a solution of Coulomb's law is not known, nor whether there is one such solution only. The iteration begins at
//!    both ends; where it arrives at two bounds there are two.

mod bounds;
mod iteration;
mod models;
mod summary;

use std::time::Instant;

use super::adaptive::Adapted;
use super::adaptive::rounds::{TIME, unknowns_of};
use super::certified::{Certified, StudyError};
use crate::bounds::{Bracket, UpperBound};
use crate::compare::BoundDistance;
use crate::dual::{DualMethod, Options};
use crate::element::Elements;
use crate::problem::{Problem, Scales};
use crate::statics::{Wedged, friction_can_balance, wedged};
use bounds::{Bounds, apart, distances};
use iteration::{Iteration, iterate};
pub(super) use summary::in_verdict;

/// A bound that keeps sides sticking, in the largest stress that data can cause.
const STICKING: f64 = 1e6;
/// Work of friction, in the energies at stake, that rounding leaves where sides stick.
const LEFT: f64 = 1e-7;
/// Bounds that differ by no more than this part are one.
const SAME: f64 = 1e-6;

/// Results on contact with Coulomb friction beside the bracket for the bound that was used.
#[derive(Debug, Clone)]
pub struct Coulomb {
    /// No Coulomb solution has less energy: the lower bound without friction; `None` where nothing else holds the bodies.
    pub lowest: Option<f64>,
    /// None has more: the upper bound of sides that stick.
    pub highest: Option<f64>,
    /// Where the iteration began, and how it ended; the first that arrived has the bound that was used.
    pub starts: Vec<Start>,
    /// How far the bound is from μ times the pressure, contact by contact; `None` without Coulomb friction.
    pub distances: Vec<Option<BoundDistance>>,
    /// By how much the bounds at which two starts arrived differ, relative to them; `None` where only one arrived.
    pub apart: Option<f64>,
    /// Pieces that friction can hold without a load.
    pub wedged: Vec<Wedged>,
}

/// One run of the iteration.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Where it began.
    pub from: From,
    /// How it ended.
    pub end: End,
}

/// Where an iteration began.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum From {
    /// The pressure of sides that stick.
    Sticking,
    /// The pressure without friction.
    Frictionless,
}

/// How an iteration ended.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// At a bound that goes with its pressure, after so many solutions.
    Arrived(usize),
    /// With a bound with which nothing holds the bodies, and the sentence that says how they move.
    NoEquilibrium(String),
    /// Not at all: after so many solutions bounds still changed by this part.
    Wanders(usize, f64),
}

impl Coulomb {
    /// Solutions on the way to the bound that was used.
    pub fn iterations(&self) -> usize {
        let arrived = |start: &Start| if let End::Arrived(count) = start.end { Some(count) } else { None };
        self.starts.iter().find_map(arrived).unwrap_or(0)
    }

    /// True if two starts arrived at different bounds.
    pub fn has_several(&self) -> bool {
        self.apart.is_some_and(|apart| apart > SAME)
    }
}

/// Finds a bound of friction that goes with its pressure, and brackets the energy of the problem with this bound; `certify` solves and
/// brackets, and may divide the mesh to that end.
///
/// # Errors
/// [`StudyError`]; [`StudyError::Coulomb`] where no start arrives though forces of friction can balance the loads.
pub fn solve_coulomb(
    problem: &Problem,
    method: &dyn DualMethod,
    options: &Options,
    certify: impl Fn(Problem) -> Result<Certified, StudyError>,
    mut told: impl FnMut(&str),
) -> Result<(Certified, Coulomb), StudyError> {
    told("solving with sides that stick");
    let most = STICKING * Scales::new(problem).data.stress;
    let sticking = certify(problem.with_friction_bounds(&Bounds::constant(problem, most).0))?;
    let problem = &sticking.problem;
    told("solving without friction");
    let none = Bounds::constant(problem, 0.0);
    let free = match certify(problem.with_friction_bounds(&none.0)) {
        Err(StudyError::NoEquilibrium { .. } | StudyError::BeyondMesh { .. }) => None,
        other => Some(other?),
    };
    let mut runs = Vec::new();
    let ends = [(From::Sticking, Some(&sticking)), (From::Frictionless, free.as_ref())];
    for (from, start) in ends.into_iter().filter_map(|(from, start)| Some((from, start?))) {
        if start.problem.mesh.triangles.len() != problem.mesh.triangles.len() {
            // Its pressures are on a mesh that was divided for them.
            continue;
        }
        let first = Bounds::of_pressure(&start.problem, &start.dual);
        runs.push((from, iterate(problem, first, method, options, &mut told)?));
    }
    let apart = match &runs[..] {
        [(_, Iteration { bounds: Some(first), .. }), (_, Iteration { bounds: Some(second), .. })] => {
            Some(apart(problem, first, second))
        }
        _ => None,
    };
    let Some(bounds) = runs.iter().find_map(|(_, run)| run.bounds.as_ref()) else {
        return Err(no_fixed_point(problem, runs));
    };
    told("bracketing the energy with the bound that was found");
    let certified = certify(problem.with_friction_bounds(&bounds.0))?;
    let coulomb = Coulomb {
        lowest: free.as_ref().map(|free| free.bracket.lower()),
        highest: highest(&sticking.bracket),
        starts: runs.iter().map(|(from, run)| Start { from: *from, end: run.end.clone() }).collect(),
        distances: distances(&certified.problem, &certified.dual),
        apart,
        wedged: wedged(&certified.problem),
    };
    Ok((certified, coulomb))
}

/// Of the seconds that are left, the part for refinement with a bound held: finding another on the finer mesh takes the rest.
const FOR_REFINEMENT: f64 = 0.5;

/// Rounds of refinement with a bound held and another bound on the finer mesh.
const ROUNDS: usize = 4;

/// Where there is a `tolerance` of the relative error, solves and refines in turn until the bracket for the bound that was found meets it:
/// `adapt` refines with the bound held, for no more than the seconds that it is given. Where `seconds` would pass before a bound is found on a
/// finer mesh, that of the coarser one is kept.
///
/// # Errors
/// As [`solve_coulomb`].
pub fn solve_coulomb_to(
    (tolerance, seconds): (Option<f64>, Option<f64>),
    mut problem: Problem,
    (method, options): (&dyn DualMethod, &Options),
    certify: impl Fn(Problem, &dyn DualMethod, &Options) -> Result<Certified, StudyError>,
    adapt: impl Fn(Problem, &Options, Option<f64>) -> Result<Adapted, StudyError>,
    mut told: impl FnMut(&str),
) -> Result<(Adapted, Coulomb), StudyError> {
    let mut options = options.clone();
    let (mut history, mut stopped, mut advice) = (Vec::new(), None, None);
    let (begin, mut rounds) = (Instant::now(), 0);
    loop {
        let before = begin.elapsed().as_secs_f64();
        let (certified, mut coulomb) =
            solve_coulomb(&problem, method, &options, |held| certify(held, method, &options), &mut told)?;
        let (took, coarse) = (begin.elapsed().as_secs_f64() - before, unknowns(&certified));
        let upper = certified.bracket.free.as_ref().map_or(f64::INFINITY, |free| free.upper());
        let met = tolerance.is_none_or(|tolerance| certified.bracket.relative_error(upper) <= tolerance);
        if met || stopped.is_some() || rounds == ROUNDS {
            let stopped = if met { None } else { stopped };
            return Ok((Adapted { certified, history, stopped, advice }, coulomb));
        }
        let left = seconds.map(|most| FOR_REFINEMENT * (most - begin.elapsed().as_secs_f64()).max(0.0));
        let adapted = adapt(certified.problem, &options, left)?;
        rounds += 1;
        let finer = &adapted.certified;
        let needed = took * (unknowns(finer) / coarse).powf(TIME);
        if seconds.is_some_and(|most| begin.elapsed().as_secs_f64() + needed > most) {
            coulomb.distances = distances(&finer.problem, &finer.dual);
            history.extend(adapted.history);
            return Ok((Adapted { history, ..adapted }, coulomb));
        }
        let stress = &adapted.certified.dual.stress;
        let degrees = || (0..stress.len()).map(|t| stress.degree(t));
        let same = matches!(options.elements, Elements::Uniform(element) if degrees().all(|p| p == element.degree()));
        if !same {
            options.elements = Elements::Blocks(degrees().map(|p| p as u8).collect());
        }
        history.extend(adapted.history);
        (problem, stopped, advice) = (adapted.certified.problem, adapted.stopped, adapted.advice);
    }
}

/// The unknowns of the stresses.
fn unknowns(certified: &Certified) -> f64 {
    let stress = &certified.dual.stress;
    unknowns_of((0..stress.len()).map(|t| stress.degree(t)))
}

/// The upper bound of sides that stick; none where its displacement slides by more than rounding. The work of friction on what rounding
/// leaves is part of it.
fn highest(bracket: &Bracket) -> Option<f64> {
    let sticks = |free: &&UpperBound| free.potential.friction <= LEFT * free.potential.magnitude;
    bracket.free.as_ref().ok().filter(sticks).map(|free| free.upper())
}

/// Why no start arrived.
fn no_fixed_point(problem: &Problem, runs: Vec<(From, Iteration)>) -> StudyError {
    let balances = friction_can_balance(problem);
    let wedges = wedged(problem);
    let mut refused = None;
    let mut wanders = None;
    for (_, run) in runs {
        match run.end {
            End::Wanders(count, change) => wanders = wanders.or(Some((count, change))),
            _ => refused = refused.or(run.refused),
        }
    }
    if !balances && let Some(StudyError::NoEquilibrium { sentence, motion, work, problem }) = refused {
        let sentence = format!(
            "{sentence} No forces of contact within the cones of Coulomb's friction balance the loads, so that no solution exists."
        );
        return StudyError::NoEquilibrium { sentence, motion, work, problem };
    }
    let law = "Coulomb's friction has no principle of least energy, and its iteration need not arrive.";
    let last = match &refused {
        Some(StudyError::NoEquilibrium { sentence, .. }) => format!(" With the last bound: {sentence}"),
        _ => String::new(),
    };
    let wedging = wedges.first().map_or(String::new(), |wedged| format!(" {}", in_words(wedged)));
    StudyError::Coulomb(match (wanders, balances) {
        (_, false) => "no forces of contact within the cones of Coulomb's friction balance the loads, so that no solution exists; a support, \
                       or a larger coefficient, would hold the bodies"
            .to_string(),
        (Some((count, change)), true) => format!(
            "no friction bound was found that goes with its pressure: after {count} solutions the bounds still change by {:.1e} of their \
             size. {law}{wedging} Lower the coefficient, give the bound itself with friction = {{ bound = … }}, or hold the bodies by \
             supports",
            change
        ),
        (None, true) => format!(
            "no friction bound was found that goes with its pressure: on the way to it the bodies lose their hold, though forces within \
             the cones of friction could balance the loads.{last} {law}{wedging} Whether there is a solution is not known. Give the bound \
             itself with friction = {{ bound = … }}, press the bodies together, or hold them by supports"
        ),
    })
}

/// Says what wedging means.
pub(super) fn in_words(wedged: &Wedged) -> String {
    format!(
        "Friction can wedge {}: forces at {} balance each other without any load, so that pressures depend on how the loads came on, and \
         solutions can be several.",
        wedged.bodies,
        wedged.contacts.join(" and ")
    )
}
