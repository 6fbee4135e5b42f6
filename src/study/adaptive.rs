//! Adaptive refinement until the guaranteed error is small enough.
//!
//! solve → local terms of the gap → mark → bisect, on meshes that grow by a fixed factor, so that all solves together
//! cost little more than twice the last one. The indicators are the terms of the gap between the free upper bound and
//! the lower bound themselves (constitutive-relation error of each triangle, complementarity of each contact pair):
//! their sum is what the tolerance is set on. Both bounds hold on every mesh, so refinement decides how soon the
//! tolerance is reached and nothing else.

use std::time::Instant;

use super::admission::Admission;
use super::certified::{Certified, StudyError, balance, solve_balanced};
use super::forecast::Forecast;
use super::indicators::Indicators;
use super::outlook::outlook;
use super::warm_start::{carried, closed_coefficients};
use crate::compare::{Allowances, Basis, Check, Comparison};
use crate::dual::{DualMethod, Options, Size, contact_coefficients};
use crate::mesh::bisect::RefinementEdges;
use crate::problem::Problem;
use crate::report::HistoryRow;
use crate::statics::{Equilibrium, Statics};

/// Triangles of the next mesh per triangle of this one: the solves on meshes that grow by g cost g/(g − 1) times the
/// last one, if a solve costs in proportion to its triangles, and less where it costs more.
const GROWTH: f64 = 2.4;

/// The bound aimed at, relative to the tolerance: a mesh that misses it narrowly costs one more solve.
const AIM: f64 = 0.9;

/// How far growth and prediction may be off before a round is made smaller.
const SLACK: f64 = 0.1;

/// Least growth: a mesh with hardly more triangles than the last one costs as much and tells little more.
const WORTH_A_SOLVE: f64 = 1.1;

/// Part of the area of a triangle of the last mesh that its pieces have on the next one, at least: predictions hold no
/// farther.
const DEEPEST: f64 = 1e-6;

/// Triangles across less than this, relative to the farthest coordinate, are not refined: rounding of the corners would
/// show in them.
const SHORTEST: f64 = 1e-11;

/// Where triangles were too small all the same, the next try keeps them larger by this factor, up to `LONGEST`.
const COARSER: f64 = 30.0;
const LONGEST: f64 = 1e-5;

/// Bisections of the ends of contact before giving up on a load that presses on less than the last edges can express.
const MOST_AT_ENDS: usize = 60;

/// What an adaptive run is to reach, and where it stops at the latest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Largest guaranteed relative energy-norm error.
    pub tolerance: f64,
    /// No mesh has more triangles than this, unless the first one has. The memory that a mesh may take is the budget of
    /// [`Options`].
    pub max_triangles: Option<usize>,
    /// No refinement begins after so many seconds.
    pub max_seconds: Option<f64>,
    /// An upper bound of the exact energy that is known from elsewhere.
    pub known_upper: Option<f64>,
    /// Refinement ends where two meshes in line brought the error down by less than this power of the unknowns.
    pub least_rate: Option<f64>,
    /// Part of the gap that the triangles marked in one round carry (Dörfler's bulk parameter), in (0, 1].
    pub bulk: f64,
}

impl Goal {
    /// This tolerance without limits.
    pub fn new(tolerance: f64) -> Self {
        Goal { tolerance, max_triangles: None, max_seconds: None, known_upper: None, least_rate: None, bulk: 0.6 }
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
    let admission = Admission::new(method, options.budget);
    let refinement = RefinementEdges::longest(&problem.mesh);
    let mut stage = Stage::new(problem, refinement);
    let mut history: Vec<HistoryRow> = Vec::new();
    let mut forecast = Forecast::default();
    let mut before: Option<(Certified, HistoryRow, RefinementEdges)> = None;
    let mut shortest = SHORTEST;
    loop {
        let began = Instant::now();
        let solved = stage.solved(method, options, before.as_ref().map(|(c, _, _)| c));
        let (certified, row, refinement, fault) = match (solved, before.take()) {
            (Ok((certified, refinement)), _) => {
                let seconds = [start.elapsed().as_secs_f64(), began.elapsed().as_secs_f64()];
                let row = row(&certified, goal, seconds, history.last());
                on_step(&row);
                history.push(row);
                forecast.learn(&certified);
                (certified, row, refinement, None)
            }
            // What was reached is worth more than the reason why there is no more. Triangles that are less small may do.
            (Err(StudyError::Dual(reason)), Some((certified, row, refinement))) => {
                shortest *= COARSER;
                (certified, row, refinement, Some(format!("the next mesh could not be solved ({reason})")))
            }
            (Err(error), _) => return Err(error),
        };
        if certified.bracket.tells(row.upper, goal.tolerance) {
            return Ok(Adapted { certified, history, stopped: None });
        }
        let spent = start.elapsed().as_secs_f64();
        let finer = match (goal.max_seconds, fault) {
            (_, Some(fault)) if shortest > LONGEST => Err(fault),
            (Some(most), _) if spent >= most => Err(format!("{most} seconds have passed")),
            _ if stalls(&history, goal) => Err("it no longer makes the error smaller".to_string()),
            _ => refined(
                &certified,
                refinement.clone(),
                goal,
                &admission,
                shortest,
                row.relative_error_bound,
                &forecast,
            )?,
        };
        stage = match finer {
            Ok(finer) => finer,
            Err(reason) => {
                let pace = outlook(&history, goal, &admission, Size::of(&certified.problem));
                return Ok(Adapted { stopped: Some(stopped(&reason, &row, goal, pace)), certified, history });
            }
        };
        before = Some((certified, row, refinement));
    }
}

/// Whether the last two meshes were hardly worth their triangles.
fn stalls(history: &[HistoryRow], goal: &Goal) -> bool {
    let slow = |row: &HistoryRow| row.rate.zip(goal.least_rate).is_some_and(|(rate, least)| rate < least);
    history.len() > 2 && history[history.len() - 2..].iter().all(slow)
}

/// A mesh to solve on.
struct Stage {
    problem: Problem,
    refinement: RefinementEdges,
    /// For each triangle, the one of the mesh solved last that it lies in.
    parent: Vec<usize>,
}

impl Stage {
    fn new(problem: Problem, refinement: RefinementEdges) -> Self {
        Stage { parent: (0..problem.mesh.triangles.len()).collect(), problem, refinement }
    }

