//! Primal–dual active sets: a semismooth Newton method (Hintermüller, Ito & Kunisch 2002).
//!
//! In a state every unknown is at a kink of its law or on a smooth piece; the values of the latter solve a linear system, and
//! values and forces tell the next state. Where the system leaves motions free the step is taken from a point: the part of it
//! along such a motion is then zero, as it is in the proximal-point method with vanishing springs, and what is loose stays where
//! the point has it.

use std::collections::HashSet;

use super::law::{Law, State};
use super::tolerance::TOLERANCES;
use super::{Program, Solution};
use crate::vector::long::largest;

/// Steps without fewer changes than ever before after which the sets are given up (Júdice & Pires 1994).
const WITHOUT_GAIN: usize = 4;
/// Steps in which changes have to halve where every step is a factorisation as dear as one of the interior point, which needs thirty.
const HALVED_IN: usize = 4;
/// Solves with the factor of a matrix nearby: each wins back the digits that the other left.
const CORRECTIONS: usize = 3;

/// Steps from `states`, until these settle, come back, come no nearer or `most` are done. `about` is the point that loose motions
/// begin from; without one they begin from zero, and only where the system alone does not tell.
pub fn active_sets(
    program: &Program<'_>,
    mut states: Vec<State>,
    mut about: Option<Vec<f64>>,
    most: usize,
) -> Solution {
    let mut seen = HashSet::new();
    let mut x = about.clone().unwrap_or_default();
    let (mut fewest, mut patience) = (usize::MAX, WITHOUT_GAIN);
    let mut history = Vec::new();
    while seen.len() < most && patience > 0 && seen.insert(states.clone()) {
        let Some(found) = program.in_state(&states, about.as_deref()) else { break };
        x = found;
        let next = program.next_states(&states, &x);
        if next == states {
            let settled = program.is_balanced(&states, &x);
            return Solution { x, states, steps: seen.len(), settled };
        }
        let changes = next.iter().zip(&states).filter(|(next, now)| next != now).count();
        (fewest, patience) = if changes < fewest { (changes, WITHOUT_GAIN) } else { (fewest, patience - 1) };
        history.push(changes);
        let before = history.iter().nth_back(HALVED_IN);
        if program.form.is_loose() && before.is_some_and(|before| 2 * changes > *before) {
            break;
        }
        states = next;
        if let Some(point) = &mut about {
            point.clone_from(&x);
        }
    }
    Solution { x, states, steps: seen.len(), settled: false }
}

impl Program<'_> {
    /// The values that belong to `states`, as near to `about` as loose motions can be.
    pub fn in_state(&self, states: &[State], about: Option<&[f64]>) -> Option<Vec<f64>> {
        if about.is_none()
            && !self.form.is_loose()
            && let Some(x) = self.solved_in_state(states, None, 0.0)
        {
            return Some(x);
        }
        TOLERANCES.regular.into_iter().find_map(|part| self.solved_in_state(states, about, part))
    }

    /// The values of `states` with `regular` added to each diagonal entry, relative to it.
    pub fn solved_in_state(&self, states: &[State], about: Option<&[f64]>, regular: f64) -> Option<Vec<f64>> {
        let Program { form, load, laws } = *self;
        let kinks: Vec<Option<f64>> = laws.iter().zip(states).map(|(law, state)| law.kink(*state)).collect();
        let start = |(i, kink): (usize, &Option<f64>)| kink.unwrap_or_else(|| about.map_or(0.0, |about| about[i]));
        let mut x: Vec<f64> = kinks.iter().enumerate().map(start).collect();
        let held: Vec<bool> = kinks.iter().map(Option::is_some).collect();
        if !held.contains(&false) {
            return Some(x);
        }
        let pieces: Vec<_> = laws.iter().zip(states).map(|(law, state)| law.piece(*state)).collect();
        let added = |(i, piece): (usize, &super::law::Piece)| piece.stiffness + regular * form.diagonal(i);
        let added: Vec<f64> = pieces.iter().enumerate().map(added).collect();
        let factor = form.factor(&added, &held)?;
        // One solve of the matrix itself; of one nearby as many as win digits back.
        for _ in 0..if about.is_some() || form.is_loose() { CORRECTIONS } else { 1 } {
            let mut left = form.gradient(load, &x);
            left.iter_mut().zip(&pieces).zip(&x).for_each(|((l, piece), x)| *l += piece.stiffness * x + piece.offset);
            left.iter_mut().for_each(|l| *l = -*l);
            let step = factor.solve(&left);
            x.iter_mut().zip(step).zip(&held).filter(|(_, held)| !**held).for_each(|((x, d), _)| *x += d);
        }
        x.iter().all(|x| x.is_finite()).then_some(x)
    }

    /// The primal–dual step from `states` with values `x`.
    pub fn next_states(&self, states: &[State], x: &[f64]) -> Vec<State> {
        let Program { form, load, laws } = *self;
        let tension = form.gradient(load, x);
        let slack = self.slack(states, x);
        let extent = laws.iter().fold(largest(x), |most, law| most.max(law.extent()));
        let depth = TOLERANCES.grazing * extent;
        let next = |i: usize| laws[i].next(states[i], x[i], -tension[i], slack[i], depth);
        (0..x.len()).map(next).collect()
    }

    /// True if, where unknowns move, the only load left over is the one that springs on loose motions hold: a load on such a motion has no
    /// minimum.
    fn is_balanced(&self, states: &[State], x: &[f64]) -> bool {
        let Program { form, load, laws } = *self;
        let tension = form.gradient(load, x);
        let (mut left, mut size) = (0.0_f64, largest(load));
        for (i, (law, state)) in laws.iter().zip(states).enumerate() {
            match law.kink(*state) {
                Some(_) => size = size.max(tension[i].abs()),
                None => {
                    let piece = law.piece(*state);
                    left = left.max((tension[i] + piece.stiffness * x[i] + piece.offset).abs());
                }
            }
        }
        left <= TOLERANCES.balanced * size
    }

    /// Force that is rounding, unknown by unknown: of the terms of the force itself, and of those at unknowns that move, whose
    /// balance the held ones make good.
    pub fn slack(&self, states: &[State], x: &[f64]) -> Vec<f64> {
        let Program { form, load, laws } = *self;
        let mut terms = form.terms(x);
        terms.iter_mut().zip(load).for_each(|(t, b)| *t += b.abs());
        let moves = |(law, state): (&Law, &State)| law.kink(*state).is_none();
        let moving = terms.iter().zip(laws.iter().zip(states).map(moves)).filter(|(_, moves)| *moves);
        let most = moving.fold(0.0_f64, |m, (t, _)| m.max(*t));
        terms.into_iter().map(|own| TOLERANCES.grazing * own.max(most)).collect()
    }
}
