//! Adaptive refinement until the guaranteed error is small enough.
//!
//! solve → local terms of the gap → mark → bisect, on meshes that grow by a fixed factor, so that all solves together
//! cost little more than twice the last one. The indicators are the terms of the gap between the free upper bound and
//! the lower bound themselves (constitutive-relation error of each triangle, complementarity of each contact pair):
//! their sum is what the tolerance is set on. Both bounds hold on every mesh, so refinement decides how soon the
//! tolerance is reached and nothing else.

pub(super) mod admission;
mod answering;
pub(super) mod forecast;
pub(super) mod indicators;
pub(super) mod outlook;
pub(super) mod rounds;
pub(super) mod sharpen;
pub(super) mod stage;
pub(super) mod stop;
pub(super) mod trend;
#[cfg(test)]
pub(super) mod trend_tests;
pub(super) mod warm_start;

use std::time::{Duration, Instant};

use super::answers::answers;
use super::certified::{Certified, StudyError, carrying_loads};
use super::dossier::in_numbers;
use crate::compare::name::OfRun;
use crate::compare::{Allowances, Basis, Check, Comparison};
use crate::dual::{DualError, DualMethod, Options, Size};
use crate::mesh::refinement::bisect::RefinementEdges;
use crate::problem::Problem;
use crate::report::HistoryRow;
use crate::report::text::number::{at_most_percent, percent};
use admission::Admission;
use answering::Answering;
use forecast::Forecast;
use indicators::Indicators;
use outlook::{outlook, rate, stalls};
use rounds::{Next, Rounds, across};
use stage::{Solved, Stage};
use stop::Stop;
use trend::{Seen, learnt};

/// Triangles across less than this, relative to the farthest coordinate, are not refined: rounding of the corners would
/// show in them.
const SHORTEST: f64 = 1e-11;

/// Where triangles were too small all the same, the next try keeps them larger by this factor, up to `LONGEST`.
const COARSER: f64 = 30.0;
const LONGEST: f64 = 1e-5;

/// How many times the limit in seconds a method may take for the first mesh before it begins no further factorisation: a
/// late result is better than none, a contact state that never settles is not worth waiting for.
const PATIENCE_WITH_THE_FIRST: f64 = 3.0;

/// A mesh that makes the error smaller by less than this power of its unknowns is hardly worth them.
const STALLED: f64 = 0.1;

/// Where the gap may be rounding alone, the power of its unknowns by which a mesh has to make the error smaller, and the part
/// of the gap that triangles and contact pairs have to make up.
const WORTH_ANOTHER: f64 = 0.25;
const BY_TERMS: f64 = 0.5;
/// A gap of no more than so many times what rounding of the bounds adds to it is mostly that.
const TWICE: f64 = 2.0;

/// How far from its tolerance a quantity is taken to be that has no interval yet.
const UNKNOWN: f64 = 10.0;

/// What an adaptive run refines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Adapt {
    /// The mesh.
    H,
    /// The mesh and the degrees of its triangles. Where linear stresses on the first mesh do not do, it is solved on with cubic ones.
    Hp,
}

/// A quantity that is to be known more closely.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// Its name.
    pub name: String,
    /// Largest half-width of its interval, relative to its value.
    pub tolerance: f64,
}

/// The goal of an adaptive run, and its limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// Largest guaranteed relative energy-norm error; infinite where only quantities are wanted.
    pub tolerance: f64,
    /// Quantities of the scene.
    pub wanted: Vec<Wanted>,
    /// No mesh has more triangles than this, unless the first one has. The memory that a mesh may take is the budget of
    /// [`Options`].
    pub max_triangles: Option<usize>,
    /// No refinement begins after so many seconds.
    pub max_seconds: Option<f64>,
    /// An upper bound of the exact energy that is known from elsewhere.
    pub known_upper: Option<f64>,
    /// Refinement ends where two meshes in line brought the error down by less than this power of the unknowns.
    pub least_rate: Option<f64>,
    /// The way of refinement.
    pub adapt: Adapt,
    /// Part of the gap that the triangles marked in one round carry (Dörfler's bulk parameter), in (0, 1].
    pub bulk: f64,
}

