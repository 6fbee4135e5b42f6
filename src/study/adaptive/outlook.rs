//! Outlook of an adaptive run at its present pace, so that nobody waits for a tolerance that will not be reached.

use super::Goal;
use super::admission::Admission;
use crate::budget::words;
use crate::dual::Size;
use crate::report::HistoryRow;
use crate::report::text::number::{at_most_percent, percent};

/// Meshes back from which the pace is taken.
const BACK: usize = 3;

/// Triangles below which the pace tells nothing yet.
const EARLY: usize = 500;

/// The power of the unknowns by which the error has to fall at least. Adapted meshes reach one for linear stresses, and
/// meet the strongest singularities with a fraction of it.
const STALLED: f64 = 0.2;

/// The error stands still if so many times as many unknowns make it fall like a lesser power of them than this.
const GROWN: f64 = 10.0;
const STANDS: f64 = 0.01;

/// A sentence where the error has stalled, or where the tolerance asks at the present pace for a mesh beyond the limits
/// of triangles and memory; `size` is that of the last mesh, and goes on growing as its triangles do.
pub fn outlook(history: &[HistoryRow], goal: &Goal, admission: &Admission<'_>, size: Size) -> Option<String> {
    let now = history.last()?;
    let before = history.get(history.len().checked_sub(BACK + 1)?)?;
    let tolerance = percent(goal.tolerance);
    if now.relative_error_bound <= goal.tolerance || now.triangles < EARLY {
        return None;
    }
    let pace = rate(before, now.relative_error_bound, now.unknowns);
    if pace < STALLED {
        return Some(format!(
            "the error stalls: {} on {} triangles, {} on {}, where {tolerance} was asked for",
            at_most_percent(before.relative_error_bound),
            before.triangles,
            at_most_percent(now.relative_error_bound),
            now.triangles
        ));
    }
    let growth = (now.relative_error_bound / goal.tolerance).powf(1.0 / pace);
    let wanted = now.triangles as f64 * growth;
    let why = match (goal.max_triangles, admission.admit(size.grown(size.triangles * growth), Some(size))) {
        (Some(most), _) if wanted > most as f64 => format!("{most} are allowed"),
        (_, Err(excess)) => format!("{}, where {} may be used", words(excess.needed), words(excess.allowed)),
        _ => return None,
    };
    Some(format!("at the present pace {tolerance} takes about {} triangles ({why})", rounded(wanted)))
}

/// True if the last two meshes were hardly worth their triangles, or if the last ten times as many unknowns changed next to nothing.
pub fn stalls(history: &[HistoryRow], goal: &Goal) -> bool {
    let slow = |row: &HistoryRow| row.rate.zip(goal.least_rate).is_some_and(|(rate, least)| rate < least);
    // Refinement towards quantities may leave the energy as it is.
    history.len() > 2 && history[history.len() - 2..].iter().all(slow)
        || goal.wanted.is_empty() && stands_still(history)
}

/// True if the error falls over the last ten times as many unknowns by less than a power of them that halves it within 10³⁰. A feature that
/// is far smaller than its triangles may leave the error as it is for many meshes, but takes few triangles on each.
fn stands_still(history: &[HistoryRow]) -> bool {
    let Some(now) = history.last() else { return false };
    let before =
        history.iter().rfind(|row| row.triangles >= EARLY && row.unknowns as f64 * GROWN <= now.unknowns as f64);
    before.is_some_and(|before| rate(before, now.relative_error_bound, now.unknowns) < STANDS)
}

/// The power of the unknowns by which the error has fallen since `before`.
pub fn rate(before: &HistoryRow, relative_error_bound: f64, unknowns: usize) -> f64 {
    (before.relative_error_bound / relative_error_bound).ln() / (unknowns as f64 / before.unknowns as f64).ln()
}

