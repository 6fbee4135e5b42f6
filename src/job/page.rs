//! `index.html`: one page for all scenes, the worst first.

use maud::{Markup, html};

use super::data::{Entry, Gathered, Job};
use crate::cause::told;
use crate::report::CSS;
use crate::report::Stored;
use crate::report::document::document;
use crate::report::text::number::{at_most_percent, clean, digits_to_tell, grouped, seconds, significant};

const MORE_CSS: &str = "td.s{white-space:nowrap;font-weight:600}tr.good td.s{color:var(--good)}tr.bad td.s{color:var(--bad)}\
tr.warn td.s{color:var(--warn)}td.w{min-width:320px}pre{white-space:pre-wrap;overflow-wrap:anywhere;font:.85em ui-monospace,Menlo,monospace;\
background:var(--sheet);border:1px solid var(--rule);border-radius:8px;padding:10px 12px;margin:6px 0}\
details{margin:2px 0}summary{cursor:pointer}a{color:var(--accent)}.target td{background:var(--sheet)}";

/// The page: no script, nothing loaded.
pub(super) fn page(gathered: &Gathered) -> String {
    let job = &gathered.job;
    let title = format!("{} · hypercircle {}", job.sentence(), job.command);
    let body = html! {
        (first_screen(gathered))
        main {
            section #scenes { h2 { "Scenes, the worst first" } (table(gathered)) }
            @if job.scenes.iter().any(has_baseline) || gathered.patch.is_some() || !job.not_in_job.is_empty() {
                section #baseline { h2 { "Against the baseline" } (against_baseline(gathered)) }
            }
            @if !job.left_out.is_empty() {
                section #left-out {
                    h2 { "Left out" }
                    p { "TOML files in the folders that have keys, and none of a scene:" }
                    ul { @for file in &job.left_out { li { code { (clean(file)) } } } }
                }
            }
        }
        footer {
            "Made by hypercircle " (job.version) " (" code { (clean(&command(job))) } "). "
            code { "job.json" } " holds the numbers of this page, " code { "junit.xml" } " every check of every scene."
        }
    };
    document(&title, &[CSS, MORE_CSS], None, body)
}

fn command(job: &Job) -> String {
    std::iter::once(job.command.as_str()).chain(job.options.iter().map(String::as_str)).collect::<Vec<_>>().join(" ")
}

/// Class of the colours of a whole job: that of its worst scene.
fn class(job: &Job) -> &'static str {
    match job.exit {
        0 => "agree",
        1 => "disagree",
        _ => "failed",
    }
}

fn first_screen(gathered: &Gathered) -> Markup {
    let job = &gathered.job;
    let first = job.worst_first().first().copied();
    let worst = first.map(|i| (i, &job.scenes[i])).filter(|(_, worst)| worst.exit != 0);
    html! {
        header {
            h1 { "hypercircle " (job.command) ", " (job.counts.scenes) @if job.counts.scenes == 1 { " scene" } @else { " scenes" } }
            p.sub { (seconds(job.seconds)) " of processes in all · exit code " (job.exit) }
            div class={ "verdict " (class(job)) } role="status" {
                span.symbol aria-hidden="true" { (worst.map_or("✔", |(_, worst)| worst.status.symbol())) }
                div {
                    div.word {
                        @match worst {
                            None if job.compares() => "ALL AGREE",
                            None => "ALL PASSED",
                            Some((_, worst)) => (job.word(worst.status).to_uppercase()),
                        }
                    }
                    p { (job.sentence()) "." }
                    @if let Some((i, worst)) = worst {
                        p { "Worst: " a href={ "#" (id(i)) } { (clean(&worst.name)) } ". " (clean(&worst.verdict)) }
                    }
                }
            }
        }
    }
}

fn table(gathered: &Gathered) -> Markup {
    let job = &gathered.job;
    html! {
        div.scroll role="region" aria-label="scenes" tabindex="0" {
            table {
                thead { tr {
                    th { "scene" } th { "status" } th.n { "error at most" } th.n { "lower bound" } th.n { "upper bound" }
                    th.n { "triangles" } th.n { "seconds" } th { "reason" }
                } }
                tbody { @for i in job.worst_first() { (row(gathered, i)) } }
            }
        }
    }
}

