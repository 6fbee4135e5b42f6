//! The contact problem on Γ_K alone: min ½ jᵀSj − cᵀj over jumps j ≤ g, with the dense Schur complement S.
//!
//! Primal–dual active sets (block principal pivoting), started from closed contact. Where the blocks come back to a
//! state they have been in, or meet an open set that leaves a body without hold, a primal active-set method in the
//! manner of Lawson and Hanson finishes: it changes one end at a time, the energy falls with every step, and no state
//! can come twice.
//!
//! What round-off is depends on the size of the terms of S j − c, not on that of their sum: a body that rests on a point
//! turns and shifts by much, and its contact forces are small differences. Ends are compared with each other, so S is
//! best given in units in which its diagonal is about one: what it gives are then forces and not tractions.

use std::collections::HashSet;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use super::DualError;
use crate::vector::long::largest;

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
const BLOCK_STEPS: usize = 200;
/// Tension and penetration below this fraction of the largest force and jump are round-off: an end that grazes keeps its
/// state.
pub const GRAZING: f64 = 1e-13;
/// What is added to the diagonal of S, relative to each entry, where the open part has free motions: the least that leaves
/// all pivots positive.
const REGULAR: [f64; 3] = [1e-13, 1e-11, 1e-9];

/// Solves the bound-constrained problem; `start` gives a first guess of the closed ends (all that have a bound, where there is
/// none). Infinite bounds are none.
///
/// # Errors
/// [`DualError::ContactUndetermined`] where the energy has no minimum, [`DualError::NotConverged`] where round-off keeps
/// the state from settling.
pub fn solve(s: &Mat<f64>, c: &[f64], bound: &[f64], start: Option<&[bool]>) -> Result<ContactState, DualError> {
    let mut closed = start.map_or_else(|| bound.iter().map(|g| g.is_finite()).collect(), <[bool]>::to_vec);
    let mut seen = HashSet::new();
    while seen.len() < BLOCK_STEPS && seen.insert(closed.clone()) {
        let Some(jumps) = with_closed_or_springs(s, c, bound, &closed) else { break };
        let slack = slack(s, c, &jumps, &closed);
        let next = next_state(&gradient(s, c, &jumps), &jumps, bound, &slack, &closed);
        if next == closed {
            return Ok(ContactState { jumps, closed, steps: seen.len() });
        }
        closed = next;
    }
    let last = with_closed(s, c, bound, &closed);
    let state = one_by_one(s, c, bound, last.as_deref())?;
    Ok(ContactState { steps: seen.len() + state.steps, ..state })
}

/// The primal–dual step: closed ends under more tension than their `slack` open, open ends that penetrate close.
pub fn next_state(tension: &[f64], jumps: &[f64], bound: &[f64], slack: &[f64], closed: &[bool]) -> Vec<bool> {
    let depth = GRAZING * largest(jumps).max(largest_finite(bound));
    let end = |i: usize| if closed[i] { tension[i] <= slack[i] } else { jumps[i] > bound[i] + depth };
    (0..tension.len()).map(end).collect()
}

/// Tension that is round-off, end by end: of the terms Σ |S_ik j_k| + |c_i| at the end itself, and of those at the open
/// ends, whose balance the closed ones make good.
fn slack(s: &Mat<f64>, c: &[f64], jumps: &[f64], closed: &[bool]) -> Vec<f64> {
    let mut terms: Vec<f64> = c.iter().map(|c| c.abs()).collect();
    for (k, jump) in jumps.iter().enumerate().filter(|(_, jump)| **jump != 0.0) {
        for (sum, entry) in terms.iter_mut().zip(s.col(k).iter()) {
            *sum += (entry * jump).abs();
        }
    }
    let open = terms.iter().zip(closed).filter(|(_, closed)| !**closed).fold(0.0_f64, |m, (t, _)| m.max(*t));
    terms.into_iter().map(|own| GRAZING * own.max(open)).collect()
}

/// The largest of the bounds that there are.
fn largest_finite(bounds: &[f64]) -> f64 {
    bounds.iter().filter(|g| g.is_finite()).fold(0.0, |m, g| m.max(g.abs()))
}

/// Normal tractions S j − c: the derivative of the energy with respect to the jumps.
pub fn gradient(s: &Mat<f64>, c: &[f64], j: &[f64]) -> Vec<f64> {
    let mut out: Vec<f64> = c.iter().map(|v| -v).collect();
    for (k, &jk) in j.iter().enumerate() {
        if jk != 0.0 {
            for (o, v) in out.iter_mut().zip(s.col(k).iter()) {
                *o += v * jk;
            }
        }
    }
    out
}

/// Jumps with the closed ones at their bound and the others in equilibrium; `None` where those are not determined.
pub fn with_closed(s: &Mat<f64>, c: &[f64], bound: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
    equilibrium(s, c, bound, closed, 0.0)
}