/// To two digits.
fn rounded(count: f64) -> String {
    let unit = 10.0_f64.powi((count.log10().floor() as i32 - 1).max(0));
    let count = (count / unit).round() * unit;
    if count < 1e9 { format!("{count:.0}") } else { format!("{count:.0e}") }
}

#[cfg(test)]
mod tests {
    use super::super::Wanted;
    use super::*;
    use crate::budget::Budget;
    use crate::dual::Condensed;

    /// Meshes of 1000, 2000, … triangles on which the error falls like that power of their number, from one per cent.
    fn falling(power: f64, meshes: i32) -> Vec<HistoryRow> {
        (0..meshes)
            .map(|k| {
                let triangles = 1000.0 * 2.0_f64.powi(k);
                HistoryRow {
                    triangles: triangles as usize,
                    unknowns: 6 * triangles as usize,
                    lower: 0.0,
                    upper: 0.0,
                    relative_error_bound: 0.01 * (triangles / 1000.0).powf(-power),
                    seconds: 0.0,
                    step_seconds: 0.0,
                    rate: None,
                }
            })
            .collect()
    }

    fn said(history: &[HistoryRow], goal: &Goal, budget: Budget) -> Option<String> {
        let method = Condensed::default();
        let triangles = history.last().expect("a mesh").triangles as f64;
        let size = Size { triangles, distinct: triangles, contact_ends: 100.0 };
        outlook(history, goal, &Admission::new(&method, budget), size)
    }

    #[test]
    fn an_error_that_hardly_falls_has_stalled() {
        let text = said(&falling(0.1, 5), &Goal::new(1e-3), Budget::UNLIMITED).expect("it has stalled");
        assert!(text.starts_with("the error stalls: 0.934 % on 2000 triangles, 0.758 % on 16000"), "{text}");
    }

    #[test]
    fn an_error_that_ten_times_the_unknowns_leave_as_it_is_stands_still() {
        let goal = Goal::new(1e-3);
        assert!(stalls(&falling(0.005, 5), &goal));
        assert!(!stalls(&falling(0.005, 4), &goal), "eight times the unknowns");
        assert!(!stalls(&falling(0.05, 9), &goal), "slow, but it falls");
        let wanted = vec![Wanted { name: "tip".to_string(), tolerance: 0.01 }];
        assert!(!stalls(&falling(0.005, 5), &Goal { wanted, ..goal.clone() }), "towards a quantity");
        // Few triangles a mesh, towards a feature far below the size of any of them.
        let mut local = falling(0.0, 40);
        for (k, row) in local.iter_mut().enumerate() {
            row.unknowns = 6000 + 100 * k;
        }
        assert!(!stalls(&local, &goal));
    }

    #[test]
    fn a_tolerance_in_reach_needs_no_words() {
        assert_eq!(said(&falling(0.5, 5), &Goal::new(1e-3), Budget::UNLIMITED), None);
        assert_eq!(said(&falling(0.1, 5), &Goal::new(0.05), Budget::UNLIMITED), None, "reached");
        assert_eq!(said(&falling(0.1, 3), &Goal::new(1e-3), Budget::UNLIMITED), None, "too early to tell");
    }

    #[test]
    fn the_mesh_that_a_tolerance_asks_for_is_held_against_the_limits() {
        // A tenth of the first error at the power one half: a hundred times the triangles.
        let goal = Goal::new(1e-3);
        let text = said(&falling(0.5, 5), &goal, Budget::of(500_000_000)).expect("memory for a fraction of it");
        assert!(text.starts_with("at the present pace 0.1 % takes about 100000 triangles ("), "{text}");
        assert!(text.ends_with("where 500 MB may be used)"), "{text}");
        let goal = Goal { max_triangles: Some(50_000), ..goal };
        let text = said(&falling(0.5, 5), &goal, Budget::UNLIMITED).expect("more than is allowed");
        assert!(text.ends_with("(50000 are allowed)"), "{text}");
    }
}