fn row(gathered: &Gathered, i: usize) -> Markup {
    let (job, entry, report) = (&gathered.job, &gathered.job.scenes[i], gathered.reports[i].as_ref());
    let colour = match entry.exit {
        0 => "good",
        1 => "bad",
        _ => "warn",
    };
    let energy = entry.energy;
    let [lower, upper] = [energy.and_then(|e| e.lower), energy.and_then(|e| e.upper)];
    let digits = lower.zip(upper).map_or(6, |(lower, upper)| digits_to_tell(lower, upper));
    let bound = |x: Option<f64>| x.map_or("–".to_string(), |x| significant(x, digits));
    html! {
        tr.(colour) id=(id(i)) {
            td.long {
                @match &entry.folder {
                    Some(folder) => a href={ (encoded(folder)) "/report.html" } { (clean(&entry.name)) },
                    None => (clean(&entry.name)),
                }
                @if let Some(title) = entry.title.as_ref().filter(|title| **title != entry.name) { br; (clean(title)) }
            }
            td.s { (entry.status.symbol()) " " (job.word(entry.status)) }
            td.n {
                @match energy.and_then(|e| e.relative_error_bound) {
                    Some(bound) if energy.is_some_and(|e| e.guaranteed) => (at_most_percent(bound)),
                    Some(bound) => span title="for the data as represented on the mesh" { "(" (at_most_percent(bound)) ")" },
                    None => "–",
                }
            }
            td.n { (bound(lower)) } td.n { (bound(upper)) }
            td.n { (entry.triangles.map_or("–".to_string(), grouped)) }
            td.n { (significant(entry.seconds, 3)) }
            td.w { (said(entry, report)) }
        }
    }
}

/// Why a scene is not in order: its first failing check, or the error with the last lines that it printed.
fn said(entry: &Entry, report: Option<&Stored>) -> Markup {
    let first = report.and_then(|report| report.checks.iter().find(|check| !check.passed));
    html! {
        @if let Some(cause) = report.and_then(|report| report.causes.first()) { p { b { (clean(&cause.sentence)) } } }
        @if let Some(check) = first {
            code { (clean(&check.name)) } ": " (clean(&told(check)))
            @if entry.failing.len() > 1 {
                " "
                details {
                    summary { "and " (entry.failing.len() - 1) " more of " (entry.checks) " checks" }
                    ul { @for name in &entry.failing[1..] { li { code { (clean(name)) } } } }
                }
            }
        } @else if entry.exit != 0 {
            @if let Some(line) = entry.line { code { (clean(&entry.scene)) ":" (line) } " " }
            (clean(&entry.verdict))
        }
        @if !entry.said.is_empty() {
            details { summary { "what it printed" } pre { (clean(&entry.said.join("\n"))) } }
        }
    }
}

fn has_baseline(entry: &Entry) -> bool {
    !(entry.changed.is_empty() && entry.new.is_empty() && entry.missing.is_empty())
}

fn against_baseline(gathered: &Gathered) -> Markup {
    let job = &gathered.job;
    let list = |what: &str, names: &[String]| {
        html! {
            @if !names.is_empty() {
                li { b { (what) ": " } @for (i, name) in names.iter().enumerate() { @if i > 0 { ", " } code { (clean(name)) } } }
            }
        }
    };
    html! {
        @if gathered.patch.is_some() {
            p {
                a href="baseline.patch" { "baseline.patch" } " brings the baseline up to date: look at it, write a reason, and apply it with "
                code { "git apply" } "; or run the job again with " code { "--accept" } "."
            }
        }
        @for i in job.worst_first() {
            @let entry = &job.scenes[i];
            @if has_baseline(entry) {
                h3 { a href={ "#" (id(i)) } { (clean(&entry.name)) } }
                ul { (list("changed", &entry.changed)) (list("new", &entry.new)) (list("missing", &entry.missing)) }
            }
        }
        @if !job.not_in_job.is_empty() {
            p { "In the baseline and not in this job: " }
            ul { @for name in &job.not_in_job { li { code { (clean(name)) } } } }
        }
    }
}

/// Where scene number `i`, from 0, is on the page.
fn id(i: usize) -> String {
    format!("scene-{}", i + 1)
}

/// A name as part of an address.
fn encoded(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-_.~".contains(&b);
    name.bytes().map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}
