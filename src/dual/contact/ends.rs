//! Whether the coefficients of contact pairs are in the state that stresses and jumps ask for.

use std::ops::Range;

use crate::dual::equilibrium::load_scale;
use crate::dual::modes::ModeTable;
use crate::dual::refinement::Refined;
use crate::dual::system::System;
use crate::dual::system::unknowns::{UnknownBlock, Unknowns};
use crate::problem::{ContactPair, Problem, Scales};

/// Tension relative to the load, or to the largest pressure of its pair, and penetration relative to the largest jump,
/// that are round-off: a coefficient that grazes keeps its state.
pub const GRAZING: f64 = 1e-12;

/// What states are held against.
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
        let pair = system.unknowns.jump_blocks().flat_map(|b| std::iter::repeat_n(own(b), b.len)).collect();
        Ends { problem, system, scales, round_off, pair }
    }

    /// By how much each coefficient misses its state: tension of closed ones relative to the load, or to the largest pressure
    /// of the pair, and penetration of open ones relative to `whole`.
    pub fn misses(&self, now: &Refined, closed: &[bool], whole: &[f64]) -> Vec<f64> {
        let first = self.system.unknowns.first_jump;
        let load = load_scale(&self.scales, || self.system.modes.stresses(self.problem, &now.s));
        let traction = |i: usize| if closed[i] { -now.r[first + i] } else { 0.0 };
        let end = |i: usize| {
            let (over, of) = match closed[i] {
                true => {
                    (traction(i) - self.round_off[i], self.pair[i].clone().fold(load, |most, k| most.max(-traction(k))))
                }
                false => (now.x[first + i] - self.system.jump_bound[i], whole[i]),
            };
            if over > 0.0 { over / of.max(f64::MIN_POSITIVE) } else { 0.0 }
        };
        (0..closed.len()).map(end).collect()
    }
}

/// Tension at each jump that is rounding of prescribed displacements and gaps.
pub fn round_off(problem: &Problem, unknowns: &Unknowns, modes: &ModeTable, scales: &Scales) -> Vec<f64> {
    let of_pair = |(pair, block): (&ContactPair, &UnknownBlock)| {
        let triangles = pair.edges.iter().flatten().filter_map(|&e| problem.mesh.edges[e].triangles[0]);
        let rounding = |t: usize| scales.stress_round_off(problem, t, modes.degree(t));
        std::iter::repeat_n(triangles.map(rounding).fold(0.0, f64::max), block.len)
    };
    problem.pairs().zip(unknowns.jump_blocks()).flat_map(of_pair).collect()
}

/// The state that the stresses ask for: closed ends under tension open, open ends that penetrate close.
pub fn next_state(closed: &[bool], misses: &[f64]) -> Vec<bool> {
    closed.iter().zip(misses).map(|(closed, by)| *closed == (*by <= GRAZING)).collect()
}
