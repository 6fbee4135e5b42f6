//! Groups checks that fail together under one cause, with its place, a likely reason and a remedy.
//!
//! A mistake rarely fails one check only. A displacement model that lacks a row of a contact is not admissible, has an energy
//! below the bound, stresses too far from those in equilibrium, and wrong reactions. Read one by one such failures contradict each
//! other; read together they have a field in common, and the most direct of the checks says what is wrong with it. Where
//! a [`Diagnosis`] found the mistake, that is the cause.

mod advice;
mod field;
mod place;
mod told;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::compare::name::{FREE_BOUND, OfRun, WIDTH};
use crate::compare::{Basis, Check, Comparison, Name};
use crate::diagnose::Diagnosis;
use crate::problem::Problem;
pub use place::Place;
pub use told::{outcome, told};

/// One reason for checks that did not pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cause {
    /// Stable name: that of the diagnosis where there is one, otherwise of the kind of failure.
    pub name: String,
    /// What failed and where.
    pub sentence: String,
    /// Where; `null` where it concerns the whole scene or no place at all.
    pub place: Option<Place>,
    /// What it suggests.
    pub suggests: String,
    /// What to try.
    pub remedy: String,
    /// The checks that it explains, in the order of the report.
    pub checks: Vec<String>,
}

/// The causes of all deciding checks that did not pass: first those in this program's own solution, then those in the
/// displacement fields, then the rest. Every such check belongs to one cause. `refinement` is the remedy for a run that ended
/// before it reached its tolerance.
pub fn causes(
    problem: &Problem,
    comparison: &Comparison,
    diagnosis: &[Diagnosis],
    refinement: Option<&str>,
) -> Vec<Cause> {
    let mut failing: Vec<&Check> = comparison.checks.iter().filter(|c| !c.passed && c.decides()).collect();
    let mut causes = Vec::new();
    let own = taken(&mut failing, |check| is_of_stresses(Name::read(&check.name)));
    causes.extend(of_stresses(problem, &own));
    let of_fields = causes.len();
    causes.extend(field::causes(problem, comparison, diagnosis, &mut failing));
    let stored = taken(&mut failing, |check| matches!(Name::read(&check.name), Name::Baseline(_)));
    let mut missing = taken(&mut failing, |check| check.difference.is_none());
    with_causes(&mut causes[of_fields..], &mut missing);
    causes.extend(of_baseline(&stored));
    causes.extend(missing.into_iter().map(not_made));
    causes.extend(failing.into_iter().map(|check| alone(check, refinement)));
    causes
}

/// True if no displacement field takes part in a check.
fn is_of_stresses(name: Name<'_>) -> bool {
    name == Name::Run(OfRun::DualEquilibrium) || name.field() == Some(FREE_BOUND)
}

/// Adds checks that could not be made to the causes of the failed checks on the same fields: the mistake in a field also
/// prevents its other checks.
fn with_causes(causes: &mut [Cause], missing: &mut Vec<&Check>) {
    missing.retain(|check| {
        let name = Name::read(&check.name);
        let same = |cause: &Cause| match (name, name.field()) {
            (Name::Contact(..), _) => true,
            (_, None) => false,
            (_, field) => cause.checks.iter().any(|own| Name::read(own).field() == field),
        };
        let cause = causes.iter_mut().find(|cause| same(cause));
        cause.map(|cause| cause.checks.push(check.name.clone())).is_none()
    });
}

/// Removes from `failing` the checks for which `is` holds.
fn taken<'a>(failing: &mut Vec<&'a Check>, is: impl Fn(&Check) -> bool) -> Vec<&'a Check> {
    let (own, rest) = failing.drain(..).partition(|check| is(check));
    *failing = rest;
    own
}

fn names(checks: &[&Check]) -> Vec<String> {
    checks.iter().map(|check| check.name.clone()).collect()
}

/// The cause of failures that involve no displacement field.
fn of_stresses(problem: &Problem, own: &[&Check]) -> Option<Cause> {
    let first = own.iter().find(|check| check.name == OfRun::DualEquilibrium.name()).or(own.first())?;
    Some(Cause {
        name: "stresses".to_string(),
        sentence: format!("The stress solution of this program does not hold: {}", told(first)),
        place: None,
        suggests: "No displacement model takes part in this. Digits were lost in the solve, or this is a defect of the program."
            .to_string(),
        remedy: format!(
            "Run the scene with another --method; if that passes, report the defect with the scene {}.",
            problem.scene.name
        ),
        checks: names(own),
    })
}

fn of_baseline(stored: &[&Check]) -> Option<Cause> {
    let excess = |check: &&&Check| check.difference.map_or(f64::INFINITY, |d| d / check.allowed.max(f64::MIN_POSITIVE));
    let worst = stored.iter().max_by(|a, b| excess(a).total_cmp(&excess(b)))?;
    let rest = match stored.len() - 1 {
        0 => String::new(),
        1 => " One other number differs too.".to_string(),
        n => format!(" {n} other numbers differ too."),
    };
    Some(Cause {
        name: "baseline".to_string(),
        sentence: format!("The run is not what the baseline has: {}{rest}", told(worst)),
        place: None,
        suggests: "The scene, the mesh or a program has changed since the baseline was accepted.".to_string(),
        remedy: "Look at what changed; if it is meant to be so, accept the numbers with --accept.".to_string(),
        checks: names(stored),
    })
}

fn not_made(check: &Check) -> Cause {
    Cause {
        name: "not-made".to_string(),
        sentence: format!("{} was not made: {}", check.name, check.why),
        place: None,
        suggests: "Nothing is known of what this check asks, so it does not count as passed.".to_string(),
        remedy: "Mend what stood in its way, as the sentence above says, and run the scene again.".to_string(),
        checks: vec![check.name.clone()],
    }
}

/// The cause of a failure that belongs to no other.
fn alone(check: &Check, refinement: Option<&str>) -> Cause {
    let name = Name::read(&check.name);
    let is_tolerance = matches!(name, Name::Run(OfRun::Tolerance) | Name::Quantity(_, WIDTH));
    let [suggests, remedy] = match (check.basis, refinement.filter(|_| is_tolerance)) {
        (Basis::Asked, Some(remedy)) => ["What was asked for was not reached.", remedy],
        (Basis::Asked, None) => [
            "What was asked for was not reached; theory allows it.",
            "Refine further, with a larger --max-triangles or --max-seconds, or ask for less.",
        ],
        _ if matches!(name, Name::Quantity(..)) => advice::of(advice::Kind::Value, ""),
        _ => advice::ALONE,
    };
    Cause {
        name: check.name.clone(),
        sentence: told(check),
        place: None,
        suggests: suggests.to_string(),
        remedy: remedy.to_string(),
        checks: vec![check.name.clone()],
    }
}
