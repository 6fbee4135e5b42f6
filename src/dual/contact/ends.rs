//! Checks that the coefficients of contact pairs are in the state that stresses and jumps ask for.

use std::ops::Range;

use crate::dual::equilibrium::load_scale;
use crate::dual::modes::ModeTable;
use crate::dual::refinement::Refined;
use crate::dual::system::System;
use crate::dual::system::unknowns::{UnknownBlock, Unknowns};
use crate::optimise::State;
use crate::problem::{ContactPair, Problem, Scales};

/// Tension relative to the load, or to the largest pressure of its pair, and penetration relative to the largest jump,
/// that are round-off: a coefficient that grazes keeps its state.
pub const GRAZING: f64 = 1e-12;

/// The data that contact states are checked against.
pub struct Ends<'a> {
    problem: &'a Problem,
    system: &'a System,
    scales: Scales,
    /// Tension at each jump that is rounding of prescribed displacements and gaps.
    round_off: Vec<f64>,
    /// The jumps of the pair that each jump belongs to.
    pair: Vec<Range<usize>>,
}

impl<'a> Ends<'a> {
    pub fn new(problem: &'a Problem, system: &'a System) -> Self {
        let scales = Scales::new(problem);
        let round_off = round_off(problem, &system.unknowns, &system.modes, &scales);
        let first = system.unknowns.first_jump;
        let own = |b: &UnknownBlock| b.start - first..b.start + b.len - first;
        let blocks = system.unknowns.jump_blocks().chain(system.unknowns.slide_blocks());
        let pair = blocks.flat_map(|b| std::iter::repeat_n(own(b), b.len)).collect();
        Ends { problem, system, scales, round_off, pair }
    }

    /// By how much each coefficient misses its state: tension of closed ones, and what exceeds the bound of friction where it holds,
    /// relative to the load, or to the largest pressure of the pair; penetration of open ones and sliding with the friction relative
    /// to `whole`.
    pub fn misses(&self, now: &Refined, states: &[State], whole: &[f64]) -> Vec<f64> {
        let (first, slides) = (self.system.unknowns.first_jump, self.system.unknowns.normal_jumps());
        let load = load_scale(&self.scales, || self.system.modes.stresses(self.problem, &now.s));
        let held = |i: usize| states[i] == State::Held;
        let traction = |i: usize| if held(i) { -now.r[first + i] } else { 0.0 };
        let end = |i: usize| {
            let (over, of) = match (held(i), i.checked_sub(slides)) {
                (true, None) => {
                    (traction(i) - self.round_off[i], self.pair[i].clone().fold(load, |most, k| most.max(-traction(k))))
                }
                (false, None) => (now.x[first + i] - self.system.jump_bound[i], whole[i]),
                (true, Some(slide)) => {
                    let bound = self.system.slide_bound[slide];
                    (traction(i).abs() - bound - self.round_off[i], load.max(bound))
                }
                (false, Some(slide)) if self.system.slide_bound[slide] == 0.0 => (0.0, whole[i]),
                (false, Some(_)) => {
                    let sense = if states[i] == State::Above { -1.0 } else { 1.0 };
                    (sense * now.x[first + i], whole[i])
                }
            };
            if over > 0.0 { over / of.max(f64::MIN_POSITIVE) } else { 0.0 }
        };
        (0..states.len()).map(end).collect()
    }

    /// The states that the stresses ask for: closed ends under tension open, open ends that penetrate close; what friction cannot hold
    /// slides, and what would slide with the friction is held.
    pub fn next(&self, now: &Refined, states: &[State], misses: &[f64]) -> Vec<State> {
        let (first, slides) = (self.system.unknowns.first_jump, self.system.unknowns.normal_jumps());
        let next = |i: usize| match (misses[i] > GRAZING, states[i]) {
            (false, state) => state,
            (true, State::Held) if i >= slides && now.r[first + i] > 0.0 => State::Above,
            (true, State::Held) => State::Below,
            (true, _) => State::Held,
        };
        (0..states.len()).map(next).collect()
    }
}

/// Tension at each jump that is rounding of prescribed displacements and gaps.
pub fn round_off(problem: &Problem, unknowns: &Unknowns, modes: &ModeTable, scales: &Scales) -> Vec<f64> {
    let of_pair = |(pair, block): (&ContactPair, &UnknownBlock)| {
        let triangles = pair.edges.iter().flatten().filter_map(|&e| problem.mesh.edges[e].triangles[0]);
        let rounding = |t: usize| scales.stress_round_off(problem, t, modes.degree(t));
        std::iter::repeat_n(triangles.map(rounding).fold(0.0, f64::max), block.len)
    };
    let slides = problem.pairs().filter(|pair| pair.friction.is_some()).zip(unknowns.slide_blocks());
    problem.pairs().zip(unknowns.jump_blocks()).chain(slides).flat_map(of_pair).collect()
}
