//! The field that balances a constant body force.

use super::N;
use super::basis::BlockBasis;
use crate::element::Material;
use crate::element::geometry::from_centroid;

/// The particular field (−F1 x, −F2 y, 0) about the centroid.
pub struct Particular {
    /// Corners of the triangle.
    pub corners: [[f64; 2]; 3],
    /// F.
    pub force: [f64; 2],
}

impl Particular {
    /// The sides at the first corner.
    fn sides(&self) -> [[f64; 2]; 2] {
        let [a, b, c] = self.corners;
        [[b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]]
    }

    /// Its values at the nodes.
    pub fn stress(&self) -> [[f64; 3]; 9] {
        let mut out = [[0.0; 3]; 9];
        if self.force == [0.0; 2] {
            return out;
        }
        let corners = from_centroid(self.corners);
        for sub in 0..3 {
            for end in 0..2 {
                let [x, y] = corners[(sub + 1 + end) % 3];
                out[3 * sub + end] = [-self.force[0] * x, -self.force[1] * y, 0.0];
            }
        }
        out
    }

    /// Its traction coefficients.
    pub fn traction(&self) -> [f64; 12] {
        let stress = self.stress();
        let mut out = [0.0; 12];
        for sub in 0..3 {
            let (a, b) = (self.corners[(sub + 1) % 3], self.corners[(sub + 2) % 3]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dy);
            for end in 0..2 {
                let tau = stress[3 * sub + end];
                out[4 * sub + 2 * end] = tau[0] * dy / length;
                out[4 * sub + 2 * end + 1] = -tau[1] * dx / length;
            }
        }
        out
    }

    /// ∫ a σ:τ of two fields linear on each subtriangle, from their nodal values.
    pub fn energy(&self, l: &[[f64; 3]; 9], m: &[[f64; 3]; 9], material: &Material) -> f64 {
        let [b, c] = self.sides();
        let sub_area = (b[0] * c[1] - b[1] * c[0]) / 6.0;
        let mut sum = 0.0;
        for (l, m) in l.chunks_exact(3).zip(m.chunks_exact(3)) {
            for (i, l) in l.iter().enumerate() {
                for (j, m) in m.iter().enumerate() {
                    let weight = if i == j { 1.0 / 6.0 } else { 1.0 / 12.0 };
                    sum += weight * sub_area * material.product(*l, *m);
                }
            }
        }
        sum
    }

    /// Its products with the modes.
    pub fn overlaps(&self, basis: &BlockBasis, inverse: &[[f64; N]; N], material: &Material) -> [f64; N] {
        let stress = self.stress();
        inverse.map(|column| self.energy(&stress, &basis.field(&column), material))
    }
}
