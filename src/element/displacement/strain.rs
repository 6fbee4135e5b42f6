//! Strains of a displacement that is polynomial on each subtriangle.

use crate::element::geometry::{sub_corners, sub_gradients};
use crate::element::polynomial::triangle;
use crate::element::{Displacement, Material, Samples, weighed};

/// Strains (xx, yy, xy) on one subtriangle, by their Bernstein coefficients: of degree k − 1 for a displacement of degree k.
#[derive(Debug, Clone, Default)]
pub struct Strains {
    degree: usize,
    displacement: Vec<[f64; 2]>,
    coefficients: Vec<[f64; 3]>,
    /// For each coefficient the sum of the absolute values of all products that make it.
    spreads: Vec<f64>,
}

impl Strains {
    /// Those of `v` on subtriangle `sub` of triangle `t`, which has these corners; kept until the next call.
    pub fn on(&mut self, corners: [[f64; 2]; 3], v: &Displacement, t: usize, sub: usize) -> &Self {
        let k = v.degree(t);
        self.displacement.clear();
        self.displacement.extend(v.sub(t, sub));
        self.coefficients.clear();
        self.spreads.clear();
        self.degree = k - 1;
        let g = sub_gradients(corners, sub);
        for beta in triangle::indices(k - 1) {
            let u = [0, 1, 2].map(|i| self.displacement[triangle::number(triangle::raised(beta, i))]);
            let (mut e, mut spread) = ([0.0; 3], 0.0);
            for i in 1..3 {
                // Differences of neighbours: a rigid translation leaves no trace.
                let (x, y) = (u[i][0] - u[0][0], u[i][1] - u[0][1]);
                let [gx, gy] = g[i].map(|d| k as f64 * d);
                e[0] += gx * x;
                e[1] += gy * y;
                e[2] += 0.5 * (gy * x + gx * y);
                spread += (gx.abs() + gy.abs()) * (x.abs() + y.abs());
            }
            self.coefficients.push(e);
            self.spreads.push(spread);
        }
        self
    }

    /// Elastic strains e(v) − ε0 of `v` in a material, of the degree [`elastic_degree`].
    pub fn elastic(
        &mut self,
        corners: [[f64; 2]; 3],
        v: &Displacement,
        t: usize,
        sub: usize,
        material: &Material,
    ) -> &Self {
        self.on(corners, v, t, sub);
        let initial = material.initial();
        if initial.is_none() {
            return self;
        }
        let degree = elastic_degree(v.degree(t), material);
        if degree > self.degree {
            // A constant strain, as a linear one.
            let (e, spread) = (self.coefficients[0], self.spreads[0]);
            self.coefficients.resize(3, e);
            self.spreads.resize(3, spread);
            self.degree = 1;
        }
        let q = sub_corners(corners, sub);
        for ((alpha, e), spread) in triangle::indices(degree).zip(&mut self.coefficients).zip(&mut self.spreads) {
            // The coefficients of a linear function are its values at equal steps.
            let l = alpha.map(|i| if degree == 0 { 1.0 / 3.0 } else { i as f64 / degree as f64 });
            let own = initial.at([0, 1].map(|c| (0..3).map(|i| l[i] * q[i][c]).sum()));
            for c in 0..3 {
                e[c] -= own[c];
                *spread += own[c].abs();
            }
        }
        self
    }

    /// The strain at the point of the subtriangle with barycentric coordinates `l`.
    pub fn at(&self, l: [f64; 3]) -> [f64; 3] {
        match self.degree {
            // The basis of degree 1 are the coordinates themselves.
            1 => weighed(&self.coefficients, l),
            degree => weighed(&self.coefficients, triangle::basis(degree, l)),
        }
    }

    /// The strain at point `q` of `samples`, which are of the degree of these strains.
    pub fn sample(&self, samples: &Samples, q: usize) -> [f64; 3] {
        weighed(&self.coefficients, samples.basis(q).iter().copied())
    }

    /// The sum of the absolute values of all products that [`Self::sample`] adds up.
    pub fn spread(&self, samples: &Samples, q: usize) -> f64 {
        samples.basis(q).iter().zip(&self.spreads).map(|(weight, spread)| weight * spread).sum()
    }

    /// As [`Self::spread`], at the point with barycentric coordinates `l`.
    pub fn spread_at(&self, l: [f64; 3]) -> f64 {
        triangle::basis(self.degree, l).zip(&self.spreads).map(|(weight, spread)| weight * spread).sum()
    }

