//! The contact problem on Γ_K where it is too long for a dense matrix: S is only applied to vectors.
//!
//! S j = L_JJ (L_JJᵀ j) − shift · j with the factor as it is stored. The state is found by MPRGP (modified proportioning
//! with reduced gradient projections; Dostál & Schöberl 2005): conjugate gradients on the open ends, a projected step
//! where they run into the bound, and a step on closed ends alone where their tension dominates. A few primal–dual
//! steps, each solved by conjugate gradients, then settle the ends that graze.

use super::DualError;
use super::factor::Factor;
use super::qp::{ContactState, GRAZING, next_state};
use crate::vector::long::{dot, largest};

/// S as an operator, scaled to a diagonal of ones.
pub struct LongContact<'a> {
    factor: &'a Factor,
    shift: &'a [f64],
    /// 1/√S_ii.
    scale: Vec<f64>,
}

/// Projected gradient, relative to the load, at which MPRGP hands over.
const IDENTIFIED: f64 = 1e-9;
/// Residual, relative to the load, of the conjugate gradients.
const SOLVED: f64 = 1e-13;
/// Proportioning: closed ends wait while their tension is below Γ times the reduced gradient of the open ones.
const PROPORTION: f64 = 1.0;
/// Primal–dual steps at most.
const POLISHING: usize = 20;

impl<'a> LongContact<'a> {
    /// The Schur complement at the end of `factor`, whose diagonal was raised by `shift`.
    pub fn new(factor: &'a Factor, shift: &'a [f64]) -> Self {
        let diagonal = factor.trailing_squares();
        let scale = diagonal.iter().zip(shift).map(|(d, s)| 1.0 / (d - s).max(1e-14 * s).sqrt()).collect();
        LongContact { factor, shift, scale }
    }

    /// S v.
    pub fn apply(&self, v: &[f64]) -> Vec<f64> {
        let mut out = self.factor.trailing_times(&self.factor.trailing_transpose_times(v));
        for ((o, v), shift) in out.iter_mut().zip(v).zip(self.shift) {
            *o -= shift * v;
        }
        out
    }

    /// D S D v with D the scaling.
    fn scaled(&self, v: &[f64]) -> Vec<f64> {
        times(&self.scale, &self.apply(&times(&self.scale, v)))
    }

    /// Jumps at most `bound` that minimise ½ jᵀSj − cᵀj.
    ///
    /// # Errors
    /// [`DualError::NotConverged`].
    pub fn solve(&self, c: &[f64], bound: &[f64], start: Option<&[bool]>) -> Result<ContactState, DualError> {
        let mut steps = 0;
        if let Some(closed) = start {
            let (state, settled) = self.polish(c, bound, closed.to_vec(), 3);
            if settled {
                return Ok(state);
            }
            steps = state.steps;
        }
        // Distance y = (g − j)/D ≥ 0 from the bound: min ½ yᵀDSDy − dᵀy with d = D(Sg − c).
        let d = times(&self.scale, &difference(&self.apply(bound), c));
        let (y, iterations) = self.mprgp(&d)?;
        let closed = y.iter().map(|&y| y == 0.0).collect();
        let (state, settled) = self.polish(c, bound, closed, POLISHING);
        steps += iterations + state.steps;
        if settled {
            return Ok(ContactState { steps, ..state });
        }
        Err(DualError::NotConverged {
            method: "contact iteration",
            iterations: steps,
            residual: f64::NAN,
            wanted: SOLVED,
            advice: "the contact state keeps changing; refine the mesh or raise the length of contact that is solved \
                     with a dense matrix"
                .to_string(),
        })
    }

    /// Primal–dual steps from `closed`; whether the state has settled.
    fn polish(&self, c: &[f64], bound: &[f64], mut closed: Vec<bool>, most: usize) -> (ContactState, bool) {
        let mut steps = 0;
        loop {
            steps += 1;
            let jumps = self.with_closed(c, bound, &closed);
            let tension = difference(&self.apply(&jumps), c);
            let slack = vec![GRAZING * largest(c).max(largest(&tension)); c.len()];
            let next = next_state(&tension, &jumps, bound, &slack, &closed);
            let settled = next == closed;
            if settled || steps == most {
                return (ContactState { jumps, closed, steps }, settled);
            }
            closed = next;
        }
    }

