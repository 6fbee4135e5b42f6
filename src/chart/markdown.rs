//! The chart as Markdown, for the documentation: figures, the fastest choices, and every run.

use std::fmt::Write;

use super::choice::{Choice, Of, WANTED, asked, fastest};
use super::data::{Chart, Cold, Plot, Run, SceneChart, Spread, Status};
use super::figure::{Cost, error_figures};
use crate::report::text::number::{clean, grouped, optional, percent, seconds, significant};

/// One section a scene, the command under each figure; figures are those that [`super::write()`] puts beside the text.
pub fn markdown(chart: &Chart) -> String {
    let mut text = String::new();
    let machine = &chart.machine;
    let _ = writeln!(
        text,
        "hypercircle {}{}, {}, {} of {} processors in use. Medians of {}, least and most in brackets; every run has a process of its \
         own and is ended after {}.",
        machine.version,
        if machine.optimised { "" } else { " (a build without optimisation)" },
        escaped(machine.processor.as_deref().unwrap_or("unknown processor")),
        chart.threads,
        machine.processors,
        if chart.repeats == 1 { "one run".to_string() } else { format!("{} runs", chart.repeats) },
        seconds(chart.budget),
    );
    for scene in &chart.scenes {
        one(&mut text, scene, &chart.command);
    }
    text
}

fn one(text: &mut String, scene: &SceneChart, command: &str) {
    let _ = writeln!(text, "\n### {} (`{}`)\n", escaped(&scene.title), scene.name);
    let known = match &scene.reference {
        Ok(r) => format!(
            "The exact energy lies between {} and {}; errors below {} are not told apart.",
            significant(r.lower, 9),
            significant(r.upper, 9),
            percent(r.resolution())
        ),
        Err(reason) => format!("There is no reference bracket, so no true errors: {}", escaped(reason)),
    };
    let _ = writeln!(text, "{known}");
    for (file, words) in figures(scene) {
        let _ = writeln!(text, "\n![{}](figures/{file})\n\n`{command}`", escaped(&words));
    }
    if !scene.cold.is_empty() {
        let list: Vec<String> = scene.cold.iter().map(first_use).collect();
        let _ =
            writeln!(text, "\nFirst use of FEniCSx on a machine, in none of the other numbers: {}.", list.join("; "));
    }
    for (of, words) in asked(scene) {
        let words = escaped(&words);
        let _ = writeln!(text, "\n| {words} | fastest with a guarantee | fastest by true error |\n|---:|---|---|");
        for wanted in WANTED {
            let [guaranteed, truly] = [true, false].map(|g| choice(fastest(scene, of, wanted, g)));
            let _ = writeln!(text, "| {} | {guaranteed} | {truly} |", percent(wanted));
        }
    }
    let _ = writeln!(text, "\n<details><summary>All runs on {}</summary>\n", escaped(&scene.name));
    let _ = writeln!(
        text,
        "| method | mesh | triangles | unknowns | seconds, whole process | solving | peak MiB | guaranteed error | true error | outcome |"
    );
    let _ = writeln!(text, "|---|---|---:|---:|---:|---:|---:|---:|---:|---|");
    for run in &scene.runs {
        let _ = writeln!(text, "{}", line(run));
    }
    let _ = writeln!(text, "\n</details>");
}

/// Names of the files of a scene's figures, and what each shows.
pub(super) fn figures(scene: &SceneChart) -> Vec<(String, String)> {
    let words = |axis: Cost, of| match of {
        Of::Energy => format!("{}: {}", axis.words().0, scene.name),
        Of::Quantity(name) => format!("{}: {}, {name}", axis.words().0, scene.name),
    };
    let mut figures: Vec<_> =
        error_figures(scene).into_iter().map(|(axis, of)| (axis.file(scene, of), words(axis, of))).collect();
    figures.push((format!("chart-{}-phases.svg", scene.name), format!("Seconds by phase: {}", scene.name)));
    figures
}

fn first_use(cold: &Cold) -> String {
    format!(
        "{} compiles its forms for {} ({} where they are found compiled), imports take {}",
        cold.method.name(),
        seconds(cold.compile),
        seconds(cold.compile_warm),
        seconds(cold.import)
    )
}

fn choice(choice: Option<Choice<'_>>) -> String {
    choice.map_or("none of these runs".to_string(), |c| {
        format!("{}, {}: {}", c.run.name(), mesh(c.run), seconds(c.plot.whole.median))
    })
}

fn mesh(run: &Run) -> String {
    match (run.tolerance, run.level) {
        (Some(tolerance), _) => format!("to {}", percent(tolerance)),
        (None, 0) => "as given".to_string(),
        (None, 1) => "1 refinement".to_string(),
        (None, n) => format!("{n} refinements"),
    }
}

fn line(run: &Run) -> String {
    let spread = |s: Spread| match s.least < s.most {
        true => format!("{} ({}–{})", significant(s.median, 3), significant(s.least, 3), significant(s.most, 3)),
        false => significant(s.median, 3),
    };
    let numbers = |p: &Plot| {
        [
            grouped(p.triangles),
            grouped(p.unknowns),
            spread(p.whole),
            spread(p.solve),
            optional(p.peak_memory.map(|b| b as f64 / 1_048_576.0), 3),
            p.guaranteed.map_or("gives none".to_string(), percent),
            p.true_error.map_or("–".to_string(), percent),
        ]
    };
    let numbers = run.plot.as_ref().map_or_else(|| std::array::from_fn(|_| "–".to_string()), numbers);
    let outcome = match &run.status {
        Status::Done => "done".to_string(),
        Status::OverBudget => "over the budget".to_string(),
        Status::Skipped(reason) => format!("skipped: {reason}"),
        Status::Failed(reason) => format!("failed: {}", reason.lines().next().unwrap_or_default()),
    };
    format!("| {} | {} | {} | {} |", run.name(), mesh(run), numbers.join(" | "), escaped(&outcome))
}

/// Text that means nothing to Markdown.
fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for c in clean(text).chars() {
        match c {
            '\n' | '\r' | '\t' => safe.push(' '),
            '<' => safe.push_str("&lt;"),
            '|' | '_' | '*' | '`' | '[' | ']' | '\\' => safe.extend(['\\', c]),
            other => safe.push(other),
        }
    }
    safe
}
