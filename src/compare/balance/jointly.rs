//! All forces of contact and friction at once, where no report says how they are shared.
//!
//! Where the direction of contact turns, two coefficients inside an edge press and two rub, and all four act on the node between its ends and on
//! the vertices. The field is a solution if any forces that their laws allow balance it: the nearest that the sum of all such forces comes
//! to the nodal forces is a quadratic program with a bound for each unknown.

use std::collections::HashMap;

use super::cones::senses;
use super::higher::{Inside, nodes};
use super::{End, HELD, Solution, dot};
use crate::bounds::Hold;
use crate::compare::contact::slides::inside;
use crate::optimise::{Law, Program, SparseForm, active_sets, interior_point};
use crate::problem::ContactPair;
use crate::vector::long::largest;

/// Mean product of force and slack that the interior point aims at, for nodal forces of size one.
const ENOUGH: f64 = 1e-22;
/// Friction that carries less than this part of the largest nodal force carries none: it leaves an interior point no room.
const NEGLIGIBLE: f64 = 1e-12;
/// Steps of active sets from its point.
const SETTLING: usize = 8;

/// A force on nodes, for a unit of its unknown, and the law of that.
struct Unknown {
    terms: Vec<(usize, [f64; 2])>,
    law: Law,
}

impl Unknown {
    /// A force that can only push: its unknown is negative where it does.
    fn pushing(terms: impl IntoIterator<Item = (usize, [f64; 2])>) -> Self {
        let pulling = terms.into_iter().map(|(node, factor)| (node, factor.map(|f| -f)));
        Unknown { terms: merged(pulling), law: Law::AtMost { bound: 0.0 } }
    }

    /// A force of friction no larger than `limit`.
    fn within(limit: f64, terms: impl IntoIterator<Item = (usize, [f64; 2])>) -> Self {
        Unknown { terms: merged(terms), law: Law::Between { lower: -limit, upper: limit } }
    }

    /// The largest force.
    fn most(&self) -> f64 {
        if let Law::Between { upper, .. } = self.law { upper } else { f64::INFINITY }
    }
}

impl Solution<'_> {
    /// True if the forces of several coefficients act on the same nodes, and no report says which of them.
    pub(super) fn is_ambiguous(&self) -> bool {
        let turns = |pair: &ContactPair| pair.friction.is_some() && !pair.direction.is_constant();
        let is_told = self.candidate.reactions.is_some() || self.inside_values().is_none();
        self.candidate.degree > 1 && !is_told && self.problem.pairs().any(turns)
    }

    /// Takes all forces of contact and friction out of `rest`, as far as their laws allow them.
    pub(super) fn take_all(&self, rest: &mut [[f64; 2]]) {
        self.slide_at_vertices(rest);
        let mut unknowns = self.at_vertices();
        let holds: Vec<Hold> = self.holds.of_nodes(&nodes(self.problem, self.candidate.degree)).collect();
        self.between_vertices(&mut unknowns, &holds, rest);
        let nodal = unknowns.iter().flat_map(|unknown| &unknown.terms).flat_map(|(node, _)| rest[*node]);
        let least = NEGLIGIBLE * nodal.fold(0.0_f64, |m, f| m.max(f.abs()));
        let mut slot = HashMap::new();
        let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
        let mut laws = Vec::new();
        for unknown in unknowns.iter().filter(|unknown| unknown.most() > least) {
            let terms = unknown.terms.iter().map(|(node, factor)| (*node, holds[*node].project(*factor)));
            let terms: Vec<(usize, [f64; 2])> = terms.collect();
            let length = terms.iter().map(|(_, f)| dot(*f, *f)).sum::<f64>().sqrt();
            if length < HELD {
                continue;
            }
            let mut row = Vec::new();
            for (node, factor) in terms {
                let next = 2 * slot.len();
                let at = *slot.entry(node).or_insert(next);
                row.extend([(at, factor[0] / length), (at + 1, factor[1] / length)]);
            }
            rows.push(row);
            laws.push(unknown.law.in_unit(1.0 / length));
        }
        let mut load = vec![0.0; 2 * slot.len()];
        slot.iter().for_each(|(node, at)| load[*at..*at + 2].copy_from_slice(&rest[*node].map(|f| -f)));
        let forces = nearest(&rows, &load, &laws);
        for (row, force) in rows.iter().zip(forces) {
            row.iter().for_each(|(at, factor)| load[*at] -= force * factor);
        }
        slot.into_iter().for_each(|(node, at)| rest[node] = [-load[at], -load[at + 1]]);
    }

    fn at_vertices(&self) -> Vec<Unknown> {
        let within = self.closed_within();
        let mut unknowns = Vec::new();
        for end in self.problem.pairs().flat_map(End::of).filter(|end| self.is_closed(end, within)) {
            let pushing = self.directions(&end).into_iter();
            unknowns.extend(pushing.map(|n| Unknown::pushing(on_both((end.first, end.second), n))));
        }
        let bounded = self.slides.iter().filter(|(slide, _)| slide.coefficient.is_none());
        let sticking = bounded.filter(|(slide, _)| self.along(slide).abs() <= within);
        unknowns.extend(
            sticking
                .map(|(slide, _)| Unknown::within(slide.limit, on_both((slide.first, slide.second), slide.tangent))),
        );
        unknowns
    }

    /// Adds the unknowns inside pairs; the forces of coefficients that slide are known, and taken out of `rest`.
    fn between_vertices(&self, unknowns: &mut Vec<Unknown>, holds: &[Hold], rest: &mut [[f64; 2]]) {
        let degree = self.candidate.degree;
        let Some(value) = self.inside_values() else { return };
        let within = self.closed_within();
        for pair in self.problem.pairs() {
            let slides = inside(self.problem, pair, degree);
            let mu = pair.friction.and_then(|friction| friction.coefficient);
            for (i, row) in Inside::of(self.problem, pair, degree).rows.iter().enumerate() {
                if row.excess_at(value) < -within {
                    continue;
                }
                let (Some(mu), Some(slide)) = (mu, slides.get(i)) else {
                    unknowns.push(Unknown::pushing(row.terms().iter().copied()));
                    continue;
                };
                for sign in senses(slide.row.excess_at(value), within) {
                    let rubbing = slide.row.terms().iter().map(|(node, factor)| (*node, factor.map(|f| sign * mu * f)));
                    unknowns.push(Unknown::pushing(row.terms().iter().copied().chain(rubbing)));
                }
            }
            for slide in slides.into_iter().filter(|_| mu.is_none()) {
                let Some(force) = slide.force(slide.row.excess_at(value), within) else {
                    unknowns.push(Unknown::within(slide.limit, slide.row.terms().iter().copied()));
                    continue;
                };
                for (node, factor) in slide.row.terms() {
                    let factor = holds[*node].project(*factor);
                    rest[*node] = [0, 1].map(|c| rest[*node][c] + force * factor[c]);
                }
            }
        }
    }
}

