//! The stress that balances a load within bounds on the contact.
//!
//! The one of least energy holds the jumps of closed contact; where s would fall below a given bound the jump is let go instead and
//! s takes the value of the bound: a bound-constrained problem in the Schur complement of the contact, solved by primal–dual
//! steps. What rounding has cost is won back on the stresses, as for λ_h, where it would show.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::sync::Arc;

use super::response::{Response, Responses};
use crate::dual::DualError;
use crate::dual::contact::states::{bounded, held, states};
use crate::dual::hybrid::{parameters, residual};
use crate::dual::refinement::{Refined, Refinement};
use crate::dual::system::System;
use crate::element::{SideValues, StressField};
use crate::problem::Problem;

/// Primal–dual steps at most; what does not settle by then is taken as it is, and costs width.
const MOST_STEPS: usize = 30;

/// Refinements on the stresses at most.
const MOST_REFINEMENTS: usize = 30;

/// Remainders of equilibrium, relative to the load, that cost an interval no digit that anybody reads: they are weighed and
/// widen it.
const ENOUGH: f64 = 1e-12;

/// Remainders of equilibrium, relative to the largest of load and traction, beyond which a stress balances something else.
const UNBALANCED: f64 = 1e-8;

/// Remainders below this part of the terms of Kx for the jumps that are held are rounding: of jumps without a stress there is nothing
/// else.
const NOISE: f64 = 1e-13;

/// A load, reduced to the contact.
pub struct Loaded<'a> {
    responses: &'a Responses<'a>,
    problem: Cow<'a, Problem>,
    system: System,
    start: Start,
    /// Solutions with all closed contact held.
    answers: Answers,
}

/// The common start of all stresses that balance a load.
pub(in crate::dual) struct Start {
    /// Mode parameters without any displacement.
    pub s: Vec<f64>,
    /// Their residual, condensed by [`Reduced::condense`](crate::dual::system::reduced::Reduced::condense).
    pub y: Vec<f64>,
    pub c: Vec<f64>,
    /// Jumps of closed contact.
    pub held: Vec<f64>,
    /// Nodal stresses of fields without traction, on triangles that have some.
    pub unloaded: Vec<(usize, Vec<[f64; 3]>)>,
}

/// Stress and moments.
type Fields = (Arc<StressField>, Arc<SideValues<[f64; 2]>>);

/// Unknowns of a response with what follows from them, once that was asked for.
struct Answered {
    now: Refined,
    fields: OnceCell<Fields>,
}

/// The stress of one state of the contact as the factor gives it and refined, once it was asked for.
#[derive(Default)]
struct Answers {
    begun: OnceCell<Answered>,
    refined: OnceCell<Answered>,
}

impl From<Refined> for Answered {
    fn from(now: Refined) -> Self {
        Answered { now, fields: OnceCell::new() }
    }
}

/// Which closed coefficients are at the floor, and the jumps of all.
type Released = (Vec<bool>, Vec<f64>);

/// Bounds on the normal traction s on Γ_K.
#[derive(Debug, Clone, Copy)]
pub struct Bounds<'a> {
    /// Coefficients of contact that are closed; s is zero at the others.
    pub closed: &'a [bool],
    /// `sign` · s is at least this at closed coefficients, not positive.
    pub floor: &'a [f64],
    /// 1 or −1.
    pub sign: f64,
}

impl Bounds<'_> {
    /// A traction, or the floor where it lies below.
    fn floored(&self, i: usize, s: f64) -> f64 {
        if self.sign * s < self.floor[i] { self.sign * self.floor[i] } else { s }
    }
}

/// State of the closed coefficients: those that are `released` have the traction of their floor, those that are `closed` their jump.
struct Holding<'a> {
    released: &'a [bool],
    closed: Vec<bool>,
    bounds: Bounds<'a>,
}

impl Holding<'_> {
    /// The traction that is given to a coefficient.
    fn set(&self, i: usize) -> f64 {
        if self.released[i] { self.bounds.sign * self.bounds.floor[i] } else { 0.0 }
    }
}

/// Remainder of the equilibrium of a stress.
struct Left {
    /// The coefficients of s.
    traction: Vec<f64>,
    /// As [`Response::remainder`].
    remainder: f64,
    /// The largest remainder, the largest of loads and tractions, and what is noise.
    largest: f64,
    scale: f64,
    noise: f64,
}

impl Left {
    fn is_balanced(&self) -> bool {
        self.largest.is_finite() && self.largest <= (UNBALANCED * self.scale).max(self.noise)
    }
}

