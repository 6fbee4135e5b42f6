//! The next mesh: rounds of Dörfler marking with predicted terms of the gap, until the mesh has grown enough or the
//! predicted bound meets the tolerance.

use super::adaptive::Goal;
use super::admission::Admission;
use super::certified::StudyError;
use super::forecast::Forecast;
use super::indicators::Indicators;
use super::stage::Stage;
use crate::dual::Size;
use crate::mesh::bisect::RefinementEdges;
use crate::problem::Problem;

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

/// From a mesh that was solved to the next one.
pub struct Rounds<'a> {
    goal: &'a Goal,
    admission: &'a Admission<'a>,
    forecast: &'a Forecast,
    /// On the mesh that was solved.
    problem: &'a Problem,
    /// No triangle of less area is refined.
    smallest: f64,
}

/// What a round came to.
enum Round {
    /// A finer mesh, and the terms of the gap to expect on it.
    Finer(Box<Stage>, Indicators),
    /// No finer mesh: why, and the factor by which triangles must have grown for the rounds so far to be of use.
    Last(String, f64),
}

impl<'a> Rounds<'a> {
    /// From the mesh of `problem`; triangles `shortest` across, relative to the farthest corner, are not refined.
    pub fn new(
        goal: &'a Goal,
        admission: &'a Admission<'a>,
        forecast: &'a Forecast,
        problem: &'a Problem,
        shortest: f64,
    ) -> Self {
        Rounds { goal, admission, forecast, problem, smallest: smallest_area(problem, shortest) }
    }

    /// The next mesh, or the reason why there is none; `terms` are those of the gap that makes the guaranteed error
    /// `bound`.
    ///
    /// # Errors
    /// [`StudyError::Mesh`].
    pub fn next(
        &self,
        refinement: RefinementEdges,
        terms: &Indicators,
        bound: f64,
    ) -> Result<Result<Stage, String>, StudyError> {
        // The part of the gap that may stay: the bound is its root.
        let enough = terms.total() * (AIM * self.goal.tolerance / bound).powi(2);
        let solved = triangles(self.problem);
        let mut stage = Stage::new(self.problem.clone(), refinement);
        let mut terms = terms.clone();
        loop {
            match self.round(&stage, &terms, enough)? {
                Round::Finer(next, predicted) => (stage, terms) = (*next, predicted),
                Round::Last(reason, worth) => {
                    let useful = triangles(&stage.problem) >= worth * solved && triangles(&stage.problem) > solved;
                    return Ok(if useful { Ok(stage) } else { Err(reason) });
                }
            }
            let count = triangles(&stage.problem);
            if count >= (1.0 - SLACK) * GROWTH * solved || (count >= WORTH_A_SOLVE * solved && terms.total() <= enough)
            {
                return Ok(Ok(stage));
            }
        }
    }

    /// One round of marking. The last one is tried with smaller parts of the gap, down to a sixteenth, while it would
    /// overshoot.
    fn round(&self, stage: &Stage, terms: &Indicators, enough: f64) -> Result<Round, StudyError> {
        let area = |t: usize| stage.problem.mesh.area(t);
        let may = |t: usize| area(t) > DEEPEST * self.problem.mesh.area(stage.parent[t]) && area(t) > self.smallest;
        let solved = triangles(self.problem);
        let mut bulk = self.goal.bulk;
        loop {
            let (next, within) = stage.bisect(&terms.marked(bulk, may))?;
            let predicted = self.forecast.foresee(terms, &stage.problem.mesh, &next.problem.mesh, &within);
            let count = triangles(&next.problem);
            let beyond = self.beyond(&next.problem);
            let enough_already =
                predicted.total() < (1.0 - SLACK) * enough && count > (1.0 + SLACK) * WORTH_A_SOLVE * solved;
            let too_far = count > (1.0 + SLACK) * GROWTH * solved || enough_already;
            bulk *= 0.5;
            if (beyond.is_some() || too_far) && bulk > self.goal.bulk / 20.0 {
                continue;
            }
            return Ok(match beyond {
                Some(reason) => Round::Last(reason, WORTH_A_SOLVE),
                None if count > triangles(&stage.problem) => Round::Finer(Box::new(next), predicted),
                None => Round::Last("the triangles are as small as numbers can resolve".to_string(), 1.0),
            });
        }
    }

    /// Why `next` is more than may be solved.
    fn beyond(&self, next: &Problem) -> Option<String> {
        let count = next.mesh.triangles.len();
        match self.goal.max_triangles {
            Some(most) if count > most => Some(format!("the next mesh would have more than {most} triangles")),
            _ => self.admission.admit(Size::of(next), Some(Size::of(self.problem))).err().map(|excess| {
                format!("the next mesh, of {count} triangles, would not fit into memory (about {excess})")
            }),
        }
    }
}

fn triangles(problem: &Problem) -> f64 {
    problem.mesh.triangles.len() as f64
}

/// The area of triangles that are `shortest` across, relative to the farthest corner.
fn smallest_area(problem: &Problem, shortest: f64) -> f64 {
    let farthest = problem.mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    (shortest * farthest).powi(2)
}