    /// The largest sum of absolute values of products that make a coefficient.
    pub fn largest_spread(&self) -> f64 {
        self.spreads.iter().copied().fold(0.0, f64::max)
    }
}

/// The degree of the elastic strain of a displacement of degree `k`: an affine initial strain makes a constant one linear.
pub fn elastic_degree(k: usize, material: &Material) -> usize {
    if material.initial().is_constant() { k - 1 } else { (k - 1).max(1) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Edge, Triangulation};

    const CORNERS: [[f64; 2]; 3] = [[0.2, -0.1], [1.7, 0.4], [0.5, 1.3]];

    /// Blossoming: the coefficients of Σ_m u_m of products of linear functions, here of (a·x)(b·x)(c·x).
    fn cubic(x: [[f64; 2]; 3]) -> [f64; 2] {
        let [p, q, r] = x;
        let symmetric = |f: fn([f64; 2]) -> f64, g: fn([f64; 2]) -> f64, h: fn([f64; 2]) -> f64| {
            let orders = [[p, q, r], [p, r, q], [q, p, r], [q, r, p], [r, p, q], [r, q, p]];
            orders.iter().map(|[a, b, c]| f(*a) * g(*b) * h(*c)).sum::<f64>() / 6.0
        };
        [symmetric(|x| x[0], |x| x[0], |x| x[1]), symmetric(|x| x[1], |x| x[1], |x| x[1] - x[0] + 1.0)]
    }

    #[test]
    fn strains_of_a_cubic_field() {
        let mut v = Displacement::zeros([3]);
        for sub in 0..3 {
            let q = sub_corners(CORNERS, sub);
            let nodes = crate::element::displacement::SplitNodes::of(3).subs[sub].clone();
            for (node, alpha) in nodes.into_iter().zip(triangle::indices(3)) {
                let arguments: Vec<[f64; 2]> = (0..3).flat_map(|i| std::iter::repeat_n(q[i], alpha[i])).collect();
                v.block_mut(0)[node] = cubic([arguments[0], arguments[1], arguments[2]]);
            }
        }
        for sub in 0..3 {
            let q = sub_corners(CORNERS, sub);
            let mut strains = Strains::default();
            strains.on(CORNERS, &v, 0, sub);
            for l in [[0.2, 0.3, 0.5], [0.9, 0.1, 0.0], [0.0, 0.0, 1.0]] {
                let [x, y] = [0, 1].map(|c| (0..3).map(|i| l[i] * q[i][c]).sum::<f64>());
                // u = (x²y, y³ − xy² + y²)
                let exact = [2.0 * x * y, 3.0 * y * y - 2.0 * x * y + 2.0 * y, 0.5 * (x * x - y * y)];
                let found = strains.at(l);
                for c in 0..3 {
                    assert!((found[c] - exact[c]).abs() < 1e-13, "{found:?} is not {exact:?}");
                }
            }
        }
    }

    #[test]
    fn strains_of_a_quadratic_field_given_by_its_values() {
        let mesh = Triangulation {
            points: CORNERS.to_vec(),
            triangles: vec![[0, 1, 2]],
            body: vec![0],
            edges: [[1, 2], [2, 0], [0, 1]]
                .map(|vertices| Edge { vertices, triangles: [Some(0), None], name: None })
                .to_vec(),
            triangle_edges: vec![[0, 1, 2]],
            names: Vec::new(),
            cells: crate::mesh::FileCells::default(),
        };
        let u = |p: [f64; 2]| [p[0] * p[0] - 2.0 * p[0] * p[1], 3.0 * p[1] * p[1] + p[0]];
        let middles = [0, 1, 2].map(|i| [0, 1].map(|c| 0.5 * (CORNERS[(i + 1) % 3][c] + CORNERS[(i + 2) % 3][c])));
        let v = Displacement::from_p2(&mesh, &CORNERS.map(u), &middles.map(u));
        let mut strains = Strains::default();
        for sub in 0..3 {
            let q = sub_corners(CORNERS, sub);
            strains.on(CORNERS, &v, 0, sub);
            let samples = Samples::of(1, 1);
            for (k, (l, _)) in samples.points.iter().enumerate() {
                let [x, y] = [0, 1].map(|c| (0..3).map(|i| l[i] * q[i][c]).sum::<f64>());
                let exact = [2.0 * x - 2.0 * y, 6.0 * y, 0.5 * (-2.0 * x + 1.0)];
                let found = strains.sample(samples, k);
                for c in 0..3 {
                    assert!((found[c] - exact[c]).abs() < 1e-13);
                }
            }
        }
    }
}
