//! Primal–dual active set on the full matrix: one factorisation a step. Simple, and the yardstick for the others.

use std::collections::HashSet;
use std::time::Instant;

use faer::sparse::SparseColMat;

use crate::dual::contact::ends::{Ends, GRAZING};
use crate::dual::contact::states::held as are_held;
use crate::dual::equilibrium::Equilibrium;
use crate::dual::factor::Factor;
use crate::dual::hybrid::{Motion, explain, held_unknowns};
use crate::dual::refinement::{ROUND_OFF, Refined, Refinement};
use crate::dual::system::{Structured, System, isolate};
use crate::dual::{DualError, DualMethod, Found, Options, Phases, Size};
use crate::optimise::{Law, State};
use crate::problem::Problem;
use crate::process::stop_if_unwanted;

/// Active set with refactorisation, started from closed contact.
#[derive(Debug, Clone, Copy)]
pub struct ActiveSet {
    /// Limit of steps, beside four for each end.
    pub most_steps: usize,
    /// Limit of refinements on the stresses in each step.
    pub most_refinements: usize,
}

/// Bytes of the sparse matrix for each triangle.
const MATRIX: f64 = 1500.0;

/// Steps for contact that another method did not settle: each is a factorisation.
const STEPS_OF_A_RESCUE: usize = 240;

impl Default for ActiveSet {
    fn default() -> Self {
        ActiveSet { most_steps: 60, most_refinements: 50 }
    }
}

impl DualMethod for ActiveSet {
    fn name(&self) -> &'static str {
        "active-set"
    }

    fn memory(&self, size: Size) -> f64 {
        // A second matrix of the system, with closed jumps taken out.
        size.factorised(0) + MATRIX * size.triangles
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        self.step_from(None, usize::MAX, problem, motions, options)
    }
}

impl ActiveSet {
    /// Solves where another method came to these `states` and no further, in a limited number of steps, none of which
    /// begins after the deadline of `options`.
    pub(in crate::dual) fn rescue(
        &self,
        problem: &Problem,
        motions: &[Motion],
        options: &Options,
        states: Option<Vec<State>>,
    ) -> Result<Found, DualError> {
        self.step_from(states, STEPS_OF_A_RESCUE, problem, motions, options)
    }

