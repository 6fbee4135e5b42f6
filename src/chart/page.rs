//! `chart.html`: one page that stands alone.

use maud::{Markup, PreEscaped, html};

use super::choice::{Of, WANTED, asked, fastest};
use super::data::{Chart, Run, SceneChart, Spread, Status};
use crate::report::CSS;
use crate::report::document::{PLOTS, document};
use crate::report::text::number::{clean, grouped, optional, percent, seconds, significant};

/// The page; `figures` are named SVG texts, of which those of a scene are shown with it.
pub fn page(chart: &Chart, figures: &[(String, String)]) -> String {
    let machine = &chart.machine;
    let body = html! {
        header { h1 { "Accuracy against time" }
        p.sub {
            "hypercircle " (machine.version) @if !machine.optimised { " (a build without optimisation)" } ", "
            (machine.processor.as_deref().unwrap_or("unknown processor")) ", " (chart.threads) " of "
            (machine.processors) " processors in use. Medians of " (chart.repeats) " runs, each in a process of its own; "
            "a run is ended after " (seconds(chart.budget)) ". Made by " code { (chart.command) } "."
        } }
        main {
            @for scene in &chart.scenes { (one(scene, figures)) }
            (reading())
        }
    };
    document("Accuracy against time", &[CSS, PLOTS], None, body)
}

fn one(scene: &SceneChart, figures: &[(String, String)]) -> Markup {
    let prefix = format!("chart-{}-", scene.name);
    let own = figures.iter().filter(|(name, _)| {
        name.strip_prefix(&prefix).is_some_and(|rest| {
            rest.starts_with("error-") || rest.starts_with("quantity-") || rest.starts_with("phases")
        })
    });
    html! {
        section {
            h2 { (clean(&scene.title)) }
            @match &scene.reference {
                Ok(r) => p {
                    "The exact energy lies between " (significant(r.lower, 9)) " and " (significant(r.upper, 9))
                    "; errors below " (percent(r.resolution())) " are not told apart. " span.dim { (r.how) }
                },
                Err(reason) => p { "There is no reference bracket, so no true errors: " (clean(reason)) },
            }
            @for (_, svg) in own { figure.plot { (PreEscaped(svg)) } }
            @if !scene.cold.is_empty() {
                p {
                    "First use of FEniCSx on a machine: "
                    @for (i, cold) in scene.cold.iter().enumerate() {
                        @if i > 0 { "; " }
                        (cold.method.name()) " compiles its forms for " (seconds(cold.compile)) " (" (seconds(cold.compile_warm))
                        " when they are found compiled, as in all other numbers of this page), imports take " (seconds(cold.import))
                    }
                    "."
                }
            }
            @for (of, words) in asked(scene) { (choices(scene, of, &words)) }
            (table(scene))
        }
    }
}

fn choices(scene: &SceneChart, of: Of<'_>, words: &str) -> Markup {
    html! {
        div.scroll role="region" aria-label={ "fastest methods, " (clean(&scene.name)) ", " (clean(words)) } tabindex="0" { table {
            thead { tr { th.n { (clean(words)) } th { "fastest with a guarantee" } th { "fastest by true error" } } }
            tbody {
                @for wanted in WANTED {
                    tr {
                        td.n { (percent(wanted)) }
                        @for guaranteed in [true, false] {
                            td {
                                @match fastest(scene, of, wanted, guaranteed) {
                                    Some(c) => { (level(c.run)) ": " (seconds(c.plot.whole.median)) },
                                    None => "none of these runs",
                                }
                            }
                        }
                    }
                }
            }
        } }
    }
}

/// Method and level of a run.
pub(crate) fn level(run: &Run) -> String {
    match run.tolerance {
        Some(t) => format!("{} to {}", run.name(), percent(t)),
        None => format!("{}, {} refinements", run.name(), run.level),
    }
}

fn table(scene: &SceneChart) -> Markup {
    let spread =
        |s: Spread| format!("{} ({}–{})", significant(s.median, 3), significant(s.least, 3), significant(s.most, 3));
    html! {
        div.scroll role="region" aria-label={ "runs, " (clean(&scene.name)) } tabindex="0" { table {
            thead { tr {
                th { "run" } th.n { "triangles" } th.n { "unknowns" } th.n { "whole process, s" } th.n { "solving, s" }
                th.n { "peak memory, MiB" } th.n { "guaranteed error" } th.n { "true error" }
            } }
            tbody {
                @for run in &scene.runs {
                    tr {
                        td { (level(run)) }
                        @match (&run.plot, &run.status) {
                            (Some(p), _) => {
                                td.n { (grouped(p.triangles)) } td.n { (grouped(p.unknowns)) }
                                td.n { (spread(p.whole)) } td.n { (spread(p.solve)) }
                                td.n { (optional(p.peak_memory.map(|b| b as f64 / 1_048_576.0), 3)) }
                                td.n { (p.guaranteed.map_or("gives none".to_string(), percent)) }
                                td.n { (p.true_error.map_or("–".to_string(), percent)) }
                            },
                            (None, Status::OverBudget) => td.mark colspan="7" { "over the budget" },
                            (None, Status::Skipped(reason)) => td.dim colspan="7" { "skipped: " (clean(reason)) },
                            (None, Status::Failed(reason)) => td.mark colspan="7" { "failed: " (clean(reason)) },
                            (None, Status::Done) => td colspan="7" { "–" },
                        }
                    }
                }
            }
        } }
    }
}

fn reading() -> Markup {
    html! {
        section {
            h2 { "How to read this page" }
            p {
                b { "Whole process" } " runs from the request for the process to the answer, for every method: start of the program, \
                mesh, solution and, for the stress methods, both bounds; for FEniCSx, or the program in its place, also its \
                start and imports, the look-up of compiled forms and the exchange files. " b { "Solving" } " begins with mesh and data in memory and ends with the answer, \
                for every method; start-up, imports, compilation and reading are left out for all of them."
            }
            p {
                "The " b { "guaranteed error" } " is √(gap/𝒮): an upper bound of the relative energy-norm error that needs no knowledge of the \
                solution. A displacement model alone gives none. The " b { "true error" } " is √(|E − energy|/𝒮) with the exact energy E in the middle of \
                the reference bracket: the lower bound for the stress methods, 𝓛(u_h) for displacements. An upright line through a \
                marker is what the bracket leaves open of it; near the dotted line that reaches to the axis, and the marker says \
                nothing any more."
            }
        }
    }
}
