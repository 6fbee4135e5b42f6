//! Refinement of the stress side alone, until its bracket can tell two models apart.
//!
//! A displacement of the mesh that was given is one of every finer mesh, with the same energy: bounds from a finer mesh
//! hold for it as they stand, and nothing has to be solved twice on the displacement side. Where edges stand for curves,
//! they are divided and stay where they are.

use super::{Goal, adapt};
use crate::compare::Comparison;
use crate::dual::{DualMethod, Options};
use crate::problem::{Problem, Refinement};
use crate::report::HistoryRow;
use crate::study::certified::{Certified, StudyError};

/// Seconds that refinement for the sake of the verdict may take where nobody sets a limit.
const PATIENCE: f64 = 30.0;

/// Below this rate refinement has met what numbers resolve: at the strongest singularities errors fall like the
/// unknowns to a few hundredths.
const STALLED: f64 = 0.01;

/// A sharper bracket of the same scene.
#[derive(Debug, Clone)]
pub struct Sharpened {
    /// On the last mesh.
    pub certified: Certified,
    /// Mesh by mesh.
    pub history: Vec<HistoryRow>,
    /// Why refinement stopped before the bracket was sharp.
    pub stopped: Option<String>,
}

/// Refines the mesh of `certified` until the guaranteed relative error is at most `goal.tolerance`, within its
/// limits; `None` where the bracket is sharp already.
///
/// # Errors
/// [`StudyError`], where the first mesh could not be solved again.
pub fn sharpen(
    certified: &Certified,
    comparison: &Comparison,
    method: &dyn DualMethod,
    options: &Options,
    goal: Goal,
    on_step: impl FnMut(&HistoryRow),
) -> Result<Option<Sharpened>, StudyError> {
    let upper = comparison.upper(&certified.bracket).map_or(f64::INFINITY, |(upper, _)| upper.upper());
    if goal.wanted.is_empty() && certified.bracket.tells(upper, goal.tolerance) {
        return Ok(None);
    }
    let bounding = comparison.judged.iter().filter(|j| j.candidate.is_polynomial());
    let known_upper = bounding.map(|j| j.admissible.upper()).reduce(f64::min);
    let goal =
        Goal { known_upper, max_seconds: goal.max_seconds.or(Some(PATIENCE)), least_rate: Some(STALLED), ..goal };
    let problem = Problem { refinement: Refinement::KeepsEdges, ..certified.problem.clone() };
    let adapted = adapt(problem, method, options, &goal, on_step)?;
    Ok(Some(Sharpened { certified: adapted.certified, history: adapted.history, stopped: adapted.stopped }))
}
