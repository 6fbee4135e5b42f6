//! Runs every method on every value of every regime, several processes at a time.

use std::collections::HashSet;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::data::{Cell, Matrix, Outcome, Row, Step};
use super::journal::{Journal, Name};
use super::judge::{Claim, judge};
use super::regimes::Regime;
use super::truth::Truth;
use crate::budget::Budget;
use crate::measure::{self, Answer, Ended, Limits, Machine, Method};
use crate::primal::SolverCommand;

/// The regimes and methods to run, and the settings of the run.
pub struct Sweep<'a> {
    /// The regimes.
    pub regimes: Vec<&'static Regime>,
    /// The methods.
    pub methods: Vec<Method>,
    /// Sweep only the values that the regimes name for it.
    pub reduced: bool,
    /// Processes at a time.
    pub workers: usize,
    /// Seconds that one run may take.
    pub budget: f64,
    /// Memory that all runs of a time may take.
    pub memory: Budget,
    /// A displacement solver to run in the place of FEniCSx; it is judged, and its energies bound nothing.
    pub solver: Option<&'a SolverCommand>,
    /// This program.
    pub program: &'a Path,
    /// The command that makes the matrix again, for its readers.
    pub command: String,
    /// Where runs are kept.
    pub journal: &'a Journal,
    /// Told what is being run.
    pub progress: &'a (dyn Fn(measure::Step) + Sync),
}

/// Why there is no matrix.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The program could not start itself, or the journal not be written.
    #[error("a run could not be started or kept: {0}")]
    Run(#[from] std::io::Error),
}

/// The layout that this program writes.
const SCHEMA_VERSION: u32 = 1;
/// Refinements of the mesh on which the truth is computed where nothing better is known.
const FINER: u32 = 2;
/// Adaptive runs aim at this guaranteed error …
const TOLERANCE: f64 = 0.02;
/// … and stop at this many triangles.
const MOST_TRIANGLES: usize = 12_000;

/// The computation of one process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Task {
    One(Method),
    Primal,
    Finer,
}

/// A process: its arguments after the problem, and the name under which its results are kept.
struct Job {
    regime: usize,
    step: usize,
    task: Task,
    options: Vec<OsString>,
    name: Name,
}

/// Of the budget of a run, the part that Uzawa's method has in a reduced matrix.
const UZAWA_REDUCED: f64 = 0.06;

