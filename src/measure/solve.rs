//! The work inside the process: make the problem, solve it, evaluate the answer.

use super::memory;
use super::method::Method;
use super::primal;
use super::record::{Answer, Asked, End, Measured, Seconds};
use super::{Clock, Settings};
use crate::compare::contact::pressure::{dual_pressure, maximum, resultant, variation};
use crate::dual::paper::{Iteration, Program};
use crate::dual::{DualError, DualMethod, Options, Solver, Uzawa};
use crate::element::{Elements, block};
use crate::problem::Problem;
use crate::study::{self, Certified, Goal, StudyError};

/// Solves what `make` makes with each of `methods`.
///
/// Displacement models share one process, so that imports are paid once; their seconds are each one's own.
pub fn measure(
    make: impl Fn() -> Result<Problem, String>,
    methods: &[Method],
    settings: &Settings,
    clock: Clock,
) -> Vec<Measured> {
    let mut results = Vec::new();
    let degrees: Vec<u8> = methods
        .iter()
        .filter_map(|m| match *m {
            Method::Displacements(degree) => Some(degree),
            _ => None,
        })
        .collect();
    for &method in methods {
        let (solver, goal) = match method {
            Method::Stresses(solver, _) => (solver, None),
            Method::Adaptive(adapt) => (Solver::Condensed, Some(settings.goal(adapt))),
            Method::Displacements(_) => continue,
        };
        let result = stresses(&make, method, solver.method().as_ref(), goal, settings, clock);
        results.push(result);
    }
    if !degrees.is_empty() {
        results.extend(primal::displacements(&make, &degrees, settings, clock));
    }
    results
}

fn stresses(
    make: &impl Fn() -> Result<Problem, String>,
    method: Method,
    solver: &dyn DualMethod,
    goal: Option<Goal>,
    settings: &Settings,
    clock: Clock,
) -> Measured {
    let began = clock.elapsed();
    let problem = match make() {
        Ok(problem) => problem,
        Err(reason) => return Measured::without_answer(method.name(), End::Refused(reason)),
    };
    let read = clock.elapsed();
    let stepped;
    let solver: &dyn DualMethod = match settings.step_length {
        None => solver,
        Some(_) if method != Method::UZAWA => {
            let reason = "the method has no step length".to_string();
            return Measured::without_answer(method.name(), End::NotApplicable(reason));
        }
        Some(fraction) => match largest_step(&problem) {
            Ok(largest) => {
                stepped = Uzawa { step_length: Some(fraction * largest), ..Uzawa::plain() };
                &stepped
            }
            Err(error) => return Measured::without_answer(method.name(), refusal(&StudyError::Dual(error))),
        },
    };
    let options = Options {
        elements: Elements::Uniform(block(method.degree())),
        threads: settings.threads.max(1),
        budget: settings.budget,
        keep_factor: !settings.quantities.is_empty(),
        ..Options::default()
    };
    let solved = match goal {
        None => study::certify(problem, solver, &options),
        Some(ref goal) => study::adapt(problem, solver, &options, goal, |_| {}).map(|adapted| adapted.certified),
    };
    let solved =
        solved.map(|certified| (clock.elapsed(), asked(&certified, &options, &settings.quantities), certified));
    let done = clock.elapsed();
    match solved {
        Err(error) => Measured::without_answer(method.name(), refusal(&error)),
        Ok((solved, quantities, certified)) => {
            let mut seconds = seconds(&certified, goal.is_some(), [began, read, solved]);
            if !quantities.is_empty() {
                seconds.add("quantities", done - solved);
            }
            Measured {
                method: method.name().to_string(),
                end: End::Solved,
                seconds,
                peak_memory: memory::own_peak(),
                answer: Some(Answer { quantities, ..answer(&certified) }),
            }
        }
    }
}

/// The intervals of the quantities that are asked for.
fn asked(certified: &Certified, options: &Options, names: &[String]) -> Vec<Asked> {
    let answers = study::answers(certified, options, |name| names.iter().any(|own| own == name));
    let known = |answer: study::Answer| {
        let [lower, upper] = answer.interval.ends.map(Some);
        Asked { name: answer.name, value: Some(answer.interval.value), lower, upper }
    };
    answers.into_iter().map(known).collect()
}

/// 2/‖BA⁻¹Bᵀ‖.
fn largest_step(problem: &Problem) -> Result<f64, DualError> {
    let program = Program::new(problem)?;
    Ok(2.0 / Iteration::new(&program).norm())
}

fn seconds(certified: &Certified, adaptive: bool, [began, read, done]: [f64; 3]) -> Seconds {
    let p = &certified.dual.seconds;
    let own = [("assemble", p.assemble), ("factor", p.factor), ("contact", p.contact), ("recover", p.recover)];
    let mut phases = vec![("start-up".to_string(), began), ("read".to_string(), read - began)];
    let mut rest = done - read;
    if adaptive {
        let last: f64 = own.iter().map(|(_, s)| s).sum();
        phases.push(("coarser meshes".to_string(), 0.0));
        rest -= last;
    } else {
        rest -= own.iter().map(|(_, s)| s).sum::<f64>();
    }
    phases.extend(own.map(|(name, s)| (name.to_string(), s)));
    match adaptive {
        // What is not the last solve is the meshes before it, with their bounds.
        true => phases[2].1 = rest,
        false => phases.push(("statics and bounds".to_string(), rest)),
    }
    Seconds { whole: done, solve: done - read, phases }
}

/// How a failure of the dual side is to be read.
pub(super) fn refusal(error: &StudyError) -> End {
    let reason = error.to_string();
    match error {
        StudyError::NoEquilibrium { .. } | StudyError::Dual(DualError::Infeasible { .. }) => End::NoEquilibrium(reason),
        StudyError::Dual(DualError::NotConverged { .. }) => End::NotConverged(reason),
        _ => End::Refused(reason),
    }
}

fn answer(certified: &Certified) -> Answer {
    let Certified { problem, dual, bracket, .. } = certified;
    let upper = bracket.free.as_ref().ok().map(|free| free.upper());
    let mut answer = Answer {
        triangles: problem.mesh.triangles.len(),
        unknowns: dual.unknowns,
        iterations: dual.iterations,
        lower: Some(bracket.lower()),
        upper,
        strain: Some(bracket.complementary.strain),
        relative_error_bound: upper.map(|upper| bracket.relative_error(upper)),
        equilibrium: Some(dual.equilibrium.residual()),
        missing: bracket.free.as_ref().err().map(ToString::to_string),
        ..Answer::default()
    };
    for (index, interface) in problem.interfaces.iter().enumerate() {
        let pieces = dual_pressure(dual, index);
        answer.resultants.push(resultant(problem, interface, &pieces).0);
        answer.pressure_max.push(maximum(problem, interface, &pieces).0);
        answer.variation.push(variation(&pieces));
    }
    answer
}
