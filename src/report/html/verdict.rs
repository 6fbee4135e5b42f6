//! The first screen: verdict, failures, quantities, bracket, three answers.

use maud::{Markup, PreEscaped, html};

use crate::report::figure::bracket::bracket;
use crate::report::text::number::{at_most_percent, clean, digits_to_tell, enclosing, grouped, percent, vector};
use crate::report::text::words::{accuracy, failing, headline, status_symbol, status_word, upper_from, worth_a_look};
use crate::report::{Dossier, Report, Status};

pub(super) fn first_screen(dossier: &Dossier) -> Markup {
    let report = &dossier.report;
    html! {
        header {
            h1 { bdi { (clean(&report.title)) } }
            p.sub {
                "Scene " bdi { code { (clean(&report.scene)) } }
                @if let Some(dual) = &report.dual { " · " (grouped(dual.triangles)) " triangles" }
            }
            div class=(format!("verdict {}", status_word(report.status))) role="status" {
                span.symbol aria-hidden="true" { (status_symbol(report.status)) }
                div {
                    div.word { (headline(report).to_uppercase()) (gloss(report)) }
                    @match leading(report) {
                        Some((sentence, rest)) => { p.cause { b { (clean(sentence)) } } p { (clean(rest)) } },
                        None => p { (clean(&report.verdict)) },
                    }
                }
            }
            (super::causes::causes(report))
            (super::quantities::card(report))
            div class=(if report.energy.is_some() { "first" } else { "first alone" }) {
                @if report.energy.is_some() { (bracket_card(report)) }
                div.answers {
                    (agreement(report))
                    @if report.energy.is_some() { (distance(report)) }
                    (differences(report))
                }
            }
            (super::scene::card(dossier))
        }
    }
}

/// The sentence of the first cause where the verdict begins with it, and what follows.
pub(super) fn leading(report: &Report) -> Option<(&str, &str)> {
    let sentence = &report.causes.first()?.sentence;
    let rest = report.verdict.strip_prefix(sentence.as_str())?;
    Some((sentence, rest.trim_start()))
}

/// Gloss on the verdict, where the word alone does not explain it.
fn gloss(report: &Report) -> &'static str {
    match report.status {
        Status::Agree if report.primal.is_empty() => ": the bounds are in order, no second model was run",
        Status::Agree | Status::Disagree => "",
        Status::Undecided => ": no check failed, but the bracket is too wide to tell",
        Status::Infeasible => ": no equilibrium exists",
        Status::Failed => ": a solver failed, there is no comparison",
    }
}

fn bracket_card(report: &Report) -> Markup {
    html! {
        section.card #bracket aria-label="energy bracket" {
            h2 { "Where the exact energy lies" }
            (PreEscaped(bracket(report)))
            @if let Some(energy) = &report.energy {
                @let [lower, upper] = enclosing([energy.lower, energy.upper], digits_to_tell(energy.lower, energy.upper));
                p {
                    "Stresses in equilibrium give " b { (lower) } ", the best admissible displacement ("
                    (upper_from(&energy.upper_from)) ") gives " b { (upper) }
                    ". "
                    @if energy.lower <= energy.upper { "The exact energy is between them." }
                    @else { b { "That is the wrong way round, which cannot be: one of the models is wrong." } }
                }
            }
            (super::links::checks_of("bracket", report))
        }
    }
}

fn agreement(report: &Report) -> Markup {
    let (passed, all) = (report.checks.len() - failing(report).len(), report.checks.len());
    html! {
        section.card {
            h2 { (if of_field(report) { "Is the field the solution it claims to be?" } else { "Do the two models agree?" }) }
            div.big {
                @match report.status {
                    Status::Agree if report.primal.is_empty() => "No second model",
                    Status::Agree if report.checks.iter().any(|check| check.excused) => "Yes, with allowances",
                    Status::Agree => "Yes",
                    Status::Disagree => "No",
                    Status::Undecided => "Cannot be told",
                    Status::Infeasible | Status::Failed => "Not compared",
                }
            }
            p {
                @if all == 0 { "No check was made." }
                @else if passed == all { "All " (all) " checks passed." }
                @else { (passed) " of " (all) " checks passed. The others are named above." }
            }
            @if !worth_a_look(report).is_empty() {
                p {
                    (worth_a_look(report).len()) " of " (report.remarks.len()) " " a href="#remarks" { (if report.remarks.len() == 1 { "remark" } else { "remarks" }) }
                    " " (if worth_a_look(report).len() == 1 { "is" } else { "are" }) " worth a look."
                }
            }
        }
    }
}

/// True if the report is about a field that was handed in.
fn of_field(report: &Report) -> bool {
    report.command == "certify" && !report.primal.is_empty()
}

/// How far a field that was handed in can be from the truth, before what the program has of its own.
fn distance_of_field(report: &Report) -> Markup {
    html! {
        section.card {
            h2 { "How far can the field be from the truth?" }
            @for primal in &report.primal {
                @if let Some(bound) = primal.relative_error_bound.filter(|bound| bound.is_finite()) {
                    div.big { "≤ " (percent(bound)) }
                    p {
                        @if primal.admissible { "The stresses of " (clean(&primal.name)) " differ" }
                        @else { (clean(&primal.name)) " is not admissible; the stresses of the nearest field that is differ" }
                        " from the exact ones by at most this in the energy norm."
                    }
                } @else { p { "No bound was obtained for " (clean(&primal.name)) "." } }
            }
            @if let Some(energy) = report.energy.as_ref().filter(|e| e.relative_error_bound.is_finite()) {
                p { "Of the stresses that this program computed for comparison: at most " b { (at_most_percent(energy.relative_error_bound)) } "." }
            }
        }
    }
}

fn distance(report: &Report) -> Markup {
    if of_field(report) {
        return distance_of_field(report);
    }
    html! {
        section.card {
            h2 { "How far can each be from the truth?" }
            @if let Some(energy) = report.energy.as_ref().filter(|e| e.relative_error_bound.is_finite()) {
                div.big { "≤ " (at_most_percent(energy.relative_error_bound)) }
            }
            p {
                (accuracy(report))
                @if report.status == Status::Disagree { " It presumes that the models are right, which the failing checks put in doubt." }
            }
            @for primal in &report.primal {
                @if let Some(bound) = primal.relative_error_bound {
                    p {
                        (clean(&primal.name))
                        @if !primal.admissible { " is not admissible and has no bound; the nearest field that is" }
                        ": at most " b { (percent(bound)) } "."
                    }
                } @else if primal.is_of_quadrature() {
                    p { (clean(&primal.name)) ": no bound, its energy is that of a quadrature on quadrilaterals that are no parallelograms." }
                } @else {
                    p { (clean(&primal.name)) ": no bound, its energy does not lie above the lower bound or it is not admissible." }
                }
            }
        }
    }
}

fn differences(report: &Report) -> Markup {
    html! {
        @if let Some(stress) = &report.stress {
            section.card {
                h2 { "Where do they differ?" }
                div.big { (percent(stress.relative_energy_norm_difference)) }
                p {
                    "is the difference of the stresses of the dual model and of " (clean(&stress.against)) " in the energy norm. "
                    "The triangle that contributes most (" (percent(stress.worst_share)) " of the square) is number "
                    (stress.worst_triangle) " at " (vector(stress.worst_at, 3)) "."
                }
                @for contact in &report.contact {
                    @if let Some(difference) = contact.pressure_l2_difference {
                        p { "Pressure on " code { (clean(&contact.name)) } ": " b { (percent(difference)) } " apart." }
                    }
                }
            }
        }
    }
}
