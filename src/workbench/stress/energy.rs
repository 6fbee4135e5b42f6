//! Modes orthonormal in complementary energy, λ̄ orthogonal to them.

use nalgebra::DMatrix;

use super::fields::Fields;
use super::{StressElement, worst};
use crate::workbench::finding::{Fault, Measured, Property};

pub const ORTHONORMAL: Property<dyn StressElement> = Property {
    name: "orthonormality",
    asks: "∫ a τ_i:τ_j = δ_ij for the modes, with the compliance of the material",
    usual: true,
    measure: |e| {
        let (value, place) = worst(e, orthonormality);
        let text = match value <= ALLOWED {
            true => "Modes are orthonormal in energy".to_string(),
            false => format!("Modes are not orthonormal in the energy of the material: worst on the triangle {place}"),
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

pub const PARTICULAR: Property<dyn StressElement> = Property {
    name: "particular",
    asks: "λ̄ is orthogonal in energy to all modes, and has the energy that the element says",
    usual: true,
    measure: |e| {
        super::usual(e)?.particular.ok_or_else(|| Fault::NotMade("it has no field for a body force".into()))?;
        let (value, place) = worst(e, particular);
        let text = match value <= ALLOWED {
            true => "λ̄ is orthogonal to the modes and has its energy".to_string(),
            false => format!("λ̄ is not orthogonal to the modes, or has another energy: worst on the triangle {place}"),
        };
        Ok(Measured::new(value, ALLOWED, text))
    },
};

const ALLOWED: f64 = 1e-8;

/// Energies of all modes with each other less the unit matrix.
pub fn orthonormality(fields: &Fields) -> f64 {
    let n = fields.fields.len();
    let modes = fields.columns(&fields.fields);
    (modes.tr_mul(&modes) - DMatrix::identity(n, n)).amax()
}

/// Cosines of λ̄ with the modes, and how far its energy is off, relative to it.
pub fn particular(fields: &Fields) -> f64 {
    let Some(particular) = &fields.particular else { return 0.0 };
    let own = fields.columns([&particular.field]);
    let energy = own.norm_squared();
    if energy == 0.0 {
        return particular.energy;
    }
    let overlap = fields.columns(&fields.fields).tr_mul(&own).amax() / energy.sqrt();
    overlap.max((energy / particular.energy - 1.0).abs())
}