    fn step_from(
        &self,
        from: Option<Vec<State>>,
        most_steps: usize,
        problem: &Problem,
        motions: &[Motion],
        options: &Options,
    ) -> Result<Found, DualError> {
        let mut seconds = Phases::default();
        let start = Instant::now();
        let Structured { system, structure, seconds_of_structure } = System::structured(problem, options);
        seconds.assemble = (start.elapsed().as_secs_f64() - seconds_of_structure).max(0.0);

        let start = Instant::now();
        let held = held_unknowns(problem, &system.unknowns, motions);
        let first_jump = system.unknowns.first_jump;
        let broken = |breakdown| explain(problem, &system.unknowns, breakdown);
        let symbolic = structure?;
        seconds.factor = seconds_of_structure + start.elapsed().as_secs_f64();

        let laws = system.laws();
        let mut states = from.unwrap_or_else(|| laws.iter().map(|law| law.stiffest()).collect());
        let most_steps = most_steps.min(self.most_steps + 4 * states.len());
        let mut symbolic = Some(symbolic);
        let ends = Ends::new(problem, &system);
        let (mut seen, mut careful, mut from_closed) = (HashSet::new(), false, true);
        let (mut left, mut steps) = (f64::INFINITY, 0);
        let (mut nearest, mut is_back) = ((f64::INFINITY, Vec::new()), false);
        for step in 1..=most_steps {
            stop_if_unwanted();
            if step > 1 && options.deadline.is_some_and(|end| Instant::now() > end) {
                break;
            }
            steps = step;
            let start = Instant::now();
            let (matrix, fixed) = constrained(&system, &held, (&laws, &states));
            let structure = symbolic.take().ok_or(DualError::ContactUndetermined)?;
            let par = options.par(structure.numbers());
            let factor = Factor::of_semidefinite(structure, matrix.as_ref(), par).map_err(broken)?;
            seconds.factor += start.elapsed().as_secs_f64();

            let start = Instant::now();
            let mut x: Vec<f64> = fixed.iter().map(|f| f.unwrap_or(0.0)).collect();
            let mut load = system.rhs.clone();
            for (value, k) in load.iter_mut().zip(system.multiply(&x)) {
                *value -= k;
            }
            let resistance = system.resistance(&states);
            load[first_jump..].iter_mut().zip(&resistance).for_each(|(load, resistance)| *load -= resistance);
            clear(&mut load, &fixed);
            let dx = factor.solve(&load);
            x.iter_mut().zip(&dx).for_each(|(a, b)| *a += b);
            // Open contact may leave a body without hold; the factor is then that of a matrix nearby.
            let is_fixed: Vec<bool> = fixed.iter().map(Option::is_some).collect();
            let correction = |r: &[f64]| {
                let mut r = r.to_vec();
                clear(&mut r, &fixed);
                Ok(factor.solve(&r))
            };
            let refinement = Refinement {
                problem,
                system: &system,
                fixed: &is_fixed,
                solve: &correction,
                enough: ROUND_OFF,
                most_steps: self.most_refinements,
            };
            let now = refinement.run(Refined::new(problem, &system, x).resisted(&system, resistance))?;
            let bounds = system.jump_bound.iter().filter(|g| g.is_finite());
            let depth = now.x[first_jump..].iter().chain(bounds).fold(0.0_f64, |m, j| m.max(j.abs()));
            let misses = ends.misses(&now, &states, &vec![depth; states.len()]);
            let mut next = ends.next(&now, &states, &misses);
            left = misses.iter().fold(0.0, |m, by| by.max(m));
            if left < nearest.0 {
                nearest = (left, states.clone());
            }
            let mut round = false;
            if !seen.insert(states.clone()) {
                // One end at a time leads from a state to always the same next one.
                round = careful;
                careful = true;
                seen = HashSet::from([states.clone()]);
            }
            let at_rounding = careful && left <= self.accuracy();
            if round && !from_closed && !at_rounding {
                // No state is without misses. One whose misses are rounding is as good as any.
                if is_back || nearest.0 > self.accuracy() {
                    break;
                }
                is_back = true;
                states.clone_from(&nearest.1);
                symbolic = Some(factor.into_symbolic());
                continue;
            }
            let anew = from_closed && (round || at_rounding && next != states);
            if anew {
                // What misses is rounding of jumps that nothing holds: with open contact nothing presses them either.
                from_closed = false;
                next = laws
                    .iter()
                    .map(|law| if let Law::Friction { .. } = law { State::Held } else { State::Below })
                    .collect();
                seen.clear();
            } else if careful && next != states {
                // Back in a state it has been in: from here on one end at a time, which cannot cycle.
                let asked = std::mem::replace(&mut next, states.clone());
                if let Some(last) = misses.iter().rposition(|by| *by > GRAZING) {
                    next[last] = asked[last];
                }
            }
            seconds.contact += start.elapsed().as_secs_f64();
            // In a state that it has been in, what misses by no more than the result may is rounding.
            if next == states || (at_rounding && !anew) {
                let start = Instant::now();
                let stress = system.modes.stresses(problem, &now.s);
                let moments = system.unknowns.moments(&now.x);
                let residual = Equilibrium::measure(problem, &stress, &moments).residual();
                if !residual.is_finite() || residual > self.accuracy() {
                    return Err(DualError::NotConverged {
                        method: self.name(),
                        iterations: step,
                        residual,
                        wanted: self.accuracy(),
                        advice:
                            "refinement of the stresses leaves too much of equilibrium; refine the mesh at the contact"
                                .to_string(),
                    });
                }
                seconds.recover = start.elapsed().as_secs_f64();
                return Ok(Found {
                    stress,
                    moments,
                    closed: system.unknowns.by_pair(are_held(&states)),
                    unknowns: system.unknowns.count,
                    iterations: step,
                    seconds,
                    notes: Vec::new(),
                    factorised: None,
                    divided: None,
                });
            }
            states = next;
            symbolic = Some(factor.into_symbolic());
        }
        Err(DualError::NotConverged {
            method: self.name(),
            iterations: steps,
            residual: left,
            wanted: GRAZING,
            advice:
                "ends of contact keep opening and closing, as where next to nothing presses on them; refine the mesh \
                     there, or leave out a contact that carries no force"
                    .to_string(),
        })
    }
}

/// Zero where the unknown is given.
fn clear(values: &mut [f64], fixed: &[Option<f64>]) {
    for (value, fixed) in values.iter_mut().zip(fixed) {
        if fixed.is_some() {
            *value = 0.0;
        }
    }
}

/// K with the rows and columns of held unknowns and jumps taken out, and the values these have.
fn constrained(
    system: &System,
    held: &[usize],
    (laws, states): (&[Law], &[State]),
) -> (SparseColMat<usize, f64>, Vec<Option<f64>>) {
    let mut fixed = vec![None; system.unknowns.count];
    for &d in held {
        fixed[d] = Some(0.0);
    }
    for (i, (law, state)) in laws.iter().zip(states).enumerate() {
        fixed[system.unknowns.first_jump + i] = law.kink(*state);
    }
    let mut matrix = (*system.matrix).clone();
    isolate(&mut matrix, |d| fixed[d].is_some());
    (matrix, fixed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn two_blocks() -> Problem {
        let path = crate::in_repository("cases/two_blocks.toml");
        Problem::load(Scene::read(&path).expect("a scene")).expect("a problem")
    }

    #[test]
    fn a_rescue_goes_on_from_the_state_that_was_reached() {
        let (problem, options) = (two_blocks(), Options::default());
        let whole = ActiveSet::default().solve(&problem, &[], &options).expect("an answer");
        assert!(whole.iterations > 2);
        let closed = crate::dual::contact::states::states(whole.closed.values());
        let rescued = ActiveSet::default().rescue(&problem, &[], &options, Some(closed)).expect("an answer");
        assert_eq!((rescued.iterations, &rescued.closed), (1, &whole.closed));
    }

    #[test]
    fn no_step_begins_after_the_deadline_but_the_first() {
        let options = Options { deadline: Some(Instant::now()), ..Options::default() };
        let error = ActiveSet::default().rescue(&two_blocks(), &[], &options, None).expect_err("not settled");
        assert!(matches!(error, DualError::NotConverged { .. }), "{error}");
    }
}