/// Makes the matrix.
///
/// # Errors
/// [`SweepError`]; runs that fail are no errors but results.
pub fn sweep(what: &Sweep<'_>) -> Result<Matrix, SweepError> {
    let jobs = jobs(what);
    let mut seen = HashSet::new();
    let todo: Vec<&Job> = jobs.iter().filter(|j| what.journal.get(&j.name).is_none() && seen.insert(&j.name)).collect();
    let (next, ended) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let failed: Mutex<Option<std::io::Error>> = Mutex::new(None);
    let work = || {
        while let Some(job) = todo.get(next.fetch_add(1, Ordering::Relaxed)) {
            let (regime, done) = (what.regimes[job.regime], ended.load(Ordering::Relaxed));
            let name = format!("{}: {}", regime.id, regime.label(job.step));
            (what.progress)(measure::Step { what: name, done, left: todo.len() - done });
            let kept = once(what, job).and_then(|ended| what.journal.put(job.name.clone(), ended));
            if let Err(error) = kept {
                *failed.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(error);
                next.store(todo.len(), Ordering::Relaxed);
            }
            ended.fetch_add(1, Ordering::Relaxed);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..what.workers {
            // Where the system has no more threads, fewer processes run at a time.
            let _ = std::thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
    if let Some(error) = failed.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        return Err(error.into());
    }
    let rows = (0..what.regimes.len()).map(|r| row(what, r, &jobs)).collect();
    Ok(Matrix {
        schema_version: SCHEMA_VERSION,
        machine: Machine::here(),
        reduced: what.reduced,
        command: what.command.clone(),
        rows,
    })
}

/// Numbers of the values to sweep.
fn steps(what: &Sweep<'_>, regime: &Regime) -> Vec<usize> {
    if what.reduced { regime.reduced.to_vec() } else { (0..regime.values.len()).collect() }
}

/// All processes, those of one problem together; problems that several regimes share have the same names.
fn jobs(what: &Sweep<'_>) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (r, regime) in what.regimes.iter().enumerate() {
        for (i, step) in steps(what, regime).into_iter().enumerate() {
            let problem = fingerprint(regime, step);
            for task in tasks(what, regime, step, i == 0) {
                let options = options(what, regime, step, task);
                let words: Vec<_> = options.iter().map(|o| o.to_string_lossy()).collect();
                let name = what.journal.name(&problem, &words.join(" "));
                jobs.push(Job { regime: r, step, task, options, name });
            }
        }
    }
    jobs
}

/// Every number of the problem. One that cannot be made is like no other.
fn fingerprint(regime: &Regime, step: usize) -> String {
    let value = regime.values[step];
    // What dies here will die in a process of its own, and be judged there.
    match std::panic::catch_unwind(|| regime.problem(value)) {
        Ok(Ok(problem)) => format!("{:?} {problem:?}", regime.step_length(value)),
        _ => format!("{} {step}", regime.id),
    }
}

/// True if a finer mesh is another problem, so that truths about this one do not carry over: new vertices lie on the
/// curves that edges stand for.
fn changes_with_its_mesh(regime: &Regime, step: usize) -> bool {
    let made = std::panic::catch_unwind(|| regime.problem(regime.values[step]));
    matches!(made, Ok(Ok(problem)) if problem.follows_curves())
}

fn tasks(what: &Sweep<'_>, regime: &Regime, step: usize, first: bool) -> Vec<Task> {
    let known = (regime.known)(regime.values[step]);
    let mut tasks = Vec::new();
    // The truth of a scaled problem is that of the first one, scaled.
    if known.energy.is_none() && known.solvable && (known.scale.is_none() || first) {
        tasks.push(Task::Finer);
    }
    if regime.is_step_length {
        tasks.extend(what.methods.contains(&Method::UZAWA).then_some(Task::One(Method::UZAWA)));
        return tasks;
    }
    let here = |m: &&Method| is_run(what, regime, **m) && is_run_at(what, regime, step, **m);
    if what.methods.iter().filter(here).any(|m| m.is_primal()) {
        tasks.push(Task::Primal);
    }
    tasks.extend(what.methods.iter().filter(here).filter(|m| !m.is_primal()).map(|&m| Task::One(m)));
    tasks
}

/// True if a method is run in a regime. Only Uzawa's is where step lengths are swept. In most rows of a reduced matrix stresses are linear, and
/// displacements of one degree, the highest.
fn is_run(what: &Sweep<'_>, regime: &Regime, method: Method) -> bool {
    if regime.is_step_length {
        return method == Method::UZAWA;
    }
    let higher = |other: &Method| other.is_primal() && other.degree() > method.degree();
    let beside_another = method.is_higher() || method.is_primal() && what.methods.iter().any(higher);
    regime.degrees || !(what.reduced && beside_another)
}

/// True if a method that is run in a regime is run at one of its values. In a reduced matrix FEniCSx and Uzawa's method, which take most of
/// its time, are run at the last value alone.
fn is_run_at(what: &Sweep<'_>, regime: &Regime, step: usize, method: Method) -> bool {
    let slow = method.is_primal() && what.solver.is_none() || method == Method::UZAWA;
    !(what.reduced && slow && !regime.is_step_length) || regime.reduced.last() == Some(&step)
}

fn options(what: &Sweep<'_>, regime: &Regime, step: usize, task: Task) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = Vec::new();
    let mut option = |name: &str, value: String| arguments.extend([name.into(), value.into()]);
    let methods = match task {
        Task::One(method) => vec![method],
        Task::Primal => {
            what.methods.iter().copied().filter(|method| method.is_primal() && is_run(what, regime, *method)).collect()
        }
        Task::Finer => {
            option("--refine", if heavy(regime, step) { 1 } else { FINER }.to_string());
            vec![Method::CONDENSED]
        }
    };
    for method in methods {
        option("--method", method.name().to_string());
    }
    if matches!(task, Task::One(method) if method.is_adaptive()) {
        option("--tolerance", TOLERANCE.to_string());
        option("--max-triangles", MOST_TRIANGLES.to_string());
    }
    if let Some(solver) = what.solver.filter(|_| task == Task::Primal) {
        option("--reference", solver.line().to_string());
    }
    option("--seconds", seconds(what, task).to_string());
    arguments
}

/// Seconds that a run may take. Uzawa's method arrives early or far too late: a reduced matrix does not wait for it.
fn seconds(what: &Sweep<'_>, task: Task) -> f64 {
    match task {
        Task::One(Method::UZAWA) if what.reduced => UZAWA_REDUCED * what.budget,
        _ => what.budget,
    }
}

fn once(what: &Sweep<'_>, job: &Job) -> std::io::Result<Ended> {
    let regime = what.regimes[job.regime];
    let mut arguments: Vec<OsString> = vec!["regime".into(), regime.id.into(), job.step.to_string().into()];
    arguments.extend(job.options.iter().cloned());
    let share = what.memory.bytes() / what.workers.max(1) as f64;
    if share.is_finite() {
        arguments.extend(["--max-memory".into(), format!("{:.0}", share.max(1.0)).into()]);
    }
    let limits = Limits { budget: crate::process::limit(seconds(what, job.task)), cache: None };
    measure::run(what.program, &arguments, limits)
}

/// Meshes so fine that two refinements more would only cost time.
fn heavy(regime: &Regime, step: usize) -> bool {
    regime.id == "refinement" && regime.values[step] > 16.0
}

fn row(what: &Sweep<'_>, r: usize, jobs: &[Job]) -> Row {
    let regime = what.regimes[r];
    let steps = steps(what, regime);
    let of = |step: usize, task: Task| {
        let job = jobs.iter().find(|j| (j.regime, j.step, j.task) == (r, step, task))?;
        what.journal.get(&job.name)
    };
    let truths: Vec<Option<Truth>> = steps
        .iter()
        .map(|&step| {
            // The energy of FEniCSx is an upper bound that owes nothing to the stress methods.
            let known = (regime.known)(regime.values[step]);
            let witnesses: &[Task] = if what.solver.is_some() { &[Task::Finer] } else { &[Task::Finer, Task::Primal] };
            let runs: Vec<Ended> = witnesses.iter().filter_map(|&t| of(step, t)).collect();
            Truth::new(&known, &runs)
        })
        .collect();
    let missing = Ended::Crashed("it was not run".to_string());
    let cells = what
        .methods
        .iter()
        .map(|&method| {
            let task = if method.is_primal() { Task::Primal } else { Task::One(method) };
            let mut solver = what.solver.filter(|_| method.is_primal()).map(SolverCommand::name);
            if !is_run(what, regime, method) {
                return Cell { method, solver, worst: Outcome::NotApplicable, steps: Vec::new() };
            }
            let first: Option<Answer> = match of(steps[0], task) {
                Some(Ended::Told(results)) => {
                    results.iter().find(|m| m.method == method.name()).and_then(|m| m.answer.clone())
                }
                _ => None,
            };
            let mut first_error = None;
            let judged: Vec<_> = steps
                .iter()
                .enumerate()
                .map(|(i, &step)| {
                    let known = (regime.known)(regime.values[step]);
                    let truth = match known.scale {
                        Some([energy, _]) => truths[0].map(|t| t.scaled(energy)),
                        None => truths[i],
                    };
                    let truth = truth.filter(|_| !method.is_adaptive() || !changes_with_its_mesh(regime, step));
                    let claim = Claim { known: &known, truth, first: first.as_ref(), first_error, flat: regime.flat };
                    if !is_run_at(what, regime, step, method) {
                        return Step::left_out();
                    }
                    let judged = judge(method, of(step, task).as_ref().unwrap_or(&missing), &claim);
                    if i == 0 {
                        first_error = judged.bound.or(judged.error);
                    }
                    judged
                })
                .collect();
            let worst = judged.iter().map(|s| s.outcome).max().unwrap_or(Outcome::NotApplicable);
            if let Some(told) = judged.iter().find_map(|step| step.answer.as_ref()?.solver.clone()) {
                solver = Some(told);
            }
            Cell { method, solver, worst, steps: judged }
        })
        .collect();
    Row {
        id: regime.id.to_string(),
        title: regime.title.to_string(),
        parameter: regime.parameter.to_string(),
        values: steps.iter().map(|&s| regime.label(s)).collect(),
        promised: steps.iter().filter(|&&s| s < regime.promised).count(),
        truth: regime.truth_with(what.solver.is_some()).to_string(),
        reported: regime.reported.to_string(),
        cells,
    }
}
