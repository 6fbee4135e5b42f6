//! A body of revolution on one triangle: stresses and strains of its fields, the work of body forces, stiffness.

use super::{Point, ROUGH, Tensor, Weighted, rule};
use crate::element::geometry::{sub_area, sub_corners, sub_gradients};
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::polynomial::triangle;
use crate::element::{Displacement, Material, Section, Strains, StressField, lattice_len};
use crate::load::BodyForce;

/// Corners of a triangle.
type Corners = [[f64; 2]; 3];

/// A body of revolution: its energies, enclosed.
#[derive(Debug, Clone, Copy)]
pub struct Revolved {
    axis: f64,
}

impl Revolved {
    /// About the line on which the first coordinate is `axis`.
    pub(in crate::element) fn about(axis: f64) -> Self {
        Revolved { axis }
    }

    pub(super) fn radial(self, force: &BodyForce) -> [f64; 2] {
        Section::Revolved { axis: self.axis }.radial(force)
    }

    /// The forces ∫ f B_α r of a body force on the coefficients of a subtriangle in degree `k`.
    pub fn body_forces(self, corners: Corners, sub: usize, k: usize, force: &BodyForce) -> Vec<[f64; 2]> {
        let (area, radii) = (sub_area(corners), self.radii(corners, sub));
        let ([a, b], [_, axial]) = (self.radial(force), Section::Revolved { axis: self.axis }.forces(force));
        let mut out = vec![[0.0; 2]; triangle::len(k)];
        for &(l, weight) in triangle_rule(k + 2) {
            let radius = (0..3).map(|i| l[i] * radii[i]).sum::<f64>();
            let f = [a + b * radius, axial].map(|f| area * weight * radius * f);
            for (out, value) in out.iter_mut().zip(triangle::basis(k, l)) {
                (0..2).for_each(|c| out[c] += value * f[c]);
            }
        }
        out
    }

    /// The work of a body force on what `v` has as its triangle `t`, in the terms of a sum.
    pub fn work_inside(self, force: &BodyForce, corners: Corners, v: &Displacement, t: usize) -> [f64; 6] {
        let forces = [0, 1, 2].map(|sub| self.body_forces(corners, sub, v.degree(t), force));
        [0, 1, 2, 3, 4, 5].map(|term| {
            let (sub, c) = (term / 2, term % 2);
            v.sub(t, sub).zip(&forces[sub]).map(|(u, f)| u[c] * f[c]).sum()
        })
    }

    pub(super) fn radii(self, corners: Corners, sub: usize) -> [f64; 3] {
        sub_corners(corners, sub).map(|p| p[0] - self.axis)
    }

    pub(super) fn weighted(stress: &StressField, t: usize, sub: usize, corners: Corners, force: [f64; 2]) -> Weighted {
        let (degree, n) = (stress.degree(t), lattice_len(stress.degree(t)));
        Weighted::new(degree, &stress.block(t)[n * sub..][..n], &sub_gradients(corners, sub), force)
    }

    /// v_r at a point of a subtriangle.
    pub(super) fn radial_of(v: &Displacement, t: usize, sub: usize, bary: [f64; 3]) -> f64 {
        v.sub(t, sub).zip(triangle::basis(v.degree(t), bary)).map(|(u, b)| u[0] * b).sum()
    }

    /// The size of what is added up for v_r.
    pub(super) fn size(v: &Displacement, t: usize, sub: usize, bary: [f64; 3]) -> f64 {
        v.sub(t, sub).zip(triangle::basis(v.degree(t), bary)).map(|(u, b)| (u[0] * b).abs()).sum()
    }

    /// λ of a weighted stress at a point of a subtriangle; on the axis the value close by. `force` is F_r.
    pub fn stress_at(
        self,
        stress: &StressField,
        t: usize,
        sub: usize,
        corners: Corners,
        force: &BodyForce,
        bary: [f64; 3],
    ) -> Tensor {
        let weighted = Self::weighted(stress, t, sub, corners, self.radial(force));
        let (point, _) = self.off_axis(corners, sub, bary);
        weighted.stress(&point).0
    }

    /// Strain of a displacement at a point of a subtriangle; on the axis the value close by.
    pub fn strain_at(self, v: &Displacement, t: usize, sub: usize, corners: Corners, bary: [f64; 3]) -> Tensor {
        let mut strains = Strains::default();
        strains.on(corners, v, t, sub);
        let (point, _) = self.off_axis(corners, sub, bary);
        tensor(strains.at(point.bary), Self::radial_of(v, t, sub, point.bary) / point.radius)
    }

