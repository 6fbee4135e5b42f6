//! Equilibrium elements: the seam, and one file per element.
//!
//! An equilibrium element is a space N(K) of stress fields on a triangle with div τ = 0, in which the traction on the
//! boundary of the triangle is a polynomial of degree p on each side. The dual problem needs to know three things of
//! it, all contained in [`Modes`]: a basis of N(K), the tractions of each basis field on the sides, and a particular
//! field λ̄ that balances the body force. (A constant force asks for degree 1, an affine one for degree 2.) The basis is orthonormal in complementary energy, so that
//!
//! ½∫ a λ:λ = ½|S|² + ½∫ a λ̄:λ̄ for λ = Σ S_k τ_k + λ̄, and the element's stiffness is K = T Tᵀ,
//!
//! where T holds the traction coefficients of the modes (theory in `docs/theory.md`).

mod block;
pub mod congruent;
pub mod displacement;
mod elements;
mod field;
mod frame;
pub mod geometry;
mod interpolate;
mod material;
pub mod polynomial;
pub mod revolved;
mod section;
pub mod spanned;
mod split;
pub mod subtriangle;
mod traction;

pub use block::Block;
pub use displacement::Displacement;
pub use displacement::on_quadrilaterals::OnQuadrilaterals;
pub use displacement::plain::PlainDisplacement;
pub use displacement::quadrilateral::Quadrilateral;
pub use displacement::strain::{Strains, elastic_degree};
pub use elements::Elements;
pub use field::{StressField, contraction, lattice, lattice_len, weighed};
pub use interpolate::{interpolant, parameters_from_tractions, side_projection};
pub use material::{Material, Roots, Stiffness};
pub use polynomial::samples::Samples;
pub use polynomial::side_values::{SideValues, parts, starts};
pub use revolved::Revolved;
pub use section::Section;
pub use spanned::Spanned;

use std::borrow::Cow;

use self::split::Split;
use crate::load::BodyForce;

/// The largest degree of [`block`].
pub const MAX_DEGREE: usize = 8;

/// The equilibrium block of degree `degree`: stresses of that degree on the three subtriangles, dim N(K) = 6(p + 1) − 3.
///
/// For p = 1 this is [`Block`], the element of the paper. From p = 2 on some self-equilibrated fields have no traction; N(K) is then the space
/// of those that have the least energy among the fields with their tractions, and λ̄ is orthogonal to fields without traction too.
///
/// # Panics
///
/// If the degree is not one of 1, …, [`MAX_DEGREE`].
pub fn block(degree: usize) -> &'static dyn EquilibriumElement {
    static SPLIT: [Split; MAX_DEGREE - 1] =
        [Split::new(2), Split::new(3), Split::new(4), Split::new(5), Split::new(6), Split::new(7), Split::new(8)];
    assert!((1..=MAX_DEGREE).contains(&degree), "no equilibrium block of degree {degree}");
    match degree {
        1 => &Block,
        p => &SPLIT[p - 2],
    }
}

/// A space of self-equilibrated stresses on a triangle.
///
/// Traction coefficients are numbered side by side: side i joins the corners i + 1 and i + 2 (counter-clockwise); on it come
/// the p + 1 Bernstein coefficients of the outward traction ([`polynomial::side`]) from its first to its second end, each with its x and y
/// component. They are conjugate to the moments ∫ u B_k ds. For p = 1 they are the values at the ends.
///
/// Every mode holds itself in balance: the force of its tractions on the three sides is zero.
///
/// ```
/// # use hypercircle_core as hypercircle;
/// use hypercircle::element::{Material, block};
/// use hypercircle::load::BodyForce;
/// use hypercircle::scene::Kinematics;
///
/// let (element, corners) = (block(2), [[0.0, 0.0], [2.0, 0.0], [0.5, 1.0]]);
/// let modes = element.modes(corners, &Material::isotropic(Kinematics::PlaneStrain, 1.0, 0.3), &BodyForce::NONE);
/// assert_eq!((modes.parameters(), element.tractions()), (6 * 3 - 3, 6 * 3));
/// for traction in modes.tractions() {
///     let force_x: f64 = (0..3)
///         .map(|side| {
///             let [a, b] = [corners[(side + 1) % 3], corners[(side + 2) % 3]];
///             let length = (b[0] - a[0]).hypot(b[1] - a[1]);
///             // ∫ B_k ds is length/(p + 1); x stands before y.
///             length / 3.0 * (0..3).map(|k| traction[6 * side + 2 * k]).sum::<f64>()
///         })
///         .sum();
///     assert!(force_x.abs() < 1e-12);
/// }
/// ```
pub trait EquilibriumElement: Sync {
    /// Name for reports.
    fn name(&self) -> &'static str;

    /// Polynomial degree p of stress and traction.
    fn degree(&self) -> usize;

    /// Dimension of N(K).
    fn parameters(&self) -> usize;

    /// Number of traction coefficients, 6(p + 1).
    fn tractions(&self) -> usize {
        6 * (self.degree() + 1)
    }

    /// How many numbers of each triangle [`Self::stresses`] needs besides its corners.
    fn kept(&self) -> usize;

