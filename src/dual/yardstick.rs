//! The baseline of the condensed method: faer's own factorisation of its matrix, with faer's own ordering.

use std::time::Instant;

use faer::Side;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky};

use super::hybrid::{Motion, held_unknowns};
use super::system::System;
use super::system::reduced::make_definite;
use super::{DualError, Options};
use crate::problem::Problem;

/// Seconds and size of one plain factorisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yardstick {
    /// Minimum-degree ordering and structure of the factor.
    pub symbolic: f64,
    /// Values of the factor.
    pub numeric: f64,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Number of entries of the factor.
    pub entries: usize,
}

/// Factorises the matrix of the condensed method as faer does when it is given nothing but the matrix; `ready` is called
/// once that is assembled.
///
/// # Errors
/// [`DualError::Factorisation`] where the matrix is not positive definite.
pub fn plain_factorisation(
    problem: &Problem,
    motions: &[Motion],
    options: &Options,
    ready: impl FnOnce(),
) -> Result<Yardstick, DualError> {
    let mut system = System::new(problem, options);
    let held = held_unknowns(problem, &system.unknowns, motions);
    make_definite(&mut system, &held);
    let failed = |reason: String| DualError::Factorisation { reason };
    ready();
    let start = Instant::now();
    let symbolic = factorize_symbolic_cholesky(
        system.matrix.symbolic(),
        Side::Lower,
        SymmetricOrdering::Amd,
        CholeskySymbolicParams::default(),
    )
    .map_err(|e| failed(e.to_string()))?;
    let after_symbolic = Instant::now();
    let mut values = vec![0.0; symbolic.len_val()];
    let par = options.par(symbolic.len_val());
    let mut memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(par, Default::default()));
    symbolic
        .factorize_numeric_llt(
            &mut values,
            (*system.matrix).as_ref(),
            Side::Lower,
            LltRegularization::default(),
            par,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .map_err(|e| failed(e.to_string()))?;
    Ok(Yardstick {
        symbolic: (after_symbolic - start).as_secs_f64(),
        numeric: after_symbolic.elapsed().as_secs_f64(),
        unknowns: system.unknowns.count,
        entries: symbolic.len_val(),
    })
}
