//! The verdict in words.

use super::{Findings, in_numbers};
use crate::cause::Cause;
use crate::compare::name::{GIVEN, Name};
use crate::report::text::number::{at_most_percent, digits_to_tell, enclosing, percent};
use crate::report::{Energy, Status};
use crate::scene::capital;
use crate::study::coulomb::Coulomb;

/// The verdict in one sentence.
pub(in crate::study) fn verdict(
    findings: &Findings<'_>,
    status: Status,
    energy: Option<&Energy>,
    causes: &[Cause],
) -> String {
    if let Some(failure) = &findings.failure {
        return format!("No comparison was made: {failure}");
    }
    let failed = findings.comparison.checks.iter().filter(|c| !c.passed && c.decides());
    let failed: Vec<&str> = failed.map(|c| c.name.as_str()).collect();
    let bound = energy.map_or(String::new(), |e| {
        let [lower, upper] = enclosing([e.lower, e.upper], digits_to_tell(e.lower, e.upper));
        let what = if e.guaranteed { "guaranteed" } else { "indicated" };
        let (whose, of) = match of_which(findings) {
            ("", of) if !e.guaranteed => ("for the scene as this mesh represents it, ", of),
            which => which,
        };
        let sentence = format!(
            "{whose}the exact energy{of} lies between {lower} and {upper}; the {what} relative energy-norm error is at most {}.",
            at_most_percent(e.relative_error_bound)
        );
        format!(" {}", capital(&sentence))
    });
    let excused = findings.comparison.checks.iter().filter(|c| c.excused && c.decides());
    let excused: Vec<&str> = excused.map(|c| c.name.as_str()).collect();
    let allowances = match excused.as_slice() {
        [] => String::new(),
        names => format!(", with what was allowed for {}", names.join(", ")),
    };
    let bound = if findings.command == "certify" { of_field(findings, energy) } else { bound };
    let told = causes.first().map_or(String::new(), |cause| format!("{} ", cause.sentence));
    let told = match causes.len() {
        0 | 1 => told,
        2 => format!("{told}There is one more cause. "),
        n => format!("{told}There are {} more causes. ", n - 1),
    };
    let models = findings.comparison.judged.len();
    match (failed.as_slice(), models) {
        ([], _) if findings.coulomb.is_some_and(Coulomb::has_several) => {
            format!("No check failed, but Coulomb's law has several solutions here.{bound}")
        }
        ([], _) if status == Status::Undecided => {
            format!("No check failed, but the bracket is too wide to tell the two models apart.{bound}")
        }
        ([], 0) => {
            format!("{}{bound}", given_values(findings).unwrap_or("Both bounds passed every check.".to_string()))
        }
        ([], _) if findings.command == "certify" => {
            let claim = if findings.is_claimed { "the discrete solution it claims to be" } else { "admissible" };
            format!("The displacement field is {claim}{allowances}, and its energy respects the bound.{bound}")
        }
        ([], _) => format!("The stress and displacement models agree{allowances}.{bound}"),
        ([one], _) => format!("{told}One check failed: {one}.{bound}"),
        (several, _) => format!("{told}{} checks failed, first {}.{bound}", several.len(), several[0]),
    }
}

/// Differences of a friction bound below this part are digits.
const DIGITS: f64 = 1e-6;

/// The problem that numbers are for where it is not the scene: what precedes "the exact energy", and what follows it.
fn of_which(findings: &Findings<'_>) -> (&'static str, String) {
    let Some(coulomb) = findings.coulomb else { return ("", String::new()) };
    let off = match coulomb.farthest() {
        off if off < DIGITS => String::new(),
        off => format!(" but for {} of its force", percent(off)),
    };
    let what = format!(" (the bound is the coefficient of friction times the pressure{off})");
    ("for the friction bound that was found, ", what)
}

/// Says where values lie that were given without a field and passed; `None` without any.
fn given_values(findings: &Findings<'_>) -> Option<String> {
    let of_value = |name: &str| match Name::read(name) {
        Name::Quantity(quantity, GIVEN) => Some(quantity.to_string()),
        _ => None,
    };
    let given = || findings.comparison.checks.iter().filter_map(|check| Some((of_value(&check.name)?, check)));
    let names: Vec<String> = given().map(|(name, _)| name).collect();
    let rounded = given().any(|(_, check)| check.difference.is_some_and(|difference| difference > 0.0));
    let but = |digits: &'static str| if rounded { digits } else { "" };
    match names.as_slice() {
        [] => None,
        [one] => Some(format!(
            "The value given for {one} lies in its interval{}.",
            but(", but for the digits that it lacks")
        )),
        several => Some(format!(
            "The values given for {} lie in their intervals{}.",
            several.join(", "),
            but(", but for the digits that they lack")
        )),
    }
}

/// The guarantee for a field that was handed in, not for the best field that the program has.
fn of_field(findings: &Findings<'_>, energy: Option<&Energy>) -> String {
    let sharpest = findings.finer.map_or(&findings.certified.bracket, |finer| &finer.bracket);
    let Some((energy, judged)) = energy.zip(findings.comparison.judged.first()) else { return String::new() };
    let name = &judged.candidate.name;
    let of = if judged.is_admissible() { name.clone() } else { format!("the admissible field nearest to {name}") };
    let what = if energy.guaranteed { "guaranteed" } else { "indicated" };
    let upper = judged.admissible.upper();
    let [lower, own] = enclosing([energy.lower, upper], digits_to_tell(energy.lower, upper));
    let (whose, bound) = of_which(findings);
    let sentence = format!(
        "{whose}the {what} relative energy-norm error of {of} is at most {}: its energy{bound} is {own}, and the exact one is no lower than {lower}.",
        at_most_percent(in_numbers(judged.relative_error(sharpest))),
    );
    format!(" {}", capital(&sentence))
}
