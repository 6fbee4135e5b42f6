//! The stiffness T Tᵀ goes with the triangle.

use nalgebra::DMatrix;

use super::{FORCE, StressElement, usual};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;

pub const FRAME: Property<dyn StressElement> = Property {
    name: "invariance",
    asks: "another place, direction and size, and another first corner, give the same T Tᵀ in its own frame",
    usual: true,
    measure,
};

const ALLOWED: f64 = 1e-9;

fn measure(e: &dyn StressElement) -> Result<Measured, Fault> {
    let fields = usual(e)?;
    let (sin, cos) = 1.1_f64.sin_cos();
    let moved = fields.corners.map(|[x, y]| [4.0 * (cos * x - sin * y) + 7.0, 4.0 * (sin * x + cos * y)]);
    let other = e.fields([moved[1], moved[2], moved[0]], &Material::USUAL.compliance(), FORCE);
    let (own, other) = (fields.forces(), other.forces());
    let per_side = own.nrows() / 3;
    let turned = DMatrix::from_fn(own.nrows(), own.ncols(), |i, k| {
        let from = (i + per_side) % own.nrows();
        let (x, y) = (own[(from - from % 2, k)], own[(from - from % 2 + 1, k)]);
        if i % 2 == 0 { cos * x - sin * y } else { sin * x + cos * y }
    });
    let (own, other) = (&turned * turned.transpose(), &other * other.transpose());
    let value = (&own - other).amax() / own.amax();
    let text = match value <= ALLOWED {
        true => "T Tᵀ goes with the triangle, relative to its largest entry",
        false => "T Tᵀ depends on place, direction, size or first corner, relative to its largest entry",
    };
    Ok(Measured::new(value, ALLOWED, text))
}
