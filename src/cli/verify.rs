//! `hypercircle verify`: dual and primal model of one scene, compared.

use std::path::PathBuf;

use super::options::{JudgeOptions, Limits, RunOptions, SolveOptions};
use super::{CliError, Exit};
use crate::scene::Scene;

/// Options of `verify`.
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
    /// How to judge.
    #[command(flatten)]
    pub judge: JudgeOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// Solves the scene twice and compares.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    Scene::read(&args.scene)?;
    Err(CliError::stopped(Exit::Failed, "`verify` is not part of this build", "use a build with solvers"))
}