impl<'a> Loaded<'a> {
    pub(in crate::dual) fn new(
        responses: &'a Responses<'a>,
        problem: Cow<'a, Problem>,
        system: System,
        start: Start,
    ) -> Self {
        Loaded { responses, problem, system, start, answers: Answers::default() }
    }

    /// The stress that balances the load where all of the `closed` coefficients hold, refined only where it would not balance it at
    /// all.
    ///
    /// # Errors
    /// As [`Self::respond`].
    pub fn held_by_all(&self, closed: &[bool]) -> Result<Response, DualError> {
        let floor = vec![f64::NEG_INFINITY; closed.len()];
        self.respond(Bounds { closed, floor: &floor, sign: 1.0 }, f64::INFINITY)
    }

    /// The stress of least energy that balances the load within `bounds`, refined where its remainder is more than `enough`.
    ///
    /// # Errors
    /// [`DualError::ContactUndetermined`] where the contact that is held leaves a body loose, [`DualError::NotConverged`]
    /// where what was found does not balance the load.
    pub fn respond(&self, bounds: Bounds<'_>, enough: f64) -> Result<Response, DualError> {
        let (released, jumps) = self.released(bounds)?;
        let closed = bounds.closed.iter().zip(&released).map(|(closed, let_go)| *closed && !let_go).collect();
        let held = Holding { released: &released, closed, bounds };
        let mut system = Cow::Borrowed(&self.system);
        let own = Answers::default();
        // Where nothing is let go the answer is the same for all floors.
        let answers = if released.contains(&true) {
            let first = system.unknowns.first_jump;
            system.to_mut().external[first..].iter_mut().enumerate().for_each(|(i, f)| *f += held.set(i));
            &own
        } else {
            &self.answers
        };
        let begun = answers.begun.get_or_init(|| self.begin(&system, &jumps).into());
        if let Some(response) = self.balanced(begun, &held, enough) {
            return Ok(response);
        }
        let refined = match answers.refined.get() {
            Some(refined) => refined,
            None => {
                let refined = self.refine(&system, &held.closed, begun.now.clone())?;
                answers.refined.get_or_init(|| refined.into())
            }
        };
        self.response(refined, &held)
    }

    /// The unknowns with these jumps and their stresses, as the factor gives them.
    fn begin(&self, system: &System, jumps: &[f64]) -> Refined {
        let x = self.responses.reduced().expand(self.start.y.clone(), jumps);
        let mut s = parameters(&self.problem, system, &x, false);
        s.iter_mut().zip(&self.start.s).for_each(|(s, start)| *s += start);
        let r = residual(&self.problem, system, &s);
        Refined { x, s, r, resistance: Vec::new() }
    }

    /// Wins back on the stresses what rounding has cost, with the jumps of `held` coefficients as they are.
    fn refine(&self, system: &System, held: &[bool], begun: Refined) -> Result<Refined, DualError> {
        let (reduced, contact) = (self.responses.reduced(), &self.responses.contact);
        let (no_move, states) = (bounded(&vec![0.0; held.len()]), states(held));
        let correction = |r: &[f64]| {
            let (y, c) = reduced.condense(r);
            let jumps = contact.in_states(&c, &no_move, &states).ok_or(DualError::ContactUndetermined)?;
            Ok(reduced.expand(y, &jumps))
        };
        let fixed = reduced.fixed(held);
        let refinement = Refinement {
            problem: &self.problem,
            system,
            fixed: &fixed,
            solve: &correction,
            enough: ENOUGH,
            most_steps: MOST_REFINEMENTS,
        };
        refinement.run(begun)
    }

    /// The stress of these unknowns, where it balances the load and leaves a remainder of no more than `enough`.
    fn balanced(&self, found: &Answered, held: &Holding<'_>, enough: f64) -> Option<Response> {
        let left = self.left(&found.now, held);
        (left.is_balanced() && left.remainder <= enough).then(|| self.stressed(found, left))
    }

    /// The stress of these unknowns.
    fn response(&self, found: &Answered, held: &Holding<'_>) -> Result<Response, DualError> {
        let left = self.left(&found.now, held);
        if left.is_balanced() {
            return Ok(self.stressed(found, left));
        }
        Err(DualError::NotConverged {
            method: "response to another load",
            iterations: MOST_REFINEMENTS,
            residual: left.largest / left.scale,
            wanted: UNBALANCED,
            advice: "nothing that is held balances the load, or triangles are too flat".to_string(),
        })
    }

