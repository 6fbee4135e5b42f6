//! The element solves a scene, and its bound is one.

use super::StressElement;
use crate::report::text::number::{percent, significant};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;
use crate::workbench::picture;
use crate::workbench::scene::{exact, solved};

pub const BOUND: Property<dyn StressElement> = Property {
    name: "bound",
    asks: "−Π(λ_h) of a solved scene lies below the exact energy, on every mesh, with a field that is in equilibrium",
    usual: true,
    measure,
};

/// Of the energy, what rounding may take.
const ROUNDING: f64 = 1e-9;

fn measure(e: &dyn StressElement) -> Result<Measured, Fault> {
    let element = e.solver().ok_or_else(|| {
        Fault::NotMade("the dual methods need one self-equilibrated field for every traction in equilibrium".into())
    })?;
    let mut material = Material::USUAL;
    let (mut worst, mut points, mut last) = (0.0_f64, Vec::new(), 0.0);
    for poisson in [0.3, 0.4999] {
        material = material.with_poisson(poisson);
        let exact = exact(&material)?;
        for size in [0.5, 0.25] {
            let run = solved(&material, size, element)?;
            let energy = run.bracket.complementary.lower();
            let equilibrium = run.dual.equilibrium.residual();
            worst = worst.max((energy - exact.upper) / exact.strain).max(equilibrium);
            last = ((exact.upper - energy).max(0.0) / exact.strain).sqrt();
            if poisson == 0.3 {
                points.push([last, run.dual.unknowns as f64]);
            }
        }
    }
    let text = format!(
        "Bounds of two meshes at ν = 0.3 and 0.4999 lie {} the exact energy; the error of the last is {}, traction jumps and excess are",
        if worst <= ROUNDING { "below" } else { "above" },
        percent(last)
    );
    let label = format!("{}, ν = {}", e.name(), significant(0.3, 2));
    let drawn = picture::curves("Unknowns for an error", ["relative error", "unknowns"], &[(label, points)]);
    Ok(Measured::new(worst, ROUNDING, text).drawn(drawn))
}
