//! The bilinear map of the unit square onto a quadrilateral, and the functions of degree k in each coordinate of the square.

/// The map x = a + b ξ + c η + d ξη; d is zero for a parallelogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bilinear {
    a: [f64; 2],
    b: [f64; 2],
    c: [f64; 2],
    d: [f64; 2],
}

fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

impl Bilinear {
    /// The map that takes (0, 0), (1, 0), (1, 1), (0, 1) to `corners`, which are convex and counter-clockwise.
    pub fn new([a, p, q, r]: [[f64; 2]; 4]) -> Self {
        let less = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
        let (b, c) = (less(p, a), less(r, a));
        Bilinear { a, b, c, d: less(less(q, r), b) }
    }

    /// The point of the quadrilateral.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| self.a[k] + (self.b[k] * x + self.c[k] * y + self.d[k] * x * y))
    }

    /// The derivatives by ξ and by η.
    fn tangents(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        [[0, 1].map(|k| self.b[k] + self.d[k] * y), [0, 1].map(|k| self.c[k] + self.d[k] * x)]
    }

    /// The determinant of the derivative: area of the quadrilateral for area of the square.
    pub fn determinant(&self, at: [f64; 2]) -> f64 {
        let [u, v] = self.tangents(at);
        cross(u, v)
    }

    /// The point of the square for a point in the quadrilateral or near it.
    pub fn inverse(&self, p: [f64; 2]) -> [f64; 2] {
        let h = [0, 1].map(|k| p[k] - self.a[k]);
        // η solves q η² + l η + n = 0, where the square root is the determinant there: positive.
        let (q, l, n) = (cross(self.d, self.c), cross(self.b, self.c) + cross(h, self.d), cross(h, self.b));
        let root = (l * l - 4.0 * q * n).max(0.0).sqrt();
        let y = if l >= 0.0 { -2.0 * n / (l + root) } else { (root - l) / (2.0 * q) };
        let along = [0, 1].map(|k| self.b[k] + self.d[k] * y);
        let rest = [0, 1].map(|k| h[k] - self.c[k] * y);
        let x = (rest[0] * along[0] + rest[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        // A step of Newton's takes back what cancelled.
        let [u, v] = self.tangents([x, y]);
        let off = [0, 1].map(|k| h[k] - (self.b[k] * x + self.c[k] * y + self.d[k] * x * y));
        let size = cross(u, v);
        [x + cross(off, v) / size, y + cross(u, off) / size]
    }

    /// The gradients, in the plane, of the functions of degree `k` in each coordinate that are one at one of the points at equal
    /// steps and zero at the others; row by row.
    pub fn gradients(&self, k: usize, at: [f64; 2]) -> Vec<[f64; 2]> {
        let [u, v] = self.tangents(at);
        let size = cross(u, v);
        let [(x, dx), (y, dy)] = at.map(|s| line(k, s));
        let grid = y.iter().zip(&dy).flat_map(|(y, dy)| x.iter().zip(&dx).map(move |(x, dx)| [dx * y, x * dy]));
        grid.map(|[g, h]| [(g * v[1] - h * u[1]) / size, (h * u[0] - g * v[0]) / size]).collect()
    }
}

/// The values of the functions whose gradients are [`Bilinear::gradients`].
pub fn values(k: usize, [x, y]: [f64; 2]) -> Vec<f64> {
    let (x, y) = (line(k, x).0, line(k, y).0);
    y.iter().flat_map(|y| x.iter().map(move |x| x * y)).collect()
}

/// The Lagrange polynomials of degree `k` to points at equal steps, and their derivatives.
pub fn line(k: usize, s: f64) -> (Vec<f64>, Vec<f64>) {
    let point = |j: usize| j as f64 / k as f64;
    let factor = |i: usize, j: usize| (s - point(j)) / (point(i) - point(j));
    let others = |i: usize| (0..=k).filter(move |j| *j != i);
    let value = |i: usize| others(i).map(|j| factor(i, j)).product();
    let slope = |i: usize| {
        let without =
            |m: usize| others(i).filter(|j| *j != m).map(|j| factor(i, j)).product::<f64>() / (point(i) - point(m));
        others(i).map(without).sum()
    };
    ((0..=k).map(value).collect(), (0..=k).map(slope).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_inverse_leads_back(moved in prop::array::uniform8(-0.24..0.24_f64), x in 0.0..=1.0_f64, y in 0.0..=1.0_f64,
            angle in 0.0..6.3_f64) {
            let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let (s, c) = angle.sin_cos();
            let corners = [0, 1, 2, 3].map(|i| {
                let [x, y] = [0, 1].map(|k| square[i][k] + moved[2 * i + k]);
                [c * x - s * y + 3.0, s * x + c * y - 1.0]
            });
            let map = Bilinear::new(corners);
            let back = map.inverse(map.at([x, y]));
            prop_assert!((back[0] - x).hypot(back[1] - y) < 1e-12, "{back:?} is not {x}, {y}");
            for (corner, at) in corners.iter().zip(square) {
                let found = map.at(at);
                prop_assert!((found[0] - corner[0]).hypot(found[1] - corner[1]) < 1e-14);
            }
        }

        #[test]
        fn gradients_are_those_of_the_values(k in 1..5_usize, x in 0.1..0.9_f64, y in 0.1..0.9_f64) {
            let map = Bilinear::new([[0.0, 0.0], [2.0, 0.3], [1.7, 1.5], [-0.2, 1.0]]);
            let p = map.at([x, y]);
            const STEP: f64 = 1e-5;
            let gradients = map.gradients(k, [x, y]);
            for c in 0..2 {
                let beside = |sign: f64| {
                    let mut q = p;
                    q[c] += sign * STEP;
                    values(k, map.inverse(q))
                };
                for ((up, down), g) in beside(1.0).iter().zip(beside(-1.0)).zip(&gradients) {
                    prop_assert!((g[c] - (up - down) / (2.0 * STEP)).abs() < 1e-6);
                }
            }
            prop_assert!((values(k, [x, y]).iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}
