//! `hypercircle verify`: dual and primal model of one scene, compared.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::value_parser;

use super::job::{self, JobOptions, Order, Own};
use crate::cli::conclude::Particulars;
use crate::cli::given::Given;
use crate::cli::given::options::{JudgeOptions, Limits, ProofOptions, RunOptions, SolveOptions, positive};
use crate::cli::given::revolved::refuse_models;
use crate::cli::session::{DualRun, Session};
use crate::cli::{CliError, Exit};
use crate::compare::{Comparison, compare};
use crate::primal::{self, HIGHEST_DEGREE, PrimalError, SolverCommand, WantedCells};
use crate::problem::Note;
use crate::process::limit;
use crate::scene::Kinematics;
use crate::study::{candidates, diagnoses, pins, quantity_checks, tolerance_check, wanted_checks};

/// Options of `verify`.
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
    /// How to judge.
    #[command(flatten)]
    pub judge: JudgeOptions,
    /// How several scenes are run.
    #[command(flatten)]
    pub job: JobOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
    /// What travels with the report.
    #[command(flatten)]
    pub proof: ProofOptions,
    /// Degrees of the displacement model, each from 1 to 9, with commas between
    #[arg(
        long, value_name = "P,…", value_delimiter = ',', default_values_t = [1, 2],
        value_parser = value_parser!(u8).range(1..=i64::from(HIGHEST_DEGREE))
    )]
    pub primal_degree: Vec<u8>,
    /// Cells of the displacement model of degree 1 and 2 where the mesh file has quadrilaterals
    #[arg(long, value_name = "CELLS", value_enum, default_value_t, conflicts_with = "reference")]
    pub primal_cells: WantedCells,
    /// Run COMMAND in the place of FEniCSx, without a shell: {problem} stands for the file to read, {out} for the folder to write
    /// primal-P1.json, … into, {degrees} for the degrees that are wanted; docs/exchange.md describes the files
    #[arg(long, value_name = "COMMAND", conflicts_with = "sabotage")]
    pub reference: Option<SolverCommand>,
    /// Give the displacement model at most S seconds
    #[arg(long, value_name = "S", default_value_t = 1800.0, value_parser = positive)]
    pub primal_seconds: f64,
    /// Plant a bug in the displacement model; the comparison must catch it
    #[arg(long, value_enum, hide = true)]
    pub sabotage: Option<Planted>,
}

/// A bug to plant in the displacement model, to see the comparison catch it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Planted {
    /// One sign of the stiffness is wrong
    FlipSign,
    /// One contact row is missing
    DropRow,
}

impl Args {
    /// The degrees, each once and the lowest first.
    fn degrees(&self) -> Vec<u8> {
        BTreeSet::from_iter(self.primal_degree.iter().copied()).into_iter().collect()
    }

    /// The names of the displacement solutions that are compared; a solver of the user's tells its own later.
    pub fn fields(&self) -> Option<Vec<String>> {
        // Which of the two is known when the mesh is.
        let letters = if self.primal_cells == WantedCells::File { "PQ" } else { "P" };
        let named = |letter: char| self.degrees().into_iter().map(move |degree| format!("FEniCSx {letter}{degree}"));
        let of_fenicsx = || letters.chars().flat_map(named).collect();
        self.reference.is_none().then(of_fenicsx)
    }

    /// Refuses options that say nothing to a solver of the user's.
    fn refuse_unheard(&self) -> Result<(), CliError> {
        let Some(program) = &self.reference else { return Ok(()) };
        let engine = &self.solve.engine;
        if engine.ranks.is_some() && engine.engine.is_none() {
            let message = format!("--ranks alone is for FEniCSx, and {} is run in its place", program.name());
            return Err(CliError::stopped(
                Exit::BadInput,
                message,
                "put what it needs into the command of --reference",
            ));
        }
        Ok(())
    }
}

/// Solves the scene twice and compares.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args, given: &Given) -> Result<Exit, CliError> {
    args.solve.say_unheard(&args.limits, args.run.quiet);
    let order = Order {
        command: "verify",
        scenes: &args.scenes,
        job: &args.job,
        given,
        threads: args.solve.threads,
        memory: &args.solve.memory,
        judge: Some(&args.judge),
        run: &args.run,
        own: &|_| Ok(Own { fields: args.fields(), ..Own::default() }),
    };
    job::run(&order, |scene| one(args, scene))
}

fn one(args: &Args, scene: &Path) -> Result<Exit, CliError> {
    args.refuse_unheard()?;
    let session = Session::open("verify", scene, &args.solve, args.run.quiet, &args.job)?;
    refuse_models(&session.scene, &args.degrees())?;
    args.proof.refuse_early(&session)?;
    let folder = args.run.report_folder(&session.scene)?;
    args.judge.refuse_early(&session.scene, args.fields(), &args.job)?;
    let Verified { run, comparison, particulars, failure } = verified(args, &session, Some(&folder))?;
    let exit = session.conclude(&run, &comparison, particulars, &folder)?;
    args.judge.say_accepted(args.run.quiet, &args.job);
    failure.map_or(Ok(exit), |error| Err(unanswered(&error)))
}

