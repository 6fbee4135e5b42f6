//! Values of displacement models and of printouts beside the intervals of quantities: rows of the report, and checks.

use super::Certified;
use super::adaptive::Wanted;
use super::answers::Answer;
use crate::bounds::Bracket;
use crate::compare::name::{GIVEN, WIDTH, of_quantity};
use crate::compare::{Allowances, Basis, Check, Comparison, Judged, weighted_reactions};
use crate::problem::{Problem, Scales};
use crate::quantity::{Form, Interval};
use crate::report::text::number::significant;
use crate::report::{QuantityOfModel, QuantitySummary};

/// How far, in units of what its own energy leaves open, the value of a displacement model may lie outside an interval.
const OWN_ERROR: f64 = 2.0;

/// Error that solvers leave in a value, relative to the size of such a quantity.
const SOLVED: f64 = 1e-8;

/// A half-width beyond this part of the value tells no value.
const NO_VALUE: f64 = 1.0;

/// Half of a unit of the last digit of a value may be this part of what its interval holds; digits that are fewer tell no right value.
const LAST_DIGIT: f64 = 0.005;

/// Of the size of a quantity that the data can cause, the part that is not zero.
const PART_OF_ALL: f64 = 0.1;

/// A value of a quantity that comes without a field.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenValue {
    /// Name of the quantity.
    pub name: String,
    /// The value.
    pub value: f64,
    /// Half of a unit of its last digit.
    pub rounding: f64,
}

impl GivenValue {
    /// A value as it was written, `text`.
    pub fn written(name: String, value: f64, text: &str) -> Self {
        let (digits, exponent) = text.trim().split_once(['e', 'E']).unwrap_or((text.trim(), "0"));
        let decimals = digits.split_once('.').map_or(0, |(_, behind)| behind.len()) as i32;
        let unit = 10.0_f64.powi(exponent.parse::<i32>().unwrap_or(0).saturating_sub(decimals));
        GivenValue { name, value, rounding: 0.5 * unit }
    }

    /// A value with the digits that it needs.
    pub fn new(name: String, value: f64) -> Self {
        Self::written(name, value, &value.to_string())
    }
}

