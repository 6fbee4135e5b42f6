//! `hypercircle measure`: one run for a chart or a stability matrix, printed as JSON. Not for people.

use std::io::Write;
use std::path::PathBuf;

use clap::{Subcommand, value_parser};

use crate::cli::given::methods::known;
use crate::cli::given::options::{MOST_REFINEMENTS, MemoryOptions, positive};
use crate::cli::given::threads;
use crate::cli::{CliError, Exit};
use crate::measure::{Clock, Method, Settings, measure};
use crate::primal::SolverCommand;
use crate::problem::Problem;
use crate::process::end_with_parent;
use crate::scene::Scene;
use crate::stability;

/// Options of `measure`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to run.
    #[command(subcommand)]
    pub what: What,
}

/// Where the problem comes from.
#[derive(Debug, Subcommand)]
pub enum What {
    /// A scene file, refined
    Scene {
        /// The scene file
        scene: PathBuf,
        /// How to run.
        #[command(flatten)]
        options: Options,
    },
    /// A value of a regime, refined
    Regime {
        /// Name of the regime
        regime: String,
        /// Number of the value, from 0
        step: usize,
        /// How to run.
        #[command(flatten)]
        options: Options,
    },
}

/// Options of both.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A method; several share the process
    #[arg(long, required = true, value_parser = known)]
    pub method: Vec<Method>,
    /// Uniform refinements
    #[arg(long, default_value_t = 0, value_parser = value_parser!(u32).range(0..=i64::from(MOST_REFINEMENTS)))]
    pub refine: u32,
    /// Threads
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// Seconds for a process started from here
    #[arg(long, default_value_t = 600.0, value_parser = positive)]
    pub seconds: f64,
    /// Tolerance of an adaptive run
    #[arg(long, value_parser = positive)]
    pub tolerance: Option<f64>,
    /// Triangles at which an adaptive run stops
    #[arg(long)]
    pub max_triangles: Option<usize>,
    /// A command to run in the place of FEniCSx
    #[arg(long)]
    pub reference: Option<SolverCommand>,
    /// How much memory may be taken.
    #[command(flatten)]
    pub memory: MemoryOptions,
    /// A quantity of the scene to bound; may be repeated
    #[arg(long)]
    pub quantity: Vec<String>,
    /// When this process was asked for, in nanoseconds since 1970
    #[arg(long)]
    pub spawned: Option<u128>,
}

/// Runs and prints.
///
/// # Errors
/// The scene is refused, or there is no such regime; a method that fails is a result.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let (What::Scene { options, .. } | What::Regime { options, .. }) = &args.what;
    let clock = Clock::since(options.spawned);
    if options.spawned.is_some() {
        end_with_parent();
    }
    let threads = threads::start(options.threads);
    let mut settings = Settings {
        threads,
        tolerance: options.tolerance,
        max_triangles: options.max_triangles,
        seconds: options.seconds,
        budget: options.memory.budget(threads),
        quantities: options.quantity.clone(),
        step_length: None,
        program: options.reference.clone(),
    };
    let refined = |problem: Problem| problem.refine_uniform(options.refine as usize).map_err(|e| e.to_string());
    let results = match &args.what {
        What::Scene { scene, .. } => {
            let make = || {
                let scene = Scene::read(scene).map_err(|e| e.to_string())?;
                let load = |scene| Problem::load(scene).map_err(|e| e.to_string());
                // As `solve --tolerance` does.
                let adaptive = options.tolerance.is_some();
                refined(if adaptive { Problem::to_refine(&scene, load)? } else { load(scene)? })
            };
            measure(make, &options.method, &settings, clock)
        }
        What::Regime { regime, step, .. } => {
            let unknown =
                || CliError::stopped(Exit::BadInput, format!("there is no step {step} of regime {regime}"), "");
            let regime = stability::regime(regime).ok_or_else(unknown)?;
            let value = *regime.values.get(*step).ok_or_else(unknown)?;
            settings.step_length = regime.step_length(value);
            measure(|| refined(regime.problem(value)?), &options.method, &settings, clock)
        }
    };
    let text = serde_json::to_string(&results)
        .map_err(|e| CliError::stopped(Exit::Failed, format!("results cannot be written: {e}"), ""))?;
    match writeln!(std::io::stdout(), "{text}") {
        Ok(()) => Ok(Exit::Agree),
        Err(e) => Err(CliError::stopped(Exit::Failed, format!("results cannot be written: {e}"), "")),
    }
}
