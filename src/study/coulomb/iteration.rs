//! The iteration τ̄ → μ |T_n(τ̄)| from one start, on one mesh, accelerated: the next bound is the combination of the last ones whose changes
//! cancel best (Anderson 1965).

use nalgebra::{DMatrix, DVector, SVD};

use super::End;
use super::bounds::{Bounds, apart};
use crate::dual::{DualMethod, Options};
use crate::problem::Problem;
use crate::study::certified::{StudyError, stresses};

/// Solutions before giving up.
const MOST: usize = 100;
/// Bounds that change by no more than this part have arrived …
const ARRIVED: f64 = 1e-10;
/// … and those that rounding keeps from it where they change by no more than this one.
const NEAR: f64 = 1e-7;
/// A step that leaves more than this part of the change before it is a slow one.
const SLOW: f64 = 0.9;
/// So many slow steps in a row are as near as rounding lets bounds come.
const PATIENCE: usize = 4;
/// A change so many times that before it says that the last bounds tell nothing of the next; the step is halved.
const GROWTH: f64 = 3.0;
/// Least part of a step.
const SHORTEST: f64 = 0.05;
/// Halvings of a step after which the bodies still lose their hold.
const RETREATS: usize = 6;

/// Bounds of which the next one is made.
const DEPTH: usize = 4;
/// Singular values below this part of the largest say nothing of a combination.
const RANK: f64 = 1e-10;

/// How the iteration ended.
pub struct Iteration {
    /// The bound that goes with its pressure.
    pub bounds: Option<Bounds>,
    /// The end.
    pub end: End,
    /// Why there is no equilibrium with the last bound, where there is none.
    pub refused: Option<StudyError>,
}

/// Runs it from `bounds`.
///
/// # Errors
/// A solver failed.
pub fn iterate(
    problem: &Problem,
    mut bounds: Bounds,
    method: &dyn DualMethod,
    options: &Options,
    told: &mut impl FnMut(&str),
) -> Result<Iteration, StudyError> {
    let options = &Options { keep_factor: false, ..options.clone() };
    let (mut step, mut slow, mut retreats) = (1.0_f64, 0, 0);
    let mut last: Option<(Bounds, f64)> = None;
    let mut history: Vec<(Bounds, Bounds)> = Vec::new();
    for count in 1..=MOST {
        let held = problem.with_friction_bounds(&bounds.0);
        let dual = match stresses(&held, method, options) {
            Err(refused @ (StudyError::NoEquilibrium { .. } | StudyError::BeyondMesh { .. })) => {
                if let Some((before, _)) = last.as_ref().filter(|_| retreats < RETREATS) {
                    retreats += 1;
                    bounds = before.towards(&bounds, 0.5);
                    continue;
                }
                let sentence = refused.to_string();
                return Ok(Iteration { bounds: None, end: End::NoEquilibrium(sentence), refused: Some(refused) });
            }
            other => other?,
        };
        let next = Bounds::of_pressure(&held, &dual);
        let change = apart(problem, &bounds, &next);
        told(&format!("friction bound {count}: changes by {change:.1e}"));
        let before = last.as_ref().map_or(f64::INFINITY, |(_, change)| *change);
        slow = if change > SLOW * before { slow + 1 } else { 0 };
        if change <= ARRIVED || slow >= PATIENCE && change <= NEAR {
            return Ok(Iteration { bounds: Some(next), end: End::Arrived(count), refused: None });
        }
        if change > GROWTH * before {
            history.clear();
            step = (0.5 * step).max(SHORTEST);
        } else if change < before {
            step = (2.0 * step).min(1.0);
        }
        if history.len() == DEPTH {
            history.remove(0);
        }
        history.push((bounds.clone(), next));
        let target = bounds.towards(&combined(&history), step);
        last = Some((std::mem::replace(&mut bounds, target), change));
    }
    let change = last.map_or(f64::INFINITY, |(_, change)| change);
    Ok(Iteration { bounds: None, end: End::Wanders(MOST, change), refused: None })
}

/// The next bound from the last ones and those that they led to, the newest behind; nowhere negative.
fn combined(history: &[(Bounds, Bounds)]) -> Bounds {
    let Some(((bounds, next), before)) = history.split_last() else { return Bounds(Vec::new()) };
    let values = |bounds: &Bounds| DVector::from_iterator(bounds.values().count(), bounds.values());
    let (led, change) = (values(next), values(next) - values(bounds));
    if before.is_empty() || change.is_empty() {
        return next.clone();
    }
    let columns = |of: &dyn Fn(&(Bounds, Bounds)) -> DVector<f64>| {
        DMatrix::from_columns(&before.iter().map(of).collect::<Vec<_>>())
    };
    let changes = columns(&|(bounds, next)| &change - (values(next) - values(bounds)));
    let steps = columns(&|(_, next)| &led - values(next));
    let largest = changes.amax();
    let shares = SVD::new(changes, true, true).solve(&change, RANK * largest);
    match shares {
        Ok(shares) => next.with_values((led - steps * shares).iter().map(|bound| bound.max(0.0))),
        Err(_) => next.clone(),
    }
}
