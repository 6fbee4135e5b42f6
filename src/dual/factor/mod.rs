//! Sparse Cholesky with the jumps ordered last, so that the end of the factor holds the Schur complement on Γ_K.

mod complement;
mod symbolic;
mod trailing;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::SymbolicCholeskyRaw;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::{Conj, MatMut, Par};

pub use self::symbolic::SymbolicFactor;
use super::contact::interface::Interface;

/// Why a matrix could not be factorised.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Breakdown {
    /// The matrix is not positive definite; the pivot of this unknown shows it.
    NotPositive(usize),
    /// Out of memory, or too large for the index type.
    TooLarge(String),
}

/// The power of two s that brings s² · `value` nearest to one; one where there is none.
pub fn power_of_two_near(value: f64) -> f64 {
    let s = (-0.5 * value.log2()).round().exp2();
    if s.is_normal() { s } else { 1.0 }
}

/// Added to the diagonal, relative to each entry, where rounding leaves nothing of a pivot: as much as rounding
/// takes at first …
const LEAST_RAISED: f64 = 1e-14;
/// … and ten times more until all pivots are positive, up to this.
const MOST_RAISED: f64 = 1e-9;

/// Part of the unknowns up to which most of the factor is not touched by a load on them.
const FEW_LOADED: f64 = 0.1;

/// y = L⁻¹ y, past the supernodes where y is zero.
fn forward_where_loaded(factor: SupernodalLltRef<'_, usize, f64>, y: &mut [f64]) {
    let mut below = Vec::new();
    for s in 0..factor.symbolic().n_supernodes() {
        let node = factor.supernode(s);
        let (start, size) = (node.start(), node.val().ncols());
        if y[start..start + size].iter().all(|value| *value == 0.0) {
            continue;
        }
        below.clear();
        below.resize(node.pattern().len(), 0.0);
        for j in 0..size {
            let Some(column) = node.val().col(j).try_as_col_major() else { unreachable!("columns are contiguous") };
            let (own, rest) = column.as_slice().split_at(size);
            let value = y[start + j] / own[j];
            y[start + j] = value;
            y[start + j + 1..start + size].iter_mut().zip(&own[j + 1..]).for_each(|(y, l)| *y -= value * l);
            below.iter_mut().zip(rest).for_each(|(sum, l)| *sum += value * l);
        }
        node.pattern().iter().zip(&below).for_each(|(&row, sum)| y[row] -= sum);
    }
}

/// Numeric factorisation P A Pᵀ = L Lᵀ.
#[derive(Debug)]
pub struct Factor {
    symbolic: SymbolicFactor,
    values: Vec<f64>,
    par: Par,
    /// The unknown at which the plain factorisation broke down, where that made it raise the diagonal.
    broken: Option<usize>,
}

impl Factor {
    /// Factorises the matrix whose lower triangle is given. Where rounding leaves nothing of a pivot, the diagonal is
    /// raised: the factor is then one of a matrix nearby, and solves with it have to be refined.
    ///
    /// # Errors
    /// [`Breakdown`] where no small raise helps.
    pub fn of_semidefinite(
        symbolic: SymbolicFactor,
        matrix: SparseColMatRef<'_, usize, f64>,
        par: Par,
    ) -> Result<Self, Breakdown> {
        let broken = match symbolic.factorise(matrix, par) {
            Ok(values) => return Ok(Factor { symbolic, values, par, broken: None }),
            Err(Breakdown::NotPositive(unknown)) => unknown,
            Err(breakdown) => return Err(breakdown),
        };
        let mut raised = matrix.val().to_vec();
        let mut part = LEAST_RAISED;
        while part <= MOST_RAISED {
            for &diagonal in &matrix.col_ptr()[..matrix.ncols()] {
                raised[diagonal] = matrix.val()[diagonal] * (1.0 + part);
            }
            match symbolic.factorise(SparseColMatRef::new(matrix.symbolic(), &raised), par) {
                Ok(values) => return Ok(Factor { symbolic, values, par, broken: Some(broken) }),
                Err(Breakdown::NotPositive(_)) => part *= 10.0,
                Err(breakdown) => return Err(breakdown),
            }
        }
        Err(Breakdown::NotPositive(broken))
    }

    /// The unknown at which rounding left no pivot, where the diagonal was raised.
    pub fn broken(&self) -> Option<usize> {
        self.broken
    }

    /// The unknowns at its end, where they are more than the jumps.
    pub fn interface(&self) -> Option<&Interface> {
        self.symbolic.interface.as_ref()
    }

    /// Gives the symbolic part back, for another matrix of the same structure.
    pub fn into_symbolic(self) -> SymbolicFactor {
        self.symbolic
    }

