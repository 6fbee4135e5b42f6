//! Hooke's law in the plane: the one place that knows what a body is made of.
//!
//! Whatever the material, a λ:λ is a sum of three squares, λ ↦ Rλ with a = RᵀR, the first of which is all that pressure has a part
//! in. A nearly incompressible body is soft in that one alone. It is kept as a factor and never as a difference, so that no digit is
//! lost as the body becomes incompressible.

mod isotropic;
mod plane;
mod stiffness;

use self::isotropic::Isotropic;
use self::plane::General;
pub use self::stiffness::Stiffness;
use super::revolved;
use crate::elasticity::{Elasticity, Initial, InitialStrain};
use crate::scene::Kinematics;

/// The material of a body in plane strain or plane stress.
///
/// Stresses and strains are (xx, yy, xy), strains with the tensor component in the last place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    law: Law,
    /// That of a body of revolution, where it is one.
    revolved: Option<revolved::Law>,
    initial: InitialStrain,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    Isotropic(Isotropic),
    General(General),
}

/// Three numbers of which a τ:τ · [`Material::unit`] is the sum of the squares, the first of them all that pressure has a part in.
#[derive(Debug, Clone, Copy)]
pub enum Roots {
    /// Of the trace, of half the difference of the normal stresses, and of the shear stress.
    Isotropic {
        /// √κ.
        trace: f64,
        /// ½√γ.
        deviator: f64,
        /// √γ.
        shear: f64,
    },
    /// R for (σ_xx + σ_yy)/2, (σ_xx − σ_yy)/2 and σ_xy.
    General([[f64; 3]; 3]),
}

impl Roots {
    /// The three numbers.
    pub fn apply(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
        match self {
            Roots::Isotropic { trace, deviator, shear } => [trace * (xx + yy), deviator * (xx - yy), shear * xy],
            Roots::General(rows) => plane::times(rows, plane::unknowns([xx, yy, xy])),
        }
    }

    /// The first of them for a unit of pressure, which has no part in the others: nothing of them may drown it.
    pub fn of_pressure(&self) -> f64 {
        match self {
            Roots::Isotropic { trace, .. } => 2.0 * trace,
            Roots::General(rows) => rows[0][0],
        }
    }
}

impl Material {
    /// The material of a body. Constants that are no material give one whose numbers are none.
    pub fn new(kinematics: Kinematics, elasticity: &Elasticity) -> Self {
        let revolved = match kinematics {
            Kinematics::Axisymmetric => revolved::Law::of(elasticity),
            Kinematics::PlaneStrain | Kinematics::PlaneStress => None,
        };
        let law = match elasticity.isotropic() {
            Some([young, poisson]) => Law::Isotropic(Isotropic::new(kinematics, young, poisson)),
            None => match elasticity.plane(kinematics != Kinematics::PlaneStress) {
                Some(plane) => Law::General(General::new(&plane)),
                None => Law::Isotropic(Isotropic::new(kinematics, f64::NAN, 0.0)),
            },
        };
        Material { law, revolved, initial: InitialStrain::NONE }
    }

    /// That of Young's modulus `young` and Poisson's ratio `poisson` in (−1, ½).
    pub fn isotropic(kinematics: Kinematics, young: f64, poisson: f64) -> Self {
        Self::new(kinematics, &Elasticity::Isotropic { young, poisson })
    }

    /// Any material at all, for what knows nothing of it.
    pub const ANY: Self =
        Material { law: Law::Isotropic(Isotropic::ANY), revolved: None, initial: InitialStrain::NONE };

    /// The law with the hoop of a body of revolution; one whose numbers are none where the material has no such law.
    pub fn revolved(&self) -> revolved::Law {
        self.revolved.unwrap_or(revolved::Law::NONE)
    }

    /// This material with the initial strain of a body.
    #[must_use]
    pub fn with_initial(self, kinematics: Kinematics, elasticity: &Elasticity, initial: &Initial) -> Self {
        let initial = match kinematics {
            Kinematics::Axisymmetric => elasticity.initial_strain_around(initial),
            Kinematics::PlaneStrain | Kinematics::PlaneStress => {
                elasticity.initial_strain(kinematics == Kinematics::PlaneStrain, initial)
            }
        };
        Material { initial, ..self }
    }

    /// This material without initial strain.
    #[must_use]
    pub fn without_initial(self) -> Self {
        Material { initial: InitialStrain::NONE, ..self }
    }

    /// cε0 at a point: minus the stress of a body that is held.
    pub fn held_back(&self, point: [f64; 2]) -> [f64; 3] {
        self.stress(self.initial.at(point))
    }

    /// ε0: the strain of a body without stress. It has no part in [`Self::stress`], [`Self::strain`] and the products.
    pub fn initial(&self) -> &InitialStrain {
        &self.initial
    }

    /// a λ:μ for two stresses.
    pub fn product(&self, l: [f64; 3], m: [f64; 3]) -> f64 {
        match &self.law {
            Law::Isotropic(own) => own.product(l, m),
            Law::General(own) => own.product(l, m),
        }
    }

