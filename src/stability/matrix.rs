//! Runs every method on every value of every regime, several processes at a time.

use std::collections::HashMap;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use super::data::{Cell, Matrix, Outcome, Row};
use super::judge::{Claim, judge};
use super::regimes::Regime;
use super::truth::Truth;
use crate::measure::{self, Answer, Ended, Limits, Machine, Method};

/// What to run.
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
    /// This program.
    pub program: &'a Path,
    /// Told what is being run.
    pub progress: &'a (dyn Fn(String) + Sync),
}

/// Why there is no matrix.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The program could not start itself.
    #[error("a run could not be started: {0}")]
    Start(#[from] std::io::Error),
}

/// The layout that this program writes.
const SCHEMA_VERSION: u32 = 1;
/// Refinements of the mesh on which the truth is computed where nothing better is known.
const FINER: u32 = 2;
/// Adaptive runs aim at this guaranteed error …
const TOLERANCE: f64 = 0.02;
/// … and stop at this many triangles.
const MOST_TRIANGLES: usize = 12_000;

/// What a process runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Task {
    One(Method),
    Primal,
    Finer,
}

type Key = (usize, usize, Task);

/// Makes the matrix.
///
/// # Errors
/// [`SweepError`]; runs that fail are no errors but results.
pub fn sweep(what: &Sweep<'_>) -> Result<Matrix, SweepError> {
    let tasks = tasks(what);
    let next = AtomicUsize::new(0);
    let done: Mutex<HashMap<Key, std::io::Result<Ended>>> = Mutex::new(HashMap::new());
    std::thread::scope(|scope| {
        for _ in 0..what.workers.max(1) {
            scope.spawn(|| {
                while let Some(&key) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let result = once(what, key);
                    done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).insert(key, result);
                }
            });
        }
    });
    let mut ended: HashMap<Key, Ended> = HashMap::new();
    for (key, result) in done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        ended.insert(key, result?);
    }
    let rows = (0..what.regimes.len()).map(|r| row(what, r, &ended)).collect();
    Ok(Matrix { schema_version: SCHEMA_VERSION, machine: Machine::here(), reduced: what.reduced, rows })
}

/// Numbers of the values to sweep.
fn steps(what: &Sweep<'_>, regime: &Regime) -> Vec<usize> {
    if what.reduced { regime.reduced.to_vec() } else { (0..regime.values.len()).collect() }
}

fn tasks(what: &Sweep<'_>) -> Vec<Key> {
    let mut tasks = Vec::new();
    let primal = what.methods.iter().any(|m| m.is_primal());
    for (r, regime) in what.regimes.iter().enumerate() {
        for step in steps(what, regime) {
            tasks.push((r, step, Task::Finer));
            if primal && !regime.is_step_length {
                tasks.push((r, step, Task::Primal));
            }
            let single = what.methods.iter().filter(|m| !m.is_primal());
            tasks.extend(single.map(|&m| (r, step, Task::One(m))));
        }
    }
    tasks
}

fn once(what: &Sweep<'_>, (r, step, task): Key) -> std::io::Result<Ended> {
    let regime = what.regimes[r];
    let known = (regime.known)(regime.values[step]);
    if task == Task::Finer && (known.energy.is_some() || !known.solvable) {
        return Ok(Ended::Told(Vec::new()));
    }
    (what.progress)(format!("{}: {}", regime.id, regime.label(step)));
    let mut arguments: Vec<OsString> = vec!["regime".into(), regime.id.into(), step.to_string().into()];
    let mut option = |name: &str, value: String| arguments.extend([name.into(), value.into()]);
    let methods = match task {
        Task::One(method) => vec![method],
        Task::Primal => vec![Method::FenicsP1, Method::FenicsP2],
        Task::Finer => {
            option("--refine", if regime.values.len() > 4 && heavy(regime, step) { 1 } else { FINER }.to_string());
            vec![Method::Condensed]
        }
    };
    for method in methods {
        option("--method", method.name().to_string());
    }
    if task == Task::One(Method::Adaptive) {
        option("--tolerance", TOLERANCE.to_string());
        option("--max-triangles", MOST_TRIANGLES.to_string());
    }
    option("--seconds", what.budget.to_string());
    let limits = Limits { budget: Duration::from_secs_f64(what.budget), cache: None };
    measure::run(what.program, &arguments, limits)
}

/// Meshes so fine that two refinements more would only cost time.
fn heavy(regime: &Regime, step: usize) -> bool {
    regime.id == "refinement" && regime.values[step] > 16.0
}

fn row(what: &Sweep<'_>, r: usize, ended: &HashMap<Key, Ended>) -> Row {
    let regime = what.regimes[r];
    let steps = steps(what, regime);
    let missing = Ended::Crashed("it was not run".to_string());
    let inapplicable = Ended::Told(Vec::new());
    let of = |step: usize, task: Task| ended.get(&(r, step, task)).unwrap_or(&missing);
    let truths: Vec<Option<Truth>> = steps
        .iter()
        .map(|&step| {
            // The displacement model's energy is an upper bound that owes nothing to the stress methods.
            let known = (regime.known)(regime.values[step]);
            let primal = ended.get(&(r, step, Task::Primal)).cloned();
            let runs: Vec<Ended> = std::iter::once(of(step, Task::Finer).clone()).chain(primal).collect();
            Truth::new(&known, &runs)
        })
        .collect();
    let cells = what
        .methods
        .iter()
        .map(|&method| {
            let task = if method.is_primal() { Task::Primal } else { Task::One(method) };
            if regime.is_step_length && method != Method::Uzawa {
                return Cell { method, worst: Outcome::NotApplicable, steps: Vec::new() };
            }
            let first: Option<Answer> = match of(steps[0], task) {
                Ended::Told(results) => {
                    results.iter().find(|m| m.method == method.name()).and_then(|m| m.answer.clone())
                }
                _ => None,
            };
            let judged: Vec<_> = steps
                .iter()
                .enumerate()
                .map(|(i, &step)| {
                    let known = (regime.known)(regime.values[step]);
                    let truth = match known.scale {
                        Some([energy, _]) => truths[0].map(|t| t.scaled(energy)),
                        None => truths[i],
                    };
                    let claim = Claim { known: &known, truth, first: first.as_ref(), flat: regime.flat };
                    judge(method, ended.get(&(r, step, task)).unwrap_or(&inapplicable), &claim)
                })
                .collect();
            let worst = judged.iter().map(|s| s.outcome).max().unwrap_or(Outcome::NotApplicable);
            Cell { method, worst, steps: judged }
        })
        .collect();
    Row {
        id: regime.id.to_string(),
        title: regime.title.to_string(),
        parameter: regime.parameter.to_string(),
        values: steps.iter().map(|&s| regime.label(s)).collect(),
        truth: regime.truth.to_string(),
        reported: regime.reported.to_string(),
        cells,
    }
}