    /// The point itself, or one that is moved a little towards the middle of the subtriangle where it lies on the axis.
    fn off_axis(self, corners: Corners, sub: usize, bary: [f64; 3]) -> (Point, bool) {
        const ASIDE: f64 = 1e-6;
        let radii = self.radii(corners, sub);
        let radius = |l: [f64; 3]| (0..3).map(|i| l[i] * radii[i]).sum::<f64>();
        let largest = radii.iter().copied().fold(0.0, f64::max);
        let on_axis = radius(bary) <= ASIDE * largest;
        let bary = if on_axis { bary.map(|l| (1.0 - ASIDE) * l + ASIDE / 3.0) } else { bary };
        (Point { bary, weight: 1.0, radius: radius(bary), excess: 0.0 }, on_axis)
    }

    /// Strain (rr, zz, rz) of a weighted stress at a point off the axis, without initial strain.
    pub fn plane_strain_of(
        self,
        stress: &StressField,
        t: usize,
        corners: Corners,
        material: &Material,
        force: &BodyForce,
    ) -> impl Fn(usize, [f64; 3]) -> [f64; 3] {
        let law = material.revolved();
        let weighted = [0, 1, 2].map(|sub| Self::weighted(stress, t, sub, corners, self.radial(force)));
        move |sub, bary| {
            let (point, _) = self.off_axis(corners, sub, bary);
            let [rr, zz, _, rz] = law.strain(weighted[sub].stress(&point).0);
            [rr, zz, rz]
        }
    }

    /// ∫ c e(B_a x̂_p) : e(B_b x̂_q) r of one subtriangle for displacements of degree `k`: calls `add` with the two coefficients and the
    /// entries rr, rz, zr, zz of each pair in one order.
    pub fn stiffness(
        self,
        k: usize,
        corners: Corners,
        sub: usize,
        material: &Material,
        mut add: impl FnMut(usize, usize, [f64; 4]),
    ) {
        let law = material.revolved();
        let n = triangle::len(k);
        let g = sub_gradients(corners, sub);
        let area = sub_area(corners);
        let mut sum = vec![[0.0; 4]; n * n];
        // Slopes along r and z, and the value over r, of all functions.
        let mut all = vec![[0.0; 3]; n];
        for point in rule(self.radii(corners, sub), 2 * k, ROUGH) {
            let weight = point.weight * area * point.radius;
            for (own, value) in all.iter_mut().zip(triangle::basis(k, point.bary)) {
                *own = [0.0, 0.0, value / point.radius];
            }
            for (beta, b) in triangle::indices(k - 1).zip(triangle::basis(k - 1, point.bary)) {
                for (i, g) in g.iter().enumerate() {
                    let own = &mut all[triangle::number(triangle::raised(beta, i))];
                    (0..2).for_each(|c| own[c] += k as f64 * b * g[c]);
                }
            }
            for (a, [r, z, hoop]) in all.iter().copied().enumerate() {
                let [along, up] =
                    [[r, 0.0, hoop, 0.5 * z], [0.0, z, 0.0, 0.5 * r]].map(|e| law.stress(e).map(|s| weight * s));
                for (entry, [r, z, hoop]) in sum[a * n..=a * n + a].iter_mut().zip(&all) {
                    let work = |s: &Tensor| [r * s[0] + hoop * s[2] + z * s[3], z * s[1] + r * s[3]];
                    let [[rr, rz], [zr, zz]] = [work(&along), work(&up)];
                    *entry = [entry[0] + rr, entry[1] + rz, entry[2] + zr, entry[3] + zz];
                }
            }
        }
        for a in 0..n {
            (0..=a).for_each(|b| add(a, b, sum[a * n + b]));
        }
    }

    /// Mean of λ over a triangle, weighted with r; (rr, zz, tt, rz).
    pub fn mean(self, stress: &StressField, t: usize, corners: Corners, force: &BodyForce) -> Tensor {
        let mut sum = [0.0; 4];
        let mut total = 0.0;
        for sub in 0..3 {
            let weighted = Self::weighted(stress, t, sub, corners, self.radial(force));
            let radii = self.radii(corners, sub);
            for &(bary, weight) in triangle_rule(stress.degree(t) + 3) {
                let radius = (0..3).map(|i| bary[i] * radii[i]).sum::<f64>();
                let point = Point { bary, weight, radius, excess: 0.0 };
                let l = weighted.stress(&point).0;
                (0..4).for_each(|c| sum[c] += weight * radius * l[c]);
                total += weight * radius;
            }
        }
        sum.map(|s| s / total)
    }
}

fn tensor([rr, zz, rz]: [f64; 3], tt: f64) -> Tensor {
    [rr, zz, tt, rz]
}
