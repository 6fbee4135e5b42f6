//! Traction coefficients: those of the stresses, and in balance.

use super::fields::{Fields, area, side, traction};
use super::{StressElement, worst};
use crate::element::geometry::sub_corners;
use crate::element::polynomial::side as polynomial;
use crate::workbench::finding::{Measured, Property};

pub const COEFFICIENTS: Property<dyn StressElement> = Property {
    name: "traction-coefficients",
    asks: "the traction coefficients are those of the stresses on the sides",
    usual: true,
    measure: |e| {
        let (value, place) = worst(e, coefficients);
        let text = match value <= ALLOWED {
            true => "Traction coefficients belong to the stresses, relative to their size".to_string(),
            false => format!(
                "Traction coefficients are not those of the stresses: worst on the triangle {place}, relative to their size"
            ),
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

pub const RESULTANT: Property<dyn StressElement> = Property {
    name: "self-equilibrium",
    asks: "the tractions of every mode have neither force nor moment, those of λ̄ balance the body force: K = T Tᵀ annihilates rigid motions",
    usual: true,
    measure: |e| {
        let (value, place) = worst(e, resultant);
        let text = match value <= ALLOWED {
            true => "Tractions balance, relative to the sum of their sizes".to_string(),
            false => format!(
                "Tractions have a force or a moment: worst on the triangle {place}, relative to the sum of their sizes"
            ),
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

const ALLOWED: f64 = 1e-10;

/// Traction coefficients against the stresses on the sides, relative to the size of the field.
pub fn coefficients(fields: &Fields) -> f64 {
    let n = fields.degree + 1;
    let mut worst = 0.0_f64;
    for (field, tractions, _) in fields.all() {
        for s in 0..3 {
            let normal = side(fields.corners, s).normal;
            for step in 0..=n {
                let x = step as f64 / n as f64;
                let (part, l) = fields.on_side(s, x);
                for (c, t) in traction(field.at(part, l), normal).into_iter().enumerate() {
                    let own: Vec<f64> = (0..n).map(|k| tractions[2 * (s * n + k) + c]).collect();
                    worst = worst.max((polynomial::value(&own, x) - t).abs() / field.largest());
                }
            }
        }
    }
    worst
}

/// Force and moment of the tractions with the body force, from their coefficients, relative to the sum of their sizes.
pub fn resultant(fields: &Fields) -> f64 {
    let n = fields.degree + 1;
    let centre = sub_corners(fields.corners, 0)[2];
    let mut worst = 0.0_f64;
    for (_, tractions, force) in fields.all() {
        let load = force.map(|f| f * area(fields.corners));
        let (mut sum, mut size) = ([load[0], load[1], 0.0], [load[0].hypot(load[1]), 0.0]);
        for s in 0..3 {
            let side = side(fields.corners, s);
            for (i, t) in tractions[2 * s * n..2 * (s + 1) * n].chunks_exact(2).enumerate() {
                // ∫ B_i ds = ℓ/(p + 1), and its centre divides the side as (i + 1) : (p + 1 − i).
                let (weight, x) = (side.length / n as f64, (i + 1) as f64 / (n + 1) as f64);
                let arm = [0, 1].map(|c| side.start[c] + x * (side.end[c] - side.start[c]) - centre[c]);
                sum[0] += weight * t[0];
                sum[1] += weight * t[1];
                sum[2] += weight * (arm[0] * t[1] - arm[1] * t[0]);
                size[0] += weight * t[0].hypot(t[1]);
                size[1] += weight * t[0].hypot(t[1]) * arm[0].hypot(arm[1]);
            }
        }
        worst = worst.max(sum[0].hypot(sum[1]) / size[0].max(1e-300)).max(sum[2].abs() / size[1].max(1e-300));
    }
    worst
}
