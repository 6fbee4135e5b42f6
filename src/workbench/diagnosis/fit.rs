//! Least squares over matrices.

use nalgebra::{DMatrix, DVector};

/// Relative to the largest eigenvalue of the normal equations, what counts as dependent.
const DEPENDENT: f64 = 1e-13;

/// The factors c with Σ cᵢ Mᵢ nearest to K, the shortest of all where matrices depend on each other.
pub(super) fn nearest(k: &DMatrix<f64>, matrices: &[DMatrix<f64>]) -> Vec<f64> {
    let n = matrices.len();
    let normal = DMatrix::from_fn(n, n, |i, j| matrices[i].dot(&matrices[j]));
    let right = DVector::from_fn(n, |i, _| matrices[i].dot(k));
    let eigen = normal.symmetric_eigen();
    let least = DEPENDENT * eigen.eigenvalues.amax();
    let mut along = eigen.eigenvectors.tr_mul(&right);
    for (x, value) in along.iter_mut().zip(&eigen.eigenvalues) {
        *x = if *value > least { *x / value } else { 0.0 };
    }
    (eigen.eigenvectors * along).iter().copied().collect()
}
