//! Sparse Cholesky with the jumps ordered last, so that the end of the factor holds the Schur complement on Γ_K.

use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, Par, Side, Spec};

use super::DualError;

/// Symbolic factorisation: the fill-reducing ordering and the structure of the factor.
#[derive(Debug)]
pub struct SymbolicFactor {
    inner: SymbolicCholesky<usize>,
    forward: Vec<usize>,
    leading: usize,
    /// Wall-clock seconds it took.
    pub seconds: f64,
}

impl SymbolicFactor {
    /// Analyses the lower triangle `pattern`; unknowns from `leading` on keep their order and come last.
    ///
    /// `order` is a fill-reducing ordering of the unknowns before `leading`.
    pub fn new(
        pattern: SymbolicSparseColMatRef<'_, usize>,
        leading: usize,
        order: Vec<usize>,
    ) -> Result<Self, DualError> {
        let start = Instant::now();
        let n = pattern.ncols();
        let mut forward = order;
        forward.extend(leading..n);
        let mut inverse = vec![0; n];
        for (new, &old) in forward.iter().enumerate() {
            inverse[old] = new;
        }
        let inner = factorize_symbolic_cholesky(
            pattern,
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n)),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|e| DualError::Factorisation { reason: format!("{e:?}") })?;
        Ok(SymbolicFactor { inner, forward, leading, seconds: start.elapsed().as_secs_f64() })
    }

    /// Number of entries of the factor, explicit zeros of its dense blocks included.
    pub fn entries(&self) -> usize {
        self.inner.len_val()
    }
}

/// Approximate minimum degree ordering of a graph given by its lower triangle.
pub fn minimum_degree(columns: &[usize], rows: &[usize]) -> Result<Vec<usize>, DualError> {
    let n = columns.len() - 1;
    let graph = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
    let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::new(amd::order_maybe_unsorted_scratch::<usize>(n, rows.len()));
    amd::order_maybe_unsorted(&mut forward, &mut inverse, graph, amd::Control::default(), MemStack::new(&mut memory))
        .map_err(|e| DualError::Factorisation { reason: format!("{e:?}") })?;
    Ok(forward)
}

/// Numeric factorisation P A Pᵀ = L Lᵀ.
#[derive(Debug)]
pub struct Factor {
    symbolic: SymbolicFactor,
    values: Vec<f64>,
    par: Par,
}

impl Factor {
    /// Factorises the matrix whose lower triangle is given.
    ///
    /// # Errors
    /// [`DualError::Factorisation`] where the matrix is not positive definite.
    pub fn new(symbolic: SymbolicFactor, matrix: SparseColMatRef<'_, usize, f64>, par: Par) -> Result<Self, DualError> {
        let mut values = vec![0.0; symbolic.inner.len_val()];
        let params = Spec::default();
        let mut memory = MemBuffer::new(symbolic.inner.factorize_numeric_llt_scratch::<f64>(par, params));
        symbolic
            .inner
            .factorize_numeric_llt(
                &mut values,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                par,
                MemStack::new(&mut memory),
                params,
            )
            .map_err(|e| DualError::Factorisation { reason: format!("{e:?}") })?;
        Ok(Factor { symbolic, values, par })
    }

    /// Gives the symbolic part back, for another matrix of the same structure.
    pub fn into_symbolic(self) -> SymbolicFactor {
        self.symbolic
    }

    fn supernodal(&self) -> SupernodalLltRef<'_, usize, f64> {
        match self.symbolic.inner.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => SupernodalLltRef::new(symbolic, &self.values),
            SymbolicCholeskyRaw::Simplicial(_) => unreachable!("the supernodal variant is forced"),
        }
    }

    /// y = L⁻¹ P b, in the order of the factor.
    pub fn forward(&self, b: &[f64]) -> Vec<f64> {
        let mut y: Vec<f64> = self.symbolic.forward.iter().map(|&old| b[old]).collect();
        let n = y.len();
        let mut memory = MemBuffer::new(self.symbolic.inner.solve_in_place_scratch::<f64>(1, self.par));
        self.supernodal().l_solve_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut y, n, 1),
            self.par,
            MemStack::new(&mut memory),
        );
        y
    }

    /// x = Pᵀ L⁻ᵀ y.
    pub fn backward(&self, mut y: Vec<f64>) -> Vec<f64> {
        let n = y.len();
        let mut memory = MemBuffer::new(self.symbolic.inner.solve_in_place_scratch::<f64>(1, self.par));
        self.supernodal().l_transpose_solve_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut y, n, 1),
            self.par,
            MemStack::new(&mut memory),
        );
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

    /// The trailing block L_JJ of the factor, where J are the unknowns ordered last.
    pub fn trailing(&self) -> Mat<f64> {
        let first = self.symbolic.leading;
        let n = self.symbolic.forward.len();
        let mut out = Mat::zeros(n - first, n - first);
        let factor = self.supernodal();
        for s in 0..factor.symbolic().n_supernodes() {
            let node = factor.supernode(s);
            let (start, size) = (node.start(), node.val().ncols());
            for column in first.max(start)..start + size {
                let values = node.val().col(column - start);
                for row in column..start + size {
                    out[(row - first, column - first)] = values[row - start];
                }
                for (k, &row) in node.pattern().iter().enumerate() {
                    out[(row - first, column - first)] = values[size + k];
                }
            }
        }
        out
    }
}
