//! The isotropic member, in the constants that follow (3.2).

use super::{Roots, Stiffness};
use crate::scene::Kinematics;

/// The inverse Hooke's law a, with a λ:λ = (α(λ11² + λ22²) + 2β λ11 λ22 + γ λ12²) / E.
///
/// It is stored by its two eigenvalues, α = κ + γ/4 and β = κ − γ/4, so that
/// a λ:λ = (κ (λ11 + λ22)² + γ/4 (λ11 − λ22)² + γ λ12²) / E. In plane strain κ = (1 + ν)(1 − 2ν)/2 tends to zero as
/// ν → ½; kept as a factor of its own it loses no digit, where α + β would.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    /// Young's modulus E.
    pub young: f64,
    /// κ = (α + β)/2: compliance against in-plane pressure.
    pub kappa: f64,
    /// γ = 2(1 + ν): compliance against shear.
    pub gamma: f64,
    /// σ_33/(σ_11 + σ_22): ν in plane strain, nothing in plane stress.
    pub transverse: f64,
    /// Stress for a unit strain in one direction with none across it.
    pub uniaxial: f64,
}

impl Isotropic {
    /// E = 1 and ν = 0 in plane stress.
    pub const ANY: Self = Isotropic { young: 1.0, kappa: 0.5, gamma: 2.0, transverse: 0.0, uniaxial: 1.0 };

    pub fn new(kinematics: Kinematics, young: f64, poisson: f64) -> Self {
        let (kappa, transverse, uniaxial) = match kinematics {
            Kinematics::PlaneStrain | Kinematics::Axisymmetric => (
                0.5 * (1.0 + poisson) * (1.0 - 2.0 * poisson),
                poisson,
                young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
            ),
            Kinematics::PlaneStress => (0.5 * (1.0 - poisson), 0.0, young / (1.0 - poisson * poisson)),
        };
        Isotropic { young, kappa, gamma: 2.0 * (1.0 + poisson), transverse, uniaxial }
    }

    pub fn product(&self, l: [f64; 3], m: [f64; 3]) -> f64 {
        let trace = (l[0] + l[1]) * (m[0] + m[1]);
        let deviator = 0.25 * (l[0] - l[1]) * (m[0] - m[1]) + l[2] * m[2];
        (self.kappa * trace + self.gamma * deviator) / self.young
    }

    pub fn strain(&self, l: [f64; 3]) -> [f64; 3] {
        let (mean, half) = (self.kappa * (l[0] + l[1]), 0.25 * self.gamma * (l[0] - l[1]));
        [(mean + half) / self.young, (mean - half) / self.young, 0.5 * self.gamma * l[2] / self.young]
    }

    pub fn stress(&self, e: [f64; 3]) -> [f64; 3] {
        let (mean, half) = (0.25 * (e[0] + e[1]) / self.kappa, (e[0] - e[1]) / self.gamma);
        [self.young * (mean + half), self.young * (mean - half), self.young * 2.0 * e[2] / self.gamma]
    }

    pub fn strain_product(&self, e: [f64; 3], d: [f64; 3]) -> f64 {
        let volume = 0.25 / self.kappa * (e[0] + e[1]) * (d[0] + d[1]);
        let deviator = ((e[0] - e[1]) * (d[0] - d[1]) + 4.0 * e[2] * d[2]) / self.gamma;
        self.young * (volume + deviator)
    }

    pub fn roots(&self) -> Roots {
        let shear = self.gamma.sqrt();
        Roots::Isotropic { trace: self.kappa.sqrt(), deviator: 0.5 * shear, shear }
    }

    /// c e:e = λ (tr e)² + 2μ e:e.
    pub fn stiffness(&self, area: f64) -> Stiffness {
        let shear = area * self.young / self.gamma;
        Stiffness::Isotropic { shear, bulk: area * 0.25 * self.young / self.kappa - shear }
    }
}
