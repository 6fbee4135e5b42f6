//! The quadratic form ½xᵀAx, as its algorithms see it.

use faer::linalg::solvers::Llt;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// A symmetric positive semidefinite A.
pub trait Quadratic {
    /// Number of unknowns.
    fn len(&self) -> usize;

    /// True if there are no unknowns.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Diagonal entry `i`.
    fn diagonal(&self, i: usize) -> f64;

    /// Adds Ax to `out`.
    fn add_product(&self, x: &[f64], out: &mut [f64]);

    /// Ax.
    fn apply(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.add_product(x, &mut out);
        out
    }

    /// Ax − b: the derivative of ½xᵀAx − bᵀx.
    fn gradient(&self, b: &[f64], x: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = b.iter().map(|b| -b).collect();
        self.add_product(x, &mut out);
        out
    }

    /// Σ_k |A_ik x_k|: the size of the terms whose sum is (Ax)_i, and with it of the rounding in that sum.
    fn terms(&self, x: &[f64]) -> Vec<f64>;

    /// True if factors are exact, and cheap beside the other work; otherwise they iterate, and algorithms that need one in each step are
    /// ruled out.
    fn is_direct(&self) -> bool {
        true
    }

    /// True if motions that A leaves free are to be expected in every state.
    fn is_loose(&self) -> bool {
        false
    }

    /// The factor of A + diag(`added`) on the unknowns that are not `held`; nothing where a pivot is not positive.
    fn factor(&self, added: &[f64], held: &[bool]) -> Option<Box<dyn Factor + '_>>;
}

/// A factor of a part of A.
pub trait Factor {
    /// The solution for the load `b`: zero at unknowns that are held.
    fn solve(&self, b: &[f64]) -> Vec<f64>;
}

impl Quadratic for Mat<f64> {
    fn len(&self) -> usize {
        self.nrows()
    }

    fn diagonal(&self, i: usize) -> f64 {
        self[(i, i)]
    }

    fn add_product(&self, x: &[f64], out: &mut [f64]) {
        for (k, &x) in x.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            out.iter_mut().zip(self.col(k).iter()).for_each(|(o, a)| *o += a * x);
        }
    }

    fn terms(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.nrows()];
        for (k, &x) in x.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            out.iter_mut().zip(self.col(k).iter()).for_each(|(o, a)| *o += (a * x).abs());
        }
        out
    }

    fn factor(&self, added: &[f64], held: &[bool]) -> Option<Box<dyn Factor + '_>> {
        let free: Vec<usize> = (0..self.nrows()).filter(|&i| !held[i]).collect();
        let mut part = Mat::zeros(free.len(), free.len());
        for (k, &column) in free.iter().enumerate() {
            let from = self.col(column);
            let to = part.col_mut(k);
            for (to, &row) in to.iter_mut().zip(&free).skip(k) {
                *to = from[row];
            }
            part[(k, k)] += added[column];
        }
        let llt = if free.is_empty() { None } else { Some(part.llt(Side::Lower).ok()?) };
        Some(Box::new(DenseFactor { llt, free, len: self.nrows() }))
    }
}

struct DenseFactor {
    llt: Option<Llt<f64>>,
    free: Vec<usize>,
    len: usize,
}

impl Factor for DenseFactor {
    fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.len];
        if let Some(llt) = &self.llt {
            let solved = llt.solve(Mat::from_fn(self.free.len(), 1, |k, _| b[self.free[k]]));
            self.free.iter().zip(solved.col(0).iter()).for_each(|(i, v)| x[*i] = *v);
        }
        x
    }
}
