//! Materials of elements.

use nalgebra::{Matrix3, Matrix4};
use schemars::JsonSchema;
use serde::Serialize;

use crate::element;
use crate::scene::Kinematics;

/// What moduli, thicknesses and their products are in any units.
const IN_ANY_UNITS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// An isotropic material in the plane or of a body of revolution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "Written")]
pub struct Material {
    /// Plane strain, plane stress, or a body of revolution.
    pub kinematics: Kinematics,
    /// Young's modulus E.
    pub young: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// Thickness t.
    pub thickness: f64,
}

impl Material {
    /// E = 1, ν = 0.3, t = 1 in plane strain.
    pub const USUAL: Material =
        Material { kinematics: Kinematics::PlaneStrain, young: 1.0, poisson: 0.3, thickness: 1.0 };

    /// The material, if there is such a one.
    ///
    /// # Errors
    /// A constant is out of range, or a body of revolution has a thickness.
    pub fn new(kinematics: Kinematics, young: f64, poisson: f64, thickness: f64) -> Result<Self, String> {
        let above_zero = |x: f64| x > 0.0 && x.is_finite();
        if !above_zero(young) {
            return Err(format!("Young's modulus is {young}; it is a finite number above zero"));
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(format!("Poisson's ratio is {poisson}; it lies above -1 and below 1/2"));
        }
        if !above_zero(thickness) {
            return Err(format!("the thickness is {thickness}; it is a finite number above zero"));
        }
        if kinematics == Kinematics::Axisymmetric && thickness != 1.0 {
            let text =
                format!("the thickness is {thickness}; a body of revolution has none: K is that of the full turn");
            return Err(text);
        }
        // Their squares, and sums of many, are numbers still.
        if ![young, thickness, young * thickness].iter().all(|x| IN_ANY_UNITS.contains(x)) {
            return Err(format!(
                "E is {young} and the thickness {thickness}; in no units are they below 1e-100 or above 1e100"
            ));
        }
        Ok(Material { kinematics, young, poisson, thickness })
    }

    /// The inverse of Hooke's law.
    pub fn compliance(&self) -> element::Material {
        element::Material::isotropic(self.kinematics, self.young, self.poisson)
    }

    /// Hooke's law as a matrix: (σ_xx, σ_yy, σ_xy) = D (ε_xx, ε_yy, γ_xy), γ_xy = 2 ε_xy.
    pub fn hooke(&self) -> Matrix3<f64> {
        let c = self.compliance();
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]].map(|e| c.stress(e).into());
        Matrix3::from_columns(&columns)
    }

    /// Hooke's law of a body of revolution: (σ_rr, σ_zz, σ_tt, σ_rz) = D (ε_rr, ε_zz, ε_tt, γ_rz), γ_rz = 2 ε_rz.
    pub fn hooke_of_rings(&self) -> Matrix4<f64> {
        let law = self.compliance().revolved();
        let unit = |i: usize| {
            std::array::from_fn(|j| {
                if i != j {
                    0.0
                } else if i == 3 {
                    0.5
                } else {
                    1.0
                }
            })
        };
        Matrix4::from_columns(&[0, 1, 2, 3].map(|i| law.stress(unit(i)).into()))
    }

    /// The material with another ν.
    pub fn with_poisson(self, poisson: f64) -> Self {
        Material { poisson, ..self }
    }

    /// The material in the other plane state.
    pub fn in_other_kinematics(self) -> Self {
        let kinematics = match self.kinematics {
            Kinematics::PlaneStrain | Kinematics::Axisymmetric => Kinematics::PlaneStress,
            Kinematics::PlaneStress => Kinematics::PlaneStrain,
        };
        Material { kinematics, ..self }
    }
}

/// A material as files have it.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Material")]
pub(super) struct Written {
    /// `plane-strain`, `plane-stress` or `axisymmetric`.
    kinematics: &'static str,
    /// Young's modulus.
    young: f64,
    /// Poisson's ratio.
    poisson: f64,
    /// Thickness.
    thickness: f64,
}

impl From<Material> for Written {
    fn from(Material { kinematics, young, poisson, thickness }: Material) -> Self {
        Written { kinematics: kinematics.name(), young, poisson, thickness }
    }
}
