//! `stability.html`: one page that stands alone.

use maud::{Markup, PreEscaped, html};

use super::data::{Cell, Matrix, Outcome, Row};
use super::markdown::shortened;
use crate::report::CSS;
use crate::report::document::{PLOTS, document};
use crate::report::text::number::{clean, percent};

const MORE_CSS: &str = "td.o{white-space:nowrap}td.o a{color:inherit}.correct{background:var(--good-bg)}.inaccurate,.no-convergence{background:var(--warn-bg)}\
.refused{background:var(--sheet)}.crash,.wrong{background:var(--bad-bg);font-weight:700}.not-applicable{color:var(--dim)}\
@page{size:A4 landscape}@media print{table{font-size:7pt}}";

/// The page; `figures` are the curves by name.
pub fn page(matrix: &Matrix, figures: &[(String, String)]) -> String {
    let body = html! {
        header { h1 { "Which method can be trusted where" }
        p.sub {
            "hypercircle " (matrix.machine.version) @if matrix.reduced { ", reduced sweeps" }
            ". Every row is a family of scenes swept through one parameter; a cell shows the worst outcome, in brackets the last \
            value before the first that was not correct."
        } }
        main {
            section aria-label="all regimes" { (table(matrix)) }
            @for row in &matrix.rows { (details(row, figures)) }
        }
    };
    document("Stability matrix", &[CSS, PLOTS, MORE_CSS], None, body)
}

fn class(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::NotApplicable => "not-applicable",
        Outcome::Correct => "correct",
        Outcome::Inaccurate => "inaccurate",
        Outcome::Refused => "refused",
        Outcome::NoConvergence => "no-convergence",
        Outcome::Crash => "crash",
        Outcome::Wrong => "wrong",
    }
}

fn table(matrix: &Matrix) -> Markup {
    html! {
        div.scroll role="region" aria-label="methods and regimes" tabindex="0" { table {
            thead { tr {
                th { "regime" }
                @if let Some(row) = matrix.rows.first() { @for cell in &row.cells { th { (cell.name()) } } }
            } }
            tbody {
                @for row in &matrix.rows {
                    tr {
                        td { a href=(format!("#{}", row.id)) { (clean(&row.title)) } }
                        @for cell in &row.cells { (summary(row, cell)) }
                    }
                }
            }
        } }
    }
}

fn summary(row: &Row, cell: &Cell) -> Markup {
    html! {
        td class={ "o " (class(cell.worst)) } {
            a href=(format!("#{}-{}", row.id, cell.method.index())) { (cell.worst.sign()) " " (cell.worst.words()) }
            @if !matches!(cell.worst, Outcome::Correct | Outcome::NotApplicable) {
                @match cell.correct_to() {
                    Some(i) => { " (" (row.values[i]) ")" },
                    None => " (–)",
                }
            }
        }
    }
}

fn details(row: &Row, figures: &[(String, String)]) -> Markup {
    let name = format!("stability-{}.svg", row.id);
    html! {
        section id=(row.id) {
            h2 { (clean(&row.title)) }
            p { "Swept: " (row.parameter) ". Truth: " (row.truth) "." @if !row.reported.is_empty() { " Reported in " (row.reported) "." } }
            @for (_, svg) in figures.iter().filter(|(n, _)| *n == name) { figure.plot { (PreEscaped(svg)) } }
            @for cell in &row.cells {
                details id=(format!("{}-{}", row.id, cell.method.index())) open[cell.worst > Outcome::Correct] {
                    summary { (cell.name()) ": " (cell.worst.words()) }
                    div.scroll role="region" aria-label={ (row.title) ", " (cell.name()) } tabindex="0" { table {
                        thead { tr { th { "value" } th { "outcome" } th.n { "guaranteed" } th.n { "true" } th { "why" } } }
                        tbody {
                            @for (value, step) in row.values.iter().zip(&cell.steps) {
                                tr {
                                    td { (value) }
                                    td class=(class(step.outcome)) { (step.outcome.sign()) " " (step.outcome.words()) }
                                    td.n { (step.bound.map_or("–".to_string(), percent)) }
                                    td.n { (step.error.map_or("–".to_string(), percent)) }
                                    td { (clean(&shortened(&step.why))) }
                                }
                            }
                        }
                    } }
                }
            }
        }
    }
}
