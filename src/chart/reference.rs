//! The tight bracket that true errors are measured against.

use super::data::{Reference, SceneChart};
use crate::measure::{Ended, Measured, Method};
use crate::study::Adapt;

/// Guaranteed relative error that the reference of a chart is refined to …
pub const REFERENCE_ADAPTIVE: f64 = 1e-4;
/// … and the refinements of the scene's own mesh on which FEniCSx may lower the upper bound further.
pub const REFERENCE_PRIMAL: usize = 1;

/// The bracket from runs that are all independent of each other: the largest lower and the smallest upper bound.
///
/// # Errors
/// The reason why there is no bracket.
pub fn from_runs(runs: &[(String, Ended)]) -> Result<Reference, String> {
    let mut lower: Option<(f64, f64, String)> = None;
    let mut upper: Option<(f64, String)> = None;
    let mut reasons = Vec::new();
    for (what, ended) in runs {
        match ended {
            Ended::Told(results) => {
                for Measured { method, end, answer, .. } in results {
                    let Some(answer) = answer else {
                        reasons.push(format!("{what} ({method}): {}", end.words()));
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

impl SceneChart {
    /// Narrows the reference by the bounds of all runs that have both, and measures every error against it anew: no run may
    /// know more than what it is measured against.
    pub(super) fn sharpen(&mut self) {
        let Ok(reference) = &mut self.reference else { return };
        let bounds = self.runs.iter().filter_map(|run| {
            let plot = run.plot.as_ref()?;
            Some((run, plot.lower?, plot.upper?))
        });
        let mut by = Vec::new();
        for (run, lower, upper) in bounds {
            let [low, high] = [reference.lower.max(lower), reference.upper.min(upper)];
            if low <= high && [low, high] != [reference.lower, reference.upper] {
                [reference.lower, reference.upper] = [low, high];
                by.push(format!("{} at level {}", run.name(), run.level));
            }
        }
        if !by.is_empty() {
            reference.how = format!("{}; narrowed by {}", reference.how, by.join(", "));
        }
        let reference = &*reference;
        for plot in self.runs.iter_mut().filter_map(|run| run.plot.as_mut()) {
            plot.true_error = plot.lower.or(plot.upper).map(|energy| reference.error(energy));
        }
    }
}

/// Names of the methods that a reference is made of.
pub(super) const OF: [Method; 2] = [Method::Adaptive(Adapt::Hp), Method::Displacements(2)];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Plot, Run, Spread, Status};

    #[test]
    fn no_run_knows_more_than_what_it_is_measured_against() {
        let spread = Spread { least: 1.0, median: 1.0, most: 1.0 };
        let run = |method, lower: Option<f64>, upper| Run {
            method,
            solver: None,
            level: 2,
            tolerance: None,
            status: Status::Done,
            plot: Some(Plot {
                triangles: 1,
                unknowns: 1,
                whole: spread,
                solve: spread,
                phases: Vec::new(),
                peak_memory: None,
                lower,
                upper: Some(upper),
                guaranteed: None,
                true_error: Some(0.5),
                quantities: Vec::new(),
            }),
        };
        let mut scene = SceneChart {
            name: "s".into(),
            title: "s".into(),
            sha256: String::new(),
            reference: Ok(Reference { lower: -1.02, upper: -0.98, strain: 1.0, how: "first".into() }),
            cold: Vec::new(),
            // A displacement may lie below the exact energy where it is not admissible.
            runs: vec![run(Method::CONDENSED, Some(-1.0001), -0.9999), run(Method::Displacements(2), None, -1.01)],
        };
        scene.sharpen();
        let reference = scene.reference.as_ref().expect("a bracket");
        assert_eq!([reference.lower, reference.upper], [-1.0001, -0.9999]);
        assert!(reference.how.contains("narrowed by condensed at level 2"), "{}", reference.how);
        // Anywhere in the bracket: nothing but the distance from its ends is sure.
        let [least, most] = reference.errors(-1.0101);
        assert!((least - 0.1).abs() < 1e-9 && (most - 0.0102_f64.sqrt()).abs() < 1e-9);
        assert_eq!(reference.errors(-1.0)[0], 0.0);
        let errors: Vec<f64> = scene.runs.iter().filter_map(|run| run.plot.as_ref()?.true_error).collect();
        assert!((errors[0] - 0.01).abs() < 1e-9 && (errors[1] - 0.1).abs() < 1e-9, "{errors:?}");
    }
}
