//! `quantities.csv`: one line for every value of every quantity, with its interval.

use super::csv::cell;
use crate::report::{QuantitySummary, Report};

pub(in crate::report) const COLUMNS: [&str; 16] = [
    "quantity",
    "kind",
    "source",
    "degree",
    "value",
    "inside",
    "outside_by",
    "lower",
    "upper",
    "half_width",
    "relative_half_width",
    "first_order_lower",
    "first_order_upper",
    "exact_by_statics",
    "reason",
    "run",
];

/// How the source of the value that belongs to the interval is called.
const OWN_SOURCE: &str = "hypercircle";

/// The rows. The first of a quantity has the value that belongs to the interval, those after it have the values of
/// displacement models and those that were given; all of them repeat the interval. What is missing or infinite is an empty cell.
pub(in crate::report) fn rows(report: &Report) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for quantity in &report.quantities {
        let mut row = |source: &str, degree: Option<usize>, value: Option<f64>| {
            rows.push(cells(quantity, source, degree, value.filter(|v| v.is_finite()), &report.run).to_vec());
        };
        row(OWN_SOURCE, None, Some(quantity.value));
        for held in quantity.held(report) {
            row(&held.of, held.degree, held.value);
        }
    }
    rows
}

fn cells(
    quantity: &QuantitySummary,
    source: &str,
    degree: Option<usize>,
    value: Option<f64>,
    run: &str,
) -> [String; 16] {
    let number = |x: f64| cell(Some(x));
    let outside = value.filter(|_| quantity.has_an_end()).map(|v| quantity.outside(v));
    [
        quantity.name.clone(),
        quantity.kind.clone(),
        source.to_string(),
        degree.map_or(String::new(), |p| p.to_string()),
        value.map_or(String::new(), number),
        outside.map_or(String::new(), |o| (o == 0.0).to_string()),
        outside.map_or(String::new(), number),
        number(quantity.lower),
        number(quantity.upper),
        number(quantity.half_width()),
        number(quantity.relative_half_width()),
        number(quantity.first_order[0]),
        number(quantity.first_order[1]),
        quantity.exact_by_statics.to_string(),
        quantity.reason.clone().unwrap_or_default(),
        run.to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};
    use crate::report::text::csv::TABLES;

    /// The cells of a line, read as a spreadsheet does.
    fn read(line: &str) -> Vec<String> {
        let (mut cells, mut quoted) = (vec![String::new()], false);
        let mut rest = line.chars().peekable();
        while let Some(c) = rest.next() {
            match c {
                '"' if quoted && rest.peek() == Some(&'"') => {
                    rest.next();
                    cells.last_mut().unwrap().push('"');
                }
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                c => cells.last_mut().unwrap().push(c),
            }
        }
        cells
    }

    #[test]
    fn every_value_has_a_line_with_its_interval() {
        let mut report = Sample::new(1, Verdict::Agree).dossier().report;
        report.quantities[0].name = "a, \"b\"\n".to_string();
        report.quantities[0].primal[0].value = Some(0.85);
        report.quantities[2].primal[0].value = None;
        let text = TABLES[0].of(&report).expect("rows");
        let lines: Vec<Vec<String>> = text.trim_end().split("\r\n").map(read).collect();
        assert_eq!(lines.len(), 1 + 2 * report.quantities.len());
        assert!(lines.iter().all(|cells| cells.len() == COLUMNS.len()), "{text}");
        let at = |line: usize, column: &str| lines[line][COLUMNS.iter().position(|c| *c == column).unwrap()].as_str();
        assert_eq!((at(1, "quantity"), at(1, "source"), at(1, "value")), ("a, \"b\" ", "hypercircle", "0.801"));
        assert_eq!((at(2, "source"), at(2, "degree"), at(2, "inside")), ("FEniCSx P2", "2", "false"));
        assert!((at(2, "outside_by").parse::<f64>().unwrap() - 0.04).abs() < 1e-14);
        // An end that is missing, and its reason.
        assert_eq!((at(3, "lower"), at(3, "upper"), at(3, "half_width")), ("0.2", "", ""));
        assert_eq!((at(3, "reason"), at(5, "exact_by_statics")), ("nothing holds <it>", "true"));
        assert_eq!((at(6, "value"), at(6, "inside"), at(6, "run")), ("", "", report.run.as_str()));
    }
}
