//! Stresses of a body of revolution from their weighted form.
//!
//! The stored field is Σ = r λ, polynomial on every subtriangle, in the components rr, zz, rz. Balance in the direction of r gives the hoop
//! stress, λ_θθ = ∂_r Σ_rr + ∂_z Σ_rz + r F_r; balance along the axis, ∂_r Σ_rz + ∂_z Σ_zz + r F_z = 0, is a property of the element.

use std::sync::OnceLock;

use nalgebra::DMatrix;

use super::law::Tensor;
use super::rule::Point;
use crate::element::displacement::MOST;
use crate::element::field::lattice;
use crate::element::lattice_len;
use crate::element::polynomial::triangle;

/// Σ on one subtriangle.
#[derive(Debug, Clone, Default)]
pub struct Weighted {
    degree: usize,
    /// Bernstein coefficients of Σ.
    sigma: Vec<[f64; 3]>,
    /// Those of ∂_r Σ_rr + ∂_z Σ_rz, of one degree less, and the sums of the absolute values of all products that make them.
    hoop: Vec<f64>,
    spread: Vec<f64>,
    /// F_r on the axis, and its slope.
    force: [f64; 2],
}

impl Weighted {
    /// From the values at the lattice nodes of a subtriangle, the gradients of its barycentric coordinates, and a and b of
    /// F_r = a + b r.
    pub fn new(degree: usize, nodal: &[[f64; 3]], g: &[[f64; 2]; 3], force: [f64; 2]) -> Self {
        let n = lattice_len(degree);
        let matrix = to_bernstein(degree);
        let row = |i: usize| {
            let mut sum = [0.0; 3];
            for (j, value) in nodal.iter().enumerate() {
                (0..3).for_each(|c| sum[c] += matrix[(i, j)] * value[c]);
            }
            sum
        };
        let sigma: Vec<[f64; 3]> = (0..n).map(row).collect();
        let (mut hoop, mut spread) = (Vec::new(), Vec::new());
        for beta in triangle::indices(degree - 1) {
            let (mut sum, mut size) = (0.0, 0.0);
            for (i, [gr, gz]) in g.iter().enumerate() {
                let [rr, _, rz] = sigma[triangle::number(triangle::raised(beta, i))];
                sum += degree as f64 * (gr * rr + gz * rz);
                size += degree as f64 * ((gr * rr).abs() + (gz * rz).abs());
            }
            hoop.push(sum);
            spread.push(size);
        }
        Weighted { degree, sigma, hoop, spread, force }
    }

    /// Degree of Σ.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Σ at a point of the subtriangle.
    pub fn sigma(&self, bary: [f64; 3]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (b, s) in triangle::basis(self.degree, bary).zip(&self.sigma) {
            (0..3).for_each(|c| sum[c] += b * s[c]);
        }
        sum
    }

    /// ∂_r Σ_rr + ∂_z Σ_rz at a point of the subtriangle.
    pub fn hoop(&self, bary: [f64; 3]) -> f64 {
        triangle::basis(self.degree - 1, bary).zip(&self.hoop).map(|(b, h)| b * h).sum()
    }

    /// λ at a point of the subtriangle, and the size of what its hoop stress is a sum of.
    pub fn stress(&self, at: &Point) -> (Tensor, f64) {
        let [rr, zz, rz] = self.sigma(at.bary).map(|s| s / at.radius);
        let force = at.radius * (self.force[0] + self.force[1] * at.radius);
        let (mut hoop, mut spread) = (force, force.abs());
        for ((b, h), s) in triangle::basis(self.degree - 1, at.bary).zip(&self.hoop).zip(&self.spread) {
            hoop += b * h;
            spread += b * s;
        }
        ([rr, zz, hoop, rz], spread)
    }
}

/// Bernstein coefficients of degree p from values at the lattice nodes.
pub fn to_bernstein(p: usize) -> &'static DMatrix<f64> {
    static MATRICES: [OnceLock<DMatrix<f64>>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
    MATRICES[p].get_or_init(|| {
        let nodes: Vec<[f64; 3]> = lattice(p.max(1)).collect();
        let n = lattice_len(p);
        let mut values = DMatrix::zeros(n, n);
        for (i, l) in nodes.iter().enumerate().take(n) {
            triangle::basis(p, *l).enumerate().for_each(|(j, b)| values[(i, j)] = b);
        }
        // Regular, the points being those of the lattice.
        values.try_inverse().unwrap_or_else(|| DMatrix::identity(n, n))
    })
}
