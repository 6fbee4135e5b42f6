//! Equilibrium elements: the seam, and one file per element.
//!
//! An equilibrium element is a space N(K) of stress fields on a triangle with div τ = 0, in which the traction on the
//! boundary of the triangle is a polynomial of degree p on each side. The dual problem needs to know three things of
//! it, all contained in [`Modes`]: a basis of N(K), the tractions of each basis field on the sides, and a particular
//! field that balances a constant body force. The basis is orthonormal in complementary energy, so that
//!
//! ½∫ a λ:λ = ½|S|² + ½∫ a λ̄:λ̄ for λ = Σ S_k τ_k + λ̄, and the element's stiffness is K = T Tᵀ,
//!
//! where T holds the traction values of the modes (theory in `docs/theory.md`).

mod block;
mod compliance;
mod field;
mod interpolate;
pub mod quadrature;
pub mod subtriangle;

pub use block::Block;
pub use compliance::Compliance;
pub use field::{Displacement, StressField, lattice_len};
pub use interpolate::{interpolant, parameters_from_tractions, side_projection};

use std::borrow::Cow;

/// A space of self-equilibrated stresses on a triangle.
///
/// Traction values are numbered side by side: side i joins the corners i + 1 and i + 2 (counter-clockwise); on it come
/// the p + 1 values from its first to its second end, each with its x and y component. They are values of the outward
/// traction at the nodes of degree p on the side, conjugate to the moments ∫ u q_j ds against the nodal basis q_j.
pub trait EquilibriumElement: Sync {
    /// Name for reports.
    fn name(&self) -> &'static str;

    /// Polynomial degree p of stress and traction.
    fn degree(&self) -> usize;

    /// Dimension of N(K).
    fn parameters(&self) -> usize;

    /// Number of traction values, 6(p + 1).
    fn tractions(&self) -> usize {
        6 * (self.degree() + 1)
    }

    /// Computes basis, tractions and particular field on the counter-clockwise triangle with the given corners.
    fn compute(&self, corners: [[f64; 2]; 3], material: &Compliance, body_force: [f64; 2], out: ModesMut<'_>);

    /// Sizes of what [`Self::compute`] writes.
    fn layout(&self) -> Layout {
        Layout { parameters: self.parameters(), tractions: self.tractions(), nodes: 3 * lattice_len(self.degree()) }
    }

    /// [`Self::compute`] into memory of its own.
    fn modes(&self, corners: [[f64; 2]; 3], material: &Compliance, body_force: [f64; 2]) -> Modes<'static> {
        let layout = self.layout();
        let mut data = vec![0.0; layout.len()];
        self.compute(corners, material, body_force, layout.split(&mut data));
        Modes { layout, data: Cow::Owned(data) }
    }
}

/// Sizes of the arrays of one element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Dimension of N(K).
    pub parameters: usize,
    /// Number of traction values.
    pub tractions: usize,
    /// Number of stress nodes.
    pub nodes: usize,
}

impl Layout {
    /// Number of values in all.
    pub fn len(&self) -> usize {
        let Layout { parameters, tractions, nodes } = *self;
        parameters * (tractions + 3 * nodes) + tractions + 3 * nodes + 1
    }

    /// Never empty.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Names the parts of a slice of [`Self::len`] values.
    pub fn split<'a>(&self, data: &'a mut [f64]) -> ModesMut<'a> {
        let (traction, rest) = data.split_at_mut(self.parameters * self.tractions);
        let (stress, rest) = rest.split_at_mut(self.parameters * 3 * self.nodes);
        let (particular_traction, rest) = rest.split_at_mut(self.tractions);
        let (particular_stress, rest) = rest.split_at_mut(3 * self.nodes);
        ModesMut { traction, stress, particular_traction, particular_stress, particular_energy: &mut rest[0] }
    }
}

/// Where an element writes its modes; shapes as in [`Modes`].
#[derive(Debug)]
pub struct ModesMut<'a> {
    /// See [`Modes::traction`].
    pub traction: &'a mut [f64],
    /// See [`Modes::stress`].
    pub stress: &'a mut [f64],
    /// See [`Modes::particular_traction`].
    pub particular_traction: &'a mut [f64],
    /// See [`Modes::particular_stress`].
    pub particular_stress: &'a mut [f64],
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

    /// Dimension of N(K).
    pub fn parameters(&self) -> usize {
        self.layout.parameters
    }

    /// Traction values of the modes, row by row: `traction()[i * parameters + k]` is value i of mode k.
    pub fn traction(&self) -> &[f64] {
        &self.data[..self.layout.parameters * self.layout.tractions]
    }

    /// Nodal stresses of the modes: `stress()[(node * 3 + component) * parameters + k]`, nodes as in
    /// [`StressField::block`].
    pub fn stress(&self) -> &[f64] {
        let start = self.layout.parameters * self.layout.tractions;
        &self.data[start..start + self.layout.parameters * 3 * self.layout.nodes]
    }

    /// Traction values of the particular field λ̄.
    pub fn particular_traction(&self) -> &[f64] {
        let end = self.layout.len() - 1 - 3 * self.layout.nodes;
        &self.data[end - self.layout.tractions..end]
    }

    /// Nodal stresses (xx, yy, xy) of λ̄ node by node; it is energy-orthogonal to all modes.
    pub fn particular_stress(&self) -> &[f64] {
        let end = self.layout.len() - 1;
        &self.data[end - 3 * self.layout.nodes..end]
    }

    /// ∫ a λ̄:λ̄.
    pub fn particular_energy(&self) -> f64 {
        self.data[self.layout.len() - 1]
    }

    /// Mode parameters S = Tᵀm that minimise the complementary energy against boundary moments `m`.
    pub fn parameters_from_moments(&self, m: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (row, &value) in self.traction().chunks_exact(self.layout.parameters).zip(m) {
            for (s, t) in out.iter_mut().zip(row) {
                *s += t * value;
            }
        }
    }

    /// Nodal stresses `particular` · λ̄ + Σ S_k τ_k.
    pub fn stress_from_parameters(&self, s: &[f64], particular: f64, out: &mut [[f64; 3]]) {
        let rows = self.stress().chunks_exact(self.layout.parameters);
        let values = out.iter_mut().flatten();
        for ((value, row), offset) in values.zip(rows).zip(self.particular_stress()) {
            let sum: f64 = row.iter().zip(s).map(|(a, b)| a * b).sum();
            *value = particular * offset + sum;
        }
    }
}
