//! Changes between two reports.

use crate::compare::{Basis, Check};
use crate::report::{Status, Stored};

/// Relative change below which two numbers count as the same: other builds and machines round differently.
const ROUNDING: f64 = 1e-9;

/// Two reports, and what is different.
#[derive(Debug)]
pub struct Difference {
    /// The two reports.
    pub reports: [Stored; 2],
    /// Checks, the changed ones first.
    pub checks: Vec<CheckChange>,
    /// Energies, quantities and contacts that both or one of them have.
    pub numbers: Vec<NumberChange>,
    /// Intervals of the same scene that have no point in common, one sentence each.
    pub contradictions: Vec<String>,
    /// Remarks to read before comparing.
    pub notes: Vec<String>,
}

/// One check in both reports, or in one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckChange {
    /// Its name.
    pub name: String,
    /// The kind of change.
    pub kind: Kind,
    /// As it is in each.
    pub checks: [Option<Check>; 2],
}

/// Kinds of changes of a check, in the order in which they are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// It passed in the first report, and does not in the second.
    Broken,
    /// It did not pass in the first report, and does in the second.
    Mended,
    /// The outcome is the same, and the value is not.
    Moved,
    /// Only in the second report.
    New,
    /// Only in the first report.
    Missing,
    /// Neither the outcome nor the value changed.
    Same,
}

/// A number in both reports, or in one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct NumberChange {
    /// Its name, such as “energy: lower bound”.
    pub name: String,
    /// Its value in each.
    pub values: [Option<f64>; 2],
}

impl NumberChange {
    /// The difference, second less first; `None` where one of them is missing.
    pub fn difference(&self) -> Option<f64> {
        self.values[0].zip(self.values[1]).map(|(a, b)| b - a)
    }

    /// True if the change is more than rounding.
    pub fn is_changed(&self) -> bool {
        moved(self.values)
    }
}

impl Kind {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Kind::Broken => "passed → failed",
            Kind::Mended => "failed → passed",
            Kind::Moved => "value changed",
            Kind::New => "new",
            Kind::Missing => "missing",
            Kind::Same => "same",
        }
    }
}

impl Difference {
    /// True if a check has another outcome, or the two reports contradict each other: then one of them is wrong, or something was
    /// broken or mended between them.
    pub fn is_decisive(&self) -> bool {
        let [first, second] = &self.reports;
        !self.contradictions.is_empty() || first.status != second.status || self.checks.iter().any(|c| self.decides(c))
    }

    /// True if a change of a check matters: another outcome does, and so does a check that was not made again.
    fn decides(&self, change: &CheckChange) -> bool {
        let [first, second] = &self.reports;
        match change.kind {
            Kind::Broken | Kind::Mended => change.checks.iter().flatten().all(Check::decides),
            Kind::New => change.checks[1].as_ref().is_some_and(|check| check.decides() && !check.passed),
            Kind::Missing => first.command == second.command && change.checks[0].as_ref().is_some_and(Check::decides),
            Kind::Moved | Kind::Same => false,
        }
    }

    /// How many checks are of that kind.
    pub fn count(&self, kind: Kind) -> usize {
        self.checks.iter().filter(|change| change.kind == kind).count()
    }
}

/// Compares `first` with `second`.
pub fn compare(first: Stored, second: Stored) -> Difference {
    let checks = checks(&first, &second);
    let numbers = numbers(&first, &second);
    let (contradictions, notes) = (contradictions(&first, &second), notes(&first, &second));
    Difference { reports: [first, second], checks, numbers, contradictions, notes }
}

fn moved([a, b]: [Option<f64>; 2]) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() > ROUNDING * a.abs().max(b.abs()),
        (a, b) => a.is_some() != b.is_some(),
    }
}

fn checks(first: &Stored, second: &Stored) -> Vec<CheckChange> {
    let all = |report: &Stored| -> Vec<Check> { report.checks.iter().chain(&report.remarks).cloned().collect() };
    let [first, second] = [all(first), all(second)];
    let find = |list: &[Check], name: &str| list.iter().find(|check| check.name == name).cloned();
    let own = first.iter().map(|check| change(&check.name, [Some(check.clone()), find(&second, &check.name)]));
    let new = second.iter().filter(|check| find(&first, &check.name).is_none());
    let mut all: Vec<CheckChange> =
        own.chain(new.map(|check| change(&check.name, [None, Some(check.clone())]))).collect();
    // Of one kind, those that decide come first.
    all.sort_by_key(|change| (change.kind, change.checks.iter().flatten().any(|check| !check.decides())));
    all
}

/// True if the numbers of a check differ. An identity that holds up to round-off counts as moved if it differs by more than that.
fn has_moved(a: &Check, b: &Check) -> bool {
    let slack = if a.basis == Basis::RoundOff { a.allowed } else { 0.0 };
    [[a.value, b.value], [a.reference, b.reference]].into_iter().any(|pair| {
        let near = pair[0].zip(pair[1]).is_some_and(|(a, b)| (a - b).abs() <= slack);
        moved(pair) && !near
    })
}

