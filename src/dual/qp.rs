//! The contact problem on Γ_K alone: min ½ jᵀSj − cᵀj over jumps j ≤ g, with the dense Schur complement S.
//!
//! Primal–dual active sets (block principal pivoting), started from closed contact. Where the blocks come back to a
//! state they have been in, or meet an open set that leaves a body without hold, the proximal-point method goes on
//! (Rockafellar 1976): springs between the iterates hold every body, each subproblem is definite and solved by a few block
//! steps, and the springs become weaker from one to the next. Should the state that it finds not settle without springs, a
//! primal active-set method in the manner of Lawson and Hanson finishes: it changes one end at a time, the energy falls
//! with every step, and no state can come twice.
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

/// Steps of block pivoting before the proximal-point method takes over: many, as long as fewer ends change than ever before, but
/// few without that (Júdice & Pires 1994).
const BLOCK_STEPS: usize = 60;
const WITHOUT_GAIN: usize = 4;
/// Springs of the proximal-point method, relative to the diagonal of S: from one that lets no open set move far to one that
/// moves what is held by contact no more than round-off does.
const PROXIMAL: [f64; 8] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10];
/// Subproblems with the same spring.
const PROXIMAL_STEPS: usize = 4;
/// Block steps for one subproblem: it starts from the state of the one before.
const PROXIMAL_BLOCK_STEPS: usize = 12;
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
    let closed = start.map_or_else(|| bound.iter().map(|g| g.is_finite()).collect(), <[bool]>::to_vec);
    let plain = Proximal { s, c, bound, spring: 0.0, centre: &[] };
    let first = plain.block_pivoting(closed, BLOCK_STEPS);
    if first.settled {
        return Ok(first.state);
    }
    let held = proximal_points(s, c, bound);
    let second = plain.block_pivoting(held.closed, BLOCK_STEPS);
    let steps = first.state.steps + held.steps + second.state.steps;
    if second.settled {
        return Ok(ContactState { steps, ..second.state });
    }
    let state = one_by_one(s, c, bound, Some(&held.jumps))?;
    Ok(ContactState { steps: steps + state.steps, ..state })
}

/// The contact problem with springs of stiffness `spring` · S_ii between each jump and its value in `centre`; without
/// springs where `spring` is zero.
struct Proximal<'a> {
    s: &'a Mat<f64>,
    c: &'a [f64],
    bound: &'a [f64],
    spring: f64,
    centre: &'a [f64],
}

/// A state that block pivoting came to, and whether its last step changed nothing.
struct Pivoted {
    state: ContactState,
    settled: bool,
}

impl Proximal<'_> {
    /// Primal–dual steps from `closed`, until the state settles, comes back, comes no nearer, leaves a body without hold, or
    /// `most` are done.
    fn block_pivoting(&self, mut closed: Vec<bool>, most: usize) -> Pivoted {
        let mut seen = HashSet::new();
        let mut jumps = Vec::new();
        let (mut fewest, mut patience) = (usize::MAX, WITHOUT_GAIN);
        while seen.len() < most && patience > 0 && seen.insert(closed.clone()) {
            let Some(found) = self.with_closed(&closed) else { break };
            jumps = found;
            let slack = slack(self.s, self.c, &jumps, &closed);
            let next = next_state(&self.tension(&jumps), &jumps, self.bound, &slack, &closed);
            if next == closed {
                return Pivoted { state: ContactState { jumps, closed, steps: seen.len() }, settled: true };
            }
            let changes = next.iter().zip(&closed).filter(|(next, now)| next != now).count();
            (fewest, patience) = if changes < fewest { (changes, WITHOUT_GAIN) } else { (fewest, patience - 1) };
            closed = next;
        }
        Pivoted { state: ContactState { jumps, closed, steps: seen.len() }, settled: false }
    }

    fn with_closed(&self, closed: &[bool]) -> Option<Vec<f64>> {
        if self.spring == 0.0 {
            return with_closed_or_springs(self.s, self.c, self.bound, closed);
        }
        let pull = self.centre.iter().enumerate().map(|(i, centre)| self.spring * self.s[(i, i)] * centre);
        let load: Vec<f64> = self.c.iter().zip(pull).map(|(c, pull)| c + pull).collect();
        equilibrium(self.s, &load, self.bound, closed, self.spring)
    }

    fn tension(&self, jumps: &[f64]) -> Vec<f64> {
        let mut out = gradient(self.s, self.c, jumps);
        for (i, (centre, jump)) in self.centre.iter().zip(jumps).enumerate() {
            out[i] += self.spring * self.s[(i, i)] * (jump - centre);
        }
        out
    }
}

/// Where the proximal-point method arrives from closed contact.
fn proximal_points(s: &Mat<f64>, c: &[f64], bound: &[f64]) -> ContactState {
    let jumps = bound.iter().map(|g| if g.is_finite() { *g } else { 0.0 }).collect();
    let mut now = ContactState { jumps, closed: bound.iter().map(|g| g.is_finite()).collect(), steps: 0 };
    for spring in PROXIMAL {
        for _ in 0..PROXIMAL_STEPS {
            let problem = Proximal { s, c, bound, spring, centre: &now.jumps };
            let found = problem.block_pivoting(now.closed.clone(), PROXIMAL_BLOCK_STEPS).state;
            let steps = now.steps + found.steps;
            if found.jumps.is_empty() {
                return now;
            }
            let same = found.closed == now.closed;
            now = ContactState { steps, ..found };
            if same {
                break;
            }
        }
    }
    now
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
pub fn largest_finite(bounds: &[f64]) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ENDS: usize = 12;
    const RANK: usize = 7;

    proptest! {
        /// A solution is planted: jumps at or below their bound, tension where they are below it none, pressure at it. S is
        /// singular, so open sets leave bodies without hold; the minimum of the energy is unique all the same.
        #[test]
        fn the_planted_minimum_is_found(
            factor in proptest::collection::vec(-1.0..1.0f64, RANK * ENDS),
            planted in proptest::collection::vec((any::<bool>(), 0.01..1.0f64, 0.0..0.5f64), ENDS),
        ) {
            let b = Mat::from_fn(RANK, ENDS, |i, k| factor[i * ENDS + k]);
            let s = b.transpose() * &b;
            let bound: Vec<f64> = planted.iter().map(|(_, _, gap)| *gap).collect();
            let jumps: Vec<f64> =
                planted.iter().map(|(closed, size, gap)| if *closed { *gap } else { gap - size }).collect();
            let pressure = |i: usize| if planted[i].0 { planted[i].1 } else { 0.0 };
            let zero = vec![0.0; ENDS];
            let c: Vec<f64> = gradient(&s, &zero, &jumps).iter().enumerate().map(|(i, sj)| sj + pressure(i)).collect();
            let energy = |j: &[f64]| (0..ENDS).map(|i| 0.5 * j[i] * (gradient(&s, &zero, j)[i] - 2.0 * c[i])).sum::<f64>();

            // From closed contact, and from where the proximal-point method arrives, which need not be the minimum yet.
            let near = proximal_points(&s, &c, &bound);
            for start in [None, Some(near.closed.as_slice())] {
                let found = solve(&s, &c, &bound, start).unwrap();
                prop_assert!(found.jumps.iter().zip(&bound).all(|(j, g)| *j <= g + 1e-9));
                prop_assert!((energy(&found.jumps) - energy(&jumps)).abs() < 1e-7, "{} {}", energy(&found.jumps), energy(&jumps));
            }
        }
    }
}