    fn stressed(&self, Answered { now, fields }: &Answered, left: Left) -> Response {
        let Loaded { problem, system, .. } = self;
        let (stress, moments) = fields.get_or_init(|| {
            let mut stress = system.modes.stresses(problem, &now.s);
            for (t, own) in &self.start.unloaded {
                stress.block_mut(*t).iter_mut().zip(own).for_each(|(s, o)| (0..3).for_each(|c| s[c] += o[c]));
            }
            (Arc::new(stress), Arc::new(system.unknowns.moments_of_change(&now.x)))
        });
        Response {
            stress: Arc::clone(stress),
            moments: Arc::clone(moments),
            contact: SideValues::new(system.unknowns.jump_blocks().map(|b| b.len), left.traction),
            remainder: left.remainder,
        }
    }

    /// The remainder of equilibrium, from residuals.
    fn left(&self, now: &Refined, held: &Holding<'_>) -> Left {
        let Loaded { responses: Responses { displaced, .. }, system, .. } = self;
        let first = system.unknowns.first_jump;
        // Where a jump is held its residual is minus the traction; all others are remainders, those of motions that nothing
        // resists among them: a load that does work on these is balanced by nothing.
        let mut traction: Vec<f64> = (0..held.closed.len()).map(|i| held.set(i)).collect();
        let (mut remainder, mut largest) = (0.0, 0.0_f64);
        let loads = now.r[first..].iter().chain(&system.rhs).chain(&system.external).chain(&traction);
        let scale = loads.fold(0.0_f64, |m, v| m.max(v.abs()));
        for (i, r) in now.r.iter().enumerate() {
            let mut left = *r;
            let mut weight = displaced[i].abs();
            if i >= first && held.closed[i - first] {
                let kept = held.bounds.floored(i - first, -r);
                traction[i - first] = kept;
                left = -r - kept;
                weight += system.jump_bound[i - first].abs();
            }
            remainder += left.abs() * weight;
            largest = largest.max(left.abs());
        }
        Left { traction, remainder, largest, scale, noise: NOISE * system.size_of_terms(&self.start.held) }
    }

    /// Which closed coefficients are at the floor, and the jumps of all.
    fn released(&self, Bounds { closed, floor, sign }: Bounds<'_>) -> Result<Released, DualError> {
        let contact = &self.responses.contact;
        let mut released = vec![false; closed.len()];
        let mut latest = None;
        for _ in 0..MOST_STEPS {
            let load = |(i, c): (usize, &f64)| if released.get(i) == Some(&true) { c + sign * floor[i] } else { *c };
            let loaded: Vec<f64> = self.start.c.iter().enumerate().map(load).collect();
            let held: Vec<bool> = closed.iter().zip(&released).map(|(closed, let_go)| *closed && !let_go).collect();
            let Some(jumps) = contact.in_states(&loaded, &bounded(&self.start.held), &states(&held)) else { break };
            let traction = contact.gradient(&self.start.c, &jumps);
            let next: Vec<bool> = (0..closed.len())
                .map(|i| {
                    closed[i]
                        && if released[i] {
                            sign * (jumps[i] - self.start.held[i]) >= 0.0
                        } else {
                            sign * traction[i] < floor[i]
                        }
                })
                .collect();
            if next == released {
                return Ok((released, jumps));
            }
            latest = Some((std::mem::replace(&mut released, next), jumps));
        }
        let bounded = closed.iter().zip(floor).all(|(closed, floor)| !closed || floor.is_finite());
        if bounded && contact.is_direct() {
            return self.released_at_once(Bounds { closed, floor, sign });
        }
        latest.ok_or(DualError::ContactUndetermined)
    }

    /// [`Self::released`] where steps of many coefficients at a time do not end, as where contact alone holds a body: the same
    /// minimum, of ½ jᵀSj − (c + sign · floor)ᵀj under sign · (j − held) ≥ 0 where closed, as a contact problem.
    fn released_at_once(&self, bounds: Bounds<'_>) -> Result<Released, DualError> {
        let Bounds { closed, floor, sign } = bounds;
        let floored = |i: usize| if closed.get(i) == Some(&true) { floor[i] } else { 0.0 };
        let load: Vec<f64> = self.start.c.iter().enumerate().map(|(i, c)| -sign * c - floored(i)).collect();
        let bound = |i: usize| if closed[i] { -sign * self.start.held[i] } else { f64::INFINITY };
        let bound: Vec<f64> = (0..closed.len()).map(bound).collect();
        let state = self.responses.contact.solve(&load, &bounded(&bound), None)?;
        let released = closed.iter().zip(held(&state.states)).map(|(closed, held)| *closed && !held).collect();
        Ok((released, state.jumps.into_iter().map(|j| -sign * j).collect()))
    }
}
