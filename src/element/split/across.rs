//! The self-equilibrated fields without stress along the longest side.
//!
//! With x along the longest side, τ_xx = 0 leaves τ_xy = −g(x) and τ_yy = f(x) + y g'(x), with polynomials f and g of degree p: 2(p + 1)
//! fields, on the whole triangle. On a triangle of aspect ratio r a field in general has τ_xy and τ_yy smaller than τ_xx by r and r²;
//! written in such fields, these would be differences of large numbers. They are a complement of all fields without traction on the
//! longest side, for tractions there determine f and g.

use super::shape::Shape;
use crate::element::MAX_DEGREE;

/// The fields of one shape, with Legendre polynomials over the longest side for f and g.
pub struct Across<'a> {
    shape: &'a Shape,
    degree: usize,
}

impl<'a> Across<'a> {
    /// The fields of degree p.
    pub fn new(shape: &'a Shape, degree: usize) -> Self {
        Across { shape, degree }
    }

    /// Their number.
    pub fn len(degree: usize) -> usize {
        2 * (degree + 1)
    }

    /// (τ_yy, τ_xy) of every field at a point: those of f, then those of g.
    pub fn at(&self, point: [f64; 2], mut each: impl FnMut(usize, [f64; 2])) {
        let p = self.degree;
        let (values, slopes) = self.legendre(point[0]);
        for j in 0..=p {
            each(j, [values[j], 0.0]);
            each(p + 1 + j, [point[1] * slopes[j], -values[j]]);
        }
    }

    /// P_j and their derivatives along x.
    fn legendre(&self, x: f64) -> ([f64; MAX_DEGREE + 1], [f64; MAX_DEGREE + 1]) {
        let t = (x + 0.5 * self.shape.apex[0]) / self.shape.half;
        let (mut values, mut slopes) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        (values[0], values[1], slopes[1]) = (1.0, t, 1.0 / self.shape.half);
        for j in 1..self.degree {
            let n = j as f64;
            values[j + 1] = ((2.0 * n + 1.0) * t * values[j] - n * values[j - 1]) / (n + 1.0);
            slopes[j + 1] = slopes[j - 1] + (2.0 * n + 1.0) * values[j] / self.shape.half;
        }
        (values, slopes)
    }
}
