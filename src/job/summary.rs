//! `summary.md`: the job for the page of a CI run, which takes no more than a mebibyte.

use std::fmt::Write;
use std::path::Path;

use super::data::{Entry, Gathered, Job};
use crate::report::text::markdown::{cell, code};
use crate::report::text::number::{at_most_percent, seconds};
use crate::scene::counted;

/// Bytes of the whole text.
const MOST: usize = 1_000_000;
/// Scenes that are not in order and are shown in full.
const IN_FULL: usize = 20;
/// Bytes that one of them may have.
const LONGEST: usize = 40_000;
/// Bytes that the table of all scenes may have.
const TABLE: usize = 150_000;

/// The job as Markdown; the summaries of single scenes are those in the folders in `out`.
pub fn summary(gathered: &Gathered, out: &Path) -> String {
    let job = &gathered.job;
    let mut text = String::new();
    // Writing to a String cannot fail, so the results of `write!` below carry no information.
    let symbol = match job.exit {
        0 => "✅",
        1 => "✘",
        _ => "⚠",
    };
    let _ = writeln!(text, "## {symbol} hypercircle {}: {}\n", job.command, job.sentence());
    let order = job.worst_first();
    table(&mut text, job, &order);
    if gathered.patch.is_some() {
        let _ = writeln!(
            text,
            "Numbers differ from the baseline. `baseline.patch` brings it up to date: look at it, write a reason, and apply it with \
             `git apply`.\n"
        );
    }
    if !job.not_in_job.is_empty() {
        let names: Vec<String> = job.not_in_job.iter().take(100).map(|name| format!("`{}`", code(name))).collect();
        let _ = writeln!(text, "In the baseline and not in this job: {}.\n", names.join(", "));
    }
    let bad: Vec<&Entry> = order.iter().map(|i| &job.scenes[*i]).filter(|entry| entry.exit != 0).collect();
    let mut shown = 0;
    for entry in bad.iter().take(IN_FULL) {
        let full = in_full(entry, out);
        if text.len() + full.len() > MOST - 1000 {
            break;
        }
        text.push_str(&full);
        shown += 1;
    }
    let more = bad.len() - shown;
    if more > 0 {
        let _ = writeln!(
            text,
            "{} {} not in order; see `index.html`.\n",
            counted(more, "more scene"),
            if more == 1 { "is" } else { "are" }
        );
    }
    let _ = writeln!(text, "hypercircle {} · {} of processes", job.version, seconds(job.seconds));
    text
}

fn table(text: &mut String, job: &Job, order: &[usize]) {
    let _ = writeln!(text, "| scene | status | error at most | seconds | reason |\n|---|---|--:|--:|---|");
    let start = text.len();
    for (row, i) in order.iter().enumerate() {
        let entry = &job.scenes[*i];
        let said = match (entry.exit, entry.failing.first()) {
            (0, _) => String::new(),
            (_, Some(first)) if entry.failing.len() > 1 => {
                format!("`{}` and {} more", code(first), entry.failing.len() - 1)
            }
            (_, Some(first)) => format!("`{}`", code(first)),
            (_, None) => cell(&shortened(&entry.verdict, 300)),
        };
        let bound =
            entry.energy.and_then(|energy| energy.relative_error_bound).map_or("–".to_string(), at_most_percent);
        let _ = writeln!(
            text,
            "| `{}` | {} {} | {bound} | {} | {said} |",
            code(&shortened(&entry.name, 200)),
            entry.status.symbol(),
            job.word(entry.status),
            seconds(entry.seconds),
        );
        if text.len() - start > TABLE && row + 1 < order.len() {
            let _ = writeln!(text, "\n… and {}.", counted(order.len() - row - 1, "more scene"));
            break;
        }
    }
    text.push('\n');
}

/// All that is said of one scene: its own summary, or what it printed.
fn in_full(entry: &Entry, out: &Path) -> String {
    let own =
        entry.folder.as_ref().and_then(|folder| std::fs::read_to_string(out.join(folder).join("summary.md")).ok());
    let text = match own {
        Some(own) => {
            let own = if own.starts_with("## ") { format!("#{own}") } else { own };
            whole_lines(&own, LONGEST)
        }
        None => {
            let said = whole_lines(&crate::report::text::number::clean(&entry.said.join("\n")), LONGEST);
            let fence = "`".repeat(3.max(longest_run(&said, '`') + 1));
            let place = entry.line.map_or(String::new(), |line| format!(":{line}"));
            let head = format!(
                "### {} `{}{place}`: {}\n\n{}\n",
                entry.status.symbol(),
                code(&entry.scene),
                entry.status.words(),
                cell(&entry.verdict)
            );
            if said.is_empty() { head } else { format!("{head}\n{fence}text\n{said}\n{fence}\n") }
        }
    };
    format!("{text}\n")
}

/// As many whole lines of `text` as `most` bytes hold.
fn whole_lines(text: &str, most: usize) -> String {
    if text.len() <= most {
        return text.to_string();
    }
    let mut length = 0;
    let kept: Vec<&str> = text
        .lines()
        .take_while(|line| {
            length += line.len() + 1;
            length <= most
        })
        .collect();
    format!("{}\n…", kept.join("\n"))
}

fn shortened(text: &str, characters: usize) -> String {
    match text.char_indices().nth(characters) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

fn longest_run(text: &str, of: char) -> usize {
    let (mut longest, mut run) = (0, 0);
    for c in text.chars() {
        run = if c == of { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Counts, SCHEMA_VERSION, SceneStatus};

    fn failed(number: usize) -> Entry {
        Entry {
            name: format!("{number}-{}", "n".repeat(250)),
            scene: format!("scenes/{number}.toml"),
            title: None,
            folder: None,
            exit: 3,
            status: SceneStatus::Crashed,
            verdict: "`words | words` ".repeat(100),
            line: None,
            seconds: 1.0,
            run: None,
            energy: None,
            triangles: None,
            checks: 0,
            failing: Vec::new(),
            changed: Vec::new(),
            new: Vec::new(),
            missing: Vec::new(),
            said: vec!["é```".repeat(500); 40],
        }
    }

    #[test]
    fn whatever_is_said_it_fits_and_tells_of_twenty() {
        let scenes: Vec<Entry> = (0..5000).map(failed).collect();
        let job = Job {
            schema_version: SCHEMA_VERSION,
            command: "verify".to_string(),
            options: Vec::new(),
            version: "0".to_string(),
            exit: 3,
            counts: Counts::of(scenes.iter().map(|scene| scene.exit)),
            seconds: 1.0,
            scenes,
            left_out: Vec::new(),
            not_in_job: vec!["x".repeat(200); 5000],
        };
        let gathered = Gathered { reports: vec![None; job.scenes.len()], job, patch: None };
        let text = summary(&gathered, Path::new("/nonexistent"));
        assert!(text.len() < 1 << 20, "{} bytes", text.len());
        assert_eq!(text.matches("\n### ").count(), IN_FULL);
        assert!(text.contains("4980 more scenes are not in order"));
        // What is printed cannot end the fence around it.
        assert!(text.contains("\n````text\n"));
    }
}
