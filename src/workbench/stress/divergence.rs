//! div τ = 0 at every point.

use super::fields::{Fields, Nodal, area};
use super::{StressElement, worst};
use crate::workbench::finding::{Measured, Property};

pub const DIVERGENCE: Property<dyn StressElement> = Property {
    name: "divergence",
    asks: "div τ = 0 in every mode, and div λ̄ = −F, at every point",
    usual: true,
    measure: |e| {
        let (value, place) = worst(e, divergence);
        let text = match value <= ALLOWED {
            true => "Stresses balance at every point, relative to their size over that of the triangle".to_string(),
            false => format!(
                "Stresses do not balance: worst on the triangle {place}, relative to their size over that of the triangle"
            ),
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

const ALLOWED: f64 = 1e-9;

/// Points of a part.
const POINTS: [[f64; 3]; 5] =
    [[0.2, 0.3, 0.5], [0.7, 0.1, 0.2], [1.0, 0.0, 0.0], [0.05, 0.05, 0.9], [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]];

/// The largest |div τ + F| √area at points of every part, relative to the size of the field.
pub fn divergence(fields: &Fields) -> f64 {
    let h = area(fields.corners).sqrt();
    let mut worst = 0.0_f64;
    for (field, _, force) in fields.all() {
        let size = field.largest() + h * force[0].hypot(force[1]);
        for div in at_points(fields, field) {
            worst = worst.max((div[0] + force[0]).hypot(div[1] + force[1]) * h / size);
        }
    }
    worst
}

/// div τ at points of every part.
pub fn at_points(fields: &Fields, field: &Nodal) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for (part, q) in fields.parts.iter().enumerate() {
        // Gradients of the first two barycentric coordinates.
        let [g, e] = [(1, 2), (2, 0)].map(|(i, j): (usize, usize)| {
            [(q[i][1] - q[j][1]) / (2.0 * area(*q)), (q[j][0] - q[i][0]) / (2.0 * area(*q))]
        });
        for l in POINTS {
            let [_, d, f] = field.jet(part, l);
            let of = |c: usize, axis: usize| d[c] * g[axis] + f[c] * e[axis];
            all.push([of(0, 0) + of(2, 1), of(2, 0) + of(1, 1)]);
        }
    }
    all
}
