//! `hypercircle stability`: the regimes where contact methods are known to fail.

use clap::value_parser;

use super::chart::{known as known_method, this_program};
use super::options::{RunOptions, positive};
use super::progress::Progress;
use super::{CliError, Exit};
use crate::measure::Method;
use crate::stability::{self, REGIMES, Regime, Sweep, markdown, sweep};

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
    #[arg(long, value_name = "NAME", value_parser = known)]
    pub regime: Vec<&'static Regime>,
    /// Only these methods; may be repeated
    #[arg(long, value_name = "NAME", value_parser = known_method)]
    pub method: Vec<Method>,
    /// End a run after SECONDS
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub budget: Option<f64>,
    /// Runs at a time [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

fn known(id: &str) -> Result<&'static Regime, String> {
    let names: Vec<&str> = REGIMES.iter().copied().flatten().map(|r| r.id).collect();
    stability::regime(id).ok_or_else(|| format!("there is no regime {id}; choose from {}", names.join(", ")))
}

/// Runs every method in every regime.
///
/// # Errors
/// No answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let folder = args.run.folder_named("stability");
    let program = this_program()?;
    let progress = Progress::new(args.run.quiet);
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let all = || REGIMES.iter().copied().flatten().collect();
    let what = Sweep {
        regimes: if args.regime.is_empty() { all() } else { args.regime.clone() },
        methods: Method::ALL.into_iter().filter(|m| args.method.is_empty() || args.method.contains(m)).collect(),
        reduced: args.reduced,
        workers: args.threads.map_or(processors, |n| n as usize),
        budget: args.budget.unwrap_or(if args.reduced { BUDGET_REDUCED } else { BUDGET }),
        program: &program,
        progress: &|what| progress.phase(what),
    };
    let failed = |text: String| CliError::stopped(Exit::Failed, text, "");
    let matrix = sweep(&what).map_err(|e| failed(e.to_string()))?;
    stability::write(&matrix, &folder).map_err(|e| failed(e.to_string()))?;
    drop(progress);
    let defects = matrix.defects();
    if !args.run.quiet {
        println!("{}", markdown(&matrix));
        println!("stability: {}", folder.join("stability.html").display());
    }
    for (row, cell) in &defects {
        if let Some(i) = cell.worst_at() {
            let (method, why) = (cell.method.name(), &cell.steps[i].why);
            eprintln!("{} in {} at {}: {}: {why}", method, row.id, row.values[i], cell.worst.words());
        }
    }
    Ok(if defects.is_empty() { Exit::Agree } else { Exit::Disagree })
}