/// The rows of the report: every answer with the values of the displacement models that were `compared`.
pub fn summaries(certified: &Certified, answers: &[Answer], comparison: &Comparison) -> Vec<QuantitySummary> {
    let summary = |answer: &Answer| {
        let Interval { ends: [lower, upper], first_order, value, exact_by_statics, rounding, reasons, .. } =
            &answer.interval;
        let known = answer.interval.has_an_end();
        let primal = |(judged, told): (&Judged, Result<Told, String>)| {
            let (value, reason) = match told {
                Ok(Told { value, remark }) => (Some(value), remark),
                Err(reason) => (None, Some(reason)),
            };
            QuantityOfModel {
                solver: judged.candidate.name.clone(),
                degree: judged.candidate.degree,
                value,
                reason,
                inside: value.filter(|_| known).map(|v| answer.interval.outside(v) == 0.0),
            }
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

/// The values of a quantity in the displacement models, on their own mesh, or why they have none.
fn values_in(certified: &Certified, answer: &Answer, comparison: &Comparison) -> Vec<Result<Told, String>> {
    let problem = &certified.problem;
    let quantity = problem.scene.quantities.iter().find(|quantity| quantity.name == answer.name);
    let form = quantity.map(|quantity| Form::new(problem, quantity));
    let value = |judged: &Judged| match &form {
        Some(Ok(form)) => told(problem, form, judged),
        Some(Err(error)) => Err(error.to_string()),
        None => Err("the scene has no quantity of this name".to_string()),
    };
    comparison.judged.iter().map(value).collect()
}

/// The value of a displacement model.
struct Told {
    value: f64,
    /// A remark on its worth, where it comes from reactions or stresses.
    remark: Option<String>,
}

/// The value of a quantity that the displacement tells, or its reactions where no displacement of the mesh moves a contact alone.
fn told(problem: &Problem, form: &Form, judged: &Judged) -> Result<Told, String> {
    let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
    let own = || finite(form.value_of(problem, &judged.field.displacement));
    let without = "the displacement has no finite value of it";
    let Some(functional) = form.linear() else {
        return own().map(|value| Told { value, remark: None }).ok_or_else(|| without.to_string());
    };
    let of_contact = functional.load.weights.iter().any(|w| !w.is_empty());
    let reactions = judged.candidate.reactions.as_ref().filter(|_| functional.is_of_contact_alone());
    let carried =
        || finite(reactions.and_then(|reactions| weighted_reactions(problem, &functional.load.weights, reactions)));
    // What lifts a force is linear on triangles, and no displacement on quadrilaterals.
    let on_quadrilaterals = judged.candidate.on_quadrilaterals.is_some() && functional.kind.is_carried();
    if let Some(value) = carried().filter(|_| on_quadrilaterals) {
        return Ok(Told { value, remark: None });
    }
    if let Some(value) = own() {
        let remark =
            "the value is that of its stresses on a motion that is linear on triangles, not of its nodal forces";
        return Ok(Told { value, remark: on_quadrilaterals.then(|| remark.to_string()) });
    }
    if functional.lift.is_some() || !of_contact {
        return Err(without.to_string());
    }
    let shared = "the contact shares a vertex with a support or another contact, or its direction turns";
    match carried() {
        Some(value) => {
            let remark = format!("{shared}: the value is that of the reactions as the model shares them out");
            Ok(Told { value, remark: Some(remark) })
        }
        None => Err(format!(
            "{shared}: no displacement of the mesh moves it alone, and how they share the force there is not told"
        )),
    }
}

/// One check for every quantity and displacement model; `sharpest` is the bracket that is known best of the scene.
pub fn quantity_checks(
    certified: &Certified,
    sharpest: &Bracket,
    answers: &[Answer],
    comparison: &Comparison,
    allow: &Allowances,
) -> Vec<Check> {
    let mut checks = Vec::new();
    let scales = Scales::new(&certified.problem);
    for answer in answers.iter().filter(|answer| answer.interval.has_an_end()) {
        for (judged, value) in comparison.judged.iter().zip(values_in(certified, answer, comparison)) {
            let field = &judged.candidate.name;
            // What reactions tell of a vertex that is shared is bounded by no energy.
            let Ok(Told { value, remark: None }) = value else { continue };
            let own = OWN_ERROR * own_error(sharpest, answer, judged);
            if !own.is_finite() {
                continue;
            }
            let whose = format!("{field} may miss it by what its own energy leaves open");
            let allowed = own + SOLVED * answer.kind.size(&certified.problem, &scales.data);
            checks.push(inside(&of_quantity(&answer.name, field), answer, value, allowed, &whose));
        }
    }
    allow.apply(&mut checks);
    checks
}

/// Why an interval says nothing of the scene as it is written, where it does not.
fn of_another_scene(certified: &Certified) -> Option<String> {
    let note = certified.problem.weakened()?;
    Some(format!("The interval is not guaranteed for the scene as it is written: {}.", note.text))
}

/// Why the interval of a quantity tells no right value from a wrong one, where it does not: it is wider than the value, and a substantial
/// part of all that the data can cause.
fn of_no_use(answer: &Answer, most: f64) -> Option<String> {
    let (half, relative) = (answer.interval.half_width(), answer.interval.relative_half_width());
    (half.is_finite() && relative > NO_VALUE && half > PART_OF_ALL * most).then(|| {
        format!(
            "The interval of the {} '{}' is too wide to tell: its half-width is {} times the value. Refine, or give --tolerance-of {}.",
            answer.kind.name(),
            answer.name,
            significant(relative, 3),
            answer.name
        )
    })
}

/// Why a value is not judged that lies outside its interval by less than its last digit.
fn of_few_digits(answer: &Answer, given: &GivenValue) -> String {
    let [lower, upper] = answer.interval.ends.map(|end| significant(end, 9));
    format!(
        "The exact {} '{}' lies between {lower} and {upper}, and {} may be it with fewer digits: give it with all that it has.",
        answer.kind.name(),
        answer.name,
        given.value
    )
}

/// One check for every value that was given. Outside an interval for another scene than the one that is written it is not judged.
pub fn value_checks(certified: &Certified, answers: &[Answer], given: &[GivenValue], allow: &Allowances) -> Vec<Check> {
    let scales = Scales::new(&certified.problem);
    let check = |given: &GivenValue| {
        let name = of_quantity(&given.name, GIVEN);
        match answers.iter().find(|answer| answer.name == given.name) {
            Some(answer) if answer.interval.has_an_end() => {
                let [lower, upper] = answer.interval.ends;
                let outside = answer.interval.outside(given.value);
                let has_digits = given.rounding <= LAST_DIGIT * lower.abs().max(upper.abs());
                let check = match outside > 0.0 && outside <= given.rounding && has_digits {
                    true => {
                        inside(&name, answer, given.value, given.rounding, "the value is rounded to its last digit")
                    }
                    false => inside(&name, answer, given.value, 0.0, "no correct value lies outside"),
                };
                let untold = match check.passed {
                    true => of_no_use(answer, answer.kind.size(&certified.problem, &scales.data)),
                    false if outside <= given.rounding => Some(of_few_digits(answer, given)),
                    false => of_another_scene(certified),
                };
                untold.map_or(check, |why| Check::not_made(&name, 0.0, Basis::Guaranteed, why))
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
pub fn wanted_checks(certified: &Certified, answers: &[Answer], wanted: &[Wanted], allow: &Allowances) -> Vec<Check> {
    let check = |wanted: &Wanted| {
        let name = of_quantity(&wanted.name, WIDTH);
        if let Some(why) = of_another_scene(certified) {
            return Check::not_made(&name, wanted.tolerance, Basis::Asked, why);
        }
        match answers.iter().find(|answer| answer.name == wanted.name) {
            Some(Answer { interval, .. }) if interval.half_width().is_finite() => Check::at_most(
                &name,
                interval.relative_half_width(),
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

/// The error in its value that the energy of a displacement allows.
fn own_error(sharpest: &Bracket, answer: &Answer, judged: &Judged) -> f64 {
    answer.sensitivity * (judged.admissible.upper() - sharpest.lower()).max(0.0).sqrt()
}
