//! Energies of stresses and displacements of a body of revolution on one triangle, those that are bounds enclosed from above.

use super::{Held, Strained, Tensor};
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

    /// ½∫ c (e − ε0):(e − ε0) r of what `v` has as its triangle `own` from above, and what a relative error of one in every number could change.
    pub fn strain_energy(self, v: &Displacement, own: usize, corners: [[f64; 2]; 3], material: &Material) -> [f64; 2] {
        let law = material.revolved();
        let hoop = law.strain_product([0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 0.0]);
        let (mut energy, mut sensitivity) = (0.0, 0.0);
        let mut strained = Strained::default();
        let held = Held::on(material, corners);
        // An affine ε0 makes the elastic strain of a linear displacement linear.
        let degree = if held.is_some() { v.degree(own).max(2) } else { v.degree(own) };
        for at in self.points(corners, 2 * degree) {
            let (e, spread) = strained.at(v, own, corners, &at);
            let (elastic, own_size) = less(e, held, &at);
            let singular = at.point.excess * hoop * e[2] * e[2];
            energy += 0.5 * at.by * (law.strain_product(elastic, elastic) + singular);
            sensitivity += at.by * absolute(law.stress(elastic)) * (spread + own_size);
        }
        [energy, sensitivity]
    }

    /// ½‖c (e(v) − ε0) − λ‖²_a r on triangle `t`. `force` is F_r.
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
        let held = Held::on(material, corners);
        let of = |at: super::Sampled| {
            let (e, _) = less(strained.strain(v, t, corners, &at), held, &at);
            let of_stress = law.strain(weighted[at.sub].stress(&at.point).0);
            let d = [0, 1, 2, 3].map(|c| e[c] - of_stress[c]);
            0.5 * at.by * law.strain_product(d, d)
        };
        self.points(corners, 2 * v.degree(t).max(stress.degree(t)).max(3)).map(of).sum()
    }
}

/// e − ε0, and the size of ε0.
fn less(e: Tensor, held: Option<Held>, at: &super::Sampled) -> (Tensor, f64) {
    let Some(held) = held else { return (e, 0.0) };
    let own = held.at(at.sub, at.point.bary);
    ([0, 1, 2, 3].map(|c| e[c] - own[c]), absolute(own))
}

fn absolute(s: Tensor) -> f64 {
    s.iter().map(|s| s.abs()).sum()
}