impl Goal {
    /// This tolerance without limits.
    pub fn new(tolerance: f64) -> Self {
        Goal {
            tolerance,
            wanted: Vec::new(),
            max_triangles: None,
            max_seconds: None,
            known_upper: None,
            least_rate: None,
            adapt: Adapt::H,
            bulk: 0.6,
        }
    }
}

/// The result of an adaptive run.
#[derive(Debug, Clone)]
pub struct Adapted {
    /// On the last mesh.
    pub certified: Certified,
    /// Mesh by mesh.
    pub history: Vec<HistoryRow>,
    /// Why refinement stopped before the tolerance was reached.
    pub stopped: Option<String>,
    /// Advice on what to do then.
    pub advice: Option<&'static str>,
}

impl Adapted {
    /// A mesh that was not refined.
    pub fn only(certified: Certified) -> Self {
        Adapted { certified, history: Vec::new(), stopped: None, advice: None }
    }
}

/// Refines `problem` until the guaranteed relative energy-norm error is at most `goal.tolerance`; `on_step` hears of
/// every mesh.
///
/// # Errors
/// [`StudyError`]; a limit that is reached is no error, see [`Adapted::stopped`].
pub fn adapt(
    problem: Problem,
    method: &dyn DualMethod,
    options: &Options,
    goal: &Goal,
    mut on_step: impl FnMut(&HistoryRow),
) -> Result<Adapted, StudyError> {
    let start = Instant::now();
    let (problem, options) = carrying_loads(problem, options)?;
    let options = &options;
    let admission = Admission::new(method, options.budget);
    let refinement = RefinementEdges::longest(&problem.mesh);
    let mut stage = Stage::new(problem, refinement, options.elements.clone());
    let mut history: Vec<HistoryRow> = Vec::new();
    let mut forecast = Forecast::default();
    let mut last: Option<Measured> = None;
    let mut shortest = SHORTEST;
    let mut answering = Answering::new(goal, stage.problem.scene.quantities.len());
    let after = |seconds: f64| start.checked_add(Duration::try_from_secs_f64(seconds).ok()?);
    let by_then = goal.max_seconds.and_then(after);
    let by_first = goal.max_seconds.and_then(|most| after(PATIENCE_WITH_THE_FIRST * most));
    loop {
        let began = Instant::now();
        // The first mesh has no result before it to end with, and is given longer.
        let deadline = if last.is_some() { by_then } else { by_first };
        let options = &Options { deadline, ..options.clone() };
        let smallest = across(&stage.problem);
        let outcome = stage.solved(method, options, last.as_ref().map(|last| &last.solved.certified));
        let (solved, fault) = match (outcome, last.take()) {
            (Ok(solved), before) => {
                let seconds = [start.elapsed().as_secs_f64(), began.elapsed().as_secs_f64()];
                let mut now = Measured::new(solved, options, goal, seconds, history.last());
                on_step(&now.row);
                history.push(now.row);
                if let Ok(terms) = &now.terms {
                    forecast.learn(&now.solved.certified.problem.mesh, terms);
                }
                if goal.adapt == Adapt::Hp {
                    now.learn_ways(before.as_ref());
                }
                (now, None)
            }
            // What was reached is worth more than the reason why there is no more. Triangles that are less small may do, where
            // there are small ones.
            (Err(StudyError::Dual(reason)), Some(solved)) => {
                shortest = COARSER * shortest.max(smallest);
                let stop = match reason {
                    DualError::TooLarge { reason } => Stop::Factors(reason),
                    other => Stop::Unsolved(other.to_string()),
                };
                (solved, Some(stop))
            }
            (Err(error), _) => return Err(error),
        };
        let Measured { solved: Solved { certified, .. }, row, terms, left } = &solved;
        if *left <= 1.0 {
            return Ok(Adapted { certified: solved.solved.certified, history, stopped: None, advice: None });
        }
        let spent = start.elapsed().as_secs_f64();
        let mesh = (&certified.problem, &solved.solved.elements);
        // What was wanted of quantities took its part of it, and a finer mesh takes it again.
        let took = answering.seconds(began.elapsed().as_secs_f64(), certified, options, goal);
        let seconds = goal.max_seconds.map(|most| [most - spent, took]);
        let rounds = Rounds::new(goal, &admission, &forecast, mesh, shortest, seconds);
        let finer = match (goal.max_seconds, fault, terms) {
            (_, Some(fault), _) if shortest > LONGEST => Next::Nothing(fault),
            (Some(most), ..) if spent >= most => Next::Nothing(Stop::Seconds(most)),
            _ if stalls(&history, goal) => Next::Nothing(Stop::Stalled),
            (.., Err(reason)) => Next::Nothing(Stop::NoUpperBound(reason.clone())),
            (.., Ok(terms)) => match rounding(certified, row, goal, terms) {
                Some(stop) => Next::Nothing(stop),
                None => rounds.next(&solved.solved, terms, *left, row.rate.is_some_and(|rate| rate < STALLED))?,
            },
        };
        stage = match finer {
            Next::Mesh(finer) => *finer,
            Next::Nothing(stop) => {
                let pace = outlook(&history, goal, &admission, Size::of_degrees(mesh.0, mesh.1));
                let (stopped, advice) = (Some(stopped(&stop, row, goal, pace)), Some(stop.advice()));
                return Ok(Adapted { certified: solved.solved.certified, history, stopped, advice });
            }
        };
        last = Some(solved);
        if let Some(last) = &mut last {
            // The next mesh needs the memory.
            last.solved.certified.dual.factorised = None;
        }
    }
}

