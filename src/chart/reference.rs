//! The tight bracket that true errors are measured against.

use super::data::Reference;
use crate::measure::{Ended, Measured, Method};

/// Guaranteed relative error that the reference of a chart is refined to …
pub const REFERENCE_ADAPTIVE: f64 = 5e-4;
/// … and the refinements of the scene's own mesh on which FEniCSx may lower the upper bound further.
pub const REFERENCE_PRIMAL: usize = 1;

/// The bracket from runs that are all independent of each other: the largest lower and the smallest upper bound.
///
/// # Errors
/// Why there is none.
pub fn from_runs(runs: &[(String, Ended)]) -> Result<Reference, String> {
    let mut lower: Option<(f64, f64, String)> = None;
    let mut upper: Option<(f64, String)> = None;
    let mut reasons = Vec::new();
    for (what, ended) in runs {
        match ended {
            Ended::Told(results) => {
                for Measured { method, end, answer, .. } in results {
                    let Some(answer) = answer else {
                        reasons.push(format!("{what} ({method}): {}", super::campaign::words(end)));
                        continue;
                    };
                    let name = format!("{method}, {what}, {} triangles", answer.triangles);
                    if let (Some(value), Some(strain)) = (answer.lower, answer.strain)
                        && lower.as_ref().is_none_or(|l| value > l.0)
                    {
                        lower = Some((value, strain, name.clone()));
                    }
                    let admissible = answer.violation.is_none_or(|v| v <= crate::compare::ADMISSIBLE);
                    if let Some(value) = answer.upper.filter(|_| admissible)
                        && upper.as_ref().is_none_or(|u| value < u.0)
                    {
                        upper = Some((value, name));
                    }
                }
            }
            Ended::Crashed(text) => reasons.push(format!("{what}: {text}")),
            Ended::OverBudget => reasons.push(format!("{what}: over the budget")),
        }
    }
    match (lower, upper) {
        (Some((low, strain, below)), Some((up, above))) if low <= up && strain > 0.0 => Ok(Reference {
            lower: low,
            upper: up,
            strain,
            how: if below == above { below } else { format!("below: {below}; above: {above}") },
        }),
        (Some((low, _, below)), Some((up, above))) if low > up => {
            Err(format!("the bounds exclude each other: {low} ({below}) is above {up} ({above})"))
        }
        _ if reasons.is_empty() => Err("no run gave both bounds".to_string()),
        _ => Err(reasons.join("; ")),
    }
}

/// Names of the methods that a reference is made of.
pub(super) const OF: [Method; 2] = [Method::Adaptive, Method::FenicsP2];
