//! Primal–dual active set on the full matrix: one factorisation a step. Simple, and the yardstick for the others.

use std::time::Instant;

use faer::sparse::SparseColMat;

use super::factor::{Factor, SymbolicFactor};
use super::hybrid::{Motion, explain, held_unknowns, ordering, parameters, residual};
use super::system::{System, isolate};
use super::{DualError, DualMethod, Found, Options, Phases};
use crate::problem::Problem;

/// Active set with refactorisation, started from closed contact.
#[derive(Debug, Clone, Copy)]
pub struct ActiveSet {
    /// Limit of steps.
    pub most_steps: usize,
}

impl Default for ActiveSet {
    fn default() -> Self {
        ActiveSet { most_steps: 60 }
    }
}

impl DualMethod for ActiveSet {
    fn name(&self) -> &'static str {
        "active-set"
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        let mut seconds = Phases::default();
        let start = Instant::now();
        let system = System::new(problem, options);
        seconds.assemble = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let held = held_unknowns(problem, &system, motions);
        let first_jump = system.unknowns.first_jump;
        let broken = |breakdown| explain(problem, &system, breakdown);
        let symbolic = SymbolicFactor::new(system.matrix.symbolic(), first_jump, ordering(problem, &system));
        let symbolic = symbolic.map_err(broken)?;
        seconds.factor = start.elapsed().as_secs_f64();

        let mut closed = vec![true; system.jump_bound.len()];
        let mut symbolic = Some(symbolic);
        for step in 1..=self.most_steps {
            let start = Instant::now();
            let (matrix, fixed) = constrained(&system, &held, &closed);
            let structure = symbolic.take().ok_or(DualError::ContactUndetermined)?;
            let factor = Factor::new(structure, matrix.as_ref(), options.par()).map_err(broken)?;
            seconds.factor += start.elapsed().as_secs_f64();

            let start = Instant::now();
            let mut x: Vec<f64> = fixed.iter().map(|f| f.unwrap_or(0.0)).collect();
            let mut load = system.rhs.clone();
            for (value, k) in load.iter_mut().zip(system.multiply(&x)) {
                *value -= k;
            }
            clear(&mut load, &fixed);
            let dx = factor.solve(&load);
            x.iter_mut().zip(&dx).for_each(|(a, b)| *a += b);
            let mut s = parameters(problem, &system, &x, true);
            // One step of refinement on the stresses.
            let mut r = residual(problem, &system, &s);
            clear(&mut r, &fixed);
            let dx = factor.solve(&r);
            x.iter_mut().zip(&dx).for_each(|(a, b)| *a += b);
            s.iter_mut().zip(parameters(problem, &system, &dx, false)).for_each(|(a, b)| *a += b);
            let traction = residual(problem, &system, &s);
            let next: Vec<bool> = (0..closed.len())
                .map(|i| match closed[i] {
                    true => -traction[first_jump + i] <= 0.0,
                    false => x[first_jump + i] > system.jump_bound[i],
                })
                .collect();
            seconds.contact += start.elapsed().as_secs_f64();
            if next == closed {
                let start = Instant::now();
                let stress = system.modes.stresses(problem, &s);
                let moments = system.unknowns.moments(problem, &x);
                seconds.recover = start.elapsed().as_secs_f64();
                return Ok(Found {
                    stress,
                    moments,
                    closed,
                    unknowns: system.unknowns.count,
                    iterations: step,
                    seconds,
                    notes: Vec::new(),
                });
            }
            closed = next;
            symbolic = Some(factor.into_symbolic());
        }
        Err(DualError::NotConverged {
            method: self.name(),
            iterations: self.most_steps,
            residual: f64::NAN,
            wanted: 0.0,
            advice: "the active set cycles; use the condensed method".to_string(),
        })
    }
}

/// Zero where the unknown is given.
fn clear(values: &mut [f64], fixed: &[Option<f64>]) {
    for (value, fixed) in values.iter_mut().zip(fixed) {
        if fixed.is_some() {
            *value = 0.0;
        }
    }
}

/// K with the rows and columns of held unknowns and closed jumps taken out, and the values these have.
fn constrained(system: &System, held: &[usize], closed: &[bool]) -> (SparseColMat<usize, f64>, Vec<Option<f64>>) {
    let mut fixed = vec![None; system.unknowns.count];
    for &d in held {
        fixed[d] = Some(0.0);
    }
    for (i, &closed) in closed.iter().enumerate() {
        if closed {
            fixed[system.unknowns.first_jump + i] = Some(system.jump_bound[i]);
        }
    }
    let mut matrix = system.matrix.clone();
    isolate(&mut matrix, |d| fixed[d].is_some());
    (matrix, fixed)
}
