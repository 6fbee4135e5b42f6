//! The initial strain ε0 of a body of revolution on one triangle.
//!
//! An affine ε0 (rr, zz, tt, rz) is in general not the strain of any displacement. That of w = (r ε0_tt, ∫ ε0_zz dz + …) has its hoop, and is
//! all of it where a body is heated evenly or along the axis: to the modes it is one of moments on the sides. What is left counts with the
//! field that balances the body force, λ̄, which has the least energy ½‖λ + cε0‖² there: then λ̄ + cε0 is orthogonal to all modes.

use super::{Sampled, Strained, Tensor, work};
use crate::elasticity::InitialStrain;
use crate::element::geometry::sub_area;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::{Displacement, Material, Revolved, StressField};
use crate::load::BodyForce;

/// ε0 on a triangle, by its values at the corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    corners: [Tensor; 3],
}

impl Held {
    /// That of a material on the triangle with these corners; `None` where there is none.
    pub fn on(material: &Material, corners: [[f64; 2]; 3]) -> Option<Self> {
        let initial = material.initial();
        (!initial.is_none()).then(|| Held { corners: corners.map(|corner| initial.around(corner)) })
    }

    /// ε0 at a point of subtriangle `sub`.
    pub fn at(&self, sub: usize, bary: [f64; 3]) -> Tensor {
        let [a, b] = [1, 2].map(|i| self.corners[(sub + i) % 3]);
        let c = self.corners[sub];
        // The third corner of a subtriangle is the centroid.
        let centre = bary[2] / 3.0;
        [0, 1, 2, 3].map(|i| bary[0] * a[i] + bary[1] * b[i] + centre * (a[i] + b[i] + c[i]))
    }
}

/// A triangle whose distance from the axis is more times its size has a w that is next to a motion along r, and none of use.
const FAR: f64 = 1e4;

/// A displacement w by its strain, on one triangle.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    initial: &'a InitialStrain,
    axis: f64,
    centre: [f64; 2],
    /// ε0 at the centre.
    own: Tensor,
}

impl<'a> Motion<'a> {
    /// That of an initial strain on the triangle with these corners, r = 0 where the first coordinate is `axis`; `None` where there is none.
    pub fn new(initial: &'a InitialStrain, axis: f64, corners: [[f64; 2]; 3]) -> Option<Self> {
        let centre = [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0);
        let size = corners.iter().fold(0.0_f64, |most, p| most.max((p[0] - centre[0]).hypot(p[1] - centre[1])));
        let there = !initial.is_none() && centre[0] - axis <= FAR * size;
        there.then(|| Motion { initial, axis, centre, own: initial.around(centre) })
    }

    /// w at a point. It is quadratic.
    pub fn at(&self, point: [f64; 2]) -> [f64; 2] {
        let InitialStrain { gradient: [_, zz, rz], hoop_gradient: [along, up], .. } = self.initial;
        let [r, z] = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let radius = point[0] - self.axis;
        let middle = self.centre[0] - self.axis;
        // f of w_z with f' = 2 ε_rz − ∂_z w_r where z is zero.
        let f = 2.0 * self.own[3] * r + rz[0] * r * r - up * (middle * r + 0.5 * r * r);
        [radius * (self.own[2] + along * r + up * z), z * (self.own[1] + zz[0] * r + 0.5 * zz[1] * z) + f]
    }

    /// Its strain at a point.
    fn strain(&self, point: [f64; 2]) -> Tensor {
        let InitialStrain { gradient: [_, zz, rz], hoop_gradient: [along, up], .. } = self.initial;
        let [r, z] = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let tt = self.own[2] + along * r + up * z;
        let axial = self.own[1] + zz[0] * r + zz[1] * z;
        [tt + along * (point[0] - self.axis), axial, tt, self.own[3] + rz[0] * r + 0.5 * zz[0] * z]
    }

    /// ε0 at a point of the plane, counted as [`Self::strain`] counts it.
    fn whole(&self, point: [f64; 2]) -> Tensor {
        let InitialStrain { gradient: [rr, zz, rz], hoop_gradient, .. } = self.initial;
        let [r, z] = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let slopes = [*rr, *zz, *hoop_gradient, *rz];
        [0, 1, 2, 3].map(|c| self.own[c] + slopes[c][0] * r + slopes[c][1] * z)
    }
}

