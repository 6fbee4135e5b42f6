//! A body force on one triangle.

use super::{Affine, BodyForce};
use crate::vector::{cross, minus};

/// A body force on one triangle: linear between its values at the corners.
#[derive(Debug, Clone, Copy)]
pub struct OnTriangle {
    corners: [[f64; 2]; 3],
    /// The one value, or those at the corners.
    values: Values,
    area: f64,
}

#[derive(Debug, Clone, Copy)]
enum Values {
    Constant([f64; 2]),
    Linear([[f64; 2]; 3]),
}

impl OnTriangle {
    pub(super) fn new(force: &BodyForce, corners: [[f64; 2]; 3]) -> Self {
        let values = match force.is_constant() {
            true => Values::Constant(force.at(corners[0])),
            false => Values::Linear(corners.map(|corner| force.at(corner))),
        };
        let area = 0.5 * cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
        OnTriangle { corners, values, area }
    }

    /// Takes an area that was computed elsewhere, for sums that must not differ in their last digits.
    pub fn of_area(self, area: f64) -> Self {
        OnTriangle { area, ..self }
    }

    /// Its value at the centroid, the mean.
    pub fn mean(&self) -> [f64; 2] {
        match self.values {
            Values::Constant(value) => value,
            Values::Linear([a, b, c]) => [0, 1].map(|i| (a[i] + b[i] + c[i]) / 3.0),
        }
    }

    /// The largest size of the force.
    pub fn largest(&self) -> f64 {
        let size = |v: [f64; 2]| v[0].hypot(v[1]);
        match self.values {
            Values::Constant(value) => size(value),
            Values::Linear(values) => values.map(size).into_iter().fold(0.0, f64::max),
        }
    }

    /// True if there is no force.
    pub fn is_none(&self) -> bool {
        match self.values {
            Values::Constant(value) => value == [0.0; 2],
            Values::Linear(values) => values == [[0.0; 2]; 3],
        }
    }

    /// ∫ f.
    pub fn resultant(&self) -> [f64; 2] {
        self.mean().map(|f| self.area * f)
    }

    /// ∫ (x − x0) × f, with the centroid for x0: none where the force is constant.
    pub fn moment(&self) -> f64 {
        let Values::Linear(values) = self.values else { return 0.0 };
        let centre = [0, 1].map(|c| (self.corners[0][c] + self.corners[1][c] + self.corners[2][c]) / 3.0);
        let mean = self.mean();
        // ∫ l_i l_j is a twelfth of the area, and as much again for i = j; arms and differences from the mean add up to zero.
        let arms = self.corners.map(|corner| minus(corner, centre));
        self.area / 12.0 * arms.iter().zip(values).map(|(arm, f)| cross(*arm, minus(f, mean))).sum::<f64>()
    }

    /// ∫ f B_α, component by component, with the Bernstein polynomial of degree |α|.
    pub fn against(&self, alpha: [usize; 3]) -> [f64; 2] {
        let k = alpha[0] + alpha[1] + alpha[2];
        let share = self.area / ((k + 1) * (k + 2) / 2) as f64;
        match self.values {
            // Every Bernstein polynomial has the same mean.
            Values::Constant(f) => f.map(|f| share * f),
            Values::Linear(values) => [0, 1].map(|c| {
                let sum: f64 = (0..3).map(|i| (alpha[i] + 1) as f64 * values[i][c]).sum();
                share * sum / (k + 3) as f64
            }),
        }
    }

    /// ∫ f φ for the shape functions of a triangle of three nodes, its corners, or of six: corners, then the midpoints of
    /// the sides opposite them.
    pub fn at_nodes(&self, six: bool) -> Vec<[f64; 2]> {
        let unit = |i: usize, n: usize| [0, 1, 2].map(|j| if i == j { n } else { 0 });
        if !six {
            return (0..3).map(|i| self.against(unit(i, 1))).collect();
        }
        // A midpoint has 4 l_j l_k = 2 B_jk, a corner l_i (2 l_i − 1) = B_ii − ½ (B_ij + B_ik).
        let middle = |i: usize| self.against([0, 1, 2].map(|j| usize::from(i != j)));
        let middles = [0, 1, 2].map(middle);
        let corner = |i: usize| match self.values {
            Values::Constant(_) => [0.0; 2],
            Values::Linear(_) => {
                let (own, [p, q]) = (self.against(unit(i, 2)), [middles[(i + 1) % 3], middles[(i + 2) % 3]]);
                [0, 1].map(|c| own[c] - 0.5 * (p[c] + q[c]))
            }
        };
        (0..3).map(corner).chain(middles.map(|m| m.map(|x| 2.0 * x))).collect()
    }
}

