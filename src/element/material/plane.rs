//! Any material that is symmetric about the plane.

use crate::elasticity::Plane;

/// Directions in which moduli are looked at.
const DIRECTIONS: usize = 36;

/// A factor of the compliance, and its inverse.
///
/// Stresses are counted as m = (σ_xx + σ_yy)/2, d = (σ_xx − σ_yy)/2 and s = σ_xy, strains by the trace, ε_xx − ε_yy and 2 ε_xy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct General {
    /// One over a compliance of the material: factors have entries about one.
    pub unit: f64,
    /// R of a = RᵀR/unit. The second and the third row have nothing of m.
    pub factor: [[f64; 3]; 3],
    /// R⁻ᵀ; the first row has the trace alone.
    inverse: [[f64; 3]; 3],
    /// σ_33 for a unit of m, d and s.
    transverse: [f64; 3],
    /// The least and the largest Young's modulus.
    pub young: [f64; 2],
    /// The largest c_1111 of all directions.
    pub uniaxial: f64,
}

/// m, d and s of a stress.
pub fn unknowns([xx, yy, xy]: [f64; 3]) -> [f64; 3] {
    [0.5 * (xx + yy), 0.5 * (xx - yy), xy]
}

/// The strains that do work on them.
fn strains([xx, yy, xy]: [f64; 3]) -> [f64; 3] {
    [xx + yy, xx - yy, 2.0 * xy]
}

/// A matrix times a vector.
pub fn times(rows: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    rows.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
}

/// A transposed matrix times a vector.
fn times_transposed(rows: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| rows[0][i] * x[0] + rows[1][i] * x[1] + rows[2][i] * x[2])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Rows that act on m, d and s in axes whose first one has the double angle (cos, sin).
fn turned(rows: &[[f64; 3]; 3], [c, s]: [f64; 2]) -> [[f64; 3]; 3] {
    rows.map(|row| turned_row(row, [c, s]))
}

fn turned_row([m, d, t]: [f64; 3], [c, s]: [f64; 2]) -> [f64; 3] {
    [m, c * d + s * t, c * t - s * d]
}

impl General {
    pub fn new(plane: &Plane) -> Self {
        let largest = plane.factor.as_flattened().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let own = General {
            unit: 1.0 / (largest * largest),
            factor: plane.factor.map(|row| row.map(|x| x / largest)),
            inverse: plane.inverse.map(|row| row.map(|x| x * largest)),
            transverse: plane.transverse,
            young: [1.0; 2],
            uniaxial: 1.0,
        };
        let (mut young, mut uniaxial) = ([f64::INFINITY, 0.0_f64], 0.0_f64);
        for k in 0..DIRECTIONS {
            let (sin, cos) = (std::f64::consts::PI * k as f64 / DIRECTIONS as f64).sin_cos();
            let along = [cos * cos, sin * sin, cos * sin];
            let modulus = 1.0 / own.product(along, along);
            young = [young[0].min(modulus), young[1].max(modulus)];
            uniaxial = uniaxial.max(own.strain_product(along, along));
        }
        General { young, uniaxial, ..own }
    }

    pub fn product(&self, l: [f64; 3], m: [f64; 3]) -> f64 {
        dot(times(&self.factor, unknowns(l)), times(&self.factor, unknowns(m))) / self.unit
    }

    pub fn strain(&self, l: [f64; 3]) -> [f64; 3] {
        let [trace, across, shear] = times_transposed(&self.factor, times(&self.factor, unknowns(l)));
        [0.5 * (trace + across), 0.5 * (trace - across), 0.5 * shear].map(|e| e / self.unit)
    }

    pub fn stress(&self, e: [f64; 3]) -> [f64; 3] {
        let [m, d, s] = times_transposed(&self.inverse, times(&self.inverse, strains(e)));
        [m + d, m - d, s].map(|s| self.unit * s)
    }

    pub fn strain_product(&self, e: [f64; 3], d: [f64; 3]) -> f64 {
        self.unit * dot(times(&self.inverse, strains(e)), times(&self.inverse, strains(d)))
    }

    /// Largest change of a λ:λ by rounding of the factor and of a stress, relative to one rounding.
    pub fn spread(&self, l: [f64; 3]) -> f64 {
        let x = unknowns(l);
        let row = |row: &[f64; 3]| {
            let value = row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
            let terms = (row[0] * x[0]).abs() + (row[1] * x[1]).abs() + (row[2] * x[2]).abs();
            2.0 * value.abs() * terms
        };
        self.factor.iter().map(row).sum::<f64>() / self.unit
    }

    pub fn in_frame(&self, [x, y]: [f64; 2]) -> Self {
        let double = [(x - y) * (x + y), 2.0 * x * y];
        General {
            factor: turned(&self.factor, double),
            inverse: turned(&self.inverse, double),
            transverse: turned_row(self.transverse, double),
            ..*self
        }
    }

    pub fn out_of_plane(&self, l: [f64; 3]) -> f64 {
        dot(self.transverse, unknowns(l))
    }
}
