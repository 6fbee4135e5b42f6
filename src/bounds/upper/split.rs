//! The energy of one triangle whose displacement is quadratic on each of its three subtriangles.
//!
//! Ten nodes: the corners, the midpoints opposite them, the centroid, the midpoints of the inner edges. The first six lie
//! on the boundary; x and y of each follow one another.

use super::cholesky::{column, packed};
use crate::bounds::strain::{gradients, sub_area, sub_corners};
use crate::element::Compliance;

/// Unknowns of all ten nodes.
pub const ALL: usize = 20;
/// Unknowns of the six on the boundary, which come first.
pub const BOUNDARY: usize = 12;
/// Unknowns of the four inside.
pub const INSIDE: usize = ALL - BOUNDARY;

/// ½ uᵀKu − fᵀu, per unit thickness, without the tractions on the boundary.
#[derive(Debug, Clone)]
pub struct Split {
    /// K.
    pub matrix: [[f64; ALL]; ALL],
    /// f: the body force.
    pub load: [f64; ALL],
}

/// Nodes of the six that each subtriangle has (corners, then the midpoints opposite them), as indices into the ten.
pub fn nodes(sub: usize) -> [usize; 6] {
    let (j, k) = ((sub + 1) % 3, (sub + 2) % 3);
    [j, k, 6, 7 + k, 7 + j, 3 + sub]
}

impl Split {
    /// The energy on a counter-clockwise triangle.
    pub fn new(corners: [[f64; 2]; 3], material: &Compliance, force: [f64; 2]) -> Self {
        let mut split = Split { matrix: [[0.0; ALL]; ALL], load: [0.0; ALL] };
        let area = sub_area(corners);
        for sub in 0..3 {
            let nodes = nodes(sub);
            split.add(&nodes, &pairs(gradients(sub_corners(corners, sub)), area, material));
            // Quadratic shape functions of corners have no mean.
            for node in &nodes[3..] {
                split.load[2 * node] += area / 3.0 * force[0];
                split.load[2 * node + 1] += area / 3.0 * force[1];
            }
        }
        split
    }

    /// The lower triangle of the nodes inside, as [`super::cholesky`] takes it.
    pub fn inside(&self) -> [f64; packed(INSIDE)] {
        let mut block = [0.0; packed(INSIDE)];
        for (j, row) in self.matrix[BOUNDARY..].iter().enumerate() {
            block[column(INSIDE, j)..][..INSIDE - j].copy_from_slice(&row[BOUNDARY + j..]);
        }
        block
    }

    /// Adds ∫ c e(φ_a):e(φ_b) of all pairs of quadratic shape functions on one subtriangle.
    ///
    /// With φ_i = λ_i (2λ_i − 1) at corners and 4 λ_i λ_j at midpoints, ∫ ∇φ_a ⊗ ∇φ_b combines the products of the
    /// gradients of the λ_i by integrals of products of the λ_i, which are a sixth and a twelfth of the area.
    fn add(&mut self, nodes: &[usize; 6], m: &[[Pair; 3]; 3]) {
        let sum = |parts: [(f64, Pair); 4]| {
            let entry = |p: usize, q: usize| parts.iter().map(|(factor, pair)| factor * pair[p][q]).sum::<f64>();
            [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
        };
        let times = |factor: f64, pair: Pair| pair.map(|row| row.map(|v| factor * v));
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            self.put(nodes[i], nodes[i], m[i][i]);
            self.put_both(nodes[i], nodes[j], times(-1.0 / 3.0, m[i][j]));
            self.put_both(nodes[i], nodes[3 + k], times(4.0 / 3.0, m[i][j]));
            self.put_both(nodes[i], nodes[3 + j], times(4.0 / 3.0, m[i][k]));
            let own = [(8.0 / 3.0, m[j][j]), (8.0 / 3.0, m[k][k]), (4.0 / 3.0, m[j][k]), (4.0 / 3.0, m[k][j])];
            self.put(nodes[3 + i], nodes[3 + i], sum(own));
            // Midpoints opposite i, on the edge (j, k), and opposite j, on the edge (i, k).
            let other = [(8.0 / 3.0, m[j][i]), (4.0 / 3.0, m[j][k]), (4.0 / 3.0, m[k][i]), (4.0 / 3.0, m[k][k])];
            self.put_both(nodes[3 + i], nodes[3 + j], sum(other));
        }
    }