    fn supernodal(&self) -> Option<SupernodalLltRef<'_, usize, f64>> {
        match self.symbolic.inner.as_ref()?.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => Some(SupernodalLltRef::new(symbolic, &self.values)),
            SymbolicCholeskyRaw::Simplicial(_) => unreachable!("the supernodal variant is forced"),
        }
    }

    fn memory(&self) -> MemBuffer {
        let inner = self.symbolic.inner.as_ref();
        MemBuffer::new(inner.map_or(Default::default(), |s| s.solve_in_place_scratch::<f64>(1, self.par)))
    }

    /// y = L⁻¹ P b, in the order of the factor.
    pub fn forward(&self, b: &[f64]) -> Vec<f64> {
        let mut y: Vec<f64> = self.symbolic.forward.iter().map(|&old| b[old]).collect();
        let n = y.len();
        if let Some(factor) = self.supernodal() {
            let loaded = b.iter().filter(|value| **value != 0.0).count();
            if loaded as f64 <= FEW_LOADED * n as f64 {
                forward_where_loaded(factor, &mut y);
            } else {
                let y = MatMut::from_column_major_slice_mut(&mut y, n, 1);
                factor.l_solve_with_conj(Conj::No, y, self.par, MemStack::new(&mut self.memory()));
            }
        }
        y
    }

    /// x = Pᵀ L⁻ᵀ y.
    pub fn backward(&self, mut y: Vec<f64>) -> Vec<f64> {
        let n = y.len();
        if let Some(factor) = self.supernodal() {
            let y = MatMut::from_column_major_slice_mut(&mut y, n, 1);
            factor.l_transpose_solve_with_conj(Conj::No, y, self.par, MemStack::new(&mut self.memory()));
        }
        let mut x = vec![0.0; n];
        for (value, &old) in y.iter().zip(&self.symbolic.forward) {
            x[old] = *value;
        }
        x
    }

    /// x = A⁻¹ b.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        self.backward(self.forward(b))
    }
}

#[cfg(test)]
mod tests {
    use faer::sparse::{SparseColMat, Triplet};

    use super::*;

    const SIDE: usize = 12;

    /// The lower triangle of the five-point stencil on a square, odd points before even ones, with a shift.
    fn stencil() -> SparseColMat<usize, f64> {
        let count = SIDE * SIDE;
        let number = |i: usize, j: usize| (i * SIDE + j) / 2 + if (i + j).is_multiple_of(2) { count / 2 } else { 0 };
        let mut entries: Vec<Triplet<usize, usize, f64>> = (0..count).map(|k| Triplet::new(k, k, 4.3)).collect();
        for i in 0..SIDE {
            for j in 0..SIDE {
                let right = (j + 1 < SIDE).then(|| (i, j + 1));
                let above = (i + 1 < SIDE).then(|| (i + 1, j));
                for (a, b) in right.into_iter().chain(above) {
                    let ends = [number(i, j), number(a, b)];
                    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                    entries.push(Triplet::new(high, low, -1.0));
                }
            }
        }
        SparseColMat::try_new_from_triplets(count, count, &entries).expect("entries within the matrix")
    }

    fn times(a: &SparseColMat<usize, f64>, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; x.len()];
        for entry in a.triplet_iter() {
            out[entry.row] += entry.val * x[entry.col];
            if entry.row != entry.col {
                out[entry.col] += entry.val * x[entry.row];
            }
        }
        out
    }

    #[test]
    fn loads_on_few_unknowns_and_on_all_are_solved_for() {
        let a = stencil();
        let n = SIDE * SIDE;
        let symbolic = SymbolicFactor::new(a.symbolic(), n - 7, (0..n).collect(), None).expect("room");
        let factor = Factor::of_semidefinite(symbolic, a.as_ref(), Par::Seq).expect("a definite matrix");
        let dense: Vec<f64> = (0..n).map(|k| ((3 * k + 1) as f64).sin()).collect();
        for loaded in [vec![0], vec![n / 2, n / 2 + 5], vec![n - 1], vec![5, 40, 90, n - 3]] {
            let mut few = vec![0.0; n];
            loaded.iter().for_each(|&k| few[k] = 1.0 + k as f64);
            let both: Vec<f64> = few.iter().zip(&dense).map(|(f, d)| f + d).collect();
            // The one goes past what is not loaded, the others do not.
            let [forward, all, other] = [&few, &both, &dense].map(|b| factor.forward(b));
            for (i, f) in forward.iter().enumerate() {
                assert!((f - (all[i] - other[i])).abs() < 1e-12 * n as f64, "{loaded:?}: {i}");
            }
            for b in [few, both] {
                let left = times(&a, &factor.solve(&b));
                assert!(left.iter().zip(&b).all(|(left, b)| (left - b).abs() < 1e-12 * n as f64), "{loaded:?}");
            }
        }
    }
}