    /// Computes tractions, particular field and what is kept on the counter-clockwise triangle with the given corners. The degree is
    /// no lower than [`BodyForce::stress_degree`]; of any other force an element balances the value at the centroid.
    fn compute(&self, corners: [[f64; 2]; 3], material: &Material, force: &BodyForce, out: ModesMut<'_>);

    /// Nodal stresses `particular` · λ̄ + Σ S_k τ_k, nodes as in [`StressField::block`], on the triangle that `modes` were
    /// computed for.
    ///
    /// Stresses are asked for once and tractions many times: an element need not keep those of its modes.
    fn stresses(
        &self,
        corners: [[f64; 2]; 3],
        force: &BodyForce,
        modes: &Modes<'_>,
        s: &[f64],
        particular: f64,
        out: &mut [[f64; 3]],
    );

    /// Sizes of what [`Self::compute`] writes.
    fn layout(&self) -> Layout {
        Layout { parameters: self.parameters(), tractions: self.tractions(), kept: self.kept() }
    }

    /// [`Self::compute`] into memory of its own.
    fn modes(&self, corners: [[f64; 2]; 3], material: &Material, force: &BodyForce) -> Modes<'static> {
        let layout = self.layout();
        let mut data = vec![0.0; layout.len()];
        self.compute(corners, material, force, layout.split(&mut data));
        Modes { layout, data: Cow::Owned(data) }
    }

    /// Nodal stresses of self-equilibrated fields without any traction, orthonormal in energy: none where every field has a traction.
    fn unloaded(&self, _corners: [[f64; 2]; 3], _material: &Material) -> Vec<Vec<[f64; 3]>> {
        Vec::new()
    }
}

/// Sizes of the arrays of one element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Dimension of N(K).
    pub parameters: usize,
    /// Number of traction coefficients.
    pub tractions: usize,
    /// Number of values that the element keeps.
    pub kept: usize,
}

impl Layout {
    /// Number of values in all.
    pub fn len(&self) -> usize {
        let Layout { parameters, tractions, kept } = *self;
        parameters * tractions + tractions + kept + 1
    }

    /// Never empty.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Names the parts of a slice of [`Self::len`] values.
    pub fn split<'a>(&self, data: &'a mut [f64]) -> ModesMut<'a> {
        let (traction, rest) = data.split_at_mut(self.parameters * self.tractions);
        let (particular_traction, rest) = rest.split_at_mut(self.tractions);
        let (kept, rest) = rest.split_at_mut(self.kept);
        ModesMut { traction, particular_traction, kept, particular_energy: &mut rest[0] }
    }
}

/// Where an element writes its modes; shapes as in [`Modes`].
#[derive(Debug)]
pub struct ModesMut<'a> {
    /// See [`Modes::traction`].
    pub traction: &'a mut [f64],
    /// See [`Modes::particular_traction`].
    pub particular_traction: &'a mut [f64],
    /// See [`Modes::kept`].
    pub kept: &'a mut [f64],
    /// See [`Modes::particular_energy`].
    pub particular_energy: &'a mut f64,
}

/// An energy-orthonormal basis of N(K) and a particular field, on one triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes<'a> {
    layout: Layout,
    data: Cow<'a, [f64]>,
}

impl<'a> Modes<'a> {
    /// Reads what an element of this layout wrote.
    pub fn view(layout: Layout, data: &'a [f64]) -> Self {
        Modes { layout, data: Cow::Borrowed(data) }
    }

    /// Owns what an element of this layout wrote.
    pub fn owned(layout: Layout, data: Vec<f64>) -> Modes<'static> {
        Modes { layout, data: Cow::Owned(data) }
    }

    /// Dimension of N(K).
    pub fn parameters(&self) -> usize {
        self.layout.parameters
    }

    /// Traction coefficients of the modes, mode by mode: `traction()[k * tractions + i]` is coefficient i of mode k.
    pub fn traction(&self) -> &[f64] {
        &self.data[..self.layout.parameters * self.layout.tractions]
    }

    /// Traction coefficients of every mode.
    pub fn tractions(&self) -> impl Iterator<Item = &[f64]> {
        self.traction().chunks_exact(self.layout.tractions)
    }

    /// Traction coefficients of the particular field λ̄, which is energy-orthogonal to all modes.
    pub fn particular_traction(&self) -> &[f64] {
        let start = self.layout.parameters * self.layout.tractions;
        &self.data[start..start + self.layout.tractions]
    }

    /// The data that the element keeps to compute stresses from parameters.
    pub fn kept(&self) -> &[f64] {
        let end = self.layout.len() - 1;
        &self.data[end - self.layout.kept..end]
    }

    /// ∫ a λ̄:λ̄.
    pub fn particular_energy(&self) -> f64 {
        self.data[self.layout.len() - 1]
    }

    /// Mode parameters S = Tᵀm that minimise the complementary energy against boundary moments `m`.
    pub fn parameters_from_moments(&self, m: &[f64], out: &mut [f64]) {
        for (s, mode) in out.iter_mut().zip(self.tractions()) {
            *s = mode.iter().zip(m).map(|(t, m)| t * m).sum();
        }
    }

    /// Traction coefficients `particular` · T̄ + T S.
    pub fn tractions_from_parameters(&self, s: &[f64], particular: f64, out: &mut [f64]) {
        out.iter_mut().zip(self.particular_traction()).for_each(|(o, t)| *o = particular * t);
        for (s, mode) in s.iter().zip(self.tractions()) {
            out.iter_mut().zip(mode).for_each(|(o, t)| *o += s * t);
        }
    }
}
