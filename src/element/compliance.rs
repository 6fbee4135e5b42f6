//! Hooke's law of plane isotropic elasticity, in the constants that follow (3.2).

use crate::scene::Kinematics;

/// The inverse Hooke's law a, with a λ:λ = (α(λ11² + λ22²) + 2β λ11 λ22 + γ λ12²) / E.
///
/// It is stored by its two eigenvalues, α = κ + γ/4 and β = κ − γ/4, so that
/// a λ:λ = (κ (λ11 + λ22)² + γ/4 (λ11 − λ22)² + γ λ12²) / E. In plane strain κ = (1 + ν)(1 − 2ν)/2 tends to zero as
/// ν → ½; kept as a factor of its own it loses no digit, where α + β would.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// Young's modulus E.
    pub young: f64,
    /// κ = (α + β)/2: compliance against in-plane pressure.
    pub kappa: f64,
    /// γ = 2(1 + ν): compliance against shear.
    pub gamma: f64,
}

impl Compliance {
    /// Compliance of a material with Young's modulus `young` and Poisson's ratio `poisson` in (−1, ½).
    pub fn new(kinematics: Kinematics, young: f64, poisson: f64) -> Self {
        let kappa = match kinematics {
            Kinematics::PlaneStrain | Kinematics::Axisymmetric => 0.5 * (1.0 + poisson) * (1.0 - 2.0 * poisson),
            Kinematics::PlaneStress => 0.5 * (1.0 - poisson),
        };
        Compliance { young, kappa, gamma: 2.0 * (1.0 + poisson) }
    }

    /// a λ:μ for two stresses (xx, yy, xy).
    pub fn product(&self, l: [f64; 3], m: [f64; 3]) -> f64 {
        let trace = (l[0] + l[1]) * (m[0] + m[1]);
        let deviator = 0.25 * (l[0] - l[1]) * (m[0] - m[1]) + l[2] * m[2];
        (self.kappa * trace + self.gamma * deviator) / self.young
    }

    /// Strain aλ as (xx, yy, xy) with the tensor component in the last place.
    pub fn strain(&self, l: [f64; 3]) -> [f64; 3] {
        let (mean, half) = (self.kappa * (l[0] + l[1]), 0.25 * self.gamma * (l[0] - l[1]));
        [(mean + half) / self.young, (mean - half) / self.young, 0.5 * self.gamma * l[2] / self.young]
    }

    /// Stress c e of a strain (xx, yy, xy).
    pub fn stress(&self, e: [f64; 3]) -> [f64; 3] {
        let (mean, half) = (0.25 * (e[0] + e[1]) / self.kappa, (e[0] - e[1]) / self.gamma);
        [self.young * (mean + half), self.young * (mean - half), self.young * 2.0 * e[2] / self.gamma]
    }

    /// λ + 2μ or 2μ, whichever is larger: no less than any eigenvalue of c but that of pressure.
    pub fn stiffest(&self) -> f64 {
        self.stress([1.0, 0.0, 0.0])[0].abs().max(self.stress([0.0, 0.0, 1.0])[2].abs())
    }

    /// c e:d for two strains (xx, yy, xy).
    pub fn strain_product(&self, e: [f64; 3], d: [f64; 3]) -> f64 {
        let volume = 0.25 / self.kappa * (e[0] + e[1]) * (d[0] + d[1]);
        let deviator = ((e[0] - e[1]) * (d[0] - d[1]) + 4.0 * e[2] * d[2]) / self.gamma;
        self.young * (volume + deviator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// λ and μ of the textbook Hooke's law c e = λ tr(e) I + 2μ e.
    fn textbook(kinematics: Kinematics, young: f64, nu: f64, e: [f64; 3]) -> [f64; 3] {
        let mu = young / (2.0 * (1.0 + nu));
        let lambda = match kinematics {
            Kinematics::PlaneStrain => young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            Kinematics::PlaneStress => young * nu / (1.0 - nu * nu),
        };
        let tr = e[0] + e[1];
        [lambda * tr + 2.0 * mu * e[0], lambda * tr + 2.0 * mu * e[1], 2.0 * mu * e[2]]
    }

    #[test]
    fn agrees_with_lame_constants() {
        for kinematics in [Kinematics::PlaneStrain, Kinematics::PlaneStress] {
            for nu in [-0.9, 0.0, 0.3, 0.49] {
                let c = Compliance::new(kinematics, 7.0, nu);
                let (e, d) = ([0.3, -1.1, 0.4], [2.0, 0.7, -0.9]);
                let (stress, expected) = (c.stress(e), textbook(kinematics, 7.0, nu, e));
                let back = c.strain(stress);
                for i in 0..3 {
                    assert!((stress[i] - expected[i]).abs() < 1e-12 * expected[i].abs().max(1.0));
                    assert!((back[i] - e[i]).abs() < 1e-13);
                }
                let work = stress[0] * d[0] + stress[1] * d[1] + 2.0 * stress[2] * d[2];
                assert!((c.strain_product(e, d) - work).abs() < 1e-11 * work.abs());
                assert!((c.product(stress, c.stress(d)) - work).abs() < 1e-11 * work.abs());
            }
        }
    }
}
