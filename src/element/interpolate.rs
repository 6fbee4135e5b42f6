//! The mapping r_h of Theorem 2.2: the nearest equilibrated field of the elements, triangle by triangle.
//!
//! On every side the traction of a stress is projected in L² onto the linear functions. The projection keeps force and
//! moment of each side, so the projected tractions of a self-equilibrated stress balance each other on every triangle
//! and determine one field of N(K) (Theorem 2.1). Both triangles of an edge see the same projection: the result has
//! continuous tractions.

use nalgebra::{DMatrix, DVector};

use super::polynomial::quadrature::segment_rule;
use super::{Block, EquilibriumElement, Material, Modes, StressField};
use crate::load::BodyForce;
use crate::mesh::Triangulation;

/// End values of the linear function that is nearest to `traction` in L² on the side from `a` to `b`.
pub fn side_projection(a: [f64; 2], b: [f64; 2], traction: impl Fn([f64; 2]) -> [f64; 2]) -> [[f64; 2]; 2] {
    let mut ends = [[0.0; 2]; 2];
    for &(s, weight) in segment_rule(9) {
        let value = traction([0, 1].map(|c| a[c] + s * (b[c] - a[c])));
        for c in 0..2 {
            // 4 − 6s and 6s − 2 are biorthogonal to the hat functions 1 − s and s.
            ends[0][c] += weight * (4.0 - 6.0 * s) * value[c];
            ends[1][c] += weight * (6.0 * s - 2.0) * value[c];
        }
    }
    ends
}

/// The parameters of the field of N(K) whose traction coefficients come nearest to `tractions`, in the order of
/// [`EquilibriumElement`], and what is left of them: the largest difference, which is round-off for tractions in
/// equilibrium. `None` where the triangle is degenerate.
pub fn parameters_from_tractions(modes: &Modes<'_>, tractions: &[f64]) -> Option<(Vec<f64>, f64)> {
    let matrix = DMatrix::from_column_slice(tractions.len(), modes.parameters(), modes.traction());
    let given = DVector::from_column_slice(tractions);
    let qr = matrix.clone().qr();
    let s = qr.r().solve_upper_triangular(&(qr.q().transpose() * &given))?;
    let left = (matrix * &s - given).amax();
    Some((s.as_slice().to_vec(), left))
}

/// r_h of a stress without divergence, given as (xx, yy, xy) by body and point, in block elements.
///
/// A stress that is not self-equilibrated has no interpolant; it gives the field of least squares. Degenerate triangles
/// are left at zero.
pub fn interpolant(mesh: &Triangulation, stress: impl Fn(usize, [f64; 2]) -> [f64; 3]) -> StressField {
    let mut field = StressField::zeros(1, mesh.triangles.len());
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        let body = mesh.body[t];
        let mut tractions = Vec::with_capacity(12);
        for side in 0..3 {
            let (a, b) = (corners[(side + 1) % 3], corners[(side + 2) % 3]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let n = [dy / dx.hypot(dy), -dx / dx.hypot(dy)];
            let traction = |p| {
                let tau = stress(body, p);
                [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]]
            };
            tractions.extend(side_projection(a, b, traction).into_iter().flatten());
        }
        // N(K) and its tractions know nothing of the material.
        let modes = Block.modes(corners, &Material::ANY, &BodyForce::NONE);
        if let Some((s, _)) = parameters_from_tractions(&modes, &tractions) {
            Block.stresses(corners, &BodyForce::NONE, &modes, &s, 0.0, field.block_mut(t));
        }
    }
    field
}