fn on_both((first, second): (usize, Option<usize>), direction: [f64; 2]) -> Vec<(usize, [f64; 2])> {
    let other = second.map(|second| (second, direction.map(|x| -x)));
    [Some((first, direction)), other].into_iter().flatten().collect()
}

/// The terms with one for each node.
fn merged(terms: impl IntoIterator<Item = (usize, [f64; 2])>) -> Vec<(usize, [f64; 2])> {
    let mut all: Vec<(usize, [f64; 2])> = Vec::new();
    for (node, factor) in terms {
        match all.iter_mut().find(|(known, _)| *known == node) {
            Some((_, sum)) => *sum = [sum[0] + factor[0], sum[1] + factor[1]],
            None => all.push((node, factor)),
        }
    }
    all
}

/// The values within their laws whose sum Σ x row is nearest to `load`: none where they cannot be found, so that all of it is left over.
fn nearest(rows: &[Vec<(usize, f64)>], load: &[f64], laws: &[Law]) -> Vec<f64> {
    let none = vec![0.0; rows.len()];
    let size = largest(load);
    let Some(form) = SparseForm::of_products(rows, load.len()).filter(|_| size > 0.0) else { return none };
    let pulls: Vec<f64> = rows.iter().map(|row| row.iter().map(|(k, v)| v * load[*k] / size).sum()).collect();
    let laws: Vec<Law> = laws.iter().map(|law| law.in_unit(size)).collect();
    let program = Program { form: &form, load: &pulls, laws: &laws };
    let Some(inner) = interior_point(&program, ENOUGH) else { return none };
    let last = active_sets(&program, inner.states.clone(), Some(inner.x.clone()), SETTLING);
    let within = |x: &[f64]| -> Vec<f64> {
        let clamped = x.iter().zip(&laws).map(|(x, law)| match law {
            Law::AtMost { bound } => x.min(*bound),
            Law::Between { lower, upper } => x.clamp(*lower, *upper),
            _ => *x,
        });
        clamped.map(|x| size * x).collect()
    };
    let left = |x: &[f64]| {
        let mut rest = load.to_vec();
        rows.iter().zip(x).for_each(|(row, x)| row.iter().for_each(|(k, v)| rest[*k] -= v * x));
        rest.iter().map(|f| f * f).sum::<f64>()
    };
    [inner.x, last.x].iter().map(|x| within(x)).min_by(|a, b| left(a).total_cmp(&left(b))).unwrap_or(none)
}

#[cfg(test)]
mod tests {
    use super::super::rubbing::least;
    use super::*;
    use nalgebra::DVector;
    use proptest::prelude::*;

    proptest! {
        /// What is left beside the nearest forces is what coordinate descent leaves.
        #[test]
        fn no_other_forces_come_nearer(
            load in proptest::array::uniform4(-1.0..1.0f64),
            pushing in proptest::collection::vec(proptest::array::uniform4(-1.0..1.0f64), 0..5),
            sticking in proptest::collection::vec((proptest::array::uniform4(-1.0..1.0f64), 0.01..1.0f64), 0..4),
        ) {
            let unit = |row: &[f64; 4]| DVector::from_row_slice(row).normalize();
            let sparse = |row: DVector<f64>| row.iter().copied().enumerate().collect::<Vec<_>>();
            let bounded: Vec<(DVector<f64>, f64)> = sticking.iter().map(|(row, limit)| (unit(row), *limit)).collect();
            let rows: Vec<Vec<(usize, f64)>> =
                pushing.iter().map(|row| sparse(-unit(row))).chain(bounded.iter().map(|(row, _)| sparse(row.clone()))).collect();
            let laws: Vec<Law> = pushing
                .iter()
                .map(|_| Law::AtMost { bound: 0.0 })
                .chain(bounded.iter().map(|(_, limit)| Law::Between { lower: -limit, upper: *limit }))
                .collect();
            let mut left = DVector::from_row_slice(&load);
            let found = nearest(&rows, &load, &laws);
            for (row, x) in rows.iter().zip(&found) {
                row.iter().for_each(|(k, v)| left[*k] -= x * v);
            }
            let by_descent = least(&DVector::from_row_slice(&load), &pushing.iter().map(unit).collect::<Vec<_>>(), &bounded);
            prop_assert!(left.norm() <= by_descent.norm() + 1e-7, "{} {}", left.norm(), by_descent.norm());
        }
    }
}
