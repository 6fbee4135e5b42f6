//! The weight of a mean over a disc that is the value in its middle.
//!
//! For every biharmonic f in the disc of radius R about x0, f(x0) = ∫ k f with
//!
//! k(s) = 2(n + 2)/(πR²) (1 − s)ⁿ (1 − (n + 3)s/2), s = |x − x0|²/R²,
//!
//! because means over circles are f(x0) + r² Δf(x0)/4, and ∫ k = 1, ∫ k r² = 0. It has n − 1 continuous derivatives across the
//! circle. It is the divergence of (x − x0) G(s), the flux of which is 1 through the circle:
//!
//! G(s) = [1 − (1 − s)ⁿ⁺¹ (1 − (n + 3)s)]/(2πR² s), a polynomial.

use std::f64::consts::PI;

use crate::element::polynomial::side::binomial;

/// k and G of one disc.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    radius: f64,
    smoothness: usize,
    /// The coefficients of 2πR² G in powers of s.
    flux: Vec<f64>,
}

impl Kernel {
    /// For a disc of this radius, with n = `smoothness`.
    pub fn new(radius: f64, smoothness: usize) -> Self {
        let m = smoothness + 1;
        let power = |j: usize| if j > m { 0.0 } else { binomial(m, j) * if j.is_multiple_of(2) { 1.0 } else { -1.0 } };
        let slope = (smoothness + 3) as f64;
        // Of (1 − s)^m (1 − slope · s), without its constant 1, divided by s.
        let flux = (1..=m + 1).map(|j| slope * power(j - 1) - power(j)).collect();
        Kernel { radius, smoothness, flux }
    }

    /// The degree of k as a polynomial of the coordinates; x G has one more.
    pub fn degree(&self) -> usize {
        2 * self.smoothness + 2
    }

    fn s(&self, [x, y]: [f64; 2]) -> f64 {
        let [x, y] = [x / self.radius, y / self.radius];
        x * x + y * y
    }

    /// k at a point as seen from the middle; beyond the circle its continuation.
    pub fn weight(&self, from_middle: [f64; 2]) -> f64 {
        let (s, n) = (self.s(from_middle), self.smoothness as f64);
        let scale = 2.0 * (n + 2.0) / (PI * self.radius * self.radius);
        scale * (1.0 - s).powi(self.smoothness as i32) * (1.0 - 0.5 * (n + 3.0) * s)
    }

    /// (x − x0) G.
    pub fn flux(&self, from_middle: [f64; 2]) -> [f64; 2] {
        let s = self.s(from_middle);
        let sum = self.flux.iter().rev().fold(0.0, |sum, c| sum * s + c);
        from_middle.map(|x| x * sum / (2.0 * PI * self.radius * self.radius))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::polynomial::quadrature::segment_rule;

    /// ∫ k f over the disc, in polar coordinates.
    fn mean(kernel: &Kernel, f: impl Fn([f64; 2]) -> f64) -> f64 {
        let steps = 64;
        let mut sum = 0.0;
        for (r, w) in segment_rule(40) {
            let r = r * kernel.radius;
            for i in 0..steps {
                let a = 2.0 * PI * f64::from(i) / f64::from(steps);
                let x = [r * a.cos(), r * a.sin()];
                sum += w * kernel.radius * 2.0 * PI / f64::from(steps) * r * kernel.weight(x) * f(x);
            }
        }
        sum
    }

    #[test]
    fn biharmonic_functions_have_their_value_in_the_middle() {
        // Real parts of z̄ z^k and z^k, about a middle that lies anywhere.
        let power = |[x, y]: [f64; 2], k: i32| {
            let (r, a) = (x.hypot(y), y.atan2(x));
            r.powi(k) * (f64::from(k) * a).cos()
        };
        for n in 0..=6 {
            let kernel = Kernel::new(1.7, n);
            for k in 0..8 {
                let harmonic = |x: [f64; 2]| power([x[0] + 0.4, x[1] - 1.1], k);
                let with_square = |x: [f64; 2]| (x[0] * x[0] + x[1] * x[1] + x[0] - 2.0) * harmonic(x);
                assert!((mean(&kernel, harmonic) - harmonic([0.0; 2])).abs() < 1e-10 * 3.0_f64.powi(k));
                assert!((mean(&kernel, with_square) - with_square([0.0; 2])).abs() < 1e-10 * 3.0_f64.powi(k));
            }
            let triharmonic = mean(&kernel, |[x, y]| (x * x + y * y).powi(2));
            assert!(triharmonic.abs() > 1e-3, "of r⁴ the mean is not the value: {triharmonic}");
        }
    }

    #[test]
    fn the_flux_has_the_weight_as_its_divergence() {
        for n in 0..=6 {
            let kernel = Kernel::new(0.8, n);
            let (x, h) = ([0.31, -0.27], 1e-5);
            let by = |c: usize| {
                let mut ends = [x; 2];
                ends[0][c] += h;
                ends[1][c] -= h;
                (kernel.flux(ends[0])[c] - kernel.flux(ends[1])[c]) / (2.0 * h)
            };
            assert!((by(0) + by(1) - kernel.weight(x)).abs() < 1e-7 * kernel.weight([0.0; 2]).abs());
            let out = kernel.flux([0.0, 0.8])[1] * 2.0 * PI * 0.8;
            assert!((out - 1.0).abs() < 1e-12);
        }
    }
}
