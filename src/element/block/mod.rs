//! The block element of Watwood and Hartz, Section 2.1 of the paper: linear stresses on the three subtriangles.
//!
//! N(K) has nine dimensions. Seven are the linear self-equilibrated fields on the whole triangle; the other two are
//! second derivatives of piecewise cubic Airy functions that are C¹ across the segments 0a_k. With barycentric
//! coordinates μ_k of the triangle and d_k = μ_{k+1} − μ_{k+2}, which vanishes on 0a_k, two cubics match to first order
//! there exactly if they differ by d_k² ℓ_k with a linear ℓ_k; going round the centroid requires Σ d_k² ℓ_k = 0, and
//! for ℓ_k that are combinations of the d_k this has two solutions.

mod basis;
mod particular;

use self::basis::BlockBasis;
use self::particular::Particular;
use super::{EquilibriumElement, Material, Modes, ModesMut};
use crate::load::BodyForce;

/// The element of the paper: p = 1, nine parameters.
#[derive(Debug, Clone, Copy, Default)]
pub struct Block;

/// Dimension of N(K).
const N: usize = 9;
/// Fields that are linear on the whole triangle; they come first.
const COMMON: usize = 7;
/// Entries of an upper triangle of order N.
const UPPER: usize = N * (N + 1) / 2;

impl EquilibriumElement for Block {
    fn name(&self) -> &'static str {
        "Watwood–Hartz block, p = 1"
    }

    fn degree(&self) -> usize {
        1
    }

    fn parameters(&self) -> usize {
        N
    }

    /// L⁻ᵀ, which turns modes into fields of the basis, and the overlaps of the particular field with the modes.
    fn kept(&self) -> usize {
        UPPER + N
    }

    fn compute(&self, corners: [[f64; 2]; 3], material: &Material, force: &BodyForce, out: ModesMut<'_>) {
        let basis = BlockBasis::new(corners);
        let scale = basis.frame.scale;
        let inverse = match basis.flexibility(material) {
            Some(flexibility) => {
                inverse_factor(&flexibility.map(|row| row.map(|f| f * (scale * scale / material.unit()))))
            }
            None => basis.inverse_factor(material),
        };
        for (column, k) in inverse.iter().zip(0..) {
            out.kept[upper(k)..][..=k].copy_from_slice(&column[..=k]);
        }
        let raw = basis.tractions();
        out.traction.fill(0.0);
        for (k, (traction, column)) in out.traction.chunks_exact_mut(12).zip(&inverse).enumerate() {
            for (c, raw) in column[..=k].iter().zip(&raw) {
                traction.iter_mut().zip(raw).for_each(|(t, v)| *t += c * v);
            }
        }
        out.kept[UPPER..].fill(0.0);
        out.particular_traction.fill(0.0);
        *out.particular_energy = 0.0;
        let force = force.on(corners).mean();
        if force == [0.0; 2] {
            return;
        }
        let particular = Particular { corners, force };
        let overlaps = particular.overlaps(&basis, &inverse, material);
        out.kept[UPPER..].copy_from_slice(&overlaps);
        out.particular_traction.copy_from_slice(&particular.traction());
        for (mode, overlap) in out.traction.chunks_exact(12).zip(overlaps) {
            out.particular_traction.iter_mut().zip(mode).for_each(|(p, t)| *p -= overlap * t);
        }
        let own = sum(basis.field(&coefficients(out.kept, &[0.0; N], 1.0)), particular.stress());
        *out.particular_energy = particular.energy(&own, &own, material);
    }

    fn stresses(
        &self,
        corners: [[f64; 2]; 3],
        force: &BodyForce,
        modes: &Modes<'_>,
        s: &[f64],
        particular: f64,
        out: &mut [[f64; 3]],
    ) {
        let field = BlockBasis::new(corners).field(&coefficients(modes.kept(), s, particular));
        let balance = Particular { corners, force: force.on(corners).mean().map(|f| particular * f) };
        out.copy_from_slice(&sum(field, balance.stress()));
    }
}

/// Where column `k` of a packed upper triangle begins.
const fn upper(k: usize) -> usize {
    k * (k + 1) / 2
}

/// Coefficients of the fields of the basis in Σ (S_k − `particular` · overlap_k) τ_k.
fn coefficients(kept: &[f64], s: &[f64], particular: f64) -> [f64; N] {
    let (inverse, overlaps) = kept.split_at(UPPER);
    let mut out = [0.0; N];
    for (k, (s, overlap)) in s.iter().zip(overlaps).enumerate() {
        let part = s - particular * overlap;
        out.iter_mut().zip(&inverse[upper(k)..][..=k]).for_each(|(c, l)| *c += part * l);
    }
    out
}

/// Two fields added node by node.
fn sum(mut a: [[f64; 3]; 9], b: [[f64; 3]; 9]) -> [[f64; 3]; 9] {
    a.as_flattened_mut().iter_mut().zip(b.as_flattened()).for_each(|(a, b)| *a += b);
    a
}

/// L⁻ᵀ of F = L Lᵀ, column by column: turns the basis into energy-orthonormal modes, the pressure first.
fn inverse_factor(f: &[[f64; N]; N]) -> [[f64; N]; N] {
    // Columns of L, what is below the diagonal of F being read.
    let mut factor = [[0.0; N]; N];
    for j in 0..N {
        let mut own = f[j];
        for done in &factor[..j] {
            let part = done[j];
            own[j..].iter_mut().zip(&done[j..]).for_each(|(o, l)| *o -= part * l);
        }
        // Positive for every triangle that is one; the floor only keeps NaN out of a degenerate block.
        let pivot = own[j].max(f64::MIN_POSITIVE).sqrt();
        own[j] = pivot;
        own[j + 1..].iter_mut().for_each(|o| *o /= pivot);
        factor[j] = own;
    }
    let mut inverse = [[0.0; N]; N];
    for (k, column) in inverse.iter_mut().enumerate() {
        for i in (0..=k).rev() {
            let unit = if i == k { 1.0 } else { 0.0 };
            let sum: f64 = (i + 1..=k).map(|j| factor[i][j] * column[j]).sum();
            column[i] = (unit - sum) / factor[i][i];
        }
    }
    inverse
}
