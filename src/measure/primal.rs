//! Displacement models: the seconds and the memory are those of the process that FEniCSx runs in.

use super::memory::Watch;
use super::record::{Answer, Asked, End, Measured, Seconds};
use super::{Clock, Method, Settings};
use crate::bounds::potential;
use crate::compare::contact::pressure::{maximum, reaction_pressure, variation};
use crate::compare::{Candidate, Reactions};
use crate::element::Displacement;
use crate::primal::{self, PrimalError, PrimalSeconds};
use crate::problem::Problem;
use crate::quantity::Form;
use crate::scene::Quantity;
use crate::statics;
use crate::study::{candidates, pins};

/// Solves in displacements of each degree, in one process.
pub(super) fn displacements(
    make: &impl Fn() -> Result<Problem, String>,
    degrees: &[u8],
    settings: &Settings,
    clock: Clock,
) -> Vec<Measured> {
    let began = clock.elapsed();
    let name = |degree: u8| Method::Displacements(degree).name();
    let all = |end: End| degrees.iter().map(|&d| Measured::without_answer(name(d), end.clone())).collect();
    if settings.step_length.is_some() {
        return all(End::NotApplicable("the method has no step length".to_string()));
    }
    let problem = match make() {
        Ok(problem) => problem,
        Err(reason) => return all(End::Refused(reason)),
    };
    let read = clock.elapsed();
    let pins = match statics::check(&problem) {
        Ok(statics) => pins(&statics),
        Err(error) => return all(End::Refused(error.to_string())),
    };
    let asked = clock.elapsed();
    let options = primal::Options {
        degrees: degrees.to_vec(),
        program: settings.program.clone(),
        timeout: crate::process::limit(settings.seconds.max(1.0)),
        ..primal::Options::default()
    };
    let watch = Watch::start();
    let solved = primal::run(&problem, &pins, &options);
    let ended = clock.elapsed();
    let memory = watch.finish();
    let solutions = match solved {
        Ok(solutions) => solutions,
        Err(error) => return all(failure(error)),
    };
    // What the process did for all degrees together, and the seconds that belong to one of them.
    let outside =
        ended - asked - solutions.iter().map(|s| s.seconds.total - s.seconds.import - s.seconds.mesh).sum::<f64>();
    let clocks: Vec<PrimalSeconds> = solutions.iter().map(|s| s.seconds).collect();
    let candidates = candidates(&problem, solutions);
    let measured = |(candidate, own): (&Candidate, PrimalSeconds)| {
        let solver = settings.program.is_some().then(|| candidate.solver.clone());
        Measured {
            method: name(candidate.degree as u8).to_string(),
            end: End::Solved,
            answer: Some(Answer { solver, ..answer(&problem, candidate, &settings.quantities) }),
            seconds: seconds(&own, outside, [began, read]),
            peak_memory: memory,
        }
    };
    let of_degree = |degree: &u8| {
        let found = candidates.iter().zip(clocks.iter().copied()).find(|(c, _)| c.degree == usize::from(*degree));
        found.map_or_else(
            || Measured::without_answer(name(*degree), End::NotApplicable(format!("it has no P{degree}"))),
            measured,
        )
    };
    degrees.iter().map(of_degree).collect()
}

/// Phases of one degree, as if it had had the process to itself.
fn seconds(own: &PrimalSeconds, outside: f64, [began, read]: [f64; 2]) -> Seconds {
    let phases = [
        ("start-up", began),
        ("read", read - began),
        // Start of the interpreter, writing and reading of the exchange files.
        ("exchange", (outside - own.import - own.mesh).max(0.0)),
        ("import", own.import),
        ("mesh", own.mesh),
        ("compile", own.compile),
        ("assemble", own.assemble),
        ("contact", own.solve),
    ];
    Seconds {
        whole: phases.iter().map(|(_, s)| s).sum(),
        solve: own.assemble + own.solve,
        phases: phases.map(|(name, s)| (name.to_string(), s)).to_vec(),
    }
}

fn failure(error: PrimalError) -> End {
    let text = error.to_string();
    match error {
        PrimalError::NotInstalled(_) | PrimalError::NotFound(_) => End::NotApplicable(text),
        PrimalError::TimedOut { .. } => End::NotConverged(text),
        PrimalError::NoAnswer { log, .. } => End::Refused(log.lines().last().unwrap_or(&text).to_string()),
        // The package gives one line for everything it noticed itself; anything else is a crash of the interpreter.
        PrimalError::Failed { ref log, .. } => {
            match log.lines().rev().find_map(|l| l.strip_prefix("hypercircle-reference: ")) {
                Some(line) if line.contains("converge") || line.contains("stopped with reason") => {
                    End::NotConverged(line.to_string())
                }
                Some(line) => End::Refused(line.to_string()),
                None => End::Crashed(log.lines().last().unwrap_or(&text).to_string()),
            }
        }
        _ => End::Refused(text),
    }
}

/// The values of quantities in a displacement, which guarantees nothing of them.
fn asked(problem: &Problem, field: &Displacement, names: &[String]) -> Vec<Asked> {
    let asked = problem.scene.quantities.iter().filter(|quantity| names.contains(&quantity.name));
    let known = |quantity: &Quantity| {
        let form = Form::new(problem, quantity).ok();
        let value = form.and_then(|form| form.value_of(problem, field));
        Asked { name: quantity.name.clone(), value, lower: None, upper: None }
    };
    asked.map(known).collect()
}

/// Evaluates a solution with this program's own quadrature, on the nearest admissible field.
fn answer(problem: &Problem, candidate: &Candidate, quantities: &[String]) -> Answer {
    let mut answer = Answer {
        triangles: problem.mesh.triangles.len(),
        // Where the program does not tell, the values of its field.
        unknowns: candidate.unknowns.unwrap_or(2 * (candidate.vertex.len() + candidate.middle.len())),
        iterations: candidate.iterations.unwrap_or(0),
        ..Answer::default()
    };
    match candidate.nearest_admissible(problem) {
        Ok((field, violation)) => {
            let energy = potential(problem, &field);
            answer.upper = Some(energy.total());
            answer.strain = Some(energy.strain);
            answer.violation = Some(violation.largest());
            answer.quantities = asked(problem, &field, quantities);
        }
        Err(reason) => answer.missing = Some(reason.to_string()),
    }
    let none = Vec::new();
    for (interface, reactions) in problem.interfaces.iter().zip(candidate.reactions.as_ref().unwrap_or(&none)) {
        let pieces = reaction_pressure(problem, interface, reactions);
        let Reactions { resultant, .. } = reactions;
        answer.resultants.push(*resultant);
        answer.pressure_max.push(maximum(problem, interface, &pieces).0);
        answer.variation.push(variation(&pieces));
    }
    answer
}
