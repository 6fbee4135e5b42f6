//! The differences of two reports on a terminal.

use std::fmt::Write;

use super::compare::{CheckChange, Difference, Kind, is_same_scene, word};
use crate::compare::Check;
use crate::report::text::number::{digits_to_tell, optional, seconds, significant};

/// The differences in lines; `names` are those of the two reports.
pub fn text(difference: &Difference, names: [&str; 2]) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    for (name, report) in names.iter().zip(&difference.reports) {
        let _ = writeln!(
            text,
            "{name}: {} of {}, {} (hypercircle {}, run {})",
            report.command,
            report.scene,
            word(report.status),
            report.provenance.version,
            report.run
        );
    }
    for contradiction in &difference.contradictions {
        let _ = writeln!(text, "contradiction: {contradiction}");
    }
    for note in &difference.notes {
        let _ = writeln!(text, "note: {note}");
    }
    for change in difference.checks.iter().filter(|change| change.kind != Kind::Same) {
        let _ = writeln!(text, "{}", check_line(change));
    }
    let same = difference.count(Kind::Same);
    let _ = writeln!(text, "{same} of {} checks are the same", difference.checks.len());
    for number in difference.numbers.iter().filter(|number| number.is_changed()) {
        let [a, b] = pair(number.values);
        let by = number.difference().map_or(String::new(), |by| format!(", by {}", significant(by, 3)));
        let _ = writeln!(text, "  {}: {a} → {b}{by}", number.name);
    }
    let [a, b] = [0, 1].map(|i| difference.reports[i].seconds().map_or("–".to_string(), seconds));
    let _ = writeln!(text, "time, for information: {a} → {b}");
    let _ = writeln!(text, "{}", verdict(difference));
    text
}

/// The verdict of the comparison, in one sentence.
pub(super) fn verdict(difference: &Difference) -> String {
    if !difference.contradictions.is_empty() {
        return "The two reports contradict each other.".to_string();
    }
    if !difference.is_decisive() {
        let [first, second] = &difference.reports;
        return match is_same_scene(first, second) {
            true => "Nothing decisive differs.".to_string(),
            false => "No verdict differs; the scenes do, and their numbers need not be the same.".to_string(),
        };
    }
    let counts = [Kind::Broken, Kind::Mended, Kind::New, Kind::Missing].map(|kind| (kind, difference.count(kind)));
    let told: Vec<String> =
        counts.iter().filter(|(_, n)| *n > 0).map(|(kind, n)| format!("{n} {}", kind.words())).collect();
    match told.as_slice() {
        [] => "The verdicts differ.".to_string(),
        told => format!("Outcomes differ: {}.", told.join(", ")),
    }
}

/// Two numbers with as many digits as tell them apart.
pub(super) fn pair(values: [Option<f64>; 2]) -> [String; 2] {
    let digits = match values {
        [Some(a), Some(b)] => digits_to_tell(a, b),
        _ => 7,
    };
    values.map(|value| optional(value, digits))
}

fn check_line(change: &CheckChange) -> String {
    let [a, b] = pair(change.checks.each_ref().map(|check| check.as_ref().and_then(|check| check.value)));
    let remark = if change.checks.iter().flatten().all(Check::decides) { "" } else { " (remark)" };
    let values = match change.kind {
        Kind::New => b,
        Kind::Missing => a,
        _ => format!("{a} → {b}"),
    };
    let by = difference(change).map_or(String::new(), |by| format!(", by {}", significant(by, 3)));
    format!("  {}: {}{remark}: {values}{by}", change.kind.words(), change.name)
}

/// By how much the value of a check moved.
pub(super) fn difference(change: &CheckChange) -> Option<f64> {
    let [a, b] = change.checks.each_ref().map(|check| check.as_ref().and_then(|check| check.value));
    a.zip(b).map(|(a, b)| b - a)
}
