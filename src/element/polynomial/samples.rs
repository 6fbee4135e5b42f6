//! Quadrature rules on a subtriangle with the functions of one degree at their points.

use std::sync::OnceLock;

use super::quadrature::triangle_rule;
use super::triangle;
use crate::element::displacement::MOST;
use crate::element::field::lattice_shape;

/// A quadrature rule on a subtriangle with functions of one degree at its points.
#[derive(Debug)]
pub struct Samples {
    /// Barycentric coordinates and weight of every point; the weights sum to one.
    pub points: &'static [([f64; 3], f64)],
    basis: Vec<f64>,
}

/// By the degree of the functions, and by half the degree to which the rule is exact.
type Table = [[OnceLock<Samples>; MOST + 1]; MOST + 1];

impl Samples {
    /// The Bernstein polynomials of strains of degree `strain`, in the rule that is exact to twice the degree `field` or twice that of
    /// the strains, whichever is larger.
    pub fn of(strain: usize, field: usize) -> &'static Samples {
        static KNOWN: Table = [const { [const { OnceLock::new() }; MOST + 1] }; MOST + 1];
        let half = strain.max(field);
        KNOWN[strain][half].get_or_init(|| Samples::new(half, |l| triangle::basis(strain, l)))
    }

    /// The shape functions of a [`crate::element::StressField`] of degree `stress`, in the rule that [`Self::of`] gives for another degree
    /// `field`.
    pub fn of_stress(stress: usize, field: usize) -> &'static Samples {
        static KNOWN: Table = [const { [const { OnceLock::new() }; MOST + 1] }; MOST + 1];
        let half = stress.max(field);
        KNOWN[stress][half].get_or_init(|| Samples::new(half, |l| lattice_shape(stress, l)))
    }

    fn new<I: Iterator<Item = f64>>(half: usize, functions: impl Fn([f64; 3]) -> I) -> Self {
        let points = triangle_rule(2 * half);
        Samples { points, basis: points.iter().flat_map(|(l, _)| functions(*l)).collect() }
    }

    /// The functions at point `q`.
    pub fn basis(&self, q: usize) -> &[f64] {
        let count = self.basis.len() / self.points.len();
        &self.basis[q * count..(q + 1) * count]
    }
}
