//! The law of each jump on Γ_K, and the states that jumps are in.
//!
//! Along n̂ a jump is at most ∫ g B_k: closed there, open below. Along t̂ friction holds it where the coefficient of the traction is below
//! that of its bound, and gives it a traction against the sliding where it slides.

use crate::dual::system::System;
use crate::optimise::{Law, State};

impl System {
    /// The law of each jump.
    pub fn laws(&self) -> Vec<Law> {
        self.laws_of_change(&vec![0.0; self.jumps()])
    }

    /// The law of the change of each jump from `jumps`.
    pub fn laws_of_change(&self, jumps: &[f64]) -> Vec<Law> {
        let (normal, tangential) = jumps.split_at(self.jump_bound.len());
        let along = self.jump_bound.iter().zip(normal).map(|(bound, jump)| Law::AtMost { bound: bound - jump });
        let across = self.slide_bound.iter().zip(tangential).map(|(threshold, jump)| match *threshold {
            0.0 => Law::Free,
            threshold => Law::Friction { threshold, centre: 0.0 - jump },
        });
        along.chain(across).collect()
    }

    /// Number of jumps, along n̂ and t̂.
    pub fn jumps(&self) -> usize {
        self.jump_bound.len() + self.slide_bound.len()
    }

    /// The residual of each jump in equilibrium where nothing holds it: what resists its sliding. Zero where it is held.
    pub fn resistance(&self, states: &[State]) -> Vec<f64> {
        let normal = self.jump_bound.len();
        let of = |(i, state): (usize, &State)| match state {
            State::Above if i >= normal => self.slide_bound[i - normal],
            State::Below if i >= normal => 0.0 - self.slide_bound[i - normal],
            _ => 0.0,
        };
        states.iter().enumerate().map(of).collect()
    }

    /// States from closed jumps along n̂, as far as they are known; jumps along t̂ are held.
    pub fn states_from(&self, closed: &[bool]) -> Option<Vec<State>> {
        if closed.len() != self.jump_bound.len() {
            return None;
        }
        let across = self.slide_bound.iter().map(|threshold| if *threshold > 0.0 { State::Held } else { State::Below });
        Some(states(closed).into_iter().chain(across).collect())
    }
}

/// Bounds of jumps as laws.
pub fn bounded(bounds: &[f64]) -> Vec<Law> {
    bounds.iter().map(|bound| Law::AtMost { bound: *bound }).collect()
}

/// The states of jumps that are held or not.
pub fn states(held: &[bool]) -> Vec<State> {
    held.iter().map(|held| if *held { State::Held } else { State::Below }).collect()
}

/// Which jumps are held.
pub fn held(states: &[State]) -> Vec<bool> {
    states.iter().map(|state| *state == State::Held).collect()
}
