//! Extrapolation of a sweep and of the step before it: conjugate gradients with a sweep as preconditioner.
//!
//! After a sweep from x to y the energy is minimised over y + a (y − x) + b p, where p is the whole step before. Slow
//! modes, of which a sweep takes a small part each time, go in one such step nearly as far as they would in dozens.

use nalgebra::{Matrix2, Vector2};

use super::share::Share;
use crate::bounds::upper::energy::model::Model;

/// Part of the slack that is left to a jump where a step is cut short: with all of it, rounding would decide whether the
/// next step is cut there again, and with none of it no step would go on where contact is closed.
const LEFT: f64 = 0.1;

/// The last step.
#[derive(Debug, Default)]
pub struct Momentum {
    step: Vec<[f64; 2]>,
}

impl Momentum {
    /// Moves `values`, the result of a sweep from `before`, and gives the energy gained. A jump that would grow beyond its gap by
    /// more than `slack` ends at it.
    pub fn push(
        &mut self,
        model: &Model,
        before: &[[f64; 2]],
        slack: f64,
        values: &mut [[f64; 2]],
        share: &dyn Share,
    ) -> f64 {
        // Near the minimum a sweep moves little but rounding, and a factor may be large: what supports hold stays out.
        let moved = values.iter().zip(before).map(|(v, b)| [v[0] - b[0], v[1] - b[1]]);
        let sweep: Vec<[f64; 2]> = moved.zip(&model.free).map(|(step, free)| free.along(step)).collect();
        if self.step.is_empty() {
            self.step = vec![[0.0; 2]; values.len()];
        }
        let (mut stiffness, mut force) = (Matrix2::<f64>::zeros(), Vector2::<f64>::zeros());
        let (mut u, mut residual) = (Vec::new(), Vec::new());
        let mut steps = [Vec::new(), Vec::new()];
        for (t, element) in model.energies.iter().filter(|(t, _)| share.has_triangle(*t)) {
            model.about_corner(t, values, &mut u);
            element.residual(&u, &mut residual);
            for (i, moves) in [&sweep, &self.step].into_iter().enumerate() {
                let along = model.nodes(t).iter().flat_map(|&node| moves[node]);
                force[i] += residual.iter().zip(along).map(|(f, step)| f * step).sum::<f64>();
                model.about_corner(t, moves, &mut steps[i]);
            }
            for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                stiffness[(i, j)] += element.form(&steps[i], &steps[j]);
            }
        }
        for bed in &model.beds {
            for (i, moves) in [&sweep, &self.step].into_iter().enumerate() {
                force[i] += bed.work(moves) - bed.form(values, moves);
            }
            for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                let moves = [&sweep, &self.step];
                stiffness[(i, j)] += bed.form(moves[i], moves[j]);
            }
        }
        let mut sums = [force[0], force[1], stiffness[(0, 0)], stiffness[(0, 1)], stiffness[(1, 1)]];
        share.sum(&mut sums);
        let [f, g, a, b, c] = sums;
        let (force, stiffness) = (Vector2::new(f, g), Matrix2::new(a, b, b, c));
        let best = factors(&stiffness, &force);
        let push = |(s, p): (&[f64; 2], &[f64; 2])| [0, 1].map(|c| best[0] * s[c] + best[1] * p[c]);
        let mut push: Vec<[f64; 2]> = sweep.iter().zip(&self.step).map(push).collect();
        let mut part = 1.0_f64;
        for (_, row) in model.rows.iter().enumerate().filter(|(row, _)| share.has_row(*row)) {
            let grows = row.terms().iter().map(|(k, f)| push[*k][0] * f[0] + push[*k][1] * f[1]).sum::<f64>();
            let room = (-row.excess(values)).max(0.0);
            if grows > room + slack {
                part = part.min((room + LEFT * slack) / grows);
            }
        }
        part = share.least(part);
        let gained = part * (force.dot(&best) - 0.5 * part * best.dot(&(stiffness * best)));
        if !(gained > 0.0 && gained.is_finite()) {
            part = 0.0;
        }
        for (((v, q), s), p) in values.iter_mut().zip(&mut push).zip(&sweep).zip(&mut self.step) {
            for c in 0..2 {
                v[c] += part * q[c];
                p[c] = s[c] + part * q[c];
            }
        }
        if part > 0.0 { gained } else { 0.0 }
    }
}

/// The minimum of ½xᵀKx − fᵀx over both directions, or over the first alone where they are as good as parallel.
///
/// Each direction is measured by its own energy, so that products of very small numbers do not vanish.
fn factors(k: &Matrix2<f64>, f: &Vector2<f64>) -> Vector2<f64> {
    const PARALLEL: f64 = 1e-10;
    let unit = [0, 1].map(|i| if k[(i, i)] > 0.0 { 1.0 / k[(i, i)].sqrt() } else { 0.0 });
    let cosine = k[(0, 1)] * unit[0] * unit[1];
    let force = [f[0] * unit[0], f[1] * unit[1]];
    let sine = 1.0 - cosine * cosine;
    if unit[1] == 0.0 || sine < PARALLEL {
        return Vector2::new(force[0] * unit[0], 0.0);
    }
    let best = [force[0] - cosine * force[1], force[1] - cosine * force[0]];
    Vector2::new(best[0] / sine * unit[0], best[1] / sine * unit[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_balance_the_forces_at_any_size() {
        for size in [1.0, 1e-200, 1e200] {
            let k = size * Matrix2::new(2.0, 0.3, 0.3, 0.5);
            let f = size * Vector2::new(1.0, -2.0);
            assert!((k * factors(&k, &f) - f).amax() < 1e-14 * size);
        }
        let parallel = factors(&Matrix2::new(1.0, 2.0, 2.0, 4.0), &Vector2::new(3.0, 6.0));
        assert_eq!(parallel, Vector2::new(3.0, 0.0));
        assert_eq!(factors(&Matrix2::zeros(), &Vector2::zeros()), Vector2::zeros());
    }
}
