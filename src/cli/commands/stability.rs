//! `hypercircle stability`: the regimes where contact methods are known to fail.

use clap::value_parser;

use super::chart::quoted;
use crate::cli::given::methods::MethodOptions;
use crate::cli::given::options::{MemoryOptions, RunOptions, positive};
use crate::cli::words::progress::Progress;
use crate::cli::words::say;
use crate::cli::{CliError, Exit, this_program};
use crate::primal::SolverCommand;
use crate::process::signals::LastWords;
use crate::report::folder;
use crate::stability::{self, Journal, Matrix, REGIMES, Regime, Sweep, markdown, sweep};

/// Seconds that one run may take.
const BUDGET: f64 = 60.0;
const BUDGET_REDUCED: f64 = 15.0;

/// Options of `stability`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Sweep fewer values of each parameter
    #[arg(long)]
    pub reduced: bool,
    /// Only these regimes; may be repeated
    #[arg(long, value_name = "NAME", value_parser = known, help = regimes())]
    pub regime: Vec<&'static Regime>,
    /// What is swept.
    #[command(flatten)]
    pub methods: MethodOptions,
    /// Run COMMAND in the place of FEniCSx, as `verify` does: {problem} stands for the file to read, {out} for the folder to write
    /// into, {degrees} for the degrees that are wanted. It is judged like this program's own methods
    #[arg(long, value_name = "COMMAND")]
    pub reference: Option<SolverCommand>,
    /// End a run after SECONDS
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub budget: Option<f64>,
    /// Keep the runs that an interrupted sweep of this build has saved
    #[arg(long)]
    pub resume: bool,
    /// Runs at a time [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,
    /// How much memory all runs at a time may take.
    #[command(flatten)]
    pub memory: MemoryOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

impl Args {
    /// The command that makes the same runs.
    fn command(&self) -> String {
        let mut words: Vec<String> = vec!["hypercircle stability".to_string()];
        words.extend(self.reduced.then(|| "--reduced".to_string()));
        words.extend(self.regime.iter().map(|r| format!("--regime {}", r.id)));
        words.extend(self.methods.words());
        words.extend(self.reference.iter().map(|program| format!("--reference {}", quoted(program.line()))));
        words.extend(self.budget.map(|s| format!("--budget {s}")));
        words.extend(self.memory.max_memory.map(|bytes| format!("--max-memory {bytes}")));
        words.join(" ")
    }

    /// The regimes to sweep, each once: those that are named, or all.
    fn regimes(&self) -> Vec<&'static Regime> {
        let named = |regime: &&Regime| self.regime.is_empty() || self.regime.iter().any(|other| other.id == regime.id);
        REGIMES.iter().copied().flatten().filter(named).collect()
    }

    /// Refuses a solver in the place of FEniCSx where the methods that are named leave FEniCSx out.
    fn refuse_unrun(&self) -> Result<(), CliError> {
        match &self.reference {
            Some(program) if !self.methods.chosen().iter().any(|method| method.is_primal()) => Err(CliError::stopped(
                Exit::BadInput,
                format!("--reference runs {} in the place of FEniCSx, and --method leaves FEniCSx out", program.name()),
                "add --method 'FEniCSx P1', or --primal-degree with the degrees to run; or leave --reference out",
            )),
            _ => Ok(()),
        }
    }
}

fn known(id: &str) -> Result<&'static Regime, String> {
    stability::regime(id).ok_or_else(|| format!("there is no regime {id}; choose from {}", names()))
}

/// Names of all regimes.
fn names() -> String {
    REGIMES.iter().copied().flatten().map(|r| r.id).collect::<Vec<_>>().join(", ")
}

/// Help text of `--regime`.
fn regimes() -> String {
    format!("Only these regimes; may be repeated. One of {}", names())
}

/// Runs every method in every regime. Exit code 1 says that a method of this program, or a solver handed in, is wrong without
/// saying so or crashed, or that a method of this program is not correct where it is promised to be.
///
/// # Errors
/// No answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    args.refuse_unrun()?;
    let folder = args.run.folder_named("stability");
    folder::refuse(&folder, [])?;
    let (program, _) = this_program()?;
    let progress = Progress::new(args.run.quiet);
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let failed = |text: String| CliError::stopped(Exit::Failed, text, "");
    let _kept = (!args.run.quiet).then(|| LastWords::kept_in(&folder, ", with this build of the program"));
    let journal =
        Journal::open(&folder, &program, args.resume).map_err(|(path, error)| CliError::unwritable(&path, &error))?;
    let what = Sweep {
        regimes: args.regimes(),
        methods: args.methods.chosen(),
        reduced: args.reduced,
        workers: args.threads.map_or(processors, |n| n as usize),
        budget: args.budget.unwrap_or(if args.reduced { BUDGET_REDUCED } else { BUDGET }),
        memory: args.memory.budget(1),
        solver: args.reference.as_ref(),
        program: &program,
        command: args.command(),
        journal: &journal,
        progress: &|step| progress.step(step),
    };
    let matrix = sweep(&what).map_err(|e| failed(e.to_string()))?;
    stability::write(&matrix, &folder).map_err(|e| failed(e.to_string()))?;
    drop(progress);
    if !args.run.quiet {
        say::line(&markdown(&matrix));
        say::line(&format!("stability: {}", folder.join("stability.html").display()));
    }
    let complaints = complaints(&matrix);
    complaints.iter().for_each(|line| say::complaint(line));
    Ok(if complaints.is_empty() { Exit::Agree } else { Exit::Disagree })
}

/// One line for each step of the program's own methods, or of a solver handed in, that is wrong, crashed, or not correct where it is
/// promised to be.
fn complaints(matrix: &Matrix) -> Vec<String> {
    let line = |row: &stability::Row, cell: &stability::Cell, i: usize| {
        let (value, step) = (row.values.get(i)?, cell.steps.get(i)?);
        Some(format!("{} in {} at {value}: {}: {}", cell.name(), row.id, step.outcome.words(), step.why))
    };
    let mut lines: Vec<String> =
        matrix.defects().into_iter().filter_map(|(row, cell)| line(row, cell, cell.worst_at()?)).collect();
    for (row, cell, i) in matrix.shortfalls() {
        let text = line(row, cell, i).unwrap_or_else(|| format!("{} in {}: no run", cell.name(), row.id));
        lines.push(format!("{text} (promised to be correct)"));
    }
    lines
}
