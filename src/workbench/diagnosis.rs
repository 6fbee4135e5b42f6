//! Which mistake explains a stiffness matrix.
//!
//! With R the matrix of the isoparametric element of the same nodes, every mistake of the list makes a matrix M, and what it explains
//! of K − R is 1 − |K − M|² / |K − R|². The simplest one that explains all but rounding is named. A formula is looked at on several
//! shapes, and the mistake has to explain it on each where it is wrong: what one shape does not show, another does.

mod coordinates;
mod enhanced;
mod fit;
mod material;
mod numbering;
mod points;
mod reference;
mod slopes;
mod untold;
mod whole;

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::Serialize;

use super::displacement::DisplacementElement;
use crate::report::text::number::{percent, significant};

pub use reference::Reference;
pub use untold::untold;

/// Of |K − R|², what an explanation may leave.
const LEFT: f64 = 1e-8;
/// Part of the difference below which the nearest mistake is not named.
const WORTH_NAMING: f64 = 0.9;
/// The cause where none is found.
const UNEXPLAINED: &str = "unexplained";

/// What is wrong with a matrix.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Diagnosis {
    /// Stable name of the mistake; `unexplained` where none is found.
    pub cause: String,
    /// Part of the squared difference from the reference that it explains.
    pub explained: f64,
    /// In words.
    pub sentence: String,
}

/// A mistake after it was made.
#[derive(Clone)]
struct Trial {
    /// The simpler the smaller.
    rank: usize,
    cause: &'static str,
    /// Identical on all shapes for one and the same mistake.
    sentence: String,
    matrix: DMatrix<f64>,
}

/// One shape of the element with the elements that are right there.
struct View {
    element: DisplacementElement,
    references: Vec<Reference>,
}

impl View {
    fn of(element: DisplacementElement) -> Result<Self, String> {
        Ok(View { references: Reference::all(&element)?, element })
    }

    fn is(&self, reference: usize) -> bool {
        self.references.get(reference).is_some_and(|r| r.off(&self.element.matrix) <= self.element.precision)
    }
}

/// The shapes that an element is looked at: the one given, and those of its formula.
fn views(e: &DisplacementElement) -> Result<Vec<View>, String> {
    let mut views = vec![View::of(e.matrix_only())?];
    views.extend(e.elsewhere().into_iter().filter_map(|e| View::of(e).ok()));
    Ok(views)
}

/// Which of the right elements gives K on all shapes.
fn recognised(views: &[View]) -> Option<usize> {
    (0..views[0].references.len()).find(|&k| views.iter().all(|v| v.is(k)))
}

/// The right element that an element is on all shapes that can be looked at; `None` where it is none.
pub fn known(e: &DisplacementElement) -> Option<Reference> {
    let mut views = views(e).ok()?;
    let k = recognised(&views)?;
    Some(views.swap_remove(0).references.swap_remove(k))
}

/// Explains why K is not that of the reference; `None` where it is, or where there is no reference.
pub fn diagnose(e: &DisplacementElement) -> Option<Diagnosis> {
    let views = views(e).ok()?;
    if recognised(&views).is_some() {
        return None;
    }
    let is_given_right = (0..views[0].references.len()).any(|k| views[0].is(k));
    let prefix = if is_given_right {
        "On the nodes given K is right. On other shapes the difference is"
    } else {
        "The difference is"
    };
    for k in 0..views[0].references.len() {
        let differing: Vec<&View> = views.iter().filter(|v| !v.is(k) && v.references.len() > k).collect();
        if let Some((trial, explained)) = common(&differing, k) {
            let sentence = format!("{prefix} explained to {}: {}.", percent(explained), trial.sentence);
            return Some(Diagnosis { cause: trial.cause.into(), explained, sentence });
        }
    }
    if !is_given_right
        && views.len() > 1
        && let Some((trial, explained)) = common(&[&views[0]], 0)
    {
        let sentence = format!(
            "On the nodes given the difference is explained to {}, but not on other shapes: {}.",
            percent(explained),
            trial.sentence
        );
        return Some(Diagnosis { cause: trial.cause.into(), explained, sentence });
    }
    let worst = views.iter().find(|v| !v.is(0))?;
    Some(nearest(worst, prefix))
}

/// The simplest mistake that explains all of these shapes with the reference of that number.
fn common(views: &[&View], k: usize) -> Option<(Trial, f64)> {
    let (first, others) = views.split_first()?;
    let mut found = explaining(first, k);
    for view in others {
        if found.is_empty() {
            return None;
        }
        let there = explaining(view, k);
        found.retain(|(t, _)| there.iter().any(|(u, _)| t.sentence == u.sentence));
    }
    found.into_iter().min_by_key(|(t, _)| t.rank)
}

