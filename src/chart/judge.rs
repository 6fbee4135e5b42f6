//! From repeated runs to the numbers of a chart.

use super::data::{Plot, Reference, Spread};
use crate::measure::{End, Measured};

/// Puts repeated runs of one kind together; `Err` is the reason why there are no numbers.
///
/// # Errors
/// The text of the first run that had no answer.
pub fn judge(repeats: &[Measured], reference: Option<&Reference>) -> Result<Plot, String> {
    for run in repeats {
        match &run.end {
            End::Solved => {}
            End::NoEquilibrium(reason)
            | End::Refused(reason)
            | End::NotConverged(reason)
            | End::NotApplicable(reason)
            | End::Crashed(reason) => return Err(reason.clone()),
        }
    }
    let all = |value: fn(&Measured) -> f64| Spread::of(&repeats.iter().map(value).collect::<Vec<_>>());
    let (Some(whole), Some(solve)) = (all(|r| r.seconds.whole), all(|r| r.seconds.solve)) else {
        return Err("no run was made".to_string());
    };
    let median = repeats.iter().find(|r| r.seconds.whole == whole.median);
    let Some((run, answer)) = median.and_then(|run| Some((run, run.answer.as_ref()?))) else {
        return Err("a run ended without an answer and without a reason".to_string());
    };
    // The lower bound is what the stress is worth; a displacement has only its upper bound.
    let energy = answer.lower.or(answer.upper);
    Ok(Plot {
        triangles: answer.triangles,
        unknowns: answer.unknowns,
        whole,
        solve,
        phases: run.seconds.phases.clone(),
        peak_memory: repeats.iter().filter_map(|r| r.peak_memory).max(),
        lower: answer.lower,
        upper: answer.upper,
        guaranteed: answer.relative_error_bound,
        true_error: reference.zip(energy).map(|(reference, energy)| reference.error(energy)),
        quantities: answer.quantities.clone(),
    })
}
