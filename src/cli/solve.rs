//! `hypercircle solve`: the dual solve and its own two-sided energy bracket.

use std::path::PathBuf;

use super::options::{Limits, RunOptions, SolveOptions};
use super::session::{Particulars, Session};
use super::{CliError, Exit};
use crate::compare::{Allowances, compare};
use crate::study::{tolerance_check, wanted_checks};

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
    let session = Session::open("solve", &args.scene, &args.solve, args.run.quiet)?;
    let folder = args.run.report_folder(&session.scene)?;
    let run = session.solve(&args.solve, &args.limits, &folder)?;
    let (certified, allow) = (&run.certified, Allowances::default());
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, Vec::new(), &allow);
    let wanted = args.solve.tolerance.map(|wanted| tolerance_check(certified, &comparison, wanted, &allow));
    comparison.checks.extend(wanted);
    let answers = session.answers(certified, &args.solve);
    comparison.checks.extend(wanted_checks(&answers, &args.solve.wanted(), &allow));
    session.conclude(run, &comparison, Particulars { answers, ..Particulars::default() }, &folder)
}
