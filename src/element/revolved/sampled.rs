//! Stresses and strains of a body of revolution at the points of a rule with the weight r.

use super::{NEAR, Point, Tensor, Weighted, rule};
use crate::element::geometry::{sub_area, sub_gradients};
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::{Displacement, Revolved, Strains, StressField, lattice_len};
use crate::load::BodyForce;

/// A point of a rule on a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Sampled {
    /// Its subtriangle.
    pub sub: usize,
    /// Where.
    pub point: Point,
    /// Its weight in ∫ · r.
    pub by: f64,
}

/// Strains of a displacement, subtriangle by subtriangle.
#[derive(Debug, Default)]
pub struct Strained {
    strains: Strains,
    on: Option<(usize, usize)>,
}

impl Revolved {
    /// The points of a rule for products of degree `degree` on a triangle, those of a subtriangle one after the other.
    pub fn points(self, corners: [[f64; 2]; 3], degree: usize) -> impl Iterator<Item = Sampled> {
        let area = sub_area(corners);
        (0..3).flat_map(move |sub| {
            let points = rule(self.radii(corners, sub), degree, NEAR);
            points.into_iter().map(move |point| Sampled { sub, point, by: point.weight * area * point.radius })
        })
    }

    /// ∫ λ:χ r over a triangle of a weighted stress of degree `p` with these nodal values, without radial force, and a constant strain.
    pub fn strained(self, p: usize, nodal: &[[f64; 3]], corners: [[f64; 2]; 3], [rr, zz, tt, rz]: Tensor) -> f64 {
        let area = sub_area(corners);
        let mut sum = 0.0;
        for sub in 0..3 {
            let own = &nodal[lattice_len(p) * sub..][..lattice_len(p)];
            let weighted = Weighted::new(p, own, &sub_gradients(corners, sub), [0.0; 2]);
            let radii = self.radii(corners, sub);
            for &(l, weight) in triangle_rule(p) {
                let radius: f64 = (0..3).map(|i| l[i] * radii[i]).sum();
                let [own_rr, own_zz, own_rz] = weighted.sigma(l);
                let hoop = radius * weighted.hoop(l);
                sum += weight * area * (own_rr * rr + own_zz * zz + 2.0 * own_rz * rz + hoop * tt);
            }
        }
        sum
    }

    /// The points of a rule on a part of a subtriangle whose corners have these barycentric coordinates there, and this signed area.
    pub fn points_of_part(
        self,
        corners: [[f64; 2]; 3],
        (sub, part, area): (usize, [[f64; 3]; 3], f64),
        degree: usize,
    ) -> impl Iterator<Item = Sampled> {
        let radii = self.radii(corners, sub);
        let own = part.map(|l| (0..3).map(|i| l[i] * radii[i]).sum::<f64>().max(0.0));
        rule(own, degree, NEAR).into_iter().map(move |point| {
            let bary = [0, 1, 2].map(|c| (0..3).map(|i| point.bary[i] * part[i][c]).sum());
            Sampled { sub, point: Point { bary, ..point }, by: point.weight * area * point.radius }
        })
    }

    /// A weighted stress on the three subtriangles of triangle `t`.
    pub fn stresses_on(
        self,
        stress: &StressField,
        t: usize,
        corners: [[f64; 2]; 3],
        force: &BodyForce,
    ) -> [Weighted; 3] {
        [0, 1, 2].map(|sub| Self::weighted(stress, t, sub, corners, self.radial(force)))
    }
}

impl Strained {
    /// The strain of `v` on its triangle `t` at a point off the axis, and the size of what it is a sum of.
    pub fn at(&mut self, v: &Displacement, t: usize, corners: [[f64; 2]; 3], at: &Sampled) -> (Tensor, f64) {
        let Sampled { sub, point, .. } = *at;
        let strain = self.strain(v, t, corners, at);
        let spread = self.strains.spread_at(point.bary) + Revolved::size(v, t, sub, point.bary) / point.radius;
        (strain, spread)
    }

    /// The strain alone.
    pub fn strain(&mut self, v: &Displacement, t: usize, corners: [[f64; 2]; 3], at: &Sampled) -> Tensor {
        let Sampled { sub, point, .. } = *at;
        if self.on.replace((t, sub)) != Some((t, sub)) {
            self.strains.on(corners, v, t, sub);
        }
        let [rr, zz, rz] = self.strains.at(point.bary);
        [rr, zz, Revolved::radial_of(v, t, sub, point.bary) / point.radius, rz]
    }
}
