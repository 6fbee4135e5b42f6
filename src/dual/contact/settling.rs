//! Refinement and contact state in turn.
//!
//! S is what elimination leaves of K, and where a body rests on a small part of its contact most digits of the softest
//! motion are gone: the state that S gives may be one that the refined stresses do not bear out. Their normal tractions
//! and jumps tell, and the same S with the remainder for a load gives the change of state: an error of S in the hundredth
//! part costs a step, and no accuracy.

use super::ends::Ends;
use super::schur::{ContactState, Schur};
use super::states::{bounded, held};
use crate::dual::DualError;
use crate::dual::equilibrium::{Equilibrium, load_scale};
use crate::dual::hybrid::parameters;
use crate::dual::refinement::{ROUND_OFF, Refined, Refinement};
use crate::dual::system::System;
use crate::dual::system::reduced::Reduced;
use crate::element::{SideValues, StressField};
use crate::optimise::State;
use crate::problem::{Problem, Scales};

/// Changes of the contact state at most.
const MOST_CHANGES: usize = 12;
/// Tension and penetration, relative as in [`Ends`], where the changes have come to an end: more is no contact state.
const UNSETTLED: f64 = 1e-8;

/// Part of what is allowed below which remainders on the unknowns need no measure on the stresses: the two differ by the shape of triangles.
const CLEAR: f64 = 1e-3;

/// A contact state to be settled, and the means to do it.
pub struct Settling<'a> {
    /// The scene.
    pub problem: &'a Problem,
    /// Its assembled form.
    pub system: &'a System,
    /// Its factor.
    pub reduced: &'a Reduced,
    /// The problem on Γ_K.
    pub contact: &'a Schur<'a>,
    /// The check of contact states.
    pub ends: Ends<'a>,
    /// Limit of refinements for one state.
    pub most_steps: usize,
}

impl Settling<'_> {
    /// Refines `now` until stresses and contact state agree.
    ///
    /// # Errors
    /// [`DualError::ContactUndetermined`], also where ends keep opening and closing, or what the contact problem returns.
    pub fn run(&self, mut now: Refined, state: &mut ContactState) -> Result<Refined, DualError> {
        now = self.refined(now, &state.states)?;
        for _ in 0..MOST_CHANGES {
            let next = self.ends.next(&now, &state.states, &self.misses(&now, &state.states));
            if next == state.states || self.most_steps == 0 {
                return Ok(now);
            }
            // The laws tell what resists the change.
            now = now.resisted(self.system, Vec::new());
            let room = self.system.laws_of_change(&now.x[self.system.unknowns.first_jump..]);
            let (y, c) = self.reduced.condense(&now.r);
            let change = self.contact.solve(&c, &room, Some(&next))?;
            let d = self.reduced.expand(y, &change.jumps);
            let ds = parameters(self.problem, self.system, &d, false);
            now.add(self.problem, self.system, 1.0, &d, &ds);
            state.steps += change.steps;
            state.states = change.states;
            now = self.refined(now, &state.states)?;
        }
        let left = self.misses(&now, &state.states).into_iter().fold(0.0, f64::max);
        if left <= UNSETTLED {
            return Ok(now);
        }
        Err(DualError::ContactUndetermined)
    }

    /// Refuses stresses that leave more of the loads than `allowed`, relative as in [`Equilibrium`].
    ///
    /// # Errors
    /// [`DualError::Factorisation`] where rounding had left nothing of a pivot, otherwise [`DualError::NotConverged`].
    pub fn accept(
        &self,
        now: &Refined,
        stress: &StressField,
        moments: &SideValues<[f64; 2]>,
        state: &ContactState,
        allowed: f64,
    ) -> Result<(), DualError> {
        let fixed = self.reduced.fixed(&held(&state.states));
        let (first, first_slide) = (self.system.unknowns.first_jump, self.system.unknowns.first_slide);
        let left = now.r.iter().zip(&fixed).enumerate().fold(0.0_f64, |m, (i, (r, fixed))| match (fixed, i >= first) {
            (false, _) => m.max(r.abs()),
            (true, true) if i >= first_slide => m.max(r.abs() - self.system.slide_bound[i - first_slide]),
            (true, true) => m.max(-r),
            (true, false) => m,
        });
        // The measure itself takes longer; where the remainders are very small against the load, it can only agree. A
        // sum notices what a maximum passes over: values that are not numbers.
        let numbers = now.r.iter().sum::<f64>().is_finite();
        if numbers && left <= CLEAR * allowed * load_scale(&Scales::new(self.problem), || stress.clone()) {
            return Ok(());
        }
        let residual = Equilibrium::measure(self.problem, stress, moments).residual();
        if numbers && residual <= allowed {
            return Ok(());
        }
        Err(self.reduced.breakdown(self.problem, self.system).unwrap_or(DualError::NotConverged {
            method: "refinement of the stresses",
            iterations: state.steps,
            residual,
            wanted: allowed,
            advice: "triangles are too flat, or a body rests on too small a part of its contact, for the digits that \
                     numbers have; refine the mesh there"
                .to_string(),
        }))
    }

    /// The least energy with the present contact state.
    fn refined(&self, now: Refined, states: &[State]) -> Result<Refined, DualError> {
        let now = now.resisted(self.system, self.system.resistance(states));
        let no_move = bounded(&vec![0.0; states.len()]);
        // What slides moves freely beside its resistance.
        let held = held(states);
        let free = super::states::states(&held);
        let correction = |r: &[f64]| {
            let (y, c) = self.reduced.condense(r);
            let jumps = self.contact.in_states(&c, &no_move, &free).ok_or(DualError::ContactUndetermined)?;
            Ok(self.reduced.expand(y, &jumps))
        };
        let refinement = Refinement {
            problem: self.problem,
            system: self.system,
            fixed: &self.reduced.fixed(&held),
            solve: &correction,
            enough: ROUND_OFF,
            most_steps: self.most_steps,
        };
        refinement.run(now)
    }

    /// By how much each end misses its state, penetration relative to the largest jump or gap.
    fn misses(&self, now: &Refined, states: &[State]) -> Vec<f64> {
        let jumps = &now.x[self.system.unknowns.first_jump..];
        self.ends.misses(now, states, &self.contact.allowed(jumps, &self.system.laws(), 1.0))
    }
}
