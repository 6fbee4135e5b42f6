//! Local terms of the gap as refinement indicators.

use crate::bounds::UpperBound;
use crate::mesh::Triangulation;
use crate::problem::Problem;

/// A term of the gap falls like this power of the triangle's area where the solution is smooth: with stresses linear on
/// a triangle of size h, ½∫ a(λ − τ):(λ − τ) is of order h⁴ · h².
const DECAY: f64 = 3.0;

/// Terms whose relative difference is smaller count as equal.
const EQUAL: f64 = 1e-7;

/// One non-negative number per triangle; together they are the gap.
#[derive(Debug, Clone, PartialEq)]
pub struct Indicators {
    terms: Vec<f64>,
}

impl Indicators {
    /// The terms of `upper` on its mesh: the constitutive-relation error of each triangle, and half of the
    /// complementarity term of each contact pair for the triangle on either side.
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
        Indicators { terms }
    }

    /// Their sum.
    pub fn total(&self) -> f64 {
        self.terms.iter().sum()
    }

    /// Dörfler's marking: as few triangles as carry the part `bulk` of the total, the largest terms first.
    pub fn marked(&self, bulk: f64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.terms.len()).collect();
        order.sort_by(|&a, &b| self.terms[b].total_cmp(&self.terms[a]).then(a.cmp(&b)));
        let wanted = bulk * self.total();
        let mut sum = 0.0;
        let mut count = 0;
        while count < order.len() && (sum < wanted || count == 0) {
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

    /// Predicts the terms on a finer mesh, each from the triangle it came from: with `power` one as for a smooth solution,
    /// with less as where singularities rule.
    pub fn inherited(&self, coarse: &Triangulation, fine: &Triangulation, parent: &[usize], power: f64) -> Indicators {
        let part = |(t, &p): (usize, &usize)| match fine.area(t) / coarse.area(p) {
            whole if whole > 0.9 => self.terms[p],
            part => self.terms[p] * part.powf(DECAY * power),
        };
        Indicators { terms: parent.iter().enumerate().map(part).collect() }
    }
}
