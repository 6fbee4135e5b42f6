//! `hypercircle solve`: the dual solve and its own two-sided energy bracket.

use std::path::{Path, PathBuf};

use super::job::{self, JobOptions, Order, Own};
use crate::cli::conclude::Particulars;
use crate::cli::given::Given;
use crate::cli::given::options::{Limits, ProofOptions, RunOptions, SolveOptions};
use crate::cli::session::{DualRun, Session};
use crate::cli::{CliError, Exit};
use crate::compare::{Allowances, Comparison, compare};
use crate::study::{Answer, tolerance_check, wanted_checks};

/// Options of `solve`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene files, and folders for the scenes in them: every .toml file but those without a table of a scene; folders below are
    /// not searched. Several scenes get a folder each, and one page for all
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveOptions,
    /// Where refinement stops.
    #[command(flatten)]
    pub limits: Limits,
    /// How several scenes are run.
    #[command(flatten)]
    pub job: JobOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
    /// What travels with the report.
    #[command(flatten)]
    pub proof: ProofOptions,
}

/// Solves the scene in stresses.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args, given: &Given) -> Result<Exit, CliError> {
    args.solve.say_unheard(&args.limits, args.run.quiet);
    let order = Order {
        command: "solve",
        scenes: &args.scenes,
        job: &args.job,
        given,
        threads: args.solve.threads,
        memory: &args.solve.memory,
        judge: None,
        run: &args.run,
        own: &|_| Ok(Own::default()),
    };
    job::run(&order, |scene| one(args, scene))
}

fn one(args: &Args, scene: &Path) -> Result<Exit, CliError> {
    let session = Session::open("solve", scene, &args.solve, args.run.quiet, &args.job)?;
    args.proof.refuse_early(&session)?;
    let folder = args.run.report_folder(&session.scene)?;
    let Solved { run, comparison, answers } = solved(args, &session, Some(&folder))?;
    session.conclude(
        &run,
        &comparison,
        Particulars { answers, is_to_prove: args.proof.proof, ..Particulars::default() },
        &folder,
    )
}

/// A solved scene.
pub struct Solved {
    /// Problem, solution and bracket.
    pub run: DualRun,
    /// The checks of the bracket, and of what was asked for.
    pub comparison: Comparison,
    /// The intervals of the quantities.
    pub answers: Vec<Answer>,
}

/// Solves the scene of `session`; one without equilibrium is reported into `folder`, where there is one.
///
/// # Errors
/// Bad input, a solver that failed, or no equilibrium.
pub fn solved(args: &Args, session: &Session, folder: Option<&Path>) -> Result<Solved, CliError> {
    let run = session.solve(&args.solve, &args.limits, folder)?;
    let (certified, allow) = (&run.certified, Allowances::default());
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, Vec::new(), &allow);
    let wanted = args.solve.tolerance.map(|wanted| tolerance_check(certified, &comparison, wanted, &allow));
    comparison.checks.extend(wanted);
    let answers = session.answers(certified, &args.solve);
    comparison.checks.extend(wanted_checks(certified, &answers, &args.solve.wanted(), &allow));
    Ok(Solved { run, comparison, answers })
}
