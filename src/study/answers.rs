//! The quantities of a scene: their intervals, the values of displacement models in them, and the checks that follow.

use super::Certified;
use super::adaptive::Wanted;
use crate::compare::{Allowances, Basis, Check, Comparison, Judged};
use crate::dual::{Factorised, Motion, Options};
use crate::element::{Displacement, Elements, StressField};
use crate::problem::{Problem, Scales};
use crate::quantity::{Functional, Interval, Kind, Known, NotBounded, displaced, value_of};
use crate::report::{QuantityOfModel, QuantitySummary};
use crate::scene::Quantity;

/// How far, in units of what its own energy leaves open, the value of a displacement model may lie outside an interval.
const OWN_ERROR: f64 = 2.0;

/// What solvers leave of a value, relative to what such a quantity can be.
const SOLVED: f64 = 1e-8;

/// A quantity and what is guaranteed of it.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Its name.
    pub name: String,
    /// Its interval; both ends infinite, with the reason, where none is known.
    pub interval: Interval,
    /// What it is.
    pub kind: Kind,
}

/// A value of a quantity that comes without a field.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenValue {
    /// Name of the quantity.
    pub name: String,
    /// The value.
    pub value: f64,
}

/// Refuses quantities that do not fit the mesh.
///
/// # Errors
/// A sentence that names the quantity.
pub fn refuse_quantities(problem: &Problem) -> Result<(), String> {
    for quantity in &problem.scene.quantities {
        match Functional::new(problem, quantity) {
            Ok(_) | Err(NotBounded::Shared { .. }) => {}
            Err(error) => return Err(format!("quantity '{}': {error}", quantity.name)),
        }
    }
    Ok(())
}

/// The intervals of the quantities of a problem that was solved with `options`, all of them or those that are `wanted`.
pub fn answers(certified: &Certified, options: &Options, wanted: impl Fn(&str) -> bool) -> Vec<Answer> {
    let quantities: Vec<&Quantity> =
        certified.problem.scene.quantities.iter().filter(|quantity| wanted(&quantity.name)).collect();
    if quantities.is_empty() {
        return Vec::new();
    }
    options.on_threads(|| bounded(certified, options, &quantities))
}

/// Their intervals, one after the other.
fn bounded(certified: &Certified, options: &Options, quantities: &[&Quantity]) -> Vec<Answer> {
    let Certified { problem, statics, dual, bracket } = certified;
    let motions = statics.held_at_vertices(problem);
    let own;
    let factorised: Result<&Factorised, String> = match &dual.factorised {
        Some(kept) => Ok(kept),
        None => {
            let options = Options { elements: elements(options, &dual.stress), ..options.clone() };
            own = Factorised::new(problem, &motions, &options).map_err(|error| error.to_string());
            own.as_ref().map_err(Clone::clone)
        }
    };
    let known = factorised.and_then(|factorised| {
        let free = bracket.free.as_ref().map_err(|error| error.to_string())?;
        Known::new(problem, dual, bracket, free, factorised, options)
    });
    let answer = |quantity: &&Quantity| {
        let name = quantity.name.clone();
        match (Functional::new(problem, quantity), &known) {
            (Ok(functional), _) if motions.iter().any(|motion| changes(problem, &functional, motion)) => {
                let reason = "a motion that neither supports nor closed contacts resist changes it";
                Answer { name, kind: functional.kind, interval: Interval::unknown(reason) }
            }
            (Ok(functional), Ok(known)) => {
                let interval = known.interval(&functional);
                Answer { name, kind: functional.kind, interval }
            }
            (Ok(functional), Err(reason)) => {
                let kind = functional.kind;
                Answer { name, kind, interval: Interval::unknown(reason) }
            }
            (Err(error), _) => Answer { name, kind: Kind::Force, interval: Interval::unknown(&error.to_string()) },
        }
    };
    quantities.iter().map(answer).collect()
}

