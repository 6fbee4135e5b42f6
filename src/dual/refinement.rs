//! Refinement on the stresses.
//!
//! Moments of a stiff body are those of its rigid motion but for a small rest, and only the rest gives stress: digits of
//! the stresses are lost that no better moments bring back. So the traction jumps r of the present stresses are taken as
//! a load, solved with the same factor, and the *stress* of that small correction is added. Directions are made
//! conjugate, dᵀKd' = 0 with dᵀKd = |Tᵀd|², and steps are those that minimise the energy: where the factor is good this
//! is plain refinement, and where it has lost a soft motion altogether (slender bodies) the iteration still converges.

use super::DualError;
use super::hybrid::{parameters, residual};
use super::system::System;
use crate::problem::Problem;

/// Refinement ends when the traction jumps are this small against the loads …
const ROUND_OFF: f64 = 2e-14;
/// … or when they have not become smaller for this many steps.
const PATIENCE: usize = 4;

/// From a residual to a correction of the unknowns.
pub type Correction<'a> = dyn Fn(&[f64]) -> Result<Vec<f64>, DualError> + 'a;

/// What is refined, and with what.
pub struct Refinement<'a> {
    /// The scene.
    pub problem: &'a Problem,
    /// Its assembled form.
    pub system: &'a System,
    /// Unknowns that stay as they are.
    pub fixed: &'a [bool],
    /// Approximate solution of Kd = r with the fixed unknowns at zero.
    pub solve: &'a Correction<'a>,
    /// Limit of steps.
    pub most_steps: usize,
}

/// Moments with the mode parameters of their stresses.
#[derive(Debug, Clone)]
pub struct Refined {
    /// Unknowns of the hybrid form.
    pub x: Vec<f64>,
    /// Mode parameters, triangle by triangle.
    pub s: Vec<f64>,
}

impl Refinement<'_> {
    /// Refines `x`.
    ///
    /// # Errors
    /// Those of `solve`.
    pub fn run(&self, x: Vec<f64>) -> Result<Refined, DualError> {
        let s = parameters(self.problem, self.system, &x, true);
        let mut now = Refined { x, s };
        let mut r = self.residual(&now.s);
        let load = match largest(&self.system.external) {
            0.0 => largest(&self.system.rhs),
            load => load,
        };
        let mut least = largest(&r);
        // The best so far, where the present one is not.
        let mut best: Option<Refined> = None;
        let mut previous: Option<(Vec<f64>, Vec<f64>, f64)> = None;
        let mut stale = 0;
        for _ in 0..self.most_steps {
            if least <= ROUND_OFF * load || stale == PATIENCE {
                break;
            }
            let mut d = (self.solve)(&r)?;
            let product = dot(&d, &r);
            if let Some((last, r_last, product_last)) = &previous {
                let beta = (product - dot(&d, r_last)) / product_last;
                d.iter_mut().zip(last).for_each(|(d, last)| *d += beta * last);
            }
            let ds = parameters(self.problem, self.system, &d, false);
            let step = dot(&d, &r) / dot(&ds, &ds);
            if !step.is_finite() {
                break;
            }
            if best.is_none() {
                best = Some(now.clone());
            }
            axpy(&mut now.x, step, &d);
            axpy(&mut now.s, step, &ds);
            let next = self.residual(&now.s);
            let size = largest(&next);
            if size < least {
                (least, stale, best) = (size, 0, None);
            } else {
                stale += 1;
            }
            previous = Some((d, std::mem::replace(&mut r, next), product));
        }
        Ok(best.unwrap_or(now))
    }

    /// What the stresses leave of equilibrium where the unknowns are free.
    fn residual(&self, s: &[f64]) -> Vec<f64> {
        let mut r = residual(self.problem, self.system, s);
        for (value, fixed) in r.iter_mut().zip(self.fixed) {
            if *fixed {
                *value = 0.0;
            }
        }
        r
    }
}

fn largest(r: &[f64]) -> f64 {
    r.iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn axpy(y: &mut [f64], a: f64, x: &[f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
}
