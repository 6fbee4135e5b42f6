//! The body that a plane figure represents: a slice, or a body of revolution.
//!
//! All differences between the two are here and in [`super::revolved`]. In a slice the stresses are λ, and integrals over areas and lengths
//! carry no weight but the thickness. In a body of revolution the stored stresses are weighted, Σ = r λ ([`super::revolved`]), tractions
//! are r T, integrals over the figure carry the weight r, and the measure is 2π, so that energies and forces are those of the full turn.
//! With weighted tractions everything on edges (moments of displacements, unknowns, contact) is common to both.

use super::congruent;
use super::revolved::{Held, Revolved, Ring};
use super::{EquilibriumElement, Layout, Material, Modes, ModesMut, displacement, lattice_len};
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

    /// The body of revolution, where it is one.
    pub fn revolved(self) -> Option<Revolved> {
        match self {
            Section::Slice => None,
            Section::Revolved { axis } => Some(Revolved::about(axis)),
        }
    }
}
