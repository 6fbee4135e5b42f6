//! From every check to its picture, and back.

use maud::{Markup, html};

use crate::compare::Name;
use crate::compare::name::{OfField, OfRun};
use crate::report::text::number::clean;
use crate::report::{Check, Report};

/// The id of the row of a check.
pub(super) fn row(report: &Report, check: &Check) -> String {
    let position = |list: &[Check]| list.iter().position(|other| other.name == check.name);
    match (position(&report.checks), position(&report.remarks)) {
        (Some(i), _) => format!("check-{i}"),
        (None, i) => format!("remark-{}", i.unwrap_or(0)),
    }
}

/// The id of the picture that shows what a check is about; `None` where there is none.
pub(super) fn picture(report: &Report, check: &Check) -> Option<String> {
    let read = Name::read(&check.name);
    if let Some(i) = report.contact.iter().position(|contact| Some(contact.name.as_str()) == read.contact()) {
        return Some(format!("pressure-{i}"));
    }
    if let Name::Quantity(quantity, _) = read {
        let own = report.quantities.iter().position(|own| own.name == quantity);
        return own.map(|i| format!("quantity-{i}"));
    }
    use OfField::{
        Admissible, Coulomb, EnergyError, Equilibrium, FrictionForce, GapTwoWays, Identity, LowerBelow, Reactions,
        Recomputed, Strain, StressDifference,
    };
    let bracket = || report.energy.as_ref().map(|_| "bracket".to_string());
    let map = || report.stress.as_ref().map(|_| "map".to_string());
    match read {
        Name::Run(OfRun::Sharpness | OfRun::Tolerance) | Name::Order(..) => bracket(),
        Name::Field(Coulomb | EnergyError | GapTwoWays | Identity | LowerBelow | Recomputed | Strain, _) => bracket(),
        Name::Run(_) | Name::SolutionContact(..) => map(),
        Name::Field(Equilibrium | Reactions | StressDifference, _) => map(),
        Name::Field(Admissible, _) => Some("shapes".to_string()),
        Name::Field(FrictionForce, _) | Name::Contact(..) | Name::Quantity(..) | Name::Baseline(_) | Name::Other => {
            None
        }
    }
}

/// Which checks a picture is about, the failing ones first.
pub(super) fn checks_of(id: &str, report: &Report) -> Markup {
    let mut own: Vec<&Check> = report
        .checks
        .iter()
        .chain(&report.remarks)
        .filter(|check| picture(report, check).as_deref() == Some(id))
        .collect();
    own.sort_by_key(|check| (check.passed, !check.decides()));
    let failed = own.iter().filter(|check| !check.passed && check.decides()).count();
    html! {
        @if !own.is_empty() {
            details.back open[failed > 0] {
                summary {
                    (own.len()) @if own.len() == 1 { " related check" } @else { " related checks" }
                    @if failed > 0 { ", " b.not { (failed) " not passed" } }
                }
                ul { @for check in own {
                    li { a href={ "#" (row(report, check)) } { code { (clean(&check.name)) } }
                        @if !check.passed && check.decides() { b.not { " ✘" } } }
                } }
            }
        }
    }
}
