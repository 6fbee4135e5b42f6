//! The quantities of a scene and their intervals.

use super::adaptive::Wanted;
use super::{Certified, slopes};
use crate::dual::{Factorised, Motion, Options};
use crate::element::{Displacement, Elements, StressField};
use crate::problem::Problem;
use crate::quantity::{Form, Interval, Kind, Known, NoTip, NotBounded, displaced};
use crate::scene::Quantity;

/// Why a quantity of a body that is free to move has no value.
const MOVES: &str = "a motion that neither supports nor closed contacts resist changes it";

/// A quantity and what is guaranteed of it.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Its name.
    pub name: String,
    /// Its interval; both ends infinite, with the reason, where none is known.
    pub interval: Interval,
    /// The kind of quantity.
    pub kind: Kind,
    /// By how much the root of the energy error of a displacement can change its value, at most: the width of the interval of
    /// first order over the root of the gap that it comes from. Infinite where there is no such interval.
    pub sensitivity: f64,
}

impl Answer {
    /// Nothing is known, for this reason.
    fn unknown(name: String, kind: Kind, reason: &str) -> Self {
        Answer { name, kind, interval: Interval::unknown(reason), sensitivity: f64::INFINITY }
    }

    /// Combines the intervals of the same value on two meshes, with the shares of this one.
    fn and(self, finer: &Answer) -> Self {
        Answer {
            interval: self.interval.and(&finer.interval),
            sensitivity: self.sensitivity.min(finer.sensitivity),
            ..self
        }
    }
}

/// Refuses quantities that do not fit the mesh.
///
/// # Errors
/// A sentence that names the quantity.
pub fn refuse_quantities(problem: &Problem) -> Result<(), String> {
    let problem = &problem.where_friction_acts();
    for quantity in &problem.scene.quantities {
        match Form::new(problem, quantity) {
            Ok(_)
            | Err(NotBounded::Shared { .. } | NotBounded::Carried { .. } | NotBounded::NoTip(NoTip::Coarse { .. })) => {
            }
            Err(error) => return Err(format!("quantity '{}': {error}", quantity.name)),
        }
    }
    Ok(())
}

/// Refuses to refine towards a quantity that has no interval on any mesh.
///
/// # Errors
/// A sentence that names the quantity.
pub fn refuse_wanted(problem: &Problem, wanted: &[Wanted]) -> Result<(), String> {
    let named = |quantity: &&Quantity| wanted.iter().any(|wanted| wanted.name == quantity.name);
    for quantity in problem.scene.quantities.iter().filter(named).filter(|_| goes_by_slopes(problem)) {
        if let Ok(form) = Form::new(problem, quantity) {
            slopes::refuse(problem, &form).map_err(|reason| format!("quantity '{}': {reason}", quantity.name))?;
        }
    }
    Ok(())
}

/// True where intervals come from energies alone.
fn goes_by_slopes(problem: &Problem) -> bool {
    problem.has_friction() || problem.has_elastic_contact() || problem.has_polynomial_tractions()
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
    let gap = bracket.free.as_ref().map_or(f64::INFINITY, |free| free.upper() - bracket.lower());
    if goes_by_slopes(problem) {
        let of_slopes = |quantity: &&Quantity| {
            let name = quantity.name.clone();
            match Form::new(problem, quantity) {
                Ok(form) if motions.iter().any(|motion| changes(problem, &form, motion)) => {
                    Answer::unknown(name, form.kind(), MOVES)
                }
                Ok(form) => {
                    let interval = slopes::interval(certified, &form, options);
                    Answer { name, kind: form.kind(), sensitivity: sensitivity(&interval, gap), interval }
                }
                Err(error) => Answer::unknown(name, Kind::of(&quantity.target), &error.to_string()),
            }
        };
        return quantities.iter().map(of_slopes).collect();
    }
    let own;
    let factorised: Result<&Factorised, String> = match &dual.factorised {
        Some(kept) => Ok(kept),
        None => {
            let options = Options { elements: elements(options, &dual.stress), ..options.clone() };
            own = Factorised::new(problem, &statics.null_motions(problem), &options).map_err(|error| error.to_string());
            own.as_ref().map_err(Clone::clone)
        }
    };
    let known = factorised.and_then(|factorised| {
        let free = bracket.free.as_ref().map_err(|error| error.to_string())?;
        Known::new(problem, dual, bracket, free, factorised, options)
    });
    let answer = |quantity: &&Quantity| {
        let name = quantity.name.clone();
        match (Form::new(problem, quantity), &known) {
            (Ok(form), _) if motions.iter().any(|motion| changes(problem, &form, motion)) => {
                Answer::unknown(name, form.kind(), MOVES)
            }
            (Ok(form), Ok(known)) => {
                let interval = form.interval(known);
                let sensitivity = sensitivity(&interval, gap);
                Answer { name, kind: form.kind(), interval, sensitivity }
            }
            (Ok(form), Err(reason)) => Answer::unknown(name, form.kind(), reason),
            (Err(error), _) => Answer::unknown(name, Kind::of(&quantity.target), &error.to_string()),
        }
    };
    quantities.iter().map(answer).collect()
}

/// The width of first order over the root of the gap; infinite where either is missing.
fn sensitivity(interval: &Interval, gap: f64) -> f64 {
    let [low, high] = interval.first_order;
    let of_root = (high - low) / gap.sqrt();
    if gap > 0.0 && of_root.is_finite() { of_root } else { f64::INFINITY }
}

/// Combines the answers on a mesh and on a finer one of the same domain: the ends that are nearer, with the contribution of each
/// triangle of the first mesh.
pub fn sharper(own: Vec<Answer>, finer: &[Answer]) -> Vec<Answer> {
    let both = |own: Answer| match finer.iter().find(|finer| finer.name == own.name) {
        Some(finer) => own.and(finer),
        None => own,
    };
    own.into_iter().map(both).collect()
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

/// True if a rigid motion changes a quantity.
fn changes(problem: &Problem, form: &Form, motion: &Motion) -> bool {
    // No stress changes.
    let Some(functional) = form.linear() else { return false };
    let largest = motion.iter().fold(0.0_f64, |m, u| m.max(u[0].hypot(u[1])));
    functional.is_of_place()
        && displaced(problem, functional, &Displacement::from_p1(&problem.mesh, motion)).abs() > UNMOVED * largest
}
