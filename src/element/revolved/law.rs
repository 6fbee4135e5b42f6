//! Hooke's law with the hoop: stresses and strains (rr, zz, tt, rz), the shear strain being the component of the tensor.

use crate::elasticity::{Elasticity, Revolution};

/// a λ:λ as a sum of four squares, the first of them all that pressure has a part in: no digit is lost as it becomes small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// One over a compliance of the material: factors have entries about one.
    unit: f64,
    factor: [[f64; 4]; 4],
    inverse: [[f64; 4]; 4],
}

/// Components (rr, zz, tt, rz).
pub type Tensor = [f64; 4];

/// σ : e.
pub fn work(e: Tensor, s: Tensor) -> f64 {
    s[0] * e[0] + s[1] * e[1] + s[2] * e[2] + 2.0 * s[3] * e[3]
}

impl Law {
    /// No material: its numbers are none.
    pub const NONE: Self = Law { unit: f64::NAN, factor: [[f64::NAN; 4]; 4], inverse: [[f64::NAN; 4]; 4] };

    /// The law of a material; `None` where its constants say nothing of the hoop.
    pub fn of(elasticity: &Elasticity) -> Option<Self> {
        let Revolution { factor, inverse, .. } = elasticity.revolution()?;
        let largest = factor.as_flattened().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        Some(Law {
            unit: 1.0 / (largest * largest),
            factor: factor.map(|row| row.map(|x| x / largest)),
            inverse: inverse.map(|row| row.map(|x| x * largest)),
        })
    }

    /// a λ:μ of two stresses.
    pub fn product(&self, l: Tensor, m: Tensor) -> f64 {
        dot(self.roots(l), self.roots(m)) / self.unit
    }

    /// Strain aλ.
    pub fn strain(&self, l: Tensor) -> Tensor {
        Revolution::components(times_transposed(&self.factor, self.roots(l)).map(|e| e / self.unit))
    }

    /// Stress c e.
    pub fn stress(&self, e: Tensor) -> Tensor {
        let [p, q, d, s] = times_transposed(&self.inverse, self.strain_roots(e)).map(|s| self.unit * s);
        [p + q + d, p + q - d, p - 2.0 * q, s]
    }

    /// c e:d of two strains.
    pub fn strain_product(&self, e: Tensor, d: Tensor) -> f64 {
        self.unit * dot(self.strain_roots(e), self.strain_roots(d))
    }

    /// Numbers of which the squares add up to a λ:λ times [`Self::unit`].
    pub fn roots(&self, l: Tensor) -> [f64; 4] {
        times(&self.factor, Revolution::unknowns(l))
    }

    /// As [`Self::roots`], for the stress of a strain.
    pub fn roots_of_strain(&self, e: Tensor) -> [f64; 4] {
        self.strain_roots(e).map(|root| self.unit * root)
    }

    /// Energies are measured in units of one over this.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    fn strain_roots(&self, e: Tensor) -> [f64; 4] {
        times(&self.inverse, Revolution::strains(e))
    }
}

fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

fn times(rows: &[[f64; 4]; 4], x: [f64; 4]) -> [f64; 4] {
    rows.map(|row| dot(row, x))
}

fn times_transposed(rows: &[[f64; 4]; 4], x: [f64; 4]) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| rows[0][i] * x[0] + rows[1][i] * x[1] + rows[2][i] * x[2] + rows[3][i] * x[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elasticity::Orthotropic;

    fn near(a: f64, b: f64, allowed: f64) -> bool {
        (a - b).abs() < allowed * b.abs().max(1.0)
    }

    #[test]
    fn it_is_the_textbook_law() {
        for nu in [-0.5, 0.0, 0.3, 0.4999] {
            let (young, e, d) = (7.0, [0.3, -1.1, 0.7, 0.4], [2.0, 0.7, -0.2, -0.9]);
            let law = Law::of(&Elasticity::Isotropic { young, poisson: nu }).expect("a law");
            let (mu, lambda) = (young / (2.0 * (1.0 + nu)), young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)));
            let stress = law.stress(e);
            let allowed = 1e-11 / (1.0 - 2.0 * nu);
            for i in 0..4 {
                let exact = 2.0 * mu * e[i] + if i < 3 { lambda * (e[0] + e[1] + e[2]) } else { 0.0 };
                assert!(near(stress[i], exact, allowed) && near(law.strain(stress)[i], e[i], allowed));
            }
            let work = stress[0] * d[0] + stress[1] * d[1] + stress[2] * d[2] + 2.0 * stress[3] * d[3];
            assert!(near(law.strain_product(e, d), work, allowed));
            assert!(near(law.product(stress, law.stress(d)), work, allowed));
            let squares: f64 = law.roots(stress).iter().map(|x| x * x).sum();
            assert!(near(squares / law.unit(), law.product(stress, stress), allowed));
            let (own, of_strain) = (law.roots(stress), law.roots_of_strain(e));
            assert!((0..4).all(|i| near(of_strain[i], own[i], allowed)));
        }
    }

    #[test]
    fn the_hoop_is_axis_three_of_an_orthotropic_body() {
        let law = Orthotropic { young: [40.0, 2.0, 3.0], poisson: [0.3, 0.1, 0.4], shear: 1.5, angle: 0.0 };
        let law = Law::of(&Elasticity::Orthotropic(law)).expect("a law");
        let e = law.strain([0.0, 0.0, 1.0, 0.0]);
        assert!(near(e[2], 1.0 / 3.0, 1e-13) && near(e[0], -0.1 / 40.0, 1e-13) && near(e[1], -0.2, 1e-13));
        assert!(near(law.strain([0.0, 0.0, 0.0, 1.0])[3], 0.5 / 1.5, 1e-13));
    }
}