/// A stress (xx, yy, xy) at `point` that balances an affine force, div σ = −f, and has no component xx: every component is a
/// polynomial in coordinates about the origin.
///
/// −σ_xy is the integral of f_x along y, and −σ_yy that of f_y + ∂_x σ_xy.
pub fn balancing(force: &Affine, [x, y]: [f64; 2]) -> [f64; 3] {
    let [fx, fy] = force.value;
    let [[xx, xy], [yx, yy]] = force.gradient;
    [0.0, -(fy * y + yx * x * y + 0.5 * (yy - xx) * y * y), -(fx * y + xx * x * y + 0.5 * xy * y * y)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 2]; 3] = [[0.2, -0.1], [1.7, 0.4], [0.5, 1.3]];
    const FORCE: Affine = Affine { value: [0.3, -0.7], gradient: [[1.0, 2.0], [-0.5, 0.25]] };

    /// ∫ of a function over the triangle, cut into n² small ones, by midpoints of sides.
    fn integral(f: impl Fn([f64; 2], [f64; 3]) -> f64) -> f64 {
        let n = 24;
        let corner = |i: usize, j: usize| {
            let l = [i as f64 / n as f64, j as f64 / n as f64];
            [1.0 - l[0] - l[1], l[0], l[1]]
        };
        let area = 0.5 * cross(minus(CORNERS[1], CORNERS[0]), minus(CORNERS[2], CORNERS[0])) / f64::from(n * n) / 3.0;
        let mut sum = 0.0;
        for i in 0..n as usize {
            for j in 0..n as usize - i {
                let mut triangles = vec![[corner(i, j), corner(i + 1, j), corner(i, j + 1)]];
                if i + j + 1 < n as usize {
                    triangles.push([corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j)]);
                }
                for t in triangles {
                    for k in 0..3 {
                        let l = [0, 1, 2].map(|c| 0.5 * (t[k][c] + t[(k + 1) % 3][c]));
                        let x = [0, 1].map(|c| (0..3).map(|v| l[v] * CORNERS[v][c]).sum());
                        sum += area * f(x, l);
                    }
                }
            }
        }
        sum
    }

    #[test]
    fn integrals_are_those_of_a_rule() {
        let on = BodyForce::affine(FORCE).on(CORNERS);
        for alpha in [[0, 0, 0], [1, 0, 0], [0, 1, 1], [0, 0, 2], [1, 2, 0]] {
            let k: usize = alpha.iter().sum();
            let factorial = |n: usize| (1..=n).product::<usize>() as f64;
            let many = factorial(k) / alpha.map(factorial).into_iter().product::<f64>();
            let b = |l: [f64; 3]| many * (0..3).map(|i| l[i].powi(alpha[i] as i32)).product::<f64>();
            for c in 0..2 {
                let exact = integral(|x, l| FORCE.at(x)[c] * b(l));
                assert!((on.against(alpha)[c] - exact).abs() < 1e-5, "{alpha:?} {c}");
            }
        }
        let centre = [0.8, 1.6 / 3.0];
        let moment = integral(|x, _| cross(minus(x, centre), FORCE.at(x)));
        assert!((on.moment() - moment).abs() < 1e-9, "{} {moment}", on.moment());
        for c in 0..2 {
            let whole = integral(|x, _| FORCE.at(x)[c]);
            assert!((on.resultant()[c] - whole).abs() < 1e-9);
            for six in [false, true] {
                let nodes = on.at_nodes(six);
                assert!((nodes.iter().map(|f| f[c]).sum::<f64>() - whole).abs() < 1e-9);
            }
            let corner = integral(|x, l| FORCE.at(x)[c] * l[1] * (2.0 * l[1] - 1.0));
            assert!((on.at_nodes(true)[1][c] - corner).abs() < 1e-5, "{} {corner}", on.at_nodes(true)[1][c]);
            let middle = integral(|x, l| FORCE.at(x)[c] * 4.0 * l[0] * l[2]);
            assert!((on.at_nodes(true)[4][c] - middle).abs() < 1e-5);
        }
    }

    #[test]
    fn the_divergence_of_the_balancing_stress_is_minus_the_force() {
        let h = 1e-4;
        for point in [[0.3, -1.2], [2.0, 0.7]] {
            let slope = |c: usize, along: usize| {
                let moved = |by: f64| [0, 1].map(|i| if i == along { point[i] + by } else { point[i] });
                (balancing(&FORCE, moved(h))[c] - balancing(&FORCE, moved(-h))[c]) / (2.0 * h)
            };
            let divergence = [slope(0, 0) + slope(2, 1), slope(2, 0) + slope(1, 1)];
            let force = FORCE.at(point);
            assert!((0..2).all(|c| (divergence[c] + force[c]).abs() < 1e-7), "{divergence:?} {force:?}");
        }
    }
}
