//! `hypercircle solve`: the dual solve and its own two-sided energy bracket.

use std::path::PathBuf;

use super::options::{Limits, RunOptions, SolveOptions};
use super::{CliError, Exit};
use crate::scene::Scene;

/// Options of `solve`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveOptions,
    /// Where refinement stops.
    #[command(flatten)]
    pub limits: Limits,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// Solves the scene in stresses.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    Scene::read(&args.scene)?;
    Err(CliError::stopped(Exit::Failed, "`solve` is not part of this build", "use a build with solvers"))
}
