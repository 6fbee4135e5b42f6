//! The matrix as a Markdown table, for the documentation and for a terminal.

use std::fmt::Write;

use super::data::{Cell, Matrix, Outcome, Row};

/// Table, legend, what stands behind every cell that is not correct, and how each truth is known.
pub fn markdown(matrix: &Matrix) -> String {
    let mut text = format!(
        "hypercircle {}{}. Made by `{}`.\n\n",
        matrix.machine.version,
        if matrix.reduced { ", reduced sweeps" } else { "" },
        matrix.command
    );
    let methods: Vec<String> =
        matrix.rows.first().map(|r| r.cells.iter().map(|c| escaped(&c.name())).collect()).unwrap_or_default();
    let _ = writeln!(text, "| regime | swept | {} |", methods.join(" | "));
    let _ = writeln!(text, "|---|---|{}", "---|".repeat(methods.len()));
    for row in &matrix.rows {
        let swept = match (row.values.first(), row.values.last()) {
            (Some(a), Some(b)) => format!("{}: {a} … {b}", row.parameter),
            _ => row.parameter.clone(),
        };
        let cells: Vec<String> = row.cells.iter().map(|c| self::cell(row, c)).collect();
        let _ = writeln!(text, "| {} | {} | {} |", escaped(&row.title), escaped(&swept), cells.join(" | "));
    }
    let signs = [
        Outcome::Correct,
        Outcome::Inaccurate,
        Outcome::Refused,
        Outcome::NoConvergence,
        Outcome::Crash,
        Outcome::Wrong,
        Outcome::NotApplicable,
    ];
    let legend: Vec<String> = signs.iter().map(|o| format!("{} {}", o.sign(), o.words())).collect();
    let _ = writeln!(
        text,
        "\n{}. A cell shows the worst outcome of the sweep and the last value before it was first other than correct.\n",
        legend.join(", ")
    );
    for row in &matrix.rows {
        let bad: Vec<&Cell> =
            row.cells.iter().filter(|c| !matches!(c.worst, Outcome::Correct | Outcome::NotApplicable)).collect();
        if bad.is_empty() {
            continue;
        }
        let _ = writeln!(text, "- **{}**", escaped(&row.title));
        for (methods, what) in together(row, &bad) {
            let _ = writeln!(text, "  - {}{}", methods.join(", "), escaped(&what));
        }
    }
    let _ = writeln!(text, "\n| regime | how the truth is known | such failures were reported in |\n|---|---|---|");
    for row in &matrix.rows {
        let _ = writeln!(text, "| {} | {} | {} |", escaped(&row.title), escaped(&row.truth), escaped(&row.reported));
    }
    text
}

/// Methods that fail at the same value in the same words share a line.
fn together(row: &Row, cells: &[&Cell]) -> Vec<(Vec<String>, String)> {
    let mut lines: Vec<(Vec<String>, String)> = Vec::new();
    for cell in cells {
        let Some((value, step)) = cell.worst_at().and_then(|i| Some((row.values.get(i)?, cell.steps.get(i)?))) else {
            continue;
        };
        let why = step.why.lines().next().unwrap_or_default();
        let what = format!(" at {value}: {}: {}", cell.worst.words(), shortened(why));
        match lines.iter_mut().find(|(_, w)| *w == what) {
            Some((methods, _)) => methods.push(escaped(&cell.name())),
            None => lines.push((vec![escaped(&cell.name())], what)),
        }
    }
    lines
}

fn cell(row: &Row, cell: &Cell) -> String {
    let until = match (cell.worst, cell.correct_to()) {
        (Outcome::Correct | Outcome::NotApplicable, _) => String::new(),
        (_, Some(i)) => format!(" ({})", row.values[i]),
        (_, None) => " (–)".to_string(),
    };
    format!("[{}{}](figures/stability-{}.svg)", cell.worst.sign(), escaped(&until), row.id)
}

/// The first 200 characters.
pub(super) fn shortened(text: &str) -> String {
    if text.chars().count() <= 200 { text.to_string() } else { text.chars().take(199).chain(['…']).collect() }
}

fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;").replace('_', "\\_").replace('*', "\\*").replace('\n', " ")
}
