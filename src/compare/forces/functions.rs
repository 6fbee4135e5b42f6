//! The functions that belong to the nodes of a displacement model on an edge.

use crate::element::polynomial::{positive, side};
use crate::mesh::Triangulation;
use crate::problem::EdgeWeight;

/// The functions that belong to the nodes of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Functions {
    /// Values at vertices, and for degree 2 at the middles of edges.
    Values,
    /// Bernstein coefficients.
    Coefficients,
}

impl Functions {
    /// ∫ φ_i φ_j on an edge of length one.
    fn product(self, degree: usize, i: usize, j: usize) -> f64 {
        const QUADRATIC: [[f64; 3]; 3] = [[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]];
        match (self, degree) {
            (Functions::Values, 2) => QUADRATIC[i][j] / 30.0,
            _ => side::product(degree, i, degree, j),
        }
    }

    /// As [`Self::product`], with the weight of the points of the edge.
    pub(super) fn weighted(self, weight: EdgeWeight, degree: usize, i: usize, j: usize) -> f64 {
        if weight.radii().is_none() {
            return self.product(degree, i, j);
        }
        // The functions of values by their Bernstein coefficients.
        const VALUES: [[f64; 3]; 3] = [[1.0, -0.5, 0.0], [0.0, 2.0, 0.0], [0.0, -0.5, 1.0]];
        match (self, degree) {
            (Functions::Values, 2) => (0..3)
                .flat_map(|p| (0..3).map(move |q| (p, q)))
                .map(|(p, q)| VALUES[i][p] * VALUES[j][q] * weight.product(2, p, q))
                .sum(),
            _ => weight.product(degree, i, j),
        }
    }

    /// ∫ f φ_i of the functions of a degree, from those of the Bernstein polynomials of that degree.
    pub fn moments(self, moments: Vec<f64>) -> Vec<f64> {
        match (self, &moments[..]) {
            (Functions::Values, [a, middle, b]) => vec![a - 0.5 * middle, 2.0 * middle, b - 0.5 * middle],
            _ => moments,
        }
    }

    /// Bernstein coefficients of what has these values at the nodes of an edge.
    pub fn coefficients(self, values: &[f64]) -> Vec<f64> {
        match (self, values) {
            (Functions::Values, [a, middle, b]) => vec![*a, 2.0 * middle - 0.5 * (a + b), *b],
            _ => values.to_vec(),
        }
    }

    /// Bernstein coefficients of the jump with these values less the gap with those coefficients.
    pub(super) fn beyond(self, jump: &[f64], gap: &[f64]) -> Vec<f64> {
        let own = self.coefficients(jump);
        let degree = own.len().max(gap.len()) - 1;
        let [own, gap] = [&own, gap].map(|f| side::elevate(f, degree));
        own.iter().zip(&gap).map(|(j, g)| j - g).collect()
    }

    /// ∫ d₊ φ_i on an edge of length one whose points have the weight `weight`, for all functions of degree `degree`.
    pub(super) fn forces(self, weight: EdgeWeight, beyond: &[f64], degree: usize) -> Vec<f64> {
        self.moments(positive::moments(beyond, degree, weight.ends()))
    }
}

/// The nodes of a field of degree `degree` on edge `e`, from its first vertex to its second.
pub fn nodes_along(mesh: &Triangulation, e: usize, degree: usize) -> impl Iterator<Item = usize> + Clone {
    let [a, b] = mesh.edges[e].vertices;
    let inside = mesh.points.len() + e * (degree - 1);
    std::iter::once(a).chain(inside..inside + degree - 1).chain([b])
}
