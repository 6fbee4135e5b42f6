//! The body that a plane figure represents: a slice, or a body of revolution.
//!
//! All differences between the two are here and in [`super::revolved`]. In a slice the stresses are λ, and integrals over areas and lengths
//! carry no weight but the thickness. In a body of revolution the stored stresses are weighted, Σ = r λ ([`super::revolved`]), tractions
//! are r T, integrals over the figure carry the weight r, and the measure is 2π, so that energies and forces are those of the full turn.
//! With weighted tractions everything on edges (moments of displacements, unknowns, contact) is common to both.

use super::congruent;
use super::geometry::{sub_area, sub_corners, sub_gradients};
use super::polynomial::quadrature::triangle_rule;
use super::polynomial::triangle;
use super::revolved::{Held, Ring, Tensor, Weighted, rule};
use super::{
    Displacement, EquilibriumElement, Layout, Material, Modes, ModesMut, Strains, StressField, displacement,
    lattice_len,
};
use crate::load::BodyForce;

/// A slice, or a body of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Section {
    /// A slice; its thickness is that of the scene.
    Slice,
    /// A body of revolution about the line on which the first coordinate is `axis`.
    Revolved {
        /// First coordinate of the points of the axis.
        axis: f64,
    },
}

/// Corners of a triangle.
type Corners = [[f64; 2]; 3];

impl Section {
    /// True for a body of revolution.
    pub fn is_revolved(self) -> bool {
        self != Section::Slice
    }

    /// First coordinate of the points of the axis of a body of revolution.
    pub fn axis(self) -> Option<f64> {
        match self {
            Section::Slice => None,
            Section::Revolved { axis } => Some(axis),
        }
    }

    /// The weight of a point in integrals: one, or its distance from the axis.
    pub fn weight(self, point: [f64; 2]) -> f64 {
        match self {
            Section::Slice => 1.0,
            Section::Revolved { axis } => point[0] - axis,
        }
    }

    /// True if a point lies on the axis of revolution.
    pub fn on_axis(self, point: [f64; 2]) -> bool {
        self.is_revolved() && self.weight(point) == 0.0
    }

    /// The components of a displacement that is the same everywhere and causes no strain: one where it is so along an axis, else zero.
    pub fn translations(self) -> [f64; 2] {
        if self.is_revolved() { [0.0, 1.0] } else { [1.0; 2] }
    }

    /// Degree of displacements that go with stresses of degree `p`.
    ///
    /// In bodies of revolution (v_r, v_z) = (−r ∂_z χ, 2χ + r ∂_r χ) is free of volume change for every χ. With χ cubic and continuously
    /// differentiable on split triangles it takes one degree more than in the plane not to lock as ν → ½.
    pub fn displacement_degree(self, p: usize) -> usize {
        if self.is_revolved() { (p + 2).min(displacement::MOST) } else { p + 1 }
    }

    /// Bernstein coefficients of a traction, given by its values at the ends of an edge, times the weight.
    pub fn weighted(self, points: [[f64; 2]; 2], ends: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        let [a, b] = points.map(|p| self.weight(p));
        let [p, q] = ends;
        if a == b || p == q {
            return vec![p.map(|x| a * x), q.map(|x| b * x)];
        }
        let middle = [0, 1].map(|c| 0.5 * (a * q[c] + b * p[c]));
        vec![p.map(|x| a * x), middle, q.map(|x| b * x)]
    }

    /// Key that distinguishes triangles of one shape and size: their distance from the axis in a body of revolution, `None` in a slice.
    pub fn place(self, corners: Corners) -> Option<i64> {
        let Section::Revolved { axis } = self else { return None };
        let (_, exponent) = congruent::shape(corners);
        let unit = (exponent as f64).exp2() * congruent::SAME;
        let centre = corners[0][0] - axis + (corners[1][0] - corners[0][0] + (corners[2][0] - corners[0][0])) / 3.0;
        Some((centre / unit).round() as i64)
    }

    /// Sizes of what [`Self::compute`] writes.
    pub fn layout(self, element: &dyn EquilibriumElement, corners: Corners) -> Layout {
        match self {
            Section::Slice => element.layout(),
            Section::Revolved { axis } => Ring::new(element.degree(), axis, corners).layout(),
        }
    }

    /// Modes and particular field of the element on a triangle.
    pub fn compute(
        self,
        element: &dyn EquilibriumElement,
        corners: Corners,
        material: &Material,
        force: &BodyForce,
        out: ModesMut<'_>,
    ) {
        match self {
            Section::Slice => element.compute(corners, material, force, out),
            Section::Revolved { axis } => {
                let (radial, [_, axial]) = (self.radial(force), self.forces(force));
                let held = Held::beside_motion(material, axis, corners);
                Ring::new(element.degree(), axis, corners).compute(&material.revolved(), (radial, axial), held, out);
            }
        }
    }