/// Those of the stresses: of the options, or blocks where refinement has chosen other degrees.
fn elements(options: &Options, stress: &StressField) -> Elements {
    let degrees = || (0..stress.len()).map(|t| stress.degree(t));
    match &options.elements {
        Elements::Uniform(element) if degrees().all(|degree| degree == element.degree()) => options.elements.clone(),
        _ => Elements::Blocks(degrees().map(|degree| degree as u8).collect()),
    }
}

/// Part of the largest displacement of a motion that is none.
const UNMOVED: f64 = 1e-9;

/// Whether a rigid motion changes a quantity.
fn changes(problem: &Problem, functional: &Functional, motion: &Motion) -> bool {
    let largest = motion.iter().fold(0.0_f64, |m, u| m.max(u[0].hypot(u[1])));
    let load = &functional.load;
    let is_displacement = !load.tractions.is_empty() || load.force.iter().any(|f| *f != [0.0; 2]);
    is_displacement
        && displaced(problem, functional, &Displacement::from_p1(&problem.mesh, motion)).abs() > UNMOVED * largest
}

/// The rows of the report: every answer with the values of the displacement models that were `compared`.
pub fn summaries(certified: &Certified, answers: &[Answer], comparison: &Comparison) -> Vec<QuantitySummary> {
    let summary = |answer: &Answer| {
        let Interval { ends: [lower, upper], first_order, value, exact_by_statics, rounding, reasons, .. } =
            &answer.interval;
        let known = answer.interval.has_an_end();
        let primal = |(judged, value): (&Judged, Option<f64>)| QuantityOfModel {
            solver: judged.candidate.name.clone(),
            degree: judged.candidate.degree,
            value,
            reason: value.is_none().then(|| not_told(certified, answer)),
            inside: value.filter(|_| known).map(|v| answer.interval.outside(v) == 0.0),
        };
        QuantitySummary {
            name: answer.name.clone(),
            kind: answer.kind.name().to_string(),
            value: *value,
            lower: *lower,
            upper: *upper,
            first_order: *first_order,
            exact_by_statics: *exact_by_statics,
            rounding: *rounding,
            primal: comparison.judged.iter().zip(values_in(certified, answer, comparison)).map(primal).collect(),
            reason: reasons.iter().flatten().next().cloned(),
        }
    };
    answers.iter().map(summary).collect()
}

/// The values of a quantity in the displacement models, on their own mesh.
fn values_in(certified: &Certified, answer: &Answer, comparison: &Comparison) -> Vec<Option<f64>> {
    let problem = &certified.problem;
    let quantity = problem.scene.quantities.iter().find(|quantity| quantity.name == answer.name);
    let functional = quantity.and_then(|quantity| Functional::new(problem, quantity).ok());
    let value = |judged: &Judged| {
        value_of(problem, functional.as_ref()?, &judged.field.displacement).filter(|value| value.is_finite())
    };
    comparison.judged.iter().map(value).collect()
}

/// Why a displacement has no value of a quantity.
fn not_told(certified: &Certified, answer: &Answer) -> String {
    let problem = &certified.problem;
    let quantity = problem.scene.quantities.iter().find(|quantity| quantity.name == answer.name);
    match quantity.map(|quantity| Functional::new(problem, quantity)) {
        Some(Err(error)) => error.to_string(),
        Some(Ok(functional)) if functional.lift.is_none() && functional.load.weights.iter().any(|w| !w.is_empty()) => {
            "the contact shares a vertex with a support or another contact, or its direction turns: no displacement of the \
             mesh moves it alone, and how they share the force there is not told"
                .to_string()
        }
        _ => "the displacement has no finite value of it".to_string(),
    }
}

/// How a value outside an interval is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meant {
    /// A discrete solution on this mesh: what its own energy leaves open is allowed.
    Discrete,
    /// The exact value.
    Exact,
}