/// A scene solved twice, and compared.
pub struct Verified {
    /// Problem, solution and bracket of the stress side.
    pub run: DualRun,
    /// The checks.
    pub comparison: Comparison,
    /// Further parts of the report.
    pub particulars: Particulars,
    /// Why the displacement model gave no answer.
    pub failure: Option<PrimalError>,
}

/// The error for a displacement model without an answer.
pub fn unanswered(error: &PrimalError) -> CliError {
    let exit = match error {
        PrimalError::NotInstalled(_) | PrimalError::NotFound(_) => Exit::NotInstalled,
        _ => Exit::Failed,
    };
    CliError::stopped(exit, error.to_string(), "")
}

/// Solves the scene of `session` twice and compares; one without equilibrium is reported into `folder`, where there is one.
///
/// # Errors
/// Bad input, a solver of the stress side that failed, or no equilibrium.
pub fn verified(args: &Args, session: &Session, folder: Option<&Path>) -> Result<Verified, CliError> {
    refuse_models(&session.scene, &args.degrees())?;
    // There are none on quadrilaterals of a body of revolution.
    let revolved = session.scene.kinematics == Kinematics::Axisymmetric;
    let cells = if revolved { WantedCells::Triangles } else { args.primal_cells };
    let run = session.solve(&args.solve, &args.limits, folder)?;
    let certified = &run.certified;
    let in_stresses = session.start.elapsed().as_secs_f64();

    let who = args.reference.as_ref().map_or("FEniCSx".to_string(), SolverCommand::name);
    session.progress.phase(format!("solving in displacements with {who}"));
    let options = primal::Options {
        program: args.reference.clone(),
        degrees: args.degrees(),
        cells,
        sabotage: args.sabotage.map(|s| match s {
            Planted::FlipSign => primal::Sabotage::FlipSign,
            Planted::DropRow => primal::Sabotage::DropRow,
        }),
        ranks: args.solve.engine.ranks.map(|n| n as usize),
        timeout: limit(args.primal_seconds),
        ..primal::Options::default()
    };
    let solutions = primal::run(&certified.problem, &pins(&certified.statics), &options);
    let in_displacements = session.start.elapsed().as_secs_f64() - in_stresses;

    session.progress.phase("comparing");
    let allow = args.judge.allowances();
    let (solutions, failure) = match solutions {
        Ok(solutions) => (solutions, None),
        Err(error) => (Vec::new(), Some(error)),
    };
    let components = solutions.first().map_or_else(Vec::new, |first| match &args.reference {
        None => vec![
            ("dolfinx".to_string(), first.solver_version.clone()),
            ("petsc4py".to_string(), first.petsc_version.clone()),
        ],
        Some(_) => vec![(first.solver.clone(), first.solver_version.clone())],
    });
    let mesh = &certified.problem.mesh;
    let on_cells = match args.reference {
        None => primal::remark(mesh, &primal::spaces(mesh, cells, &args.degrees())),
        Some(_) => None,
    };
    let models = run.coulomb.as_ref().map(|coulomb| (coulomb, solutions.clone()));
    let candidates = candidates(&certified.problem, solutions);
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, candidates, &allow);
    if let Some((coulomb, models)) = models {
        comparison.checks.extend(coulomb.of_models(&certified.problem, &models, &comparison.contacts));
    }
    let wanted = args.solve.tolerance.map(|wanted| tolerance_check(certified, &comparison, wanted, &allow));
    comparison.checks.extend(wanted);
    let (sharpened, enough) = match comparison.judged.is_empty() {
        true => (None, None),
        false => {
            let (sharpened, enough) = session.sharpen(&run, &mut comparison, &args.solve, &args.limits, &allow)?;
            (sharpened, Some(enough))
        }
    };
    let sharpest = sharpened.as_ref().map_or(certified, |finer| &finer.certified);
    let answers = session.sharpest_answers(&run, sharpened.as_ref(), &args.solve);
    comparison.checks.extend(wanted_checks(certified, &answers, &args.solve.wanted(), &allow));
    let of_models = quantity_checks(certified, &sharpest.bracket, &answers, &comparison, &allow);
    comparison.checks.extend(of_models);
    args.judge.refuse_unknown(&allow, &comparison.checks, failure.is_some(), &args.job)?;
    let (against, baseline) = args.judge.against_baseline(certified, &comparison, &answers, &allow, &args.job)?;
    comparison.checks.extend(against);
    let particulars = Particulars {
        sharpened,
        enough,
        answers,
        seconds: vec![("stresses", in_stresses), ("displacements", in_displacements)],
        components,
        diagnosis: diagnoses(&certified.problem, &comparison, &certified.bracket),
        failure: failure.as_ref().map(ToString::to_string),
        baseline,
        notes: on_cells.into_iter().map(|text| Note { weakens_guarantee: false, text }).collect(),
        is_to_prove: args.proof.proof,
        ..Particulars::default()
    };
    Ok(Verified { run, comparison, particulars, failure })
}