    /// With the marked triangles bisected, and the triangle of this stage that each one lies in.
    fn bisect(&self, marked: &[usize]) -> Result<(Stage, Vec<usize>), StudyError> {
        let (problem, refinement, within) = self.problem.bisect(&self.refinement, marked)?;
        let parent = within.iter().map(|&t| self.parent[t]).collect();
        Ok((Stage { problem, refinement, parent }, within))
    }

    /// Solves, on a mesh bisected at the ends of contact where the load asks for it, from what was found `before`.
    fn solved(
        self,
        method: &dyn DualMethod,
        options: &Options,
        before: Option<&Certified>,
    ) -> Result<(Certified, RefinementEdges), StudyError> {
        let (stage, statics) = self.expressible()?;
        let mut options = options.clone();
        let mut start = None;
        if let Some(Certified { problem, dual, bracket, .. }) = before {
            let counts = contact_coefficients(&stage.problem, &options.elements);
            options.closed = Some(closed_coefficients(problem, &dual.closed, &stage.problem, &counts));
            let free = bracket.free.as_ref().ok();
            start = free.map(|free| carried(problem, &free.displacement, &stage.problem, &stage.parent));
        }
        let certified = solve_balanced(stage.problem, statics, method, &options, start)?;
        Ok((certified, stage.refinement))
    }