/// A mesh that was solved, and what is known of its error.
struct Measured {
    solved: Solved,
    row: HistoryRow,
    /// The terms of what is to become smaller, or why there are none.
    terms: Result<Indicators, String>,
    /// By what factor it is larger than it may be.
    left: f64,
}

impl Measured {
    fn new(solved: Solved, options: &Options, goal: &Goal, seconds: [f64; 2], before: Option<&HistoryRow>) -> Self {
        let certified = &solved.certified;
        let row = row(certified, goal, seconds, before);
        let mut terms = match &certified.bracket.free {
            Ok(free) => Ok(Indicators::new(&certified.problem, free)),
            Err(reason) => Err(reason.to_string()),
        };
        // The gap is the square of the error.
        let of_energy = match row.relative_error_bound <= goal.tolerance {
            true => 0.0,
            false => (row.relative_error_bound / goal.tolerance).powi(2),
        };
        let mut left = if of_energy > 0.0 { of_energy.max(1.0 + f64::EPSILON) } else { 0.0 };
        if !goal.wanted.is_empty()
            && let Ok(gap) = &terms
        {
            let (of_quantities, shares) = open(certified, options, goal, gap);
            let weight = if of_energy > 0.0 { of_energy / gap.total() } else { 0.0 };
            terms = Ok((0..shares.len()).map(|t| weight * gap.of(t) + shares[t]).collect());
            left = left.max(of_quantities);
        }
        Measured { row, solved, terms, left }
    }

    fn seen(&self) -> Option<Seen<'_>> {
        let terms = self.terms.as_ref().ok()?;
        let Solved { certified, elements, .. } = &self.solved;
        Some(Seen { mesh: &certified.problem.mesh, elements, terms })
    }

    /// Learns whether to bisect each triangle or to raise its degree from the gain since `before`. Linear stresses tell nothing of it.
    fn learn_ways(&mut self, before: Option<&Measured>) {
        let before = before.filter(|before| before.solved.elements.largest_degree() > 1);
        if let Some((now, before)) = self.seen().zip(before)
            && let Some(then) = before.seen()
        {
            self.solved.ways = learnt(now, then, &self.solved.parent, &before.solved.ways);
        }
    }
}

