//! The end of the factor, L_JJ for the unknowns J ordered last: L_JJ L_JJᵀ is their Schur complement.

use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat};

use super::Factor;

impl Factor {
    /// Number of unknowns ordered last, J.
    pub fn trailing_len(&self) -> usize {
        self.symbolic.forward.len() - self.symbolic.leading
    }

    /// Visits the columns of L_JJ, where J are the unknowns ordered last: `visit(k, diagonal part, rows, values)` with
    /// the entries of column k from its diagonal down to where the supernode ends, then rows of J with their values.
    fn trailing_columns(&self, mut visit: impl FnMut(usize, &[f64], &[usize], &[f64])) {
        let first = self.symbolic.leading;
        let Some(factor) = self.supernodal() else { return };
        let nodes = factor.symbolic();
        let begin = nodes.supernode_end().partition_point(|&end| end <= first);
        for s in begin..nodes.n_supernodes() {
            let node = factor.supernode(s);
            let (start, size) = (node.start(), node.val().ncols());
            for column in first.max(start)..start + size {
                if let Some(values) = node.val().col(column - start).try_as_col_major() {
                    let (own, below) = values.as_slice().split_at(size);
                    visit(column - first, &own[column - start..], node.pattern(), below);
                }
            }
        }
    }

    /// L_JJ as a dense matrix.
    pub fn trailing(&self) -> Mat<f64> {
        let (m, first) = (self.trailing_len(), self.symbolic.leading);
        let mut out = Mat::zeros(m, m);
        self.trailing_columns(|k, own, rows, below| {
            for (i, value) in own.iter().enumerate() {
                out[(k + i, k)] = *value;
            }
            for (&row, value) in rows.iter().zip(below) {
                out[(row - first, k)] = *value;
            }
        });
        out
    }

    /// L_JJ L_JJᵀ, of which one half is computed.
    pub fn trailing_product(&self) -> Mat<f64> {
        let (lower, m) = (self.trailing(), self.trailing_len());
        let mut out = Mat::zeros(m, m);
        triangular::matmul(
            &mut out,
            BlockStructure::TriangularLower,
            Accum::Replace,
            &lower,
            BlockStructure::TriangularLower,
            lower.transpose(),
            BlockStructure::TriangularUpper,
            1.0,
            self.par,
        );
        for k in 0..m {
            for i in k + 1..m {
                out[(k, i)] = out[(i, k)];
            }
        }
        out
    }

    /// The diagonal of L_JJ L_JJᵀ.
    pub fn trailing_squares(&self) -> Vec<f64> {
        let first = self.symbolic.leading;
        let mut out = vec![0.0; self.trailing_len()];
        self.trailing_columns(|k, own, rows, below| {
            for (o, l) in out[k..].iter_mut().zip(own) {
                *o += l * l;
            }
            for (&row, l) in rows.iter().zip(below) {
                out[row - first] += l * l;
            }
        });
        out
    }

    /// L_JJ v.
    pub fn trailing_times(&self, v: &[f64]) -> Vec<f64> {
        let first = self.symbolic.leading;
        let mut out = vec![0.0; v.len()];
        self.trailing_columns(|k, own, rows, below| {
            for (o, l) in out[k..].iter_mut().zip(own) {
                *o += l * v[k];
            }
            for (&row, l) in rows.iter().zip(below) {
                out[row - first] += l * v[k];
            }
        });
        out
    }

    /// L_JJᵀ v.
    pub fn trailing_transpose_times(&self, v: &[f64]) -> Vec<f64> {
        let first = self.symbolic.leading;
        let mut out = vec![0.0; v.len()];
        self.trailing_columns(|k, own, rows, below| {
            let near: f64 = own.iter().zip(&v[k..]).map(|(l, x)| l * x).sum();
            let far: f64 = rows.iter().zip(below).map(|(&row, l)| l * v[row - first]).sum();
            out[k] = near + far;
        });
        out
    }
}