    /// Bisects the ends of contact until the mesh can express the pressure that balances the loads.
    fn expressible(mut self) -> Result<(Stage, Statics), StudyError> {
        for _ in 0..MOST_AT_ENDS {
            let statics = balance(&self.problem)?;
            if !matches!(statics.equilibrium, Equilibrium::Possible { beyond_mesh: Some(_), .. }) {
                return Ok((self, statics));
            }
            self = self.bisect(&contact_ends(&self.problem))?.0;
        }
        let statics = balance(&self.problem)?;
        Ok((self, statics))
    }
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
    let relative_error_bound = bracket.relative_error(upper);
    let rate = before.map(|b| {
        (b.relative_error_bound / relative_error_bound).ln() / (dual.unknowns as f64 / b.unknowns as f64).ln()
    });
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

fn stopped(reason: &str, row: &HistoryRow, goal: &Goal, pace: Option<String>) -> String {
    let pace = pace.map_or(String::new(), |pace| format!(" Outlook: {pace}."));
    format!(
        "Refinement stopped before the tolerance of {} % was reached, because {reason}: the guaranteed relative \
         energy-norm error is {:.3} % with {} triangles.{pace}",
        100.0 * goal.tolerance,
        100.0 * row.relative_error_bound,
        row.triangles
    )
}

/// Whether the tolerance that was asked for is reached, with the best upper bound of the run.
pub fn tolerance_check(certified: &Certified, comparison: &Comparison, tolerance: f64, allow: &Allowances) -> Check {
    const NAME: &str = "bracket/tolerance";
    let allowed = allow.given(NAME).unwrap_or(tolerance);
    if let Some(note) = certified.problem.notes.iter().find(|note| note.weakens_guarantee) {
        let why = format!("The bounds are not guaranteed for the scene as it is written: {}.", note.text);
        return Check::not_made(NAME, allowed, Basis::Asked, why);
    }
    match comparison.upper(&certified.bracket) {
        Some((upper, _)) => Check::at_most(
            NAME,
            certified.bracket.relative_error(upper.upper()),
            0.0,
            allowed,
            Basis::Asked,
            "The guaranteed relative energy-norm error against the tolerance that was asked for.",
        ),
        None => Check::not_made(NAME, allowed, Basis::Asked, "There is no upper bound to hold the tolerance against."),
    }
}

/// The triangles at the first and last edge of every stretch of contact without a corner.
fn contact_ends(problem: &Problem) -> Vec<usize> {
    let mut marked = Vec::new();
    for interface in &problem.interfaces {
        let pairs = &interface.pairs;
        for (k, pair) in pairs.iter().enumerate() {
            let straight_on = |other: Option<usize>| {
                other.and_then(|o| pairs.get(o)).is_some_and(|o| {
                    [[0, 1], [1, 0]].into_iter().any(|[mine, its]| {
                        let (n, m) = (pair.direction.ends[mine], o.direction.ends[its]);
                        pair.first[mine] == o.first[its] && (n[0] - m[0]).hypot(n[1] - m[1]) < 1e-9
                    })
                })
            };
            if straight_on(k.checked_sub(1)) && straight_on(Some(k + 1)) {
                continue;
            }
            marked.extend(pair.edges.iter().flatten().filter_map(|&e| problem.mesh.edges[e].triangles[0]));
        }
    }
    marked.sort_unstable();
    marked.dedup();
    marked
}

/// The next mesh: rounds of Dörfler marking with predicted indicators, until the mesh has grown enough or the predicted
/// bound meets the tolerance; or the reason why there is none.
fn refined(
    certified: &Certified,
    refinement: RefinementEdges,
    goal: &Goal,
    admission: &Admission<'_>,
    shortest: f64,
    bound: f64,
    forecast: &Forecast,
) -> Result<Result<Stage, String>, StudyError> {
    let free = match &certified.bracket.free {
        Ok(free) => free,
        Err(reason) => return Ok(Err(format!("no upper bound could be built ({reason})"))),
    };
    let mut indicators = Indicators::new(&certified.problem, free);
    // The part of the gap that may stay: the bound is its root.
    let enough = indicators.total() * (AIM * goal.tolerance / bound).powi(2);
    let kept = Size::of(&certified.problem);
    let now = kept.triangles;
    let (worth, grown) = (WORTH_A_SOLVE * now, GROWTH * now);
    let mut stage = Stage::new(certified.problem.clone(), refinement);
    let smallest = smallest_area(&certified.problem, shortest);
    loop {
        let mut bulk = goal.bulk;
        let area = |t: usize| stage.problem.mesh.area(t);
        let may = |t: usize| area(t) > DEEPEST * certified.problem.mesh.area(stage.parent[t]) && area(t) > smallest;
        // The last round is tried with smaller parts, down to a sixteenth, while it would overshoot.
        let (next, predicted) = loop {
            let (next, within) = stage.bisect(&indicators.marked(bulk, may))?;
            let predicted = forecast.foresee(&indicators, &stage.problem.mesh, &next.problem.mesh, &within);
            let count = next.problem.mesh.triangles.len();
            let beyond = match goal.max_triangles {
                Some(most) if count > most => Some(format!("the next mesh would have more than {most} triangles")),
                _ => admission.admit(Size::of(&next.problem), Some(kept)).err().map(|excess| {
                    format!("the next mesh, of {count} triangles, would not fit into memory (about {excess})")
                }),
            };
            let too_many = beyond.is_some();
            let count = count as f64;
            let enough_already = predicted.total() < (1.0 - SLACK) * enough && count > (1.0 + SLACK) * worth;
            let too_far = count > (1.0 + SLACK) * grown || enough_already;
            bulk *= 0.5;
            if (too_many || too_far) && bulk > goal.bulk / 20.0 {
                continue;
            }
            let reason = match beyond {
                Some(reason) => reason,
                _ if count > stage.problem.mesh.triangles.len() as f64 => break (next, predicted),
                _ => "the triangles are as small as numbers can resolve".to_string(),
            };
            let reached = stage.problem.mesh.triangles.len() as f64;
            let useful = if too_many { reached >= worth } else { reached > now };
            return Ok(if useful { Ok(stage) } else { Err(reason) });
        };
        let count = next.problem.mesh.triangles.len() as f64;
        indicators = predicted;
        stage = next;
        if count >= (1.0 - SLACK) * grown || (count >= worth && indicators.total() <= enough) {
            return Ok(Ok(stage));
        }
    }
}

/// The area of triangles that are `shortest` across, relative to the farthest corner.
fn smallest_area(problem: &Problem, shortest: f64) -> f64 {
    let farthest = problem.mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    (shortest * farthest).powi(2)
}
