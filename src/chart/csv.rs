//! `chart.csv`: one line a run, comma-separated as in RFC 4180.

use std::fmt::Write;

use super::data::{Chart, Status};
use crate::measure::Asked;

const COLUMNS: [&str; 21] = [
    "scene",
    "method",
    "level",
    "tolerance",
    "status",
    "reason",
    "triangles",
    "unknowns",
    "whole_median_s",
    "whole_least_s",
    "whole_most_s",
    "solve_median_s",
    "solve_least_s",
    "solve_most_s",
    "peak_memory_bytes",
    "lower",
    "upper",
    "guaranteed_error",
    "true_error",
    "phases",
    "quantities",
];

/// The whole file.
pub fn csv(chart: &Chart) -> String {
    let mut text = COLUMNS.join(",");
    text.push_str("\r\n");
    for scene in &chart.scenes {
        for run in &scene.runs {
            let (status, reason) = match &run.status {
                Status::Done => ("done", ""),
                Status::OverBudget => ("over-budget", ""),
                Status::Skipped(reason) => ("skipped", reason.as_str()),
                Status::Failed(reason) => ("failed", reason.as_str()),
            };
            let mut cells = vec![
                scene.name.clone(),
                run.name(),
                run.level.to_string(),
                optional(run.tolerance),
                status.to_string(),
                reason.to_string(),
            ];
            match &run.plot {
                None => cells.extend(std::iter::repeat_n(String::new(), COLUMNS.len() - 6)),
                Some(p) => {
                    cells.extend([p.triangles.to_string(), p.unknowns.to_string()]);
                    for spread in [p.whole, p.solve] {
                        cells.extend([spread.median, spread.least, spread.most].map(|v| format!("{v:?}")));
                    }
                    cells.push(p.peak_memory.map_or(String::new(), |b| b.to_string()));
                    cells.extend([p.lower, p.upper, p.guaranteed, p.true_error].map(optional));
                    let phases: Vec<String> = p.phases.iter().map(|(name, s)| format!("{name}={s:.6}")).collect();
                    cells.push(phases.join(";"));
                    let asked = |q: &Asked| {
                        format!("{}={} [{}, {}]", q.name, optional(q.value), optional(q.lower), optional(q.upper))
                    };
                    cells.push(p.quantities.iter().map(asked).collect::<Vec<_>>().join(";"));
                }
            }
            let line: Vec<String> = cells.iter().map(|c| quoted(c)).collect();
            let _ = write!(text, "{}\r\n", line.join(","));
        }
    }
    text
}

fn optional(value: Option<f64>) -> String {
    value.map_or(String::new(), |v| format!("{v:?}"))
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_with_commas_quotes_and_lines_are_quoted() {
        assert_eq!(quoted("a,b"), "\"a,b\"");
        assert_eq!(quoted("say \"no\"\nand go"), "\"say \"\"no\"\"\nand go\"");
        assert_eq!(quoted("plain"), "plain");
    }
}
