//! Two reports on one page.

use maud::{Markup, html};

use super::compare::{CheckChange, Difference, Kind, NumberChange, word};
use super::text::{difference, pair, verdict};
use crate::compare::Check;
use crate::report::CSS;
use crate::report::document::document;
use crate::report::text::number::{clean, optional, seconds};

const MORE_CSS: &str =
    "tr.good td.s{color:var(--good)}tr.bad td.s{color:var(--bad)}td.s{font-weight:600;white-space:nowrap}";

/// The page: no script, nothing loaded. `names` are those of the two reports.
pub fn page(found: &Difference, names: [&str; 2]) -> String {
    let changed = found.numbers.iter().filter(|number| number.is_changed()).count();
    let body = html! {
        header {
            h1 { "Two reports beside each other" }
            div class={ "verdict " (if found.is_decisive() { "disagree" } else { "agree" }) } role="status" {
                span.symbol aria-hidden="true" { (if found.is_decisive() { "✘" } else { "✔" }) }
                div {
                    div.word { (verdict(found)) }
                    @for contradiction in &found.contradictions { p { (clean(contradiction)) } }
                    @for note in &found.notes { p { (clean(note)) } }
                }
            }
        }
        main {
            section #reports { h2 { "The reports" } (reports(found, names)) }
            section #checks { h2 { "Checks, the changed ones first" } (checks(found)) }
            section #numbers {
                h2 { "Numbers" }
                p { (changed) " of " (found.numbers.len()) " moved by more than rounding." }
                (numbers(found))
            }
        }
    };
    document(&format!("{} · hypercircle diff", verdict(found)), &[CSS, MORE_CSS], None, body)
}

fn table(label: &str, head: Markup, rows: Markup) -> Markup {
    html! {
        div.scroll role="region" aria-label=(label) tabindex="0" {
            table { thead { tr { (head) } } tbody { (rows) } }
        }
    }
}

fn reports(found: &Difference, names: [&str; 2]) -> Markup {
    let [a, b] = &found.reports;
    let row = |what: &str, values: [String; 2]| {
        html! { tr { th { (what) } @for value in &values { td.long { (clean(value)) } } } }
    };
    table(
        "reports",
        html! { th { "" } th { "first" } th { "second" } },
        html! {
            (row("report", names.map(String::from)))
            (row("scene", [a, b].map(|r| r.scene.clone())))
            (row("command", [a, b].map(|r| r.command.clone())))
            (row("verdict", [a, b].map(|r| format!("{}: {}", word(r.status), r.verdict))))
            (row("hypercircle", [a, b].map(|r| r.provenance.version.clone())))
            (row("run", [a, b].map(|r| r.run.clone())))
            (row("time, for information", [a, b].map(|r| r.seconds().map_or("–".to_string(), seconds))))
        },
    )
}

fn checks(found: &Difference) -> Markup {
    let row = |change: &CheckChange| {
        let colour = match change.kind {
            Kind::Broken => "bad",
            Kind::Mended => "good",
            _ => "",
        };
        let [a, b] = pair(change.checks.each_ref().map(|check| check.as_ref().and_then(|check| check.value)));
        let outcome = |check: &Option<Check>| match check {
            None => "–",
            Some(check) if check.passed => "✔ passed",
            Some(check) if check.difference.is_none() => "✘ not made",
            Some(_) => "✘ failed",
        };
        let [first, second] = change.checks.each_ref().map(outcome);
        html! {
            tr.(colour) {
                td.s { (change.kind.words()) }
                td.long {
                    code { (clean(&change.name)) }
                    @if change.checks.iter().flatten().any(|check| !check.decides()) { " (remark)" }
                }
                td { (first) } td { (second) }
                td.n { (a) } td.n { (b) } td.n { (optional(difference(change), 3)) }
            }
        }
    };
    table(
        "checks",
        html! {
            th { "change" } th { "check" } th { "first" } th { "second" } th.n { "value, first" } th.n { "value, second" }
            th.n { "by" }
        },
        html! { @for change in &found.checks { (row(change)) } },
    )
}

fn numbers(found: &Difference) -> Markup {
    let row = |number: &NumberChange| {
        let [a, b] = pair(number.values);
        html! {
            tr {
                td.long { (clean(&number.name)) } td.n { (a) } td.n { (b) }
                td.n { @if number.is_changed() { b { (optional(number.difference(), 3)) } } @else { "–" } }
            }
        }
    };
    table(
        "numbers",
        html! { th { "number" } th.n { "first" } th.n { "second" } th.n { "by" } },
        html! { @for number in &found.numbers { (row(number)) } },
    )
}
