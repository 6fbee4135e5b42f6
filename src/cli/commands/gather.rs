//! `hypercircle gather`: one page of the parts of a job.

use std::path::PathBuf;

use super::job;
use crate::cli::given::options;
use crate::cli::{CliError, Exit};
use crate::job::Plan;

/// Options of `gather`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The folder that --out named when the parts were run, or that their folders were copied into
    #[arg(value_name = "OUT")]
    pub out: PathBuf,
    /// Who accepts, and why, where the parts were run with --accept.
    #[command(flatten)]
    pub signature: options::SignatureOptions,
    /// Say nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// Makes the page, and ends with the exit code of the worst scene; a scene that no part has run counts as failed.
///
/// # Errors
/// There is no job in the folder, or its files cannot be written.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let plan = Plan::read(&args.out).map_err(job::refused)?;
    let is_signed = !args.signature.reason.is_empty() || args.signature.accepted_by.is_some();
    if is_signed && !plan.accept {
        let message =
            "--reason and --accepted-by are said of numbers that are accepted, and the parts were run without --accept";
        return Err(CliError::stopped(Exit::BadInput, message, "leave them out"));
    }
    job::conclude(&args.out, &plan, Some(&args.signature.signature()), args.quiet)
}
