//! Materials of elements.

use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::element;
use crate::scene::Kinematics;

/// An isotropic material in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "Written")]
pub struct Material {
    /// Plane strain or plane stress.
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
    /// A constant is out of range, or the kinematics are axisymmetric.
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
        if kinematics == Kinematics::Axisymmetric {
            return Err(
                "elements of bodies of revolution are not examined; use plane-strain or plane-stress".to_string()
            );
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
    /// `plane-strain` or `plane-stress`.
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
