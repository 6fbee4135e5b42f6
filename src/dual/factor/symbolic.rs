//! The ordering and the structure of a factor, and the memory that its values take.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Par, Side, Spec};
use rayon::prelude::*;

use super::Breakdown;
use crate::budget::{fallible, words};
use crate::dual::contact::interface::Interface;

/// Symbolic factorisation: the fill-reducing ordering and the structure of the factor.
#[derive(Debug)]
pub struct SymbolicFactor {
    /// `None` where there are no unknowns.
    pub(super) inner: Option<SymbolicCholesky<usize>>,
    pub(super) forward: Vec<usize>,
    pub(super) leading: usize,
    /// The unknowns from `leading` on, where they are more than the jumps.
    pub(super) interface: Option<Interface>,
}

impl SymbolicFactor {
    /// Analyses the lower triangle `pattern`; unknowns are eliminated as they are listed in `forward`, and those from place
    /// `leading` on are those of `interface`, or jumps.
    ///
    /// # Errors
    /// [`Breakdown::TooLarge`].
    pub fn new(
        pattern: SymbolicSparseColMatRef<'_, usize>,
        leading: usize,
        forward: Vec<usize>,
        interface: Option<Interface>,
    ) -> Result<Self, Breakdown> {
        let n = pattern.ncols();
        let mut inverse = vec![0; n];
        for (new, &old) in forward.iter().enumerate() {
            inverse[old] = new;
        }
        if n == 0 {
            return Ok(SymbolicFactor { inner: None, forward, leading, interface });
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
        .map_err(|e| Breakdown::TooLarge(e.to_string()))?;
        Ok(SymbolicFactor { inner: Some(inner), forward, leading, interface })
    }

    /// Numbers in the factor.
    pub fn numbers(&self) -> usize {
        self.inner.as_ref().map_or(0, SymbolicCholesky::len_val)
    }

    /// Bytes that a numeric factorisation takes.
    pub fn memory(&self, par: Par) -> f64 {
        let Some(inner) = &self.inner else { return 0.0 };
        let scratch = inner.factorize_numeric_llt_scratch::<f64>(par, Spec::default());
        size_of::<f64>() as f64 * inner.len_val() as f64 + scratch.unaligned_bytes_required() as f64
    }

    /// Values of the factor.
    ///
    /// # Errors
    /// [`Breakdown`].
    pub(super) fn factorise(&self, matrix: SparseColMatRef<'_, usize, f64>, par: Par) -> Result<Vec<f64>, Breakdown> {
        let Some(inner) = &self.inner else { return Ok(Vec::new()) };
        let refused = || Breakdown::TooLarge(format!("the system refuses the {} it takes", words(self.memory(par))));
        // Memory that is asked for and given back at once tells whether it is there; zeros then come from the system.
        fallible(|| Vec::<f64>::new().try_reserve_exact(inner.len_val())).map_err(|_| refused())?;
        let mut values = vec![0.0; inner.len_val()];
        touch(&mut values);
        let params = Spec::default();
        let scratch = inner.factorize_numeric_llt_scratch::<f64>(par, params);
        let mut memory = fallible(|| MemBuffer::try_new(scratch)).map_err(|_| refused())?;
        inner
            .factorize_numeric_llt(
                &mut values,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                par,
                MemStack::new(&mut memory),
                params,
            )
            .map_err(|LltError::NonPositivePivot { index }| {
                Breakdown::NotPositive(self.forward.get(index).copied().unwrap_or(0))
            })?;
        Ok(values)
    }
}

/// Numbers that a thread touches at a time.
const TOUCHED: usize = 1 << 16;

/// Has the pages of a large block made by all threads: each waits for the system as long as for the numbers that go there.
fn touch(values: &mut [f64]) {
    if rayon::current_num_threads() > 1 {
        values.par_chunks_mut(TOUCHED).for_each(|part| part.fill(0.0));
    }
}
