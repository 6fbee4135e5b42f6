//! The collection as a table: what it holds, and what came of it.

use std::fmt::Write;

use super::{Case, Value, Verdict};
use crate::report::text::markdown::cell;
use crate::report::text::number::significant;

/// A published number and what was found of it.
#[derive(Debug, Clone)]
pub struct Row<'a> {
    /// The case.
    pub case: &'a Case,
    /// The published number.
    pub value: &'a Value,
    /// The interval, its ends rounded outwards.
    pub interval: String,
    /// Its verdict on the number.
    pub verdict: Verdict,
}

impl Row<'_> {
    /// The verdict, with what is known beside it.
    fn remark(&self) -> String {
        let beside = match self.verdict {
            Verdict::Elsewhere => self.value.elsewhere.as_deref(),
            Verdict::Outside(_) => self.value.finding.as_deref(),
            _ => None,
        };
        let words = self.verdict.words();
        beside.map_or(words.clone(), |beside| format!("{words}: {beside}"))
    }
}

/// A number with how far the truth may be from it.
fn with_accuracy(value: &Value) -> String {
    format!("{} ± {}", value.printed.replace('-', "−"), significant(value.accuracy, 2))
}

/// The list: one line for each published number.
pub fn listed(cases: &[Case]) -> Vec<String> {
    let cells = |case: &Case, value: &Value| {
        [
            case.name.clone(),
            case.title().to_string(),
            value.quantity.clone(),
            with_accuracy(value),
            value.source.clone(),
        ]
    };
    let rows = cases.iter().flat_map(|case| case.values.iter().map(move |value| cells(case, value)));
    aligned(["case", "scene", "quantity", "published", "source"], rows.collect())
}

/// The results of a run: one line for each published number.
pub fn text(rows: &[Row<'_>]) -> Vec<String> {
    let cells = |row: &Row<'_>| {
        let Row { case, value, interval, .. } = row;
        [case.name.clone(), value.quantity.clone(), with_accuracy(value), interval.clone(), row.remark()]
    };
    aligned(["case", "quantity", "published", "guaranteed within", "verdict"], rows.iter().map(cells).collect())
}

/// The results as a table of Markdown, with the sources.
pub fn markdown(rows: &[Row<'_>]) -> String {
    let mut text = String::from(
        "| case | quantity | published | accuracy | guaranteed within | verdict | source, and how it was checked |\n|---|---|--:|---|---|---|---|\n",
    );
    for row in rows {
        let Value { quantity, printed, formula, accuracy, because, source, checked, .. } = row.value;
        let formula = formula.as_ref().map_or(String::new(), |formula| format!(" = {formula}"));
        let cells = [
            row.case.name.clone(),
            quantity.clone(),
            printed.replace('-', "−"),
            format!("± {} ({because})", significant(*accuracy, 2)),
            row.interval.clone(),
            row.remark(),
            format!("{source}{formula}; {checked}"),
        ];
        let _ = writeln!(text, "| {} |", cells.map(|text| cell(&text)).join(" | "));
    }
    text
}

/// Rows below their headings, each column as wide as its longest cell.
fn aligned<const N: usize>(headings: [&str; N], rows: Vec<[String; N]>) -> Vec<String> {
    let all: Vec<[String; N]> = std::iter::once(headings.map(str::to_string)).chain(rows).collect();
    let width = |column: usize| all.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; N] = std::array::from_fn(width);
    let line = |row: &[String; N]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_string()
    };
    all.iter().map(line).collect()
}