/// One check for every quantity and displacement model.
pub fn quantity_checks(
    certified: &Certified,
    answers: &[Answer],
    comparison: &Comparison,
    meant: Meant,
    allow: &Allowances,
) -> Vec<Check> {
    let mut checks = Vec::new();
    let scales = Scales::new(&certified.problem);
    for answer in answers.iter().filter(|answer| answer.interval.has_an_end()) {
        for (judged, value) in comparison.judged.iter().zip(values_in(certified, answer, comparison)) {
            let field = &judged.candidate.name;
            let Some(value) = value else { continue };
            let own = match meant {
                Meant::Exact => 0.0,
                Meant::Discrete => OWN_ERROR * own_error(certified, answer, judged),
            };
            if !own.is_finite() {
                continue;
            }
            let whose = if own > 0.0 {
                format!("{field} may miss it by what its own energy leaves open")
            } else {
                format!("no correct value lies outside, and that of {field} has to lie inside")
            };
            let allowed = own + SOLVED * answer.kind.size(&certified.problem, &scales.data);
            checks.push(inside(&format!("quantity/{}/{field}", answer.name), answer, value, allowed, &whose));
        }
    }
    allow.apply(&mut checks);
    checks
}

/// One check for every value that was given.
pub fn value_checks(answers: &[Answer], given: &[GivenValue], allow: &Allowances) -> Vec<Check> {
    let check = |given: &GivenValue| {
        let name = format!("quantity/{}/given", given.name);
        match answers.iter().find(|answer| answer.name == given.name) {
            Some(answer) if answer.interval.has_an_end() => {
                inside(&name, answer, given.value, 0.0, "no correct value lies outside")
            }
            Some(answer) => {
                let reason = answer.interval.reasons.iter().flatten().next().cloned().unwrap_or_default();
                Check::not_made(&name, 0.0, Basis::Guaranteed, format!("There is no interval for it: {reason}."))
            }
            None => Check::not_made(&name, 0.0, Basis::Guaranteed, "The scene has no quantity of this name."),
        }
    };
    let mut checks: Vec<Check> = given.iter().map(check).collect();
    allow.apply(&mut checks);
    checks
}

/// One check for every quantity that was to be known more closely.
pub fn wanted_checks(answers: &[Answer], wanted: &[Wanted], allow: &Allowances) -> Vec<Check> {
    let check = |wanted: &Wanted| {
        let name = format!("quantity/{}/tolerance", wanted.name);
        match answers.iter().find(|answer| answer.name == wanted.name) {
            Some(Answer { interval, .. }) if interval.half_width().is_finite() => Check::at_most(
                &name,
                interval.half_width() / interval.value.abs(),
                0.0,
                wanted.tolerance,
                Basis::Asked,
                "The half-width of the interval, relative to the value, against the tolerance that was asked for.",
            ),
            _ => Check::not_made(&name, wanted.tolerance, Basis::Asked, "There is no interval with two ends."),
        }
    };
    let mut checks: Vec<Check> = wanted.iter().map(check).collect();
    allow.apply(&mut checks);
    checks
}

/// A check that `value` lies in the interval, or outside by no more than `allowed`.
fn inside(name: &str, answer: &Answer, value: f64, allowed: f64, whose: &str) -> Check {
    let [lower, upper] = answer.interval.ends;
    let nearest = value.max(lower).min(upper);
    let why = format!(
        "The exact {} '{}' lies between {lower:.9e} and {upper:.9e}; {whose}.",
        answer.kind.name(),
        answer.name
    );
    Check::with_difference(name, value, nearest, answer.interval.outside(value), allowed, Basis::Guaranteed, why)
}

/// What the energy of a displacement leaves open of its value: the width of first order belongs to H, its own error to its
/// own gap.
fn own_error(certified: &Certified, answer: &Answer, judged: &Judged) -> f64 {
    let bracket = &certified.bracket;
    let of_bracket = bracket.free.as_ref().map_or(0.0, |free| free.upper() - bracket.lower());
    let own = (judged.admissible.upper() - bracket.lower()).max(0.0);
    let [low, high] = answer.interval.first_order;
    let [lower, upper] = answer.interval.ends;
    let width = if (high - low).is_finite() { high - low } else { upper - lower };
    if of_bracket > 0.0 && width.is_finite() { width * (own / of_bracket).sqrt() } else { f64::INFINITY }
}
