//! `hypercircle chart`: accuracy against time, every method and refinement.

use std::path::PathBuf;

use clap::value_parser;

use super::options::{RunOptions, positive};
use super::{CliError, Exit};
use crate::scene::Scene;

/// Options of `chart`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene files
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// Print the fastest choice for the relative error X
    #[arg(long = "for", value_name = "X", value_parser = positive)]
    pub wanted: Option<f64>,
    /// Mark a method that takes longer than SECONDS for one run, and go on
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub budget: Option<f64>,
    /// Keep the runs that an interrupted chart has saved
    #[arg(long)]
    pub resume: bool,
    /// Threads to use
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// Runs every method on every scene.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    // All scenes are read before the first run, which may be hours before the last.
    for scene in &args.scenes {
        Scene::read(scene)?;
    }
    Err(CliError::stopped(Exit::Failed, "`chart` is not part of this build", "use a build with solvers"))
}
