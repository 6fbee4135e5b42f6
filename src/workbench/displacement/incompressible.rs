//! Flexibility that an element keeps as ν → ½.

use super::DisplacementElement;
use super::convergence::{Level, levels};
use crate::report::text::number::percent;
use crate::scene::Kinematics;
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::picture;
use crate::workbench::scene;

pub const INCOMPRESSIBLE: Property<DisplacementElement> = Property {
    name: "incompressible",
    asks: "a square of elements keeps its flexibility as ν → ½ in plane strain: the element does not lock",
    usual: false,
    measure,
};

const HARMLESS: f64 = 0.3;
const POISSON: [f64; 4] = [HARMLESS, 0.49, 0.4999, 0.499_999];
/// The part of the flexibility that may be lost on the finest mesh.
const LOST: f64 = 0.05;

/// 𝓛(u) is negative and 𝓛(u_h) comes nearer to zero: what the mesh stores is this part of what it should.
fn flexibility(levels: &[Level], lower: f64) -> Vec<f64> {
    levels.iter().map(|l| l.energy / lower).collect()
}

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let material = e.material()?;
    if material.kinematics == Kinematics::PlaneStress {
        return Err(Fault::NotMade("plane stress knows no incompressible limit".into()));
    }
    let (mut series, mut left) = (Vec::new(), Vec::new());
    for poisson in POISSON {
        let material = material.with_poisson(poisson);
        let exact = scene::exact(&material)?;
        let levels = levels(e, &material)?;
        let parts = flexibility(&levels, exact.lower);
        left.push(parts.last().copied().unwrap_or(f64::NAN));
        let points = levels.iter().zip(&parts).map(|(l, part)| [l.cells as f64, *part]).collect();
        series.push((format!("ν = {poisson}"), points));
    }
    let last = left[left.len() - 1];
    let value = (1.0 - last).abs();
    let text = format!(
        "On the finest mesh the element has {} of the exact flexibility at ν = 0.3 and {} at ν = 0.499999; this part is lost",
        percent(left[0]),
        percent(last)
    );
    let drawn = picture::curves(
        "Flexibility of a square of elements",
        ["cells a side", "part of the exact flexibility"],
        &series,
    );
    Ok(Measured::new(value, LOST, text).drawn(drawn))
}
