//! Tables for a spreadsheet, comma-separated as in RFC 4180. The last column of each identifies the run.

use super::number::clean;
use super::quantities_csv;
use crate::cause::{outcome, told};
use crate::report::Report;
use crate::scene::Scene;

/// A table that a report leaves where it has rows.
#[derive(Debug, Clone, Copy)]
pub(in crate::report) struct Table {
    /// Its file.
    pub name: &'static str,
    columns: &'static [&'static str],
    rows: fn(&Report) -> Vec<Vec<String>>,
}

/// All of them.
pub(in crate::report) const TABLES: [Table; 3] = [
    Table { name: "quantities.csv", columns: &quantities_csv::COLUMNS, rows: quantities_csv::rows },
    Table { name: "checks.csv", columns: &CHECKS, rows: checks },
    Table { name: "contacts.csv", columns: &CONTACTS, rows: contacts },
];

const CHECKS: [&str; 11] = [
    "check",
    "outcome",
    "decides",
    "value",
    "reference",
    "difference",
    "allowed",
    "margin",
    "basis",
    "what_came_of_it",
    "run",
];
const CONTACTS: [&str; 5] = ["contact", "model", "arc_length", "pressure", "run"];

/// The tables that a run on `scene` can leave.
pub fn tables_of(scene: &Scene) -> impl Iterator<Item = &'static str> {
    let (quantities, contacts) = (!scene.quantities.is_empty(), !scene.contacts.is_empty());
    let there = move |table: &Table| match table.name {
        "quantities.csv" => quantities,
        "contacts.csv" => contacts,
        _ => true,
    };
    TABLES.into_iter().filter(there).map(|table| table.name)
}

/// The tables of a report that have rows, by the names of their files.
pub fn tables(report: &Report) -> Vec<(&'static str, String)> {
    TABLES.iter().filter_map(|table| Some((table.name, table.of(report)?))).collect()
}

impl Table {
    /// The first line.
    pub fn header(&self) -> String {
        self.columns.join(",") + "\r\n"
    }

    /// The whole file; `None` where it has no rows.
    pub fn of(&self, report: &Report) -> Option<String> {
        let rows = (self.rows)(report);
        let line = |row: Vec<String>| row.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",") + "\r\n";
        (!rows.is_empty()).then(|| self.header() + &rows.into_iter().map(line).collect::<String>())
    }
}

/// A number as a program reads it; one that is missing or not finite is an empty cell.
pub(in crate::report) fn cell(x: Option<f64>) -> String {
    x.filter(|x| x.is_finite()).map_or(String::new(), |x| format!("{x:?}"))
}

fn checks(report: &Report) -> Vec<Vec<String>> {
    let row = |check: &crate::compare::Check| {
        vec![
            check.name.clone(),
            outcome(check).to_string(),
            check.decides().to_string(),
            cell(check.value),
            cell(check.reference),
            cell(check.difference),
            cell(Some(check.allowed)),
            cell(check.margin),
            super::words::basis_word(check.basis).to_string(),
            told(check),
            report.run.clone(),
        ]
    };
    report.checks.iter().chain(&report.remarks).map(row).collect()
}

/// The pressure of every model along every contact; two lines with one arc length are a jump.
fn contacts(report: &Report) -> Vec<Vec<String>> {
    let of = |name: &str, model: &str, [s, p]: [f64; 2]| {
        vec![name.to_string(), model.to_string(), cell(Some(s)), cell(Some(p)), report.run.clone()]
    };
    let mut rows = Vec::new();
    for contact in &report.contact {
        for profile in &contact.profiles {
            rows.extend(profile.points.iter().map(|point| of(&contact.name, &profile.model, *point)));
        }
    }
    rows
}

/// A cell on one line, in quotes where it needs them.
fn quoted(cell: &str) -> String {
    let cell = clean(cell).replace(['\n', '\t'], " ");
    if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn every_check_and_every_point_of_a_pressure_has_a_line() {
        let report = Sample::new(1, Verdict::Disagree).dossier().report;
        let [_, checks, contacts] = TABLES.map(|table| table.of(&report).expect("rows"));
        assert_eq!(checks.lines().count(), 1 + report.checks.len() + report.remarks.len());
        assert!(checks.contains("\r\nenergy.order.P2,failed,true,-1.797"), "{checks}");
        let points: usize = report.contact[0].profiles.iter().map(|profile| profile.points.len()).sum();
        assert_eq!(contacts.lines().count(), 1 + points);
        let columns = |text: &str| text.lines().map(|line| line.matches(',').count()).collect::<Vec<_>>();
        assert!(columns(&contacts).iter().all(|n| *n == CONTACTS.len() - 1), "{contacts}");
        let mut empty = report.clone();
        empty.contact.clear();
        assert!(TABLES[2].of(&empty).is_none());
    }
}
