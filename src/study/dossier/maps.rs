//! The fields behind the pictures and `fields.vtu`.

use crate::bounds::{UpperBound, mid_field, stress_of};
use crate::compare::{Comparison, von_mises_map, von_mises_of_field, von_mises_of_means};
use crate::element::StressField;
use crate::problem::Problem;
use crate::report::{Map, MapKind, plain};
use crate::study::answers::Answer;
use crate::study::certified::Certified;

/// Stresses of every model, and scalar fields for maps.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields {
    pub(in crate::study) maps: Vec<Map>,
    pub(in crate::study) mid: Option<StressField>,
    pub(in crate::study) stresses: Vec<(String, StressField)>,
}

impl Fields {
    /// Computes the fields of a run.
    pub fn new(certified: &Certified, comparison: &Comparison, answers: &[Answer]) -> Self {
        let Certified { problem, dual, bracket, .. } = certified;
        let means = |stress: &StressField| (0..stress.len()).map(|t| stress.mean(t)).collect::<Vec<_>>();
        let of_values = |who: &str, key: &str, values: Vec<f64>| Map {
            key: format!("von_mises_{key}"),
            title: who.to_string(),
            kind: MapKind::VonMises,
            values,
        };
        let mises = |who: &str, key: &str, means: &[[f64; 3]]| of_values(who, key, von_mises_map(problem, means));
        let mut maps = vec![of_values("dual", "dual", von_mises_of_means(problem, &dual.stress))];
        let models = || comparison.judged.iter().map(|judged| (judged.candidate.name.as_str(), judged));
        maps.extend(models().map(|(name, judged)| of_values(name, &plain(name), von_mises_of_field(problem, judged))));
        let upper = comparison.upper(bracket).map(|(upper, _)| upper);
        let mid = upper.and_then(|upper| mid_field(problem, &dual.stress, &upper.displacement));
        maps.extend(mid.as_ref().map(|mid| mises("half-way between the bounds", "mid", &means(mid))));
        maps.extend(models().map(|(name, judged)| Map {
            key: format!("difference_density_{}", plain(name)),
            title: format!("difference dual − {name}"),
            kind: MapKind::Difference,
            values: density(problem, &judged.field.local.triangles),
        }));
        let share = |name: &str, upper: &UpperBound| Map {
            key: format!("gap_share_{}", plain(name)),
            title: name.to_string(),
            kind: MapKind::GapShare,
            values: shares(problem, upper),
        };
        maps.extend(bracket.free.as_ref().ok().map(|free| share("free upper bound", free)));
        maps.extend(models().map(|(name, judged)| share(name, &judged.admissible)));
        maps.extend(answers.iter().filter_map(of_quantity));
        let stresses =
            models().map(|(name, judged)| (name.to_string(), stress_of(problem, &judged.field.displacement)));
        // Those of a body of revolution are no polynomials.
        let stresses = stresses.filter(|_| !problem.section().is_revolved());
        Fields { mid, stresses: stresses.collect(), maps }
    }

    /// Puts the residual of a claimed solution, triangle by triangle, before the other maps.
    pub fn with_residual(mut self, values: Option<Vec<f64>>) -> Self {
        let map = |values| Map {
            key: "residual".to_string(),
            title: "of the claimed solution".to_string(),
            kind: MapKind::Residual,
            values,
        };
        self.maps.splice(0..0, values.map(map));
        self
    }
}

/// Contribution of each triangle to the width of an interval, relative to the whole width.
fn of_quantity(answer: &Answer) -> Option<Map> {
    let whole: f64 = answer.interval.shares.iter().sum();
    (whole.is_finite() && whole > 0.0).then(|| Map {
        key: format!("quantity_contribution_{}", plain(&answer.name)),
        title: answer.name.clone(),
        kind: MapKind::QuantityShare,
        values: answer.interval.shares.iter().map(|share| share / whole).collect(),
    })
}

/// Square root of twice the term per area: the local size of a stress difference in energy units.
fn density(problem: &Problem, terms: &[f64]) -> Vec<f64> {
    terms.iter().enumerate().map(|(t, v)| (2.0 * v.max(0.0) / problem.mesh.area(t)).sqrt()).collect()
}

/// Local terms of the gap relative to their sum; those of a contact pair go to the triangle on its first side.
pub fn shares(problem: &Problem, upper: &UpperBound) -> Vec<f64> {
    let mut terms = upper.local.triangles.clone();
    for (interface, values) in problem.interfaces.iter().zip(&upper.local.pairs) {
        for (pair, value) in interface.pairs.iter().zip(values) {
            if let Some(t) = pair.edges[0].and_then(|e| problem.mesh.edges[e].triangles[0]) {
                terms[t] += value;
            }
        }
    }
    let total = upper.local.total;
    if total > 0.0 {
        terms.iter_mut().for_each(|v| *v /= total);
    }
    terms
}
