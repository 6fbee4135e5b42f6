//! `hypercircle certify`: somebody else's displacement field against the dual bound.

use std::path::PathBuf;

use super::options::{JudgeOptions, RunOptions, SolveOptions};
use super::{CliError, Exit};
use crate::scene::Scene;

/// Options of `certify`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// The displacement field, in any format that meshio reads
    #[arg(long, value_name = "FILE")]
    pub displacement: PathBuf,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveOptions,
    /// How to judge.
    #[command(flatten)]
    pub judge: JudgeOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// Measures the field against the bound.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    Scene::read(&args.scene)?;
    Err(CliError::stopped(Exit::Failed, "`certify` is not part of this build", "use a build with solvers"))
}
