//! Energies of stresses and displacements of a body of revolution on one triangle, those that are bounds enclosed from above.

use super::{Strained, Tensor};
use crate::element::{Displacement, Material, Revolved, StressField};
use crate::load::BodyForce;

impl Revolved {
    /// ∫ aλ:λ r on triangle `t` from above, and what a relative error of one in every number could change of its half. `force` is F_r.
    pub fn square(
        self,
        stress: &StressField,
        t: usize,
        corners: [[f64; 2]; 3],
        material: &Material,
        force: &BodyForce,
    ) -> [f64; 2] {
        let law = material.revolved();
        let weighted = self.stresses_on(stress, t, corners, force);
        let (mut sum, mut sensitivity) = (0.0, 0.0);
        for at in self.points(corners, 2 * stress.degree(t).max(3)) {
            let (l, spread) = weighted[at.sub].stress(&at.point);
            let plane = [l[0], l[1], 0.0, l[3]];
            sum += at.by * (law.product(l, l) + at.point.excess * law.product(plane, plane));
            sensitivity += at.by * (absolute(l) + spread) * absolute(law.strain(l));
        }
        [sum, sensitivity]
    }

    /// ½∫ c e:e r of what `v` has as its triangle `own` from above, and what a relative error of one in every number could change.
    pub fn strain_energy(self, v: &Displacement, own: usize, corners: [[f64; 2]; 3], material: &Material) -> [f64; 2] {
        let law = material.revolved();
        let hoop = law.strain_product([0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 0.0]);
        let (mut energy, mut sensitivity) = (0.0, 0.0);
        let mut strained = Strained::default();
        for at in self.points(corners, 2 * v.degree(own)) {
            let (e, spread) = strained.at(v, own, corners, &at);
            energy += 0.5 * at.by * (law.strain_product(e, e) + at.point.excess * hoop * e[2] * e[2]);
            sensitivity += at.by * absolute(law.stress(e)) * spread;
        }
        [energy, sensitivity]
    }

    /// ½‖c e(v) − λ‖²_a r on triangle `t`. `force` is F_r.
    pub fn constitutive_error(
        self,
        stress: &StressField,
        v: &Displacement,
        t: usize,
        corners: [[f64; 2]; 3],
        material: &Material,
        force: &BodyForce,
    ) -> f64 {
        let law = material.revolved();
        let weighted = self.stresses_on(stress, t, corners, force);
        let mut strained = Strained::default();
        let of = |at: super::Sampled| {
            let e = strained.strain(v, t, corners, &at);
            let of_stress = law.strain(weighted[at.sub].stress(&at.point).0);
            let d = [0, 1, 2, 3].map(|c| e[c] - of_stress[c]);
            0.5 * at.by * law.strain_product(d, d)
        };
        self.points(corners, 2 * v.degree(t).max(stress.degree(t)).max(3)).map(of).sum()
    }
}

fn absolute(s: Tensor) -> f64 {
    s.iter().map(|s| s.abs()).sum()
}
