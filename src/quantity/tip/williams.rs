//! The fields of Williams at the tip of a crack with faces free of traction, in Kolosov's and Muskhelishvili's potentials.
//!
//! 2μ(u_1 + i u_2) = κ φ(z) − z φ̄'(z̄) − ψ̄(z̄), σ_11 + σ_22 = 4 Re φ', σ_22 − σ_11 + 2iσ_12 = 2(z̄ φ'' + ψ'), with x_1 along the growth of the
//! crack, whose faces are at ±π. With φ = a z^{1/2}, ψ = (ā − a/2) z^{1/2} the faces are free, and a = (K_I − i K_II)/√(2π); with
//! φ = a z^{−1/2}, ψ = (ā + a/2) z^{−1/2} as well: the latter, of infinite energy, extracts the former.

use std::f64::consts::PI;

use nalgebra::Complex;

use crate::element::polynomial::quadrature::segment_rule;
use crate::scene::Mode;

/// A field of one power of r, with the material it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct Williams {
    power: f64,
    phi: Complex<f64>,
    psi: Complex<f64>,
    kolosov: f64,
    shear: f64,
}

impl Williams {
    /// The regular field of K = 1; λ + μ and μ of the plane.
    pub fn regular(mode: Mode, [bulk, shear]: [f64; 2]) -> Self {
        let a = match mode {
            Mode::I => Complex::new(1.0 / (2.0 * PI).sqrt(), 0.0),
            Mode::II => Complex::new(0.0, -1.0 / (2.0 * PI).sqrt()),
        };
        let kolosov = (bulk + 2.0 * shear) / bulk;
        Williams { power: 0.5, phi: a, psi: a.conj() - 0.5 * a, kolosov, shear }
    }

    /// The field of power −½ that extracts K from a body that has the angles `span` about the tip.
    pub fn extracting(mode: Mode, constants: [f64; 2], span: [f64; 2]) -> Self {
        let regular = Williams::regular(mode, constants);
        let a = match mode {
            Mode::I => Complex::new(1.0, 0.0),
            Mode::II => Complex::new(0.0, 1.0),
        };
        let unit = Williams { power: -0.5, phi: a, psi: a.conj() + 0.5 * a, ..regular };
        // ∮ (T(w)·u − T(u)·w) ds on any circle, with the outward normal.
        let mut sum = 0.0;
        for (s, weight) in segment_rule(40) {
            let angle = span[0] + s * (span[1] - span[0]);
            let n = [angle.cos(), angle.sin()];
            let work = |of: &Williams, on: &Williams| {
                let ([xx, yy, xy], u) = (of.stress(n), on.displacement(n));
                (xx * n[0] + xy * n[1]) * u[0] + (xy * n[0] + yy * n[1]) * u[1]
            };
            sum += weight * (span[1] - span[0]) * (work(&unit, &regular) - work(&regular, &unit));
        }
        let scale = -1.0 / sum;
        Williams { phi: scale * unit.phi, psi: scale * unit.psi, ..unit }
    }

    /// Displacement at a point seen from the tip, in the axes of the crack.
    pub fn displacement(&self, x: [f64; 2]) -> [f64; 2] {
        let z = Complex::new(x[0], x[1]);
        let power = z.powf(self.power);
        let slope = self.power * self.phi * power / z;
        let u = (self.kolosov * self.phi * power - z * slope.conj() - (self.psi * power).conj()) / (2.0 * self.shear);
        [u.re, u.im]
    }

    /// Stress at a point seen from the tip, in the axes of the crack.
    pub fn stress(&self, x: [f64; 2]) -> [f64; 3] {
        let z = Complex::new(x[0], x[1]);
        let power = z.powf(self.power - 1.0);
        let slope = self.power * self.phi * power;
        let bend = (self.power - 1.0) * slope / z;
        let difference = 2.0 * (z.conj() * bend + self.power * self.psi * power);
        let half = 2.0 * slope.re;
        [half - 0.5 * difference.re, half + 0.5 * difference.re, 0.5 * difference.im]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: [f64; 2] = [2.3, 0.8];

    #[test]
    fn displacement_and_stress_belong_together_and_faces_are_free() {
        for mode in [Mode::I, Mode::II] {
            for field in [Williams::regular(mode, CONSTANTS), Williams::extracting(mode, CONSTANTS, [-PI, PI])] {
                for x in [[0.3, 0.4], [-0.5, 0.2], [-0.1, -0.7], [0.9, -0.05]] {
                    let h = 1e-6;
                    let slope = |c: usize, d: usize| {
                        let mut ends = [x; 2];
                        ends[0][d] += h;
                        ends[1][d] -= h;
                        (field.displacement(ends[0])[c] - field.displacement(ends[1])[c]) / (2.0 * h)
                    };
                    let [bulk, shear] = CONSTANTS;
                    let e = [slope(0, 0), slope(1, 1), 0.5 * (slope(0, 1) + slope(1, 0))];
                    let (mean, half) = (bulk * (e[0] + e[1]), shear * (e[0] - e[1]));
                    let expected = [mean + half, mean - half, 2.0 * shear * e[2]];
                    let found = field.stress(x);
                    for c in 0..3 {
                        assert!((found[c] - expected[c]).abs() < 1e-6, "{mode:?} {x:?}: {found:?} {expected:?}");
                    }
                }
                for angle in [PI, -PI] {
                    let z = [0.7 * angle.cos(), 0.7 * angle.sin()];
                    let [_, yy, xy] = field.stress(z);
                    assert!(yy.abs() < 1e-12 && xy.abs() < 1e-12);
                }
            }
            // K by its definition.
            let r = 1e-3;
            let [_, yy, xy] = Williams::regular(mode, CONSTANTS).stress([r, 0.0]);
            let k = [yy, xy].map(|s| s * (2.0 * PI * r).sqrt());
            let expected = if mode == Mode::I { [1.0, 0.0] } else { [0.0, 1.0] };
            assert!((0..2).all(|i| (k[i] - expected[i]).abs() < 1e-12), "{k:?}");
        }
    }
}
