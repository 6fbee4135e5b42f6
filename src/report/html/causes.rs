//! Why checks did not pass, before they are listed.

use maud::{Markup, html};

use super::links;
use crate::cause::{outcome, told};
use crate::report::text::number::{clean, optional, percent, significant};
use crate::report::text::words::{basis_word, failing, meaning};
use crate::report::{Cause, Check, Report};

/// One entry for each cause, with the checks behind it folded.
pub(super) fn causes(report: &Report) -> Markup {
    let failing = failing(report);
    let rest: Vec<&Check> =
        failing.iter().copied().filter(|check| !report.causes.iter().any(|c| c.checks.contains(&check.name))).collect();
    html! {
        @if !failing.is_empty() {
            section.failures aria-label="why checks did not pass" {
                h2 { "✘ " (failing.len()) " of " (report.checks.len()) " checks did not pass" @if report.causes.len() > 1 {
                    ", for " (report.causes.len()) " reasons" } }
                ol {
                    @for (i, cause) in report.causes.iter().enumerate() { (one(report, i + 1, cause)) }
                    @for check in rest { li { (fact(report, check)) } }
                }
            }
        }
        @for diagnosis in &report.diagnosis {
            details.diagnosis open[failing.is_empty()] {
                summary { "What was found in " (clean(&diagnosis.field)) }
                p { (clean(&diagnosis.sentence)) }
                @if let Some(explained) = diagnosis.explained.filter(|_| !diagnosis.findings.is_empty()) {
                    p {
                        "Together this explains " b { (percent(explained)) } " of the squared residual; "
                        (diagnosis.tried) " hypotheses were held against it."
                    }
                }
            }
        }
    }
}

fn one(report: &Report, number: usize, cause: &Cause) -> Markup {
    let own: Vec<&Check> = report.checks.iter().filter(|check| cause.checks.contains(&check.name)).collect();
    html! {
        li id={ "cause-" (number) } {
            @if number > 1 || super::verdict::leading(report).is_none() { p.cause { b { (clean(&cause.sentence)) } } }
            p { (clean(&cause.suggests)) }
            p { b { "Try: " } (clean(&cause.remedy)) }
            @if cause.place.is_some() {
                p { "It is marked " b.not { (number) } " in the " a href="#pictures" { "pictures" } "." }
            }
            details {
                summary { (own.len()) @if own.len() == 1 { " check" } @else { " checks" } " behind it" }
                @for check in own { (fact(report, check)) }
            }
        }
    }
}

/// Outcome of a check, with its numbers.
fn fact(report: &Report, check: &Check) -> Markup {
    html! {
        div.fact {
            a.name href={ "#" (links::row(report, check)) } { (clean(&check.name)) } " " span.not { (outcome(check)) }
            @if let Some(difference) = check.difference {
                div.facts {
                    span { "found " b { (optional(check.value, 9)) } }
                    span { "held against " b { (optional(check.reference, 9)) } }
                    span { "difference " b { (significant(difference, 4)) } }
                    span { "allowed " b { (significant(check.allowed, 4)) } " (" (basis_word(check.basis)) ")" }
                }
            }
            div { (clean(&told(check))) }
            div.dim { (meaning(check)) }
        }
    }
}
