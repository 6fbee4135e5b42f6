//! Contact for the price of one linear solve.
//!
//! The jumps on Γ_K come last in one sparse Cholesky factorisation. Their diagonal is shifted so that the matrix is
//! definite even where a body is held by contact alone; the trailing block of the factor then gives the Schur complement
//! S on Γ_K, S = L_JJ L_JJᵀ − shift, and a small dense problem the contact state. One back-substitution gives all other
//! moments. What rounding has cost is won back by refining on the stresses: the traction jumps of λ_h are taken as a
//! load, solved with the same factor, and the stress of that small correction is added.

use std::time::Instant;

use faer::Mat;
use faer::sparse::SparseColMat;

use super::factor::{Factor, SymbolicFactor};
use super::hybrid::{Motion, held_unknowns, ordering, parameters, residual, stresses};
use super::qp;
use super::system::System;
use super::{DualError, DualMethod, Found, Options, Phases};
use crate::problem::Problem;

/// The default method.
#[derive(Debug, Clone, Copy, Default)]
pub struct Condensed;

/// Refinement ends when a step no longer improves the residual by this factor …
const WORTHWHILE: f64 = 0.25;
/// … or after this many steps.
const MOST_REFINEMENTS: usize = 8;

impl DualMethod for Condensed {
    fn name(&self) -> &'static str {
        "condensed"
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        let mut seconds = Phases::default();
        let start = Instant::now();
        let system = System::new(problem, options);
        seconds.assemble = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let reduced = Reduced::new(problem, &system, motions, options)?;
        seconds.factor = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let schur = reduced.schur();
        let (_, c) = reduced.condense(&schur, &system.rhs);
        let warm = options.closed.as_deref().filter(|closed| closed.len() == system.jump_bound.len());
        let state = qp::solve(&schur.matrix, &c, &system.jump_bound, warm);
        seconds.contact = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let mut x = reduced.finish(&schur, &system.rhs, |_| Some(state.jumps.clone()))?;
        let mut s = parameters(problem, &system, &x, true);
        let mut r = reduced.free_residual(residual(problem, &system, &s), &state.closed);
        let mut worst = largest(&r);
        let mut refinements = 0;
        while refinements < MOST_REFINEMENTS && worst > 0.0 {
            let no_move = vec![0.0; state.closed.len()];
            let dx = reduced.finish(&schur, &r, |c| qp::with_closed(&schur.matrix, c, &no_move, &state.closed))?;
            let ds = parameters(problem, &system, &dx, false);
            let trial: Vec<f64> = s.iter().zip(&ds).map(|(a, b)| a + b).collect();
            let trial_r = reduced.free_residual(residual(problem, &system, &trial), &state.closed);
            let trial_worst = largest(&trial_r);
            refinements += 1;
            if trial_worst >= worst {
                break;
            }
            let enough = trial_worst > WORTHWHILE * worst;
            x.iter_mut().zip(&dx).for_each(|(a, b)| *a += b);
            (s, r, worst) = (trial, trial_r, trial_worst);
            if enough {
                break;
            }
        }
        let stress = stresses(problem, &system, &s);
        let moments = system.unknowns.moments(problem, &x);
        seconds.recover = start.elapsed().as_secs_f64();
        Ok(Found {
            stress,
            moments,
            closed: state.closed,
            unknowns: system.unknowns.count,
            iterations: state.steps,
            seconds,
            notes: Vec::new(),
        })
    }
}

fn largest(r: &[f64]) -> f64 {
    r.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// The factorised system with its jumps last.
struct Reduced {
    factor: Factor,
    held: Vec<usize>,
    first_jump: usize,
    shift: f64,
}

/// The Schur complement on Γ_K.
struct Schur {
    lower: Mat<f64>,
    matrix: Mat<f64>,
}

impl Reduced {
    fn new(problem: &Problem, system: &System, motions: &[Motion], options: &Options) -> Result<Self, DualError> {
        let first_jump = system.unknowns.first_jump;
        let held = held_unknowns(problem, system, motions);
        let symbolic = SymbolicFactor::new(system.matrix.symbolic(), first_jump, ordering(system)?)?;
        let (matrix, shift) = definite(system, &held);
        let factor = Factor::new(symbolic, matrix.as_ref(), options.par())?;
        Ok(Reduced { factor, held, first_jump, shift })
    }

    fn schur(&self) -> Schur {
        let lower = self.factor.trailing();
        let mut matrix = &lower * lower.transpose();
        for i in 0..matrix.nrows() {
            matrix[(i, i)] -= self.shift;
        }
        Schur { lower, matrix }
    }

    /// L⁻¹b, and the load c = b_J − K_J1 K_11⁻¹ b_1 on the jumps.
    fn condense(&self, schur: &Schur, b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut b = b.to_vec();
        for &d in &self.held {
            b[d] = 0.0;
        }
        let y = self.factor.forward(&b);
        let tail = Mat::from_fn(y.len() - self.first_jump, 1, |i, _| y[self.first_jump + i]);
        let c = &schur.lower * tail;
        (y, (0..c.nrows()).map(|i| c[(i, 0)]).collect())
    }

    /// Solves for all unknowns, with the jumps that `choose` makes of their load c.
    fn finish(
        &self,
        schur: &Schur,
        b: &[f64],
        choose: impl FnOnce(&[f64]) -> Option<Vec<f64>>,
    ) -> Result<Vec<f64>, DualError> {
        let (mut y, c) = self.condense(schur, b);
        let jumps = choose(&c).ok_or(DualError::ContactUndetermined)?;
        // L_JJᵀ j in place of the tail: back-substitution then reproduces j and solves for the rest.
        let j = Mat::from_fn(jumps.len(), 1, |i, _| jumps[i]);
        let tail = schur.lower.transpose() * j;
        for i in 0..jumps.len() {
            y[self.first_jump + i] = tail[(i, 0)];
        }
        let mut x = self.factor.backward(y);
        x[self.first_jump..].copy_from_slice(&jumps);
        Ok(x)
    }

    /// The residual where it should vanish: not on held unknowns, not on closed jumps.
    fn free_residual(&self, mut r: Vec<f64>, closed: &[bool]) -> Vec<f64> {
        for &d in &self.held {
            r[d] = 0.0;
        }
        for (value, &closed) in r[self.first_jump..].iter_mut().zip(closed) {
            if closed {
                *value = 0.0;
            }
        }
        r
    }
}

/// K with held unknowns taken out and the jump diagonal shifted.
fn definite(system: &System, held: &[usize]) -> (SparseColMat<usize, f64>, f64) {
    let mut matrix = system.matrix.clone();
    let (symbolic, values) = matrix.parts_mut();
    let columns = symbolic.col_ptr();
    let first_jump = system.unknowns.first_jump;
    let diagonal = |values: &[f64], j: usize| values[columns[j]];
    let shift = (first_jump..system.unknowns.count).map(|j| diagonal(values, j)).fold(0.0, f64::max);
    for j in first_jump..system.unknowns.count {
        values[columns[j]] += shift;
    }
    if !held.is_empty() {
        let mut is_held = vec![false; system.unknowns.count];
        for &d in held {
            is_held[d] = true;
        }
        system.isolate(&mut matrix, |d| is_held[d]);
    }
    (matrix, shift)
}
