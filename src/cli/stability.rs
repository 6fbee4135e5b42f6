//! `hypercircle stability`: the regimes where contact methods are known to fail.

use clap::value_parser;

use super::options::RunOptions;
use super::{CliError, Exit};

/// Options of `stability`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Sweep fewer values of each parameter
    #[arg(long)]
    pub reduced: bool,
    /// Threads to use
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// Runs every method in every regime.
///
/// # Errors
/// No answer can be given.
pub fn run(_args: &Args) -> Result<Exit, CliError> {
    Err(CliError::stopped(Exit::Failed, "`stability` is not part of this build", "use a build with solvers"))
}