    /// Strain aλ.
    pub fn strain(&self, l: [f64; 3]) -> [f64; 3] {
        match &self.law {
            Law::Isotropic(own) => own.strain(l),
            Law::General(own) => own.strain(l),
        }
    }

    /// Stress c e.
    pub fn stress(&self, e: [f64; 3]) -> [f64; 3] {
        match &self.law {
            Law::Isotropic(own) => own.stress(e),
            Law::General(own) => own.stress(e),
        }
    }

    /// c e:d for two strains.
    pub fn strain_product(&self, e: [f64; 3], d: [f64; 3]) -> f64 {
        match &self.law {
            Law::Isotropic(own) => own.strain_product(e, d),
            Law::General(own) => own.strain_product(e, d),
        }
    }

    /// Largest change of a λ:λ per unit of relative error in every number.
    pub fn spread(&self, l: [f64; 3]) -> f64 {
        match &self.law {
            Law::Isotropic(own) => absolute(l) * absolute(own.strain(l)),
            Law::General(own) => own.spread(l).max(absolute(l) * absolute(own.strain(l))),
        }
    }

    /// Energies are measured in units of one over this.
    pub fn unit(&self) -> f64 {
        match &self.law {
            Law::Isotropic(own) => own.young,
            Law::General(own) => own.unit,
        }
    }

    /// R of a = RᵀR, times the root of [`Self::unit`].
    pub fn roots(&self) -> Roots {
        match &self.law {
            Law::Isotropic(own) => own.roots(),
            Law::General(own) => Roots::General(own.factor),
        }
    }

    /// This material in axes of which the first has the components `axis`, a unit vector.
    #[must_use]
    pub fn in_frame(&self, axis: [f64; 2]) -> Self {
        match &self.law {
            Law::Isotropic(_) => *self,
            Law::General(own) => Material { law: Law::General(own.in_frame(axis)), ..*self },
        }
    }

    /// c for gradients of displacements, over `area`.
    pub fn stiffness(&self, area: f64) -> Stiffness {
        match &self.law {
            Law::Isotropic(own) => own.stiffness(area),
            Law::General(own) => Stiffness::general(|e| own.stress(e).map(|s| area * s)),
        }
    }

    /// κ and γ of an isotropic material: a λ:λ · E is κ tr² and γ times the deviator's part.
    pub fn pressure_and_shear(&self) -> Option<[f64; 2]> {
        match &self.law {
            Law::Isotropic(own) => Some([own.kappa, own.gamma]),
            Law::General(_) => None,
        }
    }

    /// a times [`Self::unit`] for stresses (xx, yy, xy), the shear strain being 2 ε_xy.
    pub fn matrix(&self) -> [[f64; 3]; 3] {
        let unit = |i: usize| [0, 1, 2].map(|j| f64::from(i == j));
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| self.unit() * self.product(unit(i), unit(j))))
    }

    /// No less than any eigenvalue of c but that of pressure.
    pub fn stiffest(&self) -> f64 {
        let normal = self.stress([1.0, 0.0, 0.0]);
        let shear = self.stress([0.0, 0.0, 1.0])[2].abs();
        match &self.law {
            Law::Isotropic(_) => normal[0].abs().max(shear),
            Law::General(_) => absolute(normal) + absolute(self.stress([0.0, 1.0, 0.0])) + 2.0 * shear,
        }
    }

    /// The smallest eigenvalue of c of an isotropic material: c e:e is no less than this times |e|².
    pub fn softest(&self) -> Option<f64> {
        self.pressure_and_shear().map(|[kappa, gamma]| self.unit() * (0.5 / kappa).min(2.0 / gamma))
    }

    /// The least and the largest modulus of a strip along a direction in the plane; of an isotropic body E and E.
    pub fn young(&self) -> [f64; 2] {
        match &self.law {
            Law::Isotropic(own) => [own.young; 2],
            Law::General(own) => own.young,
        }
    }

    /// The largest stress for a unit strain in one direction with none across it.
    pub fn uniaxial(&self) -> f64 {
        match &self.law {
            Law::Isotropic(own) => own.uniaxial,
            Law::General(own) => own.uniaxial,
        }
    }

    /// σ_33 that goes with a stress at a point.
    pub fn out_of_plane(&self, l: [f64; 3], point: [f64; 2]) -> f64 {
        let own = match &self.law {
            Law::Isotropic(own) => own.transverse * (l[0] + l[1]),
            Law::General(own) => own.out_of_plane(l),
        };
        if self.initial == InitialStrain::NONE { own } else { own + self.initial.transverse_at(point) }
    }

    /// Von Mises stress of an in-plane stress at a point.
    pub fn von_mises(&self, s: [f64; 3], point: [f64; 2]) -> f64 {
        let out = self.out_of_plane(s, point);
        let (a, b, c) = (s[0] - s[1], s[1] - out, out - s[0]);
        (0.5 * (a * a + b * b + c * c) + 3.0 * s[2] * s[2]).sqrt()
    }
}

fn absolute(s: [f64; 3]) -> f64 {
    s[0].abs() + s[1].abs() + s[2].abs()
}

#[cfg(test)]
mod tests;