    fn put(&mut self, a: usize, b: usize, pair: Pair) {
        for (row, values) in self.matrix[2 * a..2 * a + 2].iter_mut().zip(pair) {
            row[2 * b] += values[0];
            row[2 * b + 1] += values[1];
        }
    }

    fn put_both(&mut self, a: usize, b: usize, pair: Pair) {
        self.put(a, b, pair);
        self.put(b, a, [[pair[0][0], pair[1][0]], [pair[0][1], pair[1][1]]]);
    }
}

/// Stiffness between two nodes: x and y of the first, x and y of the second.
type Pair = [[f64; 2]; 2];

/// ∫ c e(λ_i x̂_p) : e(λ_j x̂_q) for barycentric coordinates λ with gradients `g`.
fn pairs(g: [[f64; 2]; 3], area: f64, material: &Compliance) -> [[Pair; 3]; 3] {
    // c e:e = λ (tr e)² + 2μ e:e.
    let shear = area * material.young / material.gamma;
    let bulk = area * 0.25 * material.young / material.kappa - shear;
    g.map(|a| {
        g.map(|b| {
            let both = shear * (a[0] * b[0] + a[1] * b[1]);
            let entry = |p: usize, q: usize| bulk * a[p] * b[q] + shear * a[q] * b[p];
            [[entry(0, 0) + both, entry(0, 1)], [entry(1, 0), entry(1, 1) + both]]
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::strain::strains;
    use crate::scene::Kinematics;

    const CORNERS: [[f64; 2]; 3] = [[0.3, -0.2], [1.9, 0.1], [0.7, 1.4]];

    /// The six of the ten nodal values that one subtriangle has.
    fn on(sub: usize, u: &[[f64; 2]; 10]) -> [[f64; 2]; 6] {
        nodes(sub).map(|n| u[n])
    }

    #[test]
    fn agrees_with_the_energy_of_the_strains_by_quadrature() {
        for (kinematics, nu) in
            [(Kinematics::PlaneStrain, 0.3), (Kinematics::PlaneStrain, 0.499), (Kinematics::PlaneStress, 0.2)]
        {
            let material = Compliance::new(kinematics, 3.0, nu);
            let split = Split::new(CORNERS, &material, [0.0; 2]);
            for seed in 0..5_u32 {
                let value = |k: usize| f64::from((seed * 20 + k as u32 + 1) * 7919 % 1009) / 1009.0 - 0.5;
                let u: [[f64; 2]; 10] = std::array::from_fn(|n| [value(2 * n), value(2 * n + 1)]);
                let flat: Vec<f64> = u.iter().flatten().copied().collect();
                let form: f64 =
                    (0..ALL).map(|i| (0..ALL).map(|j| flat[i] * split.matrix[i][j] * flat[j]).sum::<f64>()).sum();
                let mut exact = 0.0;
                for sub in 0..3 {
                    for e in strains(CORNERS, sub, &on(sub, &u)) {
                        exact += sub_area(CORNERS) / 3.0 * material.strain_product(e, e);
                    }
                }
                assert!((form - exact).abs() < 1e-12 * exact, "{form} is not {exact}");
            }
        }
    }

    #[test]
    fn the_load_is_the_work_of_the_body_force() {
        let split = Split::new(CORNERS, &Compliance::new(Kinematics::PlaneStress, 1.0, 0.3), [2.0, -3.0]);
        // A unit translation does the work of the whole force.
        let work = |c: usize| (0..10).map(|n| split.load[2 * n + c]).sum::<f64>();
        let area = 3.0 * sub_area(CORNERS);
        assert!((work(0) - 2.0 * area).abs() < 1e-14 && (work(1) + 3.0 * area).abs() < 1e-14);
    }
}