    /// [`Self::compute`] into memory of its own, without a body force.
    pub fn modes(self, element: &dyn EquilibriumElement, corners: Corners, material: &Material) -> Modes<'static> {
        let layout = self.layout(element, corners);
        let mut data = vec![0.0; layout.len()];
        self.compute(element, corners, material, &BodyForce::NONE, layout.split(&mut data));
        Modes::owned(layout, data)
    }

    /// Nodal stresses of an orthonormal basis of the fields of the element without traction.
    pub fn unloaded(
        self,
        element: &dyn EquilibriumElement,
        corners: Corners,
        material: &Material,
    ) -> Vec<Vec<[f64; 3]>> {
        match self {
            Section::Slice => element.unloaded(corners, material),
            Section::Revolved { axis } => Ring::new(element.degree(), axis, corners).unloaded(&material.revolved()),
        }
    }

    /// Nodal stresses of every mode.
    pub fn mode_stresses(
        self,
        element: &dyn EquilibriumElement,
        corners: Corners,
        modes: &Modes<'_>,
    ) -> Vec<Vec<[f64; 3]>> {
        let of = |k: usize| {
            let mut unit = vec![0.0; modes.parameters()];
            unit[k] = 1.0;
            let mut out = vec![[0.0; 3]; 3 * lattice_len(element.degree())];
            self.sum(element, (corners, &BodyForce::NONE), modes, (&unit, 0.0), &mut out);
            out
        };
        (0..modes.parameters()).map(of).collect()
    }

    /// Nodal stresses of mode parameters, as [`EquilibriumElement::stresses`] has them.
    pub fn stresses(
        self,
        element: &dyn EquilibriumElement,
        corners: Corners,
        force: &BodyForce,
        modes: &Modes<'_>,
        s: &[f64],
        out: &mut [[f64; 3]],
    ) {
        self.sum(element, (corners, force), modes, (s, 1.0), out);
    }

    /// Nodal stresses of mode parameters and so many times the particular field.
    fn sum(
        self,
        element: &dyn EquilibriumElement,
        (corners, force): (Corners, &BodyForce),
        modes: &Modes<'_>,
        (s, particular): (&[f64], f64),
        out: &mut [[f64; 3]],
    ) {
        match self {
            Section::Slice => element.stresses(corners, force, modes, s, particular, out),
            Section::Revolved { .. } => Ring::stresses(modes, s, particular, out),
        }
    }

    /// ∫ w over a triangle.
    pub fn volume(self, corners: Corners) -> f64 {
        let [a, b, c] = corners;
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        match self {
            Section::Slice => area,
            Section::Revolved { .. } => area * corners.iter().map(|p| self.weight(*p)).sum::<f64>() / 3.0,
        }
    }

    /// F_r on the axis, and F_z, of a force that beside an axis is (a + b r, c).
    pub fn forces(self, force: &BodyForce) -> [f64; 2] {
        [self.radial(force)[0], force.given().value[1]]
    }

    /// a and b of F_r = a + b r: what is given, and the centrifugal force of a rotation about the axis.
    pub fn radial(self, force: &BodyForce) -> [f64; 2] {
        let Section::Revolved { axis } = self else { return [0.0; 2] };
        let (given, turning) = (force.given(), force.rotation().map_or(0.0, |rotation| rotation.stiffness()));
        [given.value[0] + given.gradient[0][0] * axis, given.gradient[0][0] + turning]
    }

    /// A body force at a point.
    pub fn force(self, force: &BodyForce, point: [f64; 2]) -> [f64; 2] {
        match self {
            Section::Slice => force.at(point),
            Section::Revolved { .. } => {
                let ([a, b], [_, axial]) = (self.radial(force), self.forces(force));
                [a + b * self.weight(point), axial]
            }
        }
    }

    /// True if the section admits this body force: in a body of revolution F_r depends on r alone, and F_z is constant.
    pub fn carries(self, force: &BodyForce) -> bool {
        let [[_, across], along] = force.given().gradient;
        !self.is_revolved() || (across == 0.0 && along == [0.0; 2])
    }
}

/// A body of revolution: its energies, enclosed.
#[derive(Debug, Clone, Copy)]
pub struct Revolved {
    axis: f64,
}

impl Section {
    /// The body of revolution, where it is one.
    pub fn revolved(self) -> Option<Revolved> {
        match self {
            Section::Slice => None,
            Section::Revolved { axis } => Some(Revolved { axis }),
        }
    }
}

impl Revolved {
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
    fn off_axis(self, corners: Corners, sub: usize, bary: [f64; 3]) -> (super::revolved::Point, bool) {
        const ASIDE: f64 = 1e-6;
        let radii = self.radii(corners, sub);
        let radius = |l: [f64; 3]| (0..3).map(|i| l[i] * radii[i]).sum::<f64>();
        let largest = radii.iter().copied().fold(0.0, f64::max);
        let on_axis = radius(bary) <= ASIDE * largest;
        let bary = if on_axis { bary.map(|l| (1.0 - ASIDE) * l + ASIDE / 3.0) } else { bary };
        (super::revolved::Point { bary, weight: 1.0, radius: radius(bary), excess: 0.0 }, on_axis)
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
        for point in rule(self.radii(corners, sub), 2 * k, super::revolved::ROUGH) {
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
                let point = super::revolved::Point { bary, weight, radius, excess: 0.0 };
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
