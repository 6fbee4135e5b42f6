//! Hooke's law with the hoop: stresses and strains (rr, zz, tt, rz), the shear strain being the component of the tensor.

use crate::element::Compliance;

/// a λ:λ = ((1 − 2ν)/3 (tr λ)² + (1 + ν) |dev λ|²) / E, in two factors that keep their digits as ν → ½.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    young: f64,
    /// (1 − 2ν)/3.
    volume: f64,
    /// 1 + ν.
    shear: f64,
}

/// Components (rr, zz, tt, rz).
pub type Tensor = [f64; 4];

impl Law {
    /// The law of the material whose compliance in plane strain is given: γ = 2(1 + ν), κ = (1 + ν)(1 − 2ν)/2.
    pub fn of(material: &Compliance) -> Self {
        let Compliance { young, kappa, gamma } = *material;
        Law { young, volume: 4.0 * kappa / (3.0 * gamma), shear: 0.5 * gamma }
    }

    /// a λ:μ of two stresses.
    pub fn product(&self, l: Tensor, m: Tensor) -> f64 {
        (self.volume * trace(l) * trace(m) + self.shear * deviators(l, m)) / self.young
    }

    /// Strain aλ.
    pub fn strain(&self, l: Tensor) -> Tensor {
        let (mean, volume) = (trace(l) / 3.0, self.volume * trace(l));
        let dev = |x: f64| (volume + self.shear * (x - mean)) / self.young;
        [dev(l[0]), dev(l[1]), dev(l[2]), self.shear * l[3] / self.young]
    }

    /// Stress c e.
    pub fn stress(&self, e: Tensor) -> Tensor {
        let (mean, pressure) = (trace(e) / 3.0, trace(e) / (9.0 * self.volume));
        let dev = |x: f64| self.young * (pressure + (x - mean) / self.shear);
        [dev(e[0]), dev(e[1]), dev(e[2]), self.young * e[3] / self.shear]
    }

    /// c e:d of two strains.
    pub fn strain_product(&self, e: Tensor, d: Tensor) -> f64 {
        self.young * (trace(e) * trace(d) / (9.0 * self.volume) + deviators(e, d) / self.shear)
    }

    /// Numbers of which the squares add up to E a λ:λ; that of the trace comes first.
    pub fn roots(&self, [rr, zz, tt, rz]: Tensor) -> [f64; 4] {
        let shear = self.shear.sqrt();
        let (half, third) = (0.5_f64.sqrt(), 6.0_f64.sqrt().recip());
        let out_of_plane = shear * third * ((tt - rr) + (tt - zz));
        [
            self.volume.sqrt() * (rr + zz + tt),
            shear * half * (rr - zz),
            out_of_plane,
            shear * std::f64::consts::SQRT_2 * rz,
        ]
    }

    /// Young's modulus.
    pub fn young(&self) -> f64 {
        self.young
    }
}

fn trace([rr, zz, tt, _]: Tensor) -> f64 {
    rr + zz + tt
}

/// dev a : dev b.
fn deviators(a: Tensor, b: Tensor) -> f64 {
    let [p, q] = [a, b].map(|x| [x[0] - x[1], x[1] - x[2], x[2] - x[0]]);
    (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]) / 3.0 + 2.0 * a[3] * b[3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Kinematics;

    #[test]
    fn it_is_the_textbook_law() {
        for nu in [-0.5, 0.0, 0.3, 0.4999] {
            let (young, e, d) = (7.0, [0.3, -1.1, 0.7, 0.4], [2.0, 0.7, -0.2, -0.9]);
            let law = Law::of(&Compliance::new(Kinematics::PlaneStrain, young, nu));
            let (mu, lambda) = (young / (2.0 * (1.0 + nu)), young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)));
            let stress = law.stress(e);
            let near = |a: f64, b: f64| (a - b).abs() < 1e-11 * b.abs().max(1.0) / (1.0 - 2.0 * nu);
            for i in 0..4 {
                let exact = 2.0 * mu * e[i] + if i < 3 { lambda * (e[0] + e[1] + e[2]) } else { 0.0 };
                assert!(near(stress[i], exact) && near(law.strain(stress)[i], e[i]));
            }
            let work = stress[0] * d[0] + stress[1] * d[1] + stress[2] * d[2] + 2.0 * stress[3] * d[3];
            assert!(near(law.strain_product(e, d), work) && near(law.product(stress, law.stress(d)), work));
            let squares: f64 = law.roots(stress).iter().map(|x| x * x).sum();
            assert!(near(squares / young, law.product(stress, stress)));
        }
    }
}
