//! Contact for the price of one linear solve.
//!
//! The jumps on Γ_K come last in one sparse Cholesky factorisation. Their diagonal is shifted so that the matrix is
//! definite even where a body is held by contact alone; the trailing block of the factor then gives the Schur complement
//! S on Γ_K, S = L_JJ L_JJᵀ − shift, and a small dense problem the contact state. One back-substitution gives all other
//! moments. What rounding has cost is won back by refining on the stresses: the traction jumps of λ_h are taken as a
//! load, solved with the same factor, and the stress of that small correction is added. The contact state is held against
//! the refined stresses, and mended where it does not fit them.

use std::sync::Arc;
use std::time::Instant;

use crate::dual::contact::ends::Ends;
use crate::dual::contact::rigid::unsupported;
use crate::dual::contact::schur::{ContactState, Schur};
use crate::dual::contact::settling::Settling;
use crate::dual::contact::states::held;
use crate::dual::hybrid::Motion;
use crate::dual::refinement::Refined;
use crate::dual::system::reduced::Reduced;
use crate::dual::system::{Structured, System};
use crate::dual::{ActiveSet, DualError, DualMethod, Factorised, Found, Options, Phases, Size};
use crate::optimise::State;
use crate::problem::Problem;
use crate::process::stop_if_unwanted;

/// The default method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Condensed {
    /// Limit of refinements on the stresses. It ends earlier where round-off is reached; none leaves the stresses as the
    /// first solve gives them, accurate or not.
    pub most_refinements: usize,
    /// Longest contact, in jumps (two for each pair), whose Schur complement is formed as a dense matrix, where there is
    /// memory for it. Longer ones are solved iteratively, with the factor as it is stored.
    pub longest_dense: usize,
}

impl Default for Condensed {
    fn default() -> Self {
        Condensed { most_refinements: 200, longest_dense: 6000 }
    }
}

impl DualMethod for Condensed {
    fn name(&self) -> &'static str {
        "condensed"
    }

    fn memory(&self, size: Size) -> f64 {
        size.factorised(self.longest_dense)
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        match self.condense(problem, motions, options) {
            // Where the open part of a contact leaves a body without hold, the Schur complement does not tell the state, or one
            // factor for all states does not reach round-off. The active set bears that, at the price of a factorisation in
            // each step.
            Err(Unsettled {
                error: first @ (DualError::ContactUndetermined | DualError::NotConverged { .. }),
                states,
            }) => {
                let why = match first {
                    DualError::ContactUndetermined => "the Schur complement on the contact did not determine its state",
                    _ => "refinement with the factor of all contact states left more than round-off",
                };
                let rescue = |from| ActiveSet::default().rescue(problem, motions, options, from);
                // What was reached may be a state that its own stresses bear out and that leaves too much of equilibrium.
                let from_there = states.map(|states| rescue(Some(states)));
                match from_there.filter(Result::is_ok).unwrap_or_else(|| rescue(None)) {
                    Ok(mut found) => {
                        found.notes.push(format!("{why}; contact was found by active sets"));
                        Ok(found)
                    }
                    Err(_) if matches!(first, DualError::NotConverged { .. }) => Err(first),
                    Err(other) => Err(other),
                }
            }
            other => other.map_err(|unsettled| unsettled.error),
        }
    }
}

/// Why no answer came of it, and the contact state that it came to.
struct Unsettled {
    error: DualError,
    states: Option<Vec<State>>,
}

impl From<DualError> for Unsettled {
    fn from(error: DualError) -> Self {
        Unsettled { error, states: None }
    }
}

impl Condensed {
    fn condense(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, Unsettled> {
        let mut seconds = Phases::default();
        let start = Instant::now();
        let Structured { mut system, structure, seconds_of_structure } = System::structured(problem, options);
        seconds.assemble = (start.elapsed().as_secs_f64() - seconds_of_structure).max(0.0);

        stop_if_unwanted();
        let start = Instant::now();
        let reduced = Reduced::new(problem, &mut system, structure?, motions, options)?;
        seconds.factor = seconds_of_structure + start.elapsed().as_secs_f64();

        stop_if_unwanted();
        let start = Instant::now();
        let contact = Schur::new(&system, &reduced, self.longest_dense, options.budget, |most| {
            unsupported(problem, &system.unknowns, most)
        });
        let (y, c) = reduced.condense(&system.rhs);
        let warm = options.closed.as_ref().and_then(|closed| system.states_from(closed.values()));
        let mut state = contact.solve(&c, &system.laws(), warm.as_deref())?;
        seconds.contact = start.elapsed().as_secs_f64();

        stop_if_unwanted();
        let start = Instant::now();
        let x = reduced.expand(y, &state.jumps);
        let traction = contact.gradient(&c, &state.jumps);
        reduced.check(&system, &x, &traction)?;
        let settling = Settling {
            problem,
            system: &system,
            reduced: &reduced,
            contact: &contact,
            ends: Ends::new(problem, &system),
            most_steps: self.most_refinements,
        };
        let now = Refined::new(problem, &system, x);
        let reached = |error, state: &ContactState| Unsettled { error, states: Some(state.states.clone()) };
        let now = settling.run(now, &mut state).map_err(|error| reached(error, &state))?;
        let stress = system.modes.stresses(problem, &now.s);
        let moments = system.unknowns.moments(&now.x);
        if self.most_refinements > 0 {
            let accepted = settling.accept(&now, &stress, &moments, &state, self.accuracy());
            accepted.map_err(|error| reached(error, &state))?;
        }
        seconds.recover = start.elapsed().as_secs_f64();
        let (notes, unknowns) = (contact.notes(state.steps), system.unknowns.count);
        let closed = system.unknowns.by_pair(held(&state.states));
        drop(contact);
        Ok(Found {
            stress,
            moments,
            closed,
            unknowns,
            iterations: state.steps,
            seconds,
            notes,
            factorised: options.keep_factor.then(|| Arc::new(Factorised::of(system, reduced))),
            divided: None,
        })
    }
}
