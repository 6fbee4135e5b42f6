//! What is left of the flexibility as ν → ½.

use super::DisplacementElement;
use super::convergence::{Level, levels};
use crate::report::number::percent;
use crate::scene::Kinematics;
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::picture;
use crate::workbench::scene;

pub const INCOMPRESSIBLE: Property<DisplacementElement> = Property {
    name: "incompressible",
    asks: "the energy error on a mesh does not grow as ν → ½ in plane strain: the element does not lock",
    usual: true,
    measure,
};

const HARMLESS: f64 = 0.3;
const POISSON: [f64; 4] = [HARMLESS, 0.49, 0.4999, 0.499_999];
/// What the error may grow to; a factor of three in the energy norm.
const GROWTH: f64 = 9.0;

/// 𝓛(u) is negative and 𝓛(u_h) comes nearer to zero: what the mesh stores is this part of what it should.
fn flexibility(levels: &[Level], lower: f64) -> Vec<f64> {
    levels.iter().map(|l| l.energy / lower).collect()
}

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.needs_formula()?;
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
    let off = |part: f64| (1.0 - part).abs().max(1e-12);
    let last = left[left.len() - 1];
    let value = off(last) / off(left[0]);
    let text = format!(
        "On the finest mesh the element has {} of the exact flexibility at ν = 0.3 and {} at ν = 0.499999; the error grows by this factor",
        percent(left[0]),
        percent(last)
    );
    let drawn = picture::curves(
        "Flexibility of a square of elements",
        ["cells a side", "part of the exact flexibility"],
        &series,
    );
    Ok(Measured::new(value, GROWTH, text).drawn(drawn))
}
