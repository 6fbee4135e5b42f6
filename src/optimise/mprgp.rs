//! MPRGP, modified proportioning with reduced gradient projections (Dostál & Schöberl 2005), for an A that is only applied.
//!
//! Conjugate gradients on the unknowns off their bound, a projected step where they run into it, and a step on those at their bound
//! alone where their tension dominates. It needs products with A and its diagonal, and knows bounds only.

use super::form::Quadratic;
use super::law::{Law, State};
use super::tolerance::TOLERANCES;
use super::{Program, Solution};
use crate::vector::long::{axpy, dot};

/// Projected gradient, relative to the load, at which the state is read.
const IDENTIFIED: f64 = 1e-9;
/// Proportioning: unknowns at their bound wait while their tension is below this times the reduced gradient of the others.
const PROPORTION: f64 = 1.0;

/// A in units that make its diagonal one.
struct Scaled<'a> {
    form: &'a dyn Quadratic,
    /// 1/√A_ii.
    scale: Vec<f64>,
}

impl<'a> Scaled<'a> {
    fn new(form: &'a dyn Quadratic) -> Self {
        Scaled { form, scale: (0..form.len()).map(|i| 1.0 / form.diagonal(i).sqrt()).collect() }
    }

    fn apply(&self, v: &[f64]) -> Vec<f64> {
        times(&self.scale, &self.form.apply(&times(&self.scale, v)))
    }

    /// An upper estimate of the largest eigenvalue, by a few power iterations.
    fn largest_eigenvalue(&self) -> f64 {
        let mut v: Vec<f64> = (0..self.scale.len()).map(|i| if i % 3 == 0 { 1.0 } else { -0.9 }).collect();
        let mut value = 1.0;
        for _ in 0..20 {
            let length = norm(&v);
            v.iter_mut().for_each(|v| *v /= length);
            v = self.apply(&v);
            value = norm(&v);
        }
        1.1 * value
    }
}

/// The minimum to [`IDENTIFIED`]; nothing where there is none, where it does not arrive, or where a law is no upper bound.
pub fn mprgp(program: &Program<'_>) -> Option<Solution> {
    let bound: Option<Vec<f64>> = program
        .laws
        .iter()
        .map(|law| if let Law::AtMost { bound } = law { Some(*bound).filter(|b| b.is_finite()) } else { None })
        .collect();
    let bound = bound?;
    let scaled = Scaled::new(program.form);
    // Distance y = (g − x)/D ≥ 0 from the bound: min ½ yᵀDADy − dᵀy with d = D(Ag − b).
    let d = times(&scaled.scale, &program.form.gradient(program.load, &bound));
    let (y, steps) = nonnegative(&scaled, &d)?;
    let states = y.iter().map(|&y| if y == 0.0 { State::Held } else { State::Below }).collect();
    let x = bound.iter().zip(times(&scaled.scale, &y)).map(|(g, y)| g - y).collect();
    Some(Solution { x, states, steps, settled: false })
}

/// y ≥ 0 that minimises ½ yᵀAy − dᵀy, and the number of iterations.
fn nonnegative(a: &Scaled<'_>, d: &[f64]) -> Option<(Vec<f64>, usize)> {
    let m = d.len();
    let step = 1.8 / a.largest_eigenvalue();
    let mut y = vec![0.0; m];
    let mut gradient: Vec<f64> = d.iter().map(|d| -d).collect();
    let mut p = free_gradient(&gradient, &y);
    let scale = norm(d);
    for iteration in 0..200 * m + 1000 {
        let free = free_gradient(&gradient, &y);
        let chopped: Vec<f64> =
            gradient.iter().zip(&y).map(|(g, y)| if *y == 0.0 { g.min(0.0) } else { 0.0 }).collect();
        let residual = dot(&free, &free) + dot(&chopped, &chopped);
        if residual.sqrt() <= IDENTIFIED * scale {
            return Some((y, iteration));
        }
        let reduced: f64 = free.iter().zip(&y).map(|(f, y)| f * f.min(y / step)).sum();
        if dot(&chopped, &chopped) > PROPORTION * PROPORTION * reduced {
            // Proportioning: let go of what is under tension at its bound.
            let q = a.apply(&chopped);
            let curvature = dot(&chopped, &q);
            let alpha = if curvature > 0.0 { dot(&gradient, &chopped) / curvature } else { step };
            axpy(&mut y, -alpha, &chopped);
            axpy(&mut gradient, -alpha, &q);
            p = free_gradient(&gradient, &y);
            continue;
        }
        let q = a.apply(&p);
        let curvature = dot(&p, &q);
        let feasible = y.iter().zip(&p).filter(|(_, p)| **p > 0.0).map(|(y, p)| y / p).fold(f64::INFINITY, f64::min);
        let alpha = if curvature > 0.0 { dot(&gradient, &p) / curvature } else { f64::INFINITY };
        if alpha <= feasible {
            if alpha.is_infinite() {
                return None;
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
            gradient = a.apply(&y);
            gradient.iter_mut().zip(d).for_each(|(g, d)| *g -= d);
            p = free_gradient(&gradient, &y);
        }
    }
    None
}

/// The solution of Ax = `load` on the unknowns that are not `held`, zero on these, by conjugate gradients.
pub fn conjugate_gradients(form: &dyn Quadratic, load: &[f64], held: &[bool]) -> Vec<f64> {
    let a = Scaled::new(form);
    let free = |mut v: Vec<f64>| {
        v.iter_mut().zip(held).filter(|(_, held)| **held).for_each(|(v, _)| *v = 0.0);
        v
    };
    let mut r = free(times(&a.scale, load));
    let enough = TOLERANCES.solved * norm(&r);
    let mut x = vec![0.0; load.len()];
    let mut p = r.clone();
    let mut rr = dot(&r, &r);
    let mut best = (rr, x.clone());
    for _ in 0..4 * load.len() + 100 {
        if rr.sqrt() <= enough {
            break;
        }
        let q = free(a.apply(&p));
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
    times(&a.scale, &best.1)
}

/// The gradient on unknowns off their bound, tolerating that y = 0 is the bound.
fn free_gradient(gradient: &[f64], y: &[f64]) -> Vec<f64> {
    gradient.iter().zip(y).map(|(g, y)| if *y > 0.0 { *g } else { 0.0 }).collect()
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