/// The part of |K − R|² that a mistake leaves.
fn left(view: &View, r: &Reference, trial: &Trial) -> f64 {
    let k = &view.element.matrix;
    (k - &trial.matrix).norm_squared() / (k - &r.matrix).norm_squared()
}

/// The mistakes that explain one shape, with how much each explains.
fn explaining(view: &View, k: usize) -> Vec<(Trial, f64)> {
    let (e, r) = (&view.element, &view.references[k]);
    // What the digits of K leave is explained by nothing.
    let digits = (e.precision * r.matrix.amax()).powi(2) * e.matrix.len() as f64;
    let enough = LEFT.max(digits / (&e.matrix - &r.matrix).norm_squared());
    let with_left = |t: Trial| {
        let left = left(view, r, &t);
        (left <= enough).then_some((t, 1.0 - left))
    };
    trials(e, r).into_iter().filter_map(with_left).collect()
}

/// Names the nearest mistake where none explains the difference, if it explains most of it.
fn nearest(view: &View, prefix: &str) -> Diagnosis {
    let (e, r) = (&view.element, &view.references[0]);
    let all = trials(e, r);
    // Nor is a small matrix explained by a factor near zero: most of K itself, too, has to be met.
    let whole = (&e.matrix - &r.matrix).norm_squared().min(e.matrix.norm_squared());
    let missed = |t: &Trial| (&e.matrix - &t.matrix).norm_squared() / whole;
    // What has many numbers of its own comes near to anything.
    let few = all.iter().filter(|t| !["material", "weights"].contains(&t.cause));
    let best = few.min_by(|a, b| missed(a).total_cmp(&missed(b)));
    let explained = best.map_or(0.0, |t| (1.0 - missed(t)).max(0.0));
    let none = format!("None of {} mistakes explains the difference", all.len());
    let sentence = match best {
        _ if e.is_consistent() => format!(
            "{none} from the {}. Rigid motions and constant strains are right: the other motions store another energy, as those of an element of another kind do.",
            r.words()
        ),
        Some(best) if explained >= WORTH_NAMING => {
            let where_ = if prefix.starts_with("On") { " on other shapes than the one given" } else { "" };
            format!("{none}{where_}; the nearest explains {}: {}.", percent(explained), best.sentence)
        }
        _ => format!("{none}."),
    };
    Diagnosis { cause: UNEXPLAINED.into(), explained, sentence }
}

/// All mistakes, made on purpose.
fn trials(e: &DisplacementElement, r: &Reference) -> Vec<Trial> {
    let k = &e.matrix;
    let mut trials = material::trials(e, r);
    trials.extend(numbering::trials(e, &r.matrix));
    trials.extend(whole::trials(r));
    trials.extend(coordinates::trials(e, r));
    trials.extend(points::trials(k, e.precision, r));
    trials.extend(slopes::trials(r));
    trials.extend(enhanced::trials(e, r));
    let scaled: Vec<Trial> = trials.iter().filter_map(|t| with_factor(k, t)).collect();
    trials.extend(scaled);
    trials.extend(material::fitted_hooke(k, e.precision, r));
    trials.extend(numbering::entries(e, &r.matrix));
    if !r.is_isoparametric() {
        trials.iter_mut().for_each(|t| t.sentence += &format!(" (of the {})", r.words()));
    }
    trials
}

/// Adds a fitted factor to a mistake; `None` where it has a factor of its own.
fn with_factor(k: &DMatrix<f64>, trial: &Trial) -> Option<Trial> {
    let has_own = ["sign", "factor", "shear", "weights", "plane-stress-factor", "plane-strain-factor"];
    if has_own.contains(&trial.cause) {
        return None;
    }
    let factor = k.dot(&trial.matrix) / trial.matrix.norm_squared();
    let of_k = match factor {
        _ if (factor + 1.0).abs() < 1e-9 => "has the wrong sign".to_string(),
        _ => format!("is {} times what it should be", significant(factor, 6)),
    };
    let sentence = format!("{}, and K {of_k}", trial.sentence);
    // Next to nothing of a matrix explains none.
    (factor.is_finite() && factor.abs() > 1e-9).then(|| Trial {
        rank: trial.rank + 5,
        cause: trial.cause,
        sentence,
        matrix: &trial.matrix * factor,
    })
}
