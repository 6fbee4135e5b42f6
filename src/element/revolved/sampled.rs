//! Stresses and strains of a body of revolution at the points of a rule with the weight r.

use super::{NEAR, Point, Tensor, Weighted, rule};
use crate::element::geometry::sub_area;
use crate::element::{Displacement, Revolved, Strains, StressField};
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
