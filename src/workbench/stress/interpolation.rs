//! Polynomial solutions of elasticity belong to the space.

use nalgebra::{Complex, DMatrix};

use super::fields::Fields;
use super::{StressElement, worst};
use crate::workbench::finding::{Measured, Property};

pub const INTERPOLATION: Property<dyn StressElement> = Property {
    name: "interpolation",
    asks: "all polynomial stresses up to degree p that solve the equations of elasticity are in the space",
    usual: true,
    measure: |e| {
        let (value, place) = worst(e, missed);
        let text = match value <= ALLOWED {
            true => {
                "Polynomial solutions of elasticity are in the space; the part of their energy norm that is missed is"
                    .to_string()
            }
            false => format!(
                "A polynomial solution of elasticity is not in the space: worst on the triangle {place}; missed of its energy norm is"
            ),
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

const ALLOWED: f64 = 1e-7;

/// The stress of Re(z̄ f + g) (Kolosov): σ_xx + σ_yy = 4 Re f', σ_yy − σ_xx + 2iσ_xy = 2(z̄ f'' + g''), with f = c z^n or g = c z^n.
fn solution(is_f: bool, c: Complex<f64>, n: usize, [x, y]: [f64; 2]) -> [f64; 3] {
    let z = Complex::new(x, y);
    let n = n as i32;
    let first = c * f64::from(n) * if n > 0 { z.powi(n - 1) } else { 0.0.into() };
    let second = c * f64::from(n * (n - 1)) * if n > 1 { z.powi(n - 2) } else { 0.0.into() };
    let (sum, turned) = if is_f { (4.0 * first.re, z.conj() * second * 2.0) } else { (0.0, second * 2.0) };
    [0.5 * (sum - turned.re), 0.5 * (sum + turned.re), 0.5 * turned.im]
}

/// The largest part of a solution of degree up to p that is not in the space, in the energy norm relative to its own.
fn missed(fields: &Fields) -> f64 {
    let [a, b, c] = fields.corners;
    let centre = [0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0);
    let size = super::fields::side(fields.corners, 0).length.max(super::fields::side(fields.corners, 1).length);
    let space = fields.columns(&fields.fields);
    let Some(basis) = orthonormal(&space) else { return f64::NAN };
    let mut worst = 0.0_f64;
    for degree in 0..=fields.degree {
        for is_f in [true, false] {
            for c in [Complex::new(1.0, 0.0), Complex::new(0.0, 1.0)] {
                let n = if is_f { degree + 1 } else { degree + 2 };
                let column = fields.column(|part, l| {
                    let at = [0, 1].map(|k| {
                        let x: f64 = (0..3).map(|i| l[i] * fields.parts[part][i][k]).sum();
                        (x - centre[k]) / size
                    });
                    solution(is_f, c, n, at)
                });
                let exact = DMatrix::from_vec(column.len(), 1, column);
                // A rotation alone, f = i z, has no stress.
                if exact.norm() > 0.0 {
                    let rest = &exact - &basis * basis.tr_mul(&exact);
                    worst = worst.max(rest.norm() / exact.norm());
                }
            }
        }
    }
    worst
}

/// An orthonormal basis of the columns.
pub fn orthonormal(space: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let svd = space.clone().svd(true, false);
    let least = 1e-10 * svd.singular_values.max();
    let kept: Vec<usize> = (0..svd.singular_values.len()).filter(|&k| svd.singular_values[k] > least).collect();
    svd.u.map(|u| u.select_columns(&kept))
}
