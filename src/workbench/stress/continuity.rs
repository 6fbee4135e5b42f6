//! Continuous tractions inside.

use super::fields::{Fields, traction};
use super::{StressElement, worst};
use crate::workbench::finding::{Measured, Property};

pub const CONTINUITY: Property<dyn StressElement> = Property {
    name: "inner-continuity",
    asks: "tractions are continuous across the segments between the parts of the triangle",
    usual: true,
    measure: |e| {
        let (value, place) = worst(e, inner_jump);
        let text = match value <= ALLOWED {
            true => "Tractions are continuous inside, relative to the size of the stress".to_string(),
            false => {
                format!("Tractions jump inside: worst on the triangle {place}, relative to the size of the stress")
            }
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

const ALLOWED: f64 = 1e-10;

/// The largest jump of the traction across inner segments, relative to the size of the field. A triangle of one part has none.
pub fn inner_jump(fields: &Fields) -> f64 {
    let mut worst = 0.0_f64;
    if fields.parts.len() < 3 {
        return worst;
    }
    let steps = fields.degree + 1;
    for (field, ..) in fields.all() {
        for sub in 0..3 {
            let q = fields.parts[sub];
            // From a_{sub + 2} to the centroid.
            let (dx, dy) = (q[2][0] - q[1][0], q[2][1] - q[1][1]);
            let n = [dy / dx.hypot(dy), -dx / dx.hypot(dy)];
            for step in 0..=steps {
                let s = step as f64 / steps as f64;
                // The corner is the second one of part `sub` and the first one of the next.
                let l = traction(field.at(sub, [0.0, 1.0 - s, s]), n);
                let m = traction(field.at((sub + 1) % 3, [1.0 - s, 0.0, s]), n);
                worst = worst.max((l[0] - m[0]).hypot(l[1] - m[1]) / field.largest());
            }
        }
    }
    worst
}