/// By what factor the widest interval that is wanted is wider than it may be, and what each triangle adds to those that
/// are: shares of the gap where there is no interval.
fn open(certified: &Certified, options: &Options, goal: &Goal, gap: &Indicators) -> (f64, Vec<f64>) {
    let mut shares = vec![0.0; certified.problem.mesh.triangles.len()];
    let mut most = 0.0_f64;
    let wanted = |name: &str| goal.wanted.iter().find(|wanted| wanted.name == name);
    for answer in answers(certified, options, |name| wanted(name).is_some()) {
        let Some(tolerance) = wanted(&answer.name).map(|wanted| wanted.tolerance) else { continue };
        let allowed = tolerance * answer.interval.value.abs();
        let left = answer.interval.relative_half_width() / tolerance;
        if left <= 1.0 {
            continue;
        }
        let known = left.is_finite() && answer.interval.shares.iter().sum::<f64>() > 0.0;
        most = most.max(if known { left } else { UNKNOWN });
        for (t, share) in shares.iter_mut().enumerate() {
            *share += if known { answer.interval.shares[t] / allowed } else { UNKNOWN * gap.of(t) / gap.total() };
        }
    }
    (most, shares)
}

/// Rounding, where it may be all that is left of the gap: below what the data explain a mesh has to have brought the error
/// down to be worth another. What the data explain is much where gaps are wide or a body is stiff, and often much more than
/// what rounding left of these solves.
fn rounding(certified: &Certified, row: &HistoryRow, goal: &Goal, terms: &Indicators) -> Option<Stop> {
    let bracket = &certified.bracket;
    let widening = bracket.lower_widening + bracket.free.as_ref().map_or(0.0, |free| free.widening);
    let (gap, round_off) = (row.upper - row.lower, bracket.round_off.max(TWICE * widening));
    let idle = row.rate.is_some_and(|rate| rate < WORTH_ANOTHER);
    let is_rounding =
        row.relative_error_bound > goal.tolerance && gap <= round_off && (idle || terms.total() <= BY_TERMS * gap);
    is_rounding.then_some(Stop::Rounding { gap, round_off })
}

fn row(
    certified: &Certified,
    goal: &Goal,
    [seconds, step_seconds]: [f64; 2],
    before: Option<&HistoryRow>,
) -> HistoryRow {
    let Certified { problem, dual, bracket, .. } = certified;
    let free = bracket.free.as_ref().map_or(f64::INFINITY, |free| free.upper());
    let upper = goal.known_upper.map_or(free, |known| free.min(known));
    let relative_error_bound = in_numbers(bracket.relative_error(upper));
    let rate = before.map(|before| rate(before, relative_error_bound, dual.unknowns));
    HistoryRow {
        triangles: problem.mesh.triangles.len(),
        unknowns: dual.unknowns,
        lower: bracket.lower(),
        upper,
        relative_error_bound,
        seconds,
        step_seconds,
        rate: rate.filter(|r| r.is_finite()),
    }
}

fn stopped(reason: &Stop, row: &HistoryRow, goal: &Goal, pace: Option<String>) -> String {
    let pace = pace.map_or(String::new(), |pace| format!(" Outlook: {pace}."));
    let tolerance = match goal.wanted.first() {
        Some(wanted) if goal.tolerance.is_infinite() => {
            format!("{} for quantity '{}'", percent(wanted.tolerance), wanted.name)
        }
        _ => percent(goal.tolerance),
    };
    format!(
        "Refinement stopped before the tolerance of {tolerance} was reached, because {reason}: the guaranteed relative \
         energy-norm error is {} with {} triangles.{pace}",
        at_most_percent(row.relative_error_bound),
        row.triangles
    )
}

/// Checks that the tolerance asked for is reached, with the best upper bound of the run.
pub fn tolerance_check(certified: &Certified, comparison: &Comparison, tolerance: f64, allow: &Allowances) -> Check {
    let name = OfRun::Tolerance.name();
    let allowed = allow.given(name).unwrap_or(tolerance);
    if let Some(note) = certified.problem.weakened() {
        let why = format!("The bounds are not guaranteed for the scene as it is written: {}.", note.text);
        return Check::not_made(name, allowed, Basis::Asked, why);
    }
    match comparison.upper(&certified.bracket) {
        Some((upper, _)) => Check::at_most(
            name,
            certified.bracket.relative_error(upper.upper()),
            0.0,
            allowed,
            Basis::Asked,
            "The guaranteed relative energy-norm error of the stresses against the tolerance that was asked for.",
        ),
        None => Check::not_made(name, allowed, Basis::Asked, "There is no upper bound to hold the tolerance against."),
    }
}
