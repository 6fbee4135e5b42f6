//! `report.html`: one page that stands alone.

use maud::{Markup, PreEscaped, html};

use super::finding::Finding;
use super::report::Report;
use crate::report::CSS;
use crate::report::document::document;
use crate::report::text::number::{clean, optional};

/// The page: verdict, diagnosis, what is missing, pictures, and a table of all findings.
pub fn page(report: &Report) -> String {
    let title = format!("Element {}", clean(&report.element));
    let (class, symbol, word) = match report.passed {
        true => ("agree", "✔", "every property claimed holds"),
        false => ("disagree", "✘", "a property claimed is missing"),
    };
    let body = html! {
        header {
            h1 { (title) }
            p.sub { (report.kind) " element" @if !report.nodes.is_empty() { " of " (report.nodes.len()) " nodes" } }
            div class=(format!("verdict {class}")) role="status" {
                span.symbol aria-hidden="true" { (symbol) }
                div { div.word { (word.to_uppercase()) } p { (clean(&report.verdict)) } }
            }
            (failures(report))
        }
        main {
            section { h2 { "Pictures" } div.gallery {
                @for finding in &report.findings { @if let Some(svg) = &finding.picture {
                    figure id=(finding.name) {
                        h3 { (finding.name) }
                        (PreEscaped(svg))
                        figcaption { (clean(&finding.sentence)) }
                    }
                } }
            } }
            (table(report))
        }
        footer { "Made by hypercircle " (report.version) ". " code { "report.json" } " holds every number of this page." }
    };
    document(&title, &[CSS], None, body)
}

fn failures(report: &Report) -> Markup {
    let missing: Vec<&Finding> = report.findings.iter().filter(|f| f.is_missing()).collect();
    html! {
        @if let Some(diagnosis) = &report.diagnosis {
            div.card.asked { h3 { "Diagnosis" } p { (clean(&diagnosis.sentence)) } }
        }
        @if let Some(hint) = &report.hint {
            div.card.asked { h3 { "Digits" } p { (clean(hint)) } }
        }
        @if let Some(untold) = &report.untold {
            div.card.asked { h3 { "One shape" } p { (clean(untold)) } }
        }
        @if !missing.is_empty() {
            section.failures aria-label="what is missing" {
                ol { @for finding in missing { li {
                    span.name { (finding.name) }
                    p { (clean(&finding.sentence)) }
                    p.facts { span { "asked: " (finding.asks) } }
                } } }
            }
        }
    }
}

fn table(report: &Report) -> Markup {
    html! {
        section { h2 { "All properties" } div.scroll { table {
            thead { tr { th { "property" } th { "verdict" } th.n { "value" } th.n { "allowed" } th { "what was found" } } }
            tbody { @for finding in &report.findings {
                tr class=[finding.is_missing().then_some("no")] {
                    td { code { (finding.name) } }
                    td { @match (finding.passed, finding.claim) {
                        (Some(true), _) => span.yes { "✔ holds" },
                        (Some(false), true) => span.not { "✘ missing" },
                        (Some(false), false) => "· absent, not claimed",
                        (None, _) => "– not made",
                    } }
                    td.n { (optional(finding.value, 3)) }
                    td.n { (optional(finding.allowed, 3)) }
                    td.why { (clean(&finding.sentence)) br; "Asked: " (finding.asks) "." }
                }
            } }
        } } }
    }
}