    /// Jumps with the closed ones at their bound and the others in equilibrium, by conjugate gradients.
    pub fn with_closed(&self, c: &[f64], bound: &[f64], closed: &[bool]) -> Vec<f64> {
        let at = |v: &[f64], open: bool| -> Vec<f64> {
            v.iter().zip(closed).map(|(v, &closed)| if closed == open { 0.0 } else { *v }).collect()
        };
        let mut jumps = at(bound, false);
        let load = at(&times(&self.scale, &difference(c, &self.apply(&jumps))), true);
        let enough = SOLVED * norm(&load);
        let mut x = vec![0.0; c.len()];
        let mut r = load;
        let mut p = r.clone();
        let mut rr = dot(&r, &r);
        let mut best = (rr, x.clone());
        for _ in 0..4 * c.len() + 100 {
            if rr.sqrt() <= enough {
                break;
            }
            let q = at(&self.scaled(&p), true);
            let curvature = dot(&p, &q);
            if curvature <= 0.0 {
                break;
            }
            let alpha = rr / curvature;
            axpy(&mut x, alpha, &p);
            axpy(&mut r, -alpha, &q);
            let next = dot(&r, &r);
            if next < best.0 {
                best = (next, x.clone());
            }
            let beta = next / rr;
            p.iter_mut().zip(&r).for_each(|(p, r)| *p = r + beta * *p);
            rr = next;
        }
        jumps.iter_mut().zip(times(&self.scale, &best.1)).for_each(|(j, x)| *j += x);
        jumps
    }

    /// y ≥ 0 that minimises ½ yᵀAy − dᵀy for A = DSD, and the number of iterations.
    fn mprgp(&self, d: &[f64]) -> Result<(Vec<f64>, usize), DualError> {
        let m = d.len();
        let step = 1.8 / self.largest_eigenvalue();
        let mut y = vec![0.0; m];
        let mut gradient: Vec<f64> = d.iter().map(|d| -d).collect();
        let mut p = free_gradient(&gradient, &y);
        let scale = norm(d);
        let most = 200 * m + 1000;
        let mut residual = 0.0;
        for iteration in 0..most {
            let free = free_gradient(&gradient, &y);
            let chopped: Vec<f64> =
                gradient.iter().zip(&y).map(|(g, y)| if *y == 0.0 { g.min(0.0) } else { 0.0 }).collect();
            residual = dot(&free, &free) + dot(&chopped, &chopped);
            if residual.sqrt() <= IDENTIFIED * scale {
                return Ok((y, iteration));
            }
            let reduced: f64 = free.iter().zip(&y).map(|(f, y)| f * f.min(y / step)).sum();
            if dot(&chopped, &chopped) > PROPORTION * PROPORTION * reduced {
                // Proportioning: let go of closed ends under tension.
                let q = self.scaled(&chopped);
                let curvature = dot(&chopped, &q);
                let alpha = if curvature > 0.0 { dot(&gradient, &chopped) / curvature } else { step };
                axpy(&mut y, -alpha, &chopped);
                axpy(&mut gradient, -alpha, &q);
                p = free_gradient(&gradient, &y);
                continue;
            }
            let q = self.scaled(&p);
            let curvature = dot(&p, &q);
            let feasible =
                y.iter().zip(&p).filter(|(_, p)| **p > 0.0).map(|(y, p)| y / p).fold(f64::INFINITY, f64::min);
            let alpha = if curvature > 0.0 { dot(&gradient, &p) / curvature } else { f64::INFINITY };
            if alpha <= feasible {
                if alpha.is_infinite() {
                    return Err(DualError::ContactUndetermined);
                }
                axpy(&mut y, -alpha, &p);
                axpy(&mut gradient, -alpha, &q);
                let free = free_gradient(&gradient, &y);
                let beta = dot(&free, &q) / curvature;
                p.iter_mut().zip(&free).for_each(|(p, f)| *p = f - beta * *p);
            } else {
                // Expansion: up to the bound, and a projected gradient step beyond.
                axpy(&mut y, -feasible, &p);
                axpy(&mut gradient, -feasible, &q);
                let free = free_gradient(&gradient, &y);
                y.iter_mut().zip(&free).for_each(|(y, f)| *y = (*y - step * f).max(0.0));
                gradient = difference(&self.scaled(&y), d);
                p = free_gradient(&gradient, &y);
            }
        }
        Err(DualError::NotConverged {
            method: "contact iteration",
            iterations: most,
            residual: residual.sqrt() / scale,
            wanted: IDENTIFIED,
            advice: "raise the length of contact that is solved with a dense matrix".to_string(),
        })
    }

    /// An upper estimate of the largest eigenvalue of DSD, by a few power iterations.
    fn largest_eigenvalue(&self) -> f64 {
        let mut v: Vec<f64> = (0..self.scale.len()).map(|i| if i % 3 == 0 { 1.0 } else { -0.9 }).collect();
        let mut value = 1.0;
        for _ in 0..20 {
            let length = norm(&v);
            v.iter_mut().for_each(|v| *v /= length);
            v = self.scaled(&v);
            value = norm(&v);
        }
        1.1 * value
    }
}

/// The gradient on ends off their bound, tolerating that y = 0 is the bound.
fn free_gradient(gradient: &[f64], y: &[f64]) -> Vec<f64> {
    gradient.iter().zip(y).map(|(g, y)| if *y > 0.0 { *g } else { 0.0 }).collect()
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn axpy(y: &mut [f64], a: f64, x: &[f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
}