/// [`with_closed`], with open ends held by weak springs where nothing else holds them. The stress of the result is
/// right to the stiffness of the springs, and refinement takes that error away.
pub fn with_closed_or_springs(s: &Mat<f64>, c: &[f64], bound: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
    with_closed(s, c, bound, closed)
        .or_else(|| REGULAR.into_iter().find_map(|spring| equilibrium(s, c, bound, closed, spring)))
}

fn equilibrium(s: &Mat<f64>, c: &[f64], bound: &[f64], closed: &[bool], spring: f64) -> Option<Vec<f64>> {
    let open: Vec<usize> = (0..c.len()).filter(|&i| !closed[i]).collect();
    let mut jumps: Vec<f64> = (0..c.len()).map(|i| if closed[i] { bound[i] } else { 0.0 }).collect();
    if open.is_empty() {
        return Some(jumps);
    }
    let residual = gradient(s, c, &jumps);
    let entry = |i: usize, k: usize| s[(open[i], open[k])] * if i == k { 1.0 + spring } else { 1.0 };
    let block = Mat::from_fn(open.len(), open.len(), entry);
    let rhs = Mat::from_fn(open.len(), 1, |i, _| -residual[open[i]]);
    let x = block.llt(Side::Lower).ok()?.solve(&rhs);
    for (k, &i) in open.iter().enumerate() {
        jumps[i] = x[(k, 0)];
    }
    jumps.iter().all(|j| j.is_finite()).then_some(jumps)
}

/// Steps, beside two for each end, after which tension is judged more leniently, by a factor of ten each time: a state that
/// is nearly right can be held against the refined stresses …
const LENIENT_AFTER: usize = 40;
/// … up to this fraction.
const MOST_LENIENT: f64 = 1e-6;

/// Opens the end under the largest tension, one at a time, and closes again what would penetrate. `near` gives jumps
/// to start from, feasible or not.
pub fn one_by_one(s: &Mat<f64>, c: &[f64], bound: &[f64], near: Option<&[f64]>) -> Result<ContactState, DualError> {
    let m = c.len();
    let at_bound = || bound.iter().map(|g| if g.is_finite() { *g } else { 0.0 }).collect();
    let mut jumps: Vec<f64> = near.map_or_else(at_bound, |j| j.iter().zip(bound).map(|(j, g)| j.min(*g)).collect());
    let mut closed: Vec<bool> = jumps.iter().zip(bound).map(|(j, g)| j == g).collect();
    let most_steps = 20 * m + 400;
    let mut barred = vec![false; m];
    // The start is settled before the first end opens.
    let mut opening = None;
    let mut residual = 0.0;
    for steps in 1..=most_steps {
        let lenient = 10.0_f64.powi((steps / (2 * m + LENIENT_AFTER)) as i32).min(MOST_LENIENT / GRAZING);
        settle(s, c, bound, &mut jumps, &mut closed, opening, &mut barred)?;
        let tension = gradient(s, c, &jumps);
        let slack = slack(s, c, &jumps, &closed);
        let candidate = (0..m)
            .filter(|&i| closed[i] && !barred[i] && tension[i] > lenient * slack[i])
            .max_by(|&a, &b| tension[a].total_cmp(&tension[b]));
        let Some(next) = candidate else {
            return Ok(ContactState { jumps, closed, steps });
        };
        residual = GRAZING * tension[next] / slack[next];
        closed[next] = false;
        opening = Some(next);
    }
    Err(DualError::NotConverged {
        method: "active set",
        iterations: most_steps,
        residual,
        wanted: GRAZING,
        advice: "the contact state keeps changing within round-off; use another method".to_string(),
    })
}

/// Moves to the minimum over the open ends, and closes those that stop the way there.
fn settle(
    s: &Mat<f64>,
    c: &[f64],
    bound: &[f64],
    jumps: &mut [f64],
    closed: &mut [bool],
    opening: Option<usize>,
    barred: &mut [bool],
) -> Result<(), DualError> {
    loop {
        let target = with_closed_or_springs(s, c, bound, closed).ok_or(DualError::ContactUndetermined)?;
        let mut length = 1.0_f64;
        let mut blocking = None;
        for i in (0..jumps.len()).filter(|&i| !closed[i] && target[i] > bound[i]) {
            let ratio = (bound[i] - jumps[i]) / (target[i] - jumps[i]);
            if ratio < length {
                (length, blocking) = (ratio.max(0.0), Some(i));
            }
        }
        for (jump, target) in jumps.iter_mut().zip(&target) {
            *jump += length * (target - *jump);
        }
        let Some(i) = blocking else {
            barred.fill(false);
            return Ok(());
        };
        closed[i] = true;
        jumps[i] = bound[i];
        if Some(i) == opening {
            // Its tension was round-off.
            barred[i] = true;
        }
    }
}
