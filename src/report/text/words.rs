//! The words shared by the page, the summary and the JUnit file.

use super::number::{significant, vector};
use crate::compare::name::OfField;
use crate::compare::{Basis, Check, MeanPressure};
use crate::report::{GuaranteeLevel, Report, Status};

/// The verdict as one word.
pub(crate) fn status_word(status: Status) -> &'static str {
    match status {
        Status::Agree => "agree",
        Status::Disagree => "disagree",
        Status::Undecided => "undecided",
        Status::Infeasible => "infeasible",
        Status::Failed => "failed",
    }
}

/// The verdict for a heading. Where there is no second model nothing can agree: then the checks of the one passed.
pub(crate) fn headline(report: &Report) -> &'static str {
    match report.status {
        Status::Agree if report.primal.is_empty() => "passed",
        Status::Agree if report.checks.iter().any(|check| check.excused) => "agree, with allowances",
        status => status_word(status),
    }
}

/// A symbol that tells the verdicts apart without colour.
pub(crate) fn status_symbol(status: Status) -> &'static str {
    match status {
        Status::Agree => "✔",
        Status::Disagree => "✘",
        Status::Undecided => "?",
        Status::Infeasible => "∅",
        Status::Failed => "⚠",
    }
}

/// A mean pressure with what it is worth.
pub(crate) fn mean_in_words(mean: &MeanPressure, is_guaranteed: bool) -> String {
    let worth = match (mean.half_width, is_guaranteed) {
        (Some(half), true) => format!(" ± {}, guaranteed", significant(half, 2)),
        (Some(half), false) => format!(" ± {}, for the data as represented on the mesh", significant(half, 2)),
        (None, _) => " without a bound".to_string(),
    };
    let (value, radius) = (significant(mean.value, 4), significant(mean.radius, 3));
    format!(
        "pressure {value}{worth}, in the mean around {}, with a weight that falls to zero at {radius} from there",
        vector(mean.at, 4)
    )
}

/// Where an allowed value comes from, in one or two words.
pub(crate) fn basis_word(basis: Basis) -> &'static str {
    match basis {
        Basis::Guaranteed => "guaranteed",
        Basis::RoundOff => "round-off",
        Basis::Claimed => "claimed",
        Basis::Chosen => "chosen",
        Basis::Asked => "asked for",
    }
}

/// Explains the failure of a check.
pub(crate) fn meaning(check: &Check) -> &'static str {
    match (check.difference, check.basis) {
        (None, _) => "Not made: what has not been compared counts as not passed.",
        (_, Basis::Guaranteed) => {
            "Guaranteed: the allowed value follows from the bound: no correct pair of solutions of this scene can differ by \
             more. At least one of the two models is wrong, or they do not solve the same scene."
        }
        (_, Basis::RoundOff) => {
            "Round-off: the two numbers are equal in exact arithmetic, and differ here by more than rounding explains. \
             One of them was computed or transferred wrongly."
        }
        (_, Basis::Claimed) => {
            "Claimed: the field is not the solution it claims to be. The bound is not affected: it belongs to the nearest \
             admissible field; --allow NAME=VALUE takes a larger difference for none."
        }
        (_, Basis::Chosen) => {
            "Chosen: theory sets no limit here, and this is no part of the verdict. The models differ more than is usual: \
             look at the pictures, or refine the mesh."
        }
        (_, Basis::Asked) => {
            "Asked for: the tolerance comes from the command line or from a stored result, and was not met."
        }
    }
}

/// The checks that did not pass, in the order of the report.
pub(crate) fn failing(report: &Report) -> Vec<&Check> {
    report.checks.iter().filter(|check| !check.passed).collect()
}

/// The remarks that are worth a look, in the order of the report.
pub(crate) fn worth_a_look(report: &Report) -> Vec<&Check> {
    report.remarks.iter().filter(|remark| !remark.passed).collect()
}

/// The energies of the report by name: the lower bound, the free upper bound, then the displacement solutions.
pub(crate) fn energies(report: &Report) -> Vec<(String, f64)> {
    let mut list = Vec::new();
    if let Some(energy) = &report.energy {
        list.push(("lower bound (stresses)".to_string(), energy.lower));
        if let Some(free) = energy.free_upper {
            list.push(("free upper bound".to_string(), free));
        }
    }
    for primal in &report.primal {
        let recomputed = OfField::Recomputed.of(&primal.name);
        let reported = report.checks.iter().any(|check| check.name == recomputed && !check.passed);
        let suffix = match (primal.admissible, reported) {
            (_, true) => " (as reported)",
            (true, _) if primal.is_of_quadrature() => " (its quadrature)",
            (true, _) => "",
            (false, _) => " (not admissible)",
        };
        list.push((format!("{}{suffix}", primal.name), primal.energy));
    }
    list
}

/// Where the upper bound comes from, for a reader who does not know the word `free`.
pub(crate) fn upper_from(name: &str) -> String {
    if name == "free" { "built from the dual solve".to_string() } else { super::number::clean(name) }
}

/// Accuracy of the stresses that follows from the bracket, in one sentence.
pub(crate) fn accuracy(report: &Report) -> String {
    use super::number::at_most_percent;
    match &report.energy {
        Some(energy) if energy.relative_error_bound.is_finite() => {
            let bound = at_most_percent(energy.relative_error_bound);
            let differs =
                format!("The exact stress differs from the computed one by at most {bound} in the energy norm");
            if energy.guarantee.level == GuaranteeLevel::Proved {
                format!("{differs}. This is {}, not estimated.", energy.guarantee.words)
            } else if energy.guaranteed {
                format!("{differs}. This is guaranteed, not estimated.")
            } else {
                format!("{differs}, for the data as represented on the mesh; the notes say what weakens the guarantee.")
            }
        }
        _ => "No two-sided bound was obtained, so nothing can be said about the distance from the exact solution."
            .to_string(),
    }
}
