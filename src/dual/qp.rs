//! The contact problem on Γ_K alone: min ½ jᵀSj − cᵀj over jumps j ≤ g, with the dense Schur complement S.
//!
//! Primal–dual active sets (block principal pivoting), started from closed contact. Where the blocks do not settle, the
//! method of Lawson and Hanson on g − j ≥ 0 finishes: it changes one end at a time and cannot cycle.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// The contact state.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactState {
    /// Jumps j.
    pub jumps: Vec<f64>,
    /// Which of them are at their bound: closed.
    pub closed: Vec<bool>,
    /// Steps taken.
    pub steps: usize,
}

/// Steps of block pivoting before the careful method takes over.
const BLOCK_STEPS: usize = 40;

/// Solves the bound-constrained problem; `start` gives a first guess of the closed ends (all, where there is none).
pub fn solve(s: &Mat<f64>, c: &[f64], bound: &[f64], start: Option<&[bool]>) -> ContactState {
    let m = c.len();
    let mut closed = start.map_or_else(|| vec![true; m], <[bool]>::to_vec);
    for step in 1..=BLOCK_STEPS {
        let Some(jumps) = with_closed(s, c, bound, &closed) else { break };
        let gradient = gradient(s, c, &jumps);
        let next: Vec<bool> =
            (0..m).map(|i| if closed[i] { gradient[i] <= 0.0 } else { jumps[i] > bound[i] }).collect();
        if next == closed {
            return ContactState { jumps, closed, steps: step };
        }
        closed = next;
    }
    one_by_one(s, c, bound)
}

/// Normal tractions S j − c: the derivative of the energy with respect to the jumps.
pub fn gradient(s: &Mat<f64>, c: &[f64], j: &[f64]) -> Vec<f64> {
    let m = c.len();
    let mut out: Vec<f64> = c.iter().map(|v| -v).collect();
    for (k, &jk) in j.iter().enumerate() {
        if jk != 0.0 {
            let column = s.col(k);
            for i in 0..m {
                out[i] += column[i] * jk;
            }
        }
    }
    out
}

/// Jumps with the closed ones at their bound and the others in equilibrium; `None` where those are not determined.
pub fn with_closed(s: &Mat<f64>, c: &[f64], bound: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
    let open: Vec<usize> = (0..c.len()).filter(|&i| !closed[i]).collect();
    let mut jumps: Vec<f64> = (0..c.len()).map(|i| if closed[i] { bound[i] } else { 0.0 }).collect();
    if open.is_empty() {
        return Some(jumps);
    }
    let residual = gradient(s, c, &jumps);
    let block = Mat::from_fn(open.len(), open.len(), |i, k| s[(open[i], open[k])]);
    let rhs = Mat::from_fn(open.len(), 1, |i, _| -residual[open[i]]);
    let factor = block.llt(Side::Lower).ok()?;
    let x = factor.solve(&rhs);
    for (k, &i) in open.iter().enumerate() {
        if !x[(k, 0)].is_finite() {
            return None;
        }
        jumps[i] = x[(k, 0)];
    }
    Some(jumps)
}

/// Lawson–Hanson: opens the end under the largest tension, one at a time, and closes again what would penetrate.
fn one_by_one(s: &Mat<f64>, c: &[f64], bound: &[f64]) -> ContactState {
    let m = c.len();
    let mut closed = vec![true; m];
    let mut jumps = bound.to_vec();
    let largest = (0..m).map(|i| s[(i, i)]).fold(0.0, f64::max);
    let scale = c.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    let mut regular = s.clone();
    for i in 0..m {
        // Only decides the path; the final state is solved with S itself wherever that is possible.
        regular[(i, i)] += 1e-13 * largest;
    }
    let mut steps = 0;
    let mut barred = vec![false; m];
    while steps < 10 * m + 100 {
        steps += 1;
        let tension = gradient(s, c, &jumps);
        let candidate = (0..m)
            .filter(|&i| closed[i] && !barred[i] && tension[i] > 1e-12 * scale)
            .max_by(|&a, &b| tension[a].total_cmp(&tension[b]));
        let Some(opening) = candidate else { break };
        closed[opening] = false;
        loop {
            let Some(target) = with_closed(&regular, c, bound, &closed) else {
                closed[opening] = true;
                barred[opening] = true;
                break;
            };
            let mut length = 1.0_f64;
            let mut blocking = None;
            for i in (0..m).filter(|&i| !closed[i] && target[i] > bound[i]) {
                let ratio = (bound[i] - jumps[i]) / (target[i] - jumps[i]);
                if ratio < length {
                    (length, blocking) = (ratio.max(0.0), Some(i));
                }
            }
            for i in 0..m {
                jumps[i] += length * (target[i] - jumps[i]);
            }
            match blocking {
                None => {
                    barred.fill(false);
                    break;
                }
                Some(i) => {
                    closed[i] = true;
                    jumps[i] = bound[i];
                    if i == opening {
                        barred[i] = true;
                    }
                }
            }
        }
    }
    if let Some(exact) = with_closed(s, c, bound, &closed) {
        jumps = exact;
    }
    ContactState { jumps, closed, steps: BLOCK_STEPS + steps }
}
