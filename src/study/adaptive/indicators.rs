//! Local terms of the gap as refinement indicators.

use crate::bounds::{UpperBound, oscillation};
use crate::problem::Problem;

/// Part of the largest term below which terms wait.
const STANDS_OUT: f64 = 0.1;

/// Terms whose relative difference is smaller count as equal.
const EQUAL: f64 = 1e-7;

/// One non-negative number per triangle; together they are the gap, with what tractions of higher degrees add to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Indicators {
    terms: Vec<f64>,
}

impl Indicators {
    /// The terms of `upper` on its mesh: the constitutive-relation error of each triangle, and half of the
    /// complementarity term of each contact pair, or of a pair of an elastic layer, for the triangle on either side.
    pub fn new(problem: &Problem, upper: &UpperBound) -> Self {
        let mut terms: Vec<f64> = upper.local.triangles.iter().map(|v| v.max(0.0)).collect();
        for (interface, values) in problem.interfaces.iter().zip(&upper.local.pairs) {
            for (pair, value) in interface.pairs.iter().zip(values) {
                let sides: Vec<usize> =
                    pair.edges.iter().flatten().filter_map(|&e| problem.mesh.edges[e].triangles[0]).collect();
                for &t in &sides {
                    terms[t] += value.max(0.0) / sides.len() as f64;
                }
            }
        }
        for ((pair, _), value) in problem.bed_pairs().zip(&upper.local.springs) {
            let sides: Vec<usize> = pair.sides().filter_map(|(_, e)| problem.mesh.edges[e].triangles[0]).collect();
            sides.iter().for_each(|&t| terms[t] += value.max(0.0) / sides.len() as f64);
        }
        let of_tractions = oscillation::shares(problem, &upper.displacement, &upper.local.triangles);
        of_tractions.into_iter().for_each(|(t, share)| terms[t] += share);
        Indicators { terms }
    }

    /// Their sum.
    pub fn total(&self) -> f64 {
        self.terms.iter().sum()
    }

    /// Dörfler's marking: as few triangles as carry the part `bulk` of the total, the largest terms first, without those
    /// far below the largest: a singular point is first refined until it stands out no more, which takes few triangles.
    /// Only triangles that `may` be refined count.
    pub fn marked(&self, bulk: f64, may: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.terms.len()).filter(|&t| may(t)).collect();
        order.sort_by(|&a, &b| self.terms[b].total_cmp(&self.terms[a]).then(a.cmp(&b)));
        let wanted = bulk * order.iter().map(|&t| self.terms[t]).sum::<f64>();
        let mut sum = 0.0;
        let mut count = 0;
        let least = order.first().map_or(0.0, |&t| STANDS_OUT * self.terms[t]);
        while count < order.len() && ((sum < wanted && self.terms[order[count]] >= least) || count == 0) {
            sum += self.terms[order[count]];
            count += 1;
        }
        // Halves of one triangle have equal predictions: which of them is marked must not hang on round-off.
        while count > 0
            && count < order.len()
            && self.terms[order[count]] >= (1.0 - EQUAL) * self.terms[order[count - 1]]
        {
            count += 1;
        }
        order.truncate(count);
        order
    }

    /// The term of triangle `t`.
    pub fn of(&self, t: usize) -> f64 {
        self.terms[t]
    }
}

impl FromIterator<f64> for Indicators {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        Indicators { terms: terms.into_iter().collect() }
    }
}
