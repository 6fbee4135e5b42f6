//! Orthonormal bases of small subspaces, with the rank decided by pivoting.

use nalgebra::DVector;

/// A subspace of ℝⁿ by an orthonormal basis.
#[derive(Debug, Clone)]
pub(in crate::statics) struct Span {
    dimension: usize,
    pub basis: Vec<DVector<f64>>,
}

impl Span {
    /// The zero subspace of ℝ^`dimension`.
    pub fn empty(dimension: usize) -> Self {
        Span { dimension, basis: Vec::new() }
    }

    /// The component of `v` orthogonal to the subspace. Two passes of Gram–Schmidt leave it orthogonal to round-off.
    pub fn residual(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut rest = v.clone();
        for _ in 0..2 {
            for q in &self.basis {
                let along = q.dot(&rest);
                rest.axpy(-along, q, 1.0);
            }
        }
        rest
    }

    /// The component of `v` within the subspace.
    pub fn project(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut inside = DVector::zeros(self.dimension);
        for q in &self.basis {
            inside.axpy(q.dot(v), q, 1.0);
        }
        inside
    }

    /// Adds the vectors `rows`, the one farthest from the subspace first, until the farthest left over is no farther
    /// than `tolerance`. Rows of comparable length make `tolerance` a relative one.
    pub fn extend(&mut self, rows: &[DVector<f64>], tolerance: f64) {
        self.extend_up_to(rows, tolerance, self.dimension);
    }

    /// The orthogonal complement.
    pub fn complement(&self) -> Span {
        let n = self.dimension;
        let units: Vec<_> = (0..n).map(|i| DVector::from_fn(n, |j, _| f64::from(i == j))).collect();
        let mut whole = self.clone();
        whole.extend_up_to(&units, 0.0, n);
        Span { dimension: n, basis: whole.basis.split_off(self.basis.len()) }
    }

    fn extend_up_to(&mut self, rows: &[DVector<f64>], tolerance: f64, rank: usize) {
        let mut rests: Vec<_> = rows.iter().map(|row| self.residual(row)).collect();
        while self.basis.len() < rank {
            let Some((farthest, distance)) =
                rests.iter().map(DVector::norm).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
            else {
                return;
            };
            if distance <= tolerance {
                return;
            }
            let new = self.residual(&rests[farthest]).normalize();
            for rest in &mut rests {
                let along = new.dot(rest);
                rest.axpy(-along, &new, 1.0);
            }
            self.basis.push(new);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complement_is_orthogonal_and_complete() {
        let rows = [
            DVector::from_vec(vec![1.0, 2.0, 0.0, 1.0]),
            DVector::from_vec(vec![1.0, 2.0, 1e-13, 1.0]),
            DVector::from_vec(vec![0.0, 1.0, 5.0, -1.0]),
        ];
        let mut span = Span::empty(4);
        span.extend(&rows, 1e-9);
        assert_eq!(span.basis.len(), 2);
        let complement = span.complement();
        assert_eq!(complement.basis.len(), 2);
        for q in &complement.basis {
            assert!((q.norm() - 1.0).abs() < 1e-15);
            assert!(rows.iter().all(|row| row.dot(q).abs() < 1e-12));
        }
    }
}