impl Held {
    /// The part of ε0 on a triangle beyond the strain of [`Motion`]; `None` if that is zero.
    pub fn beside_motion(material: &Material, axis: f64, corners: [[f64; 2]; 3]) -> Option<Self> {
        let whole = Held::on(material, corners)?;
        let Some(motion) = Motion::new(material.initial(), axis, corners) else { return Some(whole) };
        let rest = corners.map(|corner| {
            let [own, of_motion] = [motion.whole(corner), motion.strain(corner)];
            [0, 1, 2, 3].map(|c| own[c] - of_motion[c])
        });
        (rest != [[0.0; 4]; 3]).then_some(Held { corners: rest })
    }
}

impl Revolved {
    /// ∫ λ:ε0 r on triangle `t`, and the integral of the sizes of what it is a sum of.
    pub fn initial_on(
        self,
        stress: &StressField,
        t: usize,
        corners: [[f64; 2]; 3],
        material: &Material,
        force: &BodyForce,
    ) -> [f64; 2] {
        let Some(held) = Held::on(material, corners) else { return [0.0; 2] };
        let (mut sum, mut size) = (0.0, 0.0);
        // Σ, and r λ_θθ with a radial force of degree one, times ε0.
        let degree = (stress.degree(t) + 1).max(4);
        let weighted = self.stresses_on(stress, t, corners, force);
        let area = sub_area(corners);
        for (sub, weighted) in weighted.iter().enumerate() {
            let radii = self.radii(corners, sub);
            for &(bary, weight) in triangle_rule(degree) {
                let radius = (0..3).map(|i| bary[i] * radii[i]).sum();
                let (l, spread) = weighted.stress(&super::Point { bary, weight, radius, excess: 0.0 });
                let e = held.at(sub, bary);
                let by = weight * area * radius;
                sum += by * work(e, l);
                let stresses = l.iter().map(|l| l.abs()).sum::<f64>() + spread;
                size += by * stresses * e.iter().map(|e| e.abs()).sum::<f64>();
            }
        }
        [sum, size]
    }

    /// ∫ σ(v):ε0 r of what `v` has as its triangle `t`.
    pub fn initial_work(self, v: &Displacement, t: usize, corners: [[f64; 2]; 3], material: &Material) -> f64 {
        let Some(held) = Held::on(material, corners) else { return 0.0 };
        let (law, mut strained) = (material.revolved(), Strained::default());
        let of = |at: Sampled| {
            let (e, own) = (strained.strain(v, t, corners, &at), held.at(at.sub, at.point.bary));
            at.by * law.strain_product([0, 1, 2, 3].map(|c| e[c] - own[c]), own)
        };
        self.points(corners, v.degree(t).max(2) + 1).map(of).sum()
    }

    /// ∫ cε0:ε0 r on the triangle with these corners.
    pub fn initial_square(self, corners: [[f64; 2]; 3], material: &Material) -> f64 {
        let Some(held) = Held::on(material, corners) else { return 0.0 };
        let law = material.revolved();
        let of =
            |at: Sampled| at.by * law.strain_product(held.at(at.sub, at.point.bary), held.at(at.sub, at.point.bary));
        self.points(corners, 3).map(of).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_has_its_strain() {
        let initial = InitialStrain {
            value: [0.3, -0.2, 0.5],
            gradient: [[1.0, -2.0], [0.4, 0.7], [-0.6, 0.9]],
            hoop: 0.8,
            hoop_gradient: [-0.3, 1.1],
            ..InitialStrain::NONE
        };
        let corners = [[1.3, 0.2], [2.0, 0.1], [1.6, 0.9]];
        let motion = Motion::new(&initial, 0.5, corners).expect("a strain");
        let (at, h) = ([1.7, 0.4], 1e-5);
        let slope = |c: usize, k: usize| {
            let moved = |by: f64| {
                let mut p: [f64; 2] = at;
                p[k] += by;
                motion.at(p)[c]
            };
            (moved(h) - moved(-h)) / (2.0 * h)
        };
        let found = [slope(0, 0), slope(1, 1), motion.at(at)[0] / (at[0] - 0.5), 0.5 * (slope(0, 1) + slope(1, 0))];
        let exact = motion.strain(at);
        (0..4).for_each(|c| assert!((found[c] - exact[c]).abs() < 1e-9, "{found:?} {exact:?}"));
        let whole = motion.whole(at);
        let own = initial.around(at);
        (0..4).for_each(|c| assert!((whole[c] - own[c]).abs() < 1e-14));
        assert!((own[2] - exact[2]).abs() < 1e-14 && (own[1] - exact[1]).abs() < 1e-14);
    }
}
