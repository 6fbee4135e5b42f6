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
use crate::vector::long::{axpy, dot, largest};

/// Traction jumps and their resultants that are no more than round-off against the loads.
pub const ROUND_OFF: f64 = 2e-14;
/// Refinement ends when they are as small as was asked for, or when they are as small as they must be at least, and have not become smaller for some steps …
const ENOUGH: f64 = 1e-11;
const PATIENCE: usize = 4;
/// … or for this many steps: where the factor is a poor one, residuals rise and fall on their way.
const MOST_PATIENCE: usize = 25;

/// From a residual to a correction of the unknowns.
pub type Correction<'a> = dyn Fn(&[f64]) -> Result<Vec<f64>, DualError> + 'a;

/// A system of equations and the means to refine its solution.
pub struct Refinement<'a> {
    /// The scene.
    pub problem: &'a Problem,
    /// Its assembled form.
    pub system: &'a System,
    /// Unknowns that stay as they are.
    pub fixed: &'a [bool],
    /// Approximate solution of Kd = r with the fixed unknowns at zero.
    pub solve: &'a Correction<'a>,
    /// Traction jumps, and their resultants, against the loads at which it ends.
    pub enough: f64,
    /// Limit of steps.
    pub most_steps: usize,
}

/// Moments, the mode parameters of their stresses, and what these leave of the loads.
#[derive(Debug, Clone)]
pub struct Refined {
    /// Unknowns of the hybrid form.
    pub x: Vec<f64>,
    /// Mode parameters, triangle by triangle.
    pub s: Vec<f64>,
    /// Residual of every unknown: on free ones a jump of traction, on jumps that are held minus the traction.
    pub r: Vec<f64>,
    /// Forces that resist the sliding of jumps, subtracted from their residuals; empty without friction.
    pub resistance: Vec<f64>,
}

impl Refined {
    /// The stresses of the unknowns `x`.
    pub fn new(problem: &Problem, system: &System, x: Vec<f64>) -> Self {
        let s = parameters(problem, system, &x, true);
        let r = residual(problem, system, &s);
        Refined { x, s, r, resistance: Vec::new() }
    }

    /// Adds this resistance to the sliding of jumps.
    pub fn resisted(mut self, system: &System, resistance: Vec<f64>) -> Self {
        let new = resistance.iter().chain(std::iter::repeat(&0.0));
        let old = self.resistance.iter().chain(std::iter::repeat(&0.0));
        let changes = new.zip(old).map(|(new, old)| new - old);
        self.r[system.unknowns.first_jump..].iter_mut().zip(changes).for_each(|(r, change)| *r -= change);
        self.resistance = resistance;
        self
    }

    /// Adds `step` times the correction `d`, with its stresses `ds`.
    pub fn add(&mut self, problem: &Problem, system: &System, step: f64, d: &[f64], ds: &[f64]) {
        axpy(&mut self.x, step, d);
        axpy(&mut self.s, step, ds);
        self.r = residual(problem, system, &self.s);
        let jumps = self.r[system.unknowns.first_jump..].iter_mut();
        jumps.zip(&self.resistance).for_each(|(r, resistance)| *r -= resistance);
    }
}

impl Refinement<'_> {
    /// Refines `now`.
    ///
    /// # Errors
    /// Those of `solve`.
    pub fn run(&self, mut now: Refined) -> Result<Refined, DualError> {
        let load = match largest(&self.system.external) {
            0.0 => largest(&self.system.rhs),
            load => load,
        };
        let size = |r: &[f64]| self.stray(r, load);
        let mut least = size(&now.r);
        // The best so far, where the present one is not.
        let mut best: Option<Refined> = None;
        let mut previous: Option<(Vec<f64>, Vec<f64>, f64)> = None;
        let mut stale = 0;
        for _ in 0..self.most_steps {
            let patience = if least <= ENOUGH { PATIENCE } else { MOST_PATIENCE };
            if least <= self.enough || stale >= patience {
                break;
            }
            // Fixed unknowns do not move: d is zero there, and so is their part of every product with r.
            let mut d = (self.solve)(&now.r)?;
            let product = dot(&d, &now.r);
            if let Some((last, r_last, product_last)) = &previous {
                let beta = (product - dot(&d, r_last)) / product_last;
                d.iter_mut().zip(last).for_each(|(d, last)| *d += beta * last);
            }
            let ds = parameters(self.problem, self.system, &d, false);
            let step = dot(&d, &now.r) / dot(&ds, &ds);
            if !step.is_finite() {
                break;
            }
            if best.is_none() {
                best = Some(now.clone());
            }
            let r = now.r.clone();
            now.add(self.problem, self.system, step, &d, &ds);
            let size = size(&now.r);
            if size < least {
                (least, stale, best) = (size, 0, None);
            } else {
                stale += 1;
            }
            previous = Some((d, r, product));
        }
        Ok(best.unwrap_or(now))
    }

    /// The largest residual where the unknowns are free, relative to the largest load, or the largest resultant of the
    /// residuals on a body, relative to the sum of the loads, if that is more: on slender bodies it is.
    fn stray(&self, r: &[f64], load: f64) -> f64 {
        let Refinement { problem, system, fixed, .. } = *self;
        let mut force = vec![[0.0; 2]; problem.scene.bodies.len()];
        let (mut largest, mut gross) = (0.0_f64, 0.0);
        for (e, edge) in problem.mesh.edges.iter().enumerate() {
            let Some(t) = edge.triangles[0] else { continue };
            let (length, _) = problem.mesh.edge_frame(e);
            let force = &mut force[problem.mesh.body[t]];
            let degree = system.unknowns.degree(e);
            let share = length / (degree + 1) as f64;
            for component in (0..=degree).flat_map(|k| system.unknowns.components(e, k)) {
                // A jump belongs to both sides, which balance it between them.
                for &(unknown, share_of) in component.own_terms() {
                    gross += share * system.external[unknown].abs();
                    if !fixed[unknown] {
                        largest = largest.max(r[unknown].abs());
                        let part = share * r[unknown] * share_of.clamp(-1.0, 1.0);
                        force[0] += part * component.direction[0];
                        force[1] += part * component.direction[1];
                    }
                }
            }
        }
        let first = system.unknowns.first_jump;
        let open = r[first..].iter().zip(&fixed[first..]).filter(|(_, fixed)| !**fixed);
        largest = open.fold(largest, |m, (r, _)| m.max(r.abs()));
        let resultant = force.iter().fold(0.0_f64, |m, f| m.max(f[0].hypot(f[1])));
        let over = |a: f64, b: f64| if a > 0.0 { a / b.max(f64::MIN_POSITIVE) } else { 0.0 };
        over(largest, load).max(if gross > 0.0 { over(resultant, gross) } else { 0.0 })
    }
}