fn change(name: &str, checks: [Option<Check>; 2]) -> CheckChange {
    let kind = match &checks {
        [Some(a), Some(b)] => match (a.passed, b.passed) {
            (true, false) => Kind::Broken,
            (false, true) => Kind::Mended,
            _ if has_moved(a, b) => Kind::Moved,
            _ => Kind::Same,
        },
        [None, _] => Kind::New,
        [_, None] => Kind::Missing,
    };
    CheckChange { name: name.to_string(), kind, checks }
}

/// Names and values of what can be compared, in the order of the report.
fn values(report: &Stored) -> Vec<(String, Option<f64>)> {
    let mut list = Vec::new();
    let energy = report.energy;
    list.push(("energy: lower bound".to_string(), energy.and_then(|energy| energy.lower)));
    list.push(("energy: upper bound".to_string(), energy.and_then(|energy| energy.upper)));
    list.push(("relative error at most".to_string(), energy.and_then(|energy| energy.relative_error_bound)));
    list.push(("triangles".to_string(), report.dual.as_ref().map(|dual| dual.triangles as f64)));
    list.extend(report.primal.iter().map(|primal| (format!("energy: {}", primal.name), primal.energy)));
    for quantity in &report.quantities {
        for (what, value) in [("value", quantity.value), ("lower", quantity.lower), ("upper", quantity.upper)] {
            list.push((format!("{}: {what}", quantity.name), value));
        }
    }
    for contact in &report.contact {
        let [x, y] = contact.resultant.dual;
        for (what, value) in [("force x", x), ("force y", y), ("largest pressure", contact.pressure_max.dual)] {
            list.push((format!("{}: {what}", contact.name), value));
        }
    }
    list
}

fn numbers(first: &Stored, second: &Stored) -> Vec<NumberChange> {
    let [first, second] = [values(first), values(second)];
    let find = |list: &[(String, Option<f64>)], name: &str| list.iter().find(|(n, _)| n == name).and_then(|(_, v)| *v);
    let new = second.iter().filter(|(name, _)| !first.iter().any(|(n, _)| n == name));
    let names = first.iter().chain(new).map(|(name, _)| name);
    let number = |name: &String| NumberChange { name: name.clone(), values: [find(&first, name), find(&second, name)] };
    names.map(number).filter(|number| number.values.iter().any(Option::is_some)).collect()
}

/// Guaranteed intervals of one scene that have no point in common.
fn contradictions(first: &Stored, second: &Stored) -> Vec<String> {
    if !is_same_scene(first, second) {
        return Vec::new();
    }
    let apart = |what: &str, intervals: [[Option<f64>; 2]; 2]| {
        let [[Some(a), Some(b)], [Some(c), Some(d)]] = intervals else { return None };
        (b < c || d < a).then(|| {
            format!(
                "{what}: between {a:?} and {b:?} in the first report, between {c:?} and {d:?} in the second. Both are guaranteed for \
                 the same scene, so at least one of them is wrong."
            )
        })
    };
    let guaranteed = |report: &Stored| report.energy.filter(|energy| energy.guaranteed).is_some();
    if !(guaranteed(first) && guaranteed(second)) {
        return Vec::new();
    }
    let energy = |report: &Stored| report.energy.map_or([None; 2], |energy| [energy.lower, energy.upper]);
    let mut found: Vec<String> = apart("energy", [energy(first), energy(second)]).into_iter().collect();
    for quantity in &first.quantities {
        if let Some(other) = second.quantities.iter().find(|other| other.name == quantity.name) {
            found.extend(apart(&quantity.name, [[quantity.lower, quantity.upper], [other.lower, other.upper]]));
        }
    }
    found
}

/// True if both are reports of one scene file.
pub(super) fn is_same_scene(first: &Stored, second: &Stored) -> bool {
    let [a, b] = [&first.provenance.scene_sha256, &second.provenance.scene_sha256];
    a == b && !a.is_empty()
}

fn notes(first: &Stored, second: &Stored) -> Vec<String> {
    let mut notes = Vec::new();
    let mut note = |condition: bool, text: String| {
        if condition {
            notes.push(text);
        }
    };
    let [a, b] = [first, second].map(|report| &report.provenance);
    note(
        !is_same_scene(first, second),
        "The two reports are about scene files with different content: their brackets need not meet.".to_string(),
    );
    note(is_same_scene(first, second) && a.mesh_sha256 != b.mesh_sha256, "The meshes are different.".to_string());
    note(
        first.command != second.command,
        format!(
            "The first report is one of `{}`, the second of `{}`: they make different checks.",
            first.command, second.command
        ),
    );
    note(a.version != b.version, format!("They were made by hypercircle {} and {}.", a.version, b.version));
    note(first.run == second.run, "Both are reports of the same run.".to_string());
    notes
}

/// A status as a word.
pub(super) fn word(status: Status) -> &'static str {
    crate::report::text::words::status_word(status)
}

#[cfg(test)]
#[path = "compare_tests.rs"]
mod tests;
