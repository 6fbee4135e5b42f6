//! All checks: the failing ones in full, the others folded.

use maud::{Markup, html};

use super::links;
use super::tables::scroll;
use crate::cause::{outcome, told};
use crate::report::text::number::{clean, optional};
use crate::report::text::words::basis_word;
use crate::report::{Check, Report};

pub(super) fn checks(report: &Report) -> Markup {
    let (passed, failed): (Vec<&Check>, Vec<&Check>) = report.checks.iter().partition(|check| check.passed);
    let word = |check: &Check| {
        html! {
            @if check.passed { span.yes { "✔ yes" } } @else { span.not { "✘ " (outcome(check)) } }
        }
    };
    html! {
        @if report.checks.is_empty() { p { "No check was made." } } @else {
            p { "Margin: how far the difference is from what is allowed. A check that could not be made does not count as passed." }
            @if !failed.is_empty() { (table(report, "checks that did not pass", "passed", &failed, word)) }
            @if !passed.is_empty() {
                details.passing {
                    summary { (passed.len()) @if passed.len() == 1 { " check" } @else { " checks" } " passed" }
                    (table(report, "checks that passed", "passed", &passed, word))
                }
            }
        }
    }
}

/// Comparisons with tolerances that theory does not set.
pub(super) fn remarks(report: &Report) -> Markup {
    let mut all: Vec<&Check> = report.remarks.iter().collect();
    all.sort_by_key(|remark| remark.passed);
    html! {
        p {
            "Theory sets no limit to these differences. What exceeds the usual size is worth a look and does not change the verdict; "
            code { "--allow NAME=VALUE" } " makes a check of a remark."
        }
        (table(report, "remarks", "usual", &all, |remark| html! {
            @if remark.passed { "yes" } @else { b { "worth a look" } }
        }))
    }
}

fn table(report: &Report, label: &str, passed: &str, list: &[&Check], word: impl Fn(&Check) -> Markup) -> Markup {
    let heads = ["value", "held against", "difference", "allowed", "margin"];
    scroll(
        label,
        html! {
            table.sortable {
                thead { tr {
                    th { "name" } th { (passed) } @for head in heads { th.n { (head) } } th { "basis" } th { "result" }
                } }
                tbody { @for check in list {
                    tr.no[!check.passed && check.decides()] id=(links::row(report, check)) {
                        td.long {
                            code { (clean(&check.name)) }
                            @if let Some(picture) = links::picture(report, check) {
                                " " a href={ "#" (picture) } aria-label={ "picture of " (clean(&check.name)) } { "picture" }
                            }
                        }
                        td { (word(check)) }
                        @let numbers = [(check.value, 8), (check.reference, 8), (check.difference, 3), (Some(check.allowed), 3), (check.margin, 3)];
                        @for (number, digits) in numbers {
                            td.n data-value=[number.map(|x| format!("{x:e}"))] { (optional(number, digits)) }
                        }
                        td { (basis_word(check.basis)) }
                        td.why {
                            (clean(&told(check)))
                            @if !check.passed { span.asks { " What it asks: " (clean(&check.why)) } }
                        }
                    }
                } }
            }
        },
    )
}
