//! The options that several commands share, and how their values are read.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum, value_parser};

use crate::budget::{self, Budget};
use crate::cli::words::say;
use crate::cli::{CliError, Exit};
use crate::dual::{LinearSolver, Solver};
use crate::element::Elements;
use crate::report;
use crate::report::text::number::significant;
use crate::scene::Scene;
use crate::study::{Adapt, GivenValue, Wanted};

/// Uniform refinements beyond which no machine follows: each multiplies the triangles by four.
pub const MOST_REFINEMENTS: u32 = 12;

/// What runs on other processors, or other machines.
#[derive(Debug, Clone, Copy, Args)]
pub struct EngineOptions {
    /// Solve in stresses with another program, over MPI ranks, in place of --method
    #[arg(long, value_enum, conflicts_with = "method")]
    pub engine: Option<Engine>,
    /// Run on N MPI ranks: the engine, and the displacement model
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=65536))]
    pub ranks: Option<u32>,
    /// How the engine solves its linear systems
    #[arg(long, value_enum, default_value_t = LinearSolver::Mumps, requires = "engine")]
    pub linear_solver: LinearSolver,
    /// Give each solve of the engine at most S seconds
    #[arg(long, value_name = "S", default_value_t = 7200.0, value_parser = positive, requires = "engine")]
    pub engine_seconds: f64,
}

/// Programs that solve in stresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// PETSc
    Petsc,
}

/// How to solve.
#[derive(Debug, Clone, Args)]
pub struct SolveOptions {
    /// Solver of the dual problem
    #[arg(long, value_enum, default_value_t = Solver::Condensed)]
    pub method: Solver,
    /// What runs over MPI.
    #[command(flatten)]
    pub engine: EngineOptions,
    /// Polynomial degree of the stresses, 1 where it is missing; the one to begin with where --tolerance raises it, 3 where it is missing
    #[arg(long, value_name = "P", value_parser = value_parser!(u32).range(1..=MOST_DEGREE))]
    pub degree: Option<u32>,
    /// Elements in place of blocks of one degree: of a degree for each triangle, or the user's own; no option has them.
    #[arg(skip)]
    pub elements: Option<Elements>,
    /// Refine the mesh uniformly N times before solving
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = value_parser!(u32).range(0..=i64::from(MOST_REFINEMENTS)))]
    pub refine: u32,
    /// Refine adaptively until the guaranteed relative energy-norm error is below X
    #[arg(long, value_name = "X", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Refine adaptively until the half-width of the interval of quantity NAME is below X times its value; may be repeated
    #[arg(long, value_name = "NAME=X")]
    pub tolerance_of: Vec<NamedTolerance>,
    /// What to refine towards the tolerance: mesh and degrees where it is missing, the mesh alone with uzawa
    #[arg(long, value_enum)]
    pub adapt: Option<Adapt>,
    /// Threads to use, at most one for each processor
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// Give meshio at most S seconds to read a file
    #[arg(long, value_name = "S", default_value_t = 120.0, value_parser = positive)]
    pub reading_seconds: f64,
    /// How much memory may be taken.
    #[command(flatten)]
    pub memory: MemoryOptions,
}

/// The largest degree of stresses.
const MOST_DEGREE: i64 = crate::element::MAX_DEGREE as i64;

/// How much memory may be taken.
#[derive(Debug, Clone, Args)]
pub struct MemoryOptions {
    /// Memory to take at most, for instance 500M or 2G; four fifths of what is available where it is missing.
    #[arg(
        long,
        value_name = "SIZE",
        value_parser = budget::parse,
        help = "Take at most SIZE of memory, for instance 500M or 2G [default: four fifths of what is available]"
    )]
    pub max_memory: Option<u64>,
}

impl SolveOptions {
    /// True if the mesh is refined adaptively.
    pub fn is_adaptive(&self) -> bool {
        self.tolerance.is_some() || !self.tolerance_of.is_empty()
    }

    /// Says, unless `quiet`, which option on refinement does nothing because no tolerance says how far to refine.
    pub fn say_unheard(&self, limits: &Limits, quiet: bool) {
        let given = [
            ("--adapt", self.adapt.is_some()),
            ("--max-triangles", limits.max_triangles.is_some()),
            ("--max-seconds", limits.max_seconds.is_some()),
        ];
        let idle = given.into_iter().find(|(_, is_given)| *is_given && !self.is_adaptive());
        if let Some((option, _)) = idle.filter(|_| !quiet) {
            say::complaint(&format!(
                "{option} is about refinement towards a tolerance, and none is given: the mesh is solved on as it is. Add \
                 --tolerance X or --tolerance-of NAME=X"
            ));
        }
    }

    /// The quantities that are to be known more closely.
    pub fn wanted(&self) -> Vec<Wanted> {
        let wanted = |of: &NamedTolerance| Wanted { name: of.name.clone(), tolerance: of.value };
        self.tolerance_of.iter().map(wanted).collect()
    }

    /// The kind of refinement towards the tolerance.
    pub fn adapt(&self) -> Adapt {
        self.adapt.unwrap_or(if self.is_linear() { Adapt::H } else { Adapt::Hp })
    }

    /// True if the method has linear stresses alone.
    fn is_linear(&self) -> bool {
        self.method == Solver::Uzawa && self.engine.engine.is_none()
    }

    /// Refuses to raise degrees for a method that has none to raise.
    ///
    /// # Errors
    /// Bad input.
    pub fn refuse_degrees_of_uzawa(&self) -> Result<(), CliError> {
        if self.adapt != Some(Adapt::Hp) || !self.is_linear() {
            return Ok(());
        }
        let message = "--method uzawa solves with linear stresses, and --adapt hp raises their degrees";
        Err(CliError::stopped(Exit::BadInput, message, "leave --adapt out, or choose another --method"))
    }
}

impl MemoryOptions {
    /// The memory that was asked for, or else that is available to a run with so many threads.
    pub fn budget(&self, threads: usize) -> Budget {
        self.max_memory.map_or_else(|| Budget::of_available(threads), Budget::of)
    }
}

/// Where adaptive refinement stops at the latest.
#[derive(Debug, Clone, Args)]
pub struct Limits {
    /// Stop refining before a mesh has more than N triangles
    #[arg(long, value_name = "N", value_parser = at_least_one)]
    pub max_triangles: Option<usize>,
    /// Refine for S seconds: no mesh is begun that would take longer, judged by the last one
    #[arg(long, value_name = "S", value_parser = positive)]
    pub max_seconds: Option<f64>,
}

/// Where results go, and how much is said on the way.
#[derive(Debug, Clone, Args)]
pub struct RunOptions {
    /// Folder for the results, made when there is something to write; `out/` and the name of the scene where it is
    /// missing.
    #[arg(
        long,
        value_name = "DIR",
        help = "Folder for the results, made when there is something to write [default: out/<name>; out for several scenes]"
    )]
    pub out: Option<PathBuf>,
    /// Say nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// What travels with the report.
#[derive(Debug, Clone, Copy, Args)]
pub struct ProofOptions {
    /// Leave proof.npz beside the report, from which `hypercircle-check` verifies the bracket in exact arithmetic
    #[arg(long)]
    pub proof: bool,
}

impl RunOptions {
    /// The folder for results about `scene`. It need not exist.
    pub fn folder(&self, scene: &Scene) -> PathBuf {
        self.folder_named(&scene.name)
    }

    /// The folder for a report on `scene`, which can be written to; a run that writes into it now is waited for.
    ///
    /// # Errors
    /// Something else has its place, or another run does not end.
    pub fn report_folder(&self, scene: &Scene) -> Result<PathBuf, CliError> {
        let folder = self.folder(scene);
        let refused = |e: report::ReportError| CliError::stopped(Exit::BadInput, e.to_string(), "");
        report::folder::refuse(&folder, report::NAMES.into_iter().chain(report::tables_of(scene))).map_err(refused)?;
        report::folder::wait(&folder).map_err(|e| CliError::stopped(Exit::Failed, e.to_string(), ""))?;
        Ok(folder)
    }

    /// The folder for results called `name`.
    pub fn folder_named(&self, name: &str) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(name))
    }
}

/// How a comparison is judged.
#[derive(Debug, Clone, Args)]
pub struct JudgeOptions {
    /// Compare with the results stored in FILE; one for several scenes has a name that ends with .toml
    #[arg(long, value_name = "FILE")]
    pub baseline: Option<PathBuf>,
    /// Write the results to the baseline instead of comparing with it
    #[arg(long, requires = "baseline")]
    pub accept: bool,
    /// Who accepts, and why.
    #[command(flatten)]
    pub signature: SignatureOptions,
    /// Allow the check NAME a difference of VALUE; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    pub allow: Vec<Allowance>,
}

/// What a baseline says about those who accept it.
#[derive(Debug, Clone, Args)]
pub struct SignatureOptions {
    /// Write into the baseline why its numbers are accepted
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub reason: String,
    /// Write into the baseline who accepts its numbers [default: who runs this, as the environment tells]
    #[arg(long, value_name = "NAME")]
    pub accepted_by: Option<String>,
}

/// A tolerance from the command line.
#[derive(Debug, Clone, PartialEq)]
pub struct Allowance {
    /// Name of the check.
    pub name: String,
    /// Finite, not negative.
    pub value: f64,
}

impl FromStr for Allowance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Names of checks may contain names of boundaries, and those an equals sign; a value cannot.
        let (name, value) = text.rsplit_once('=').ok_or("write NAME=VALUE, for instance energy=1e-3")?;
        if name.is_empty() {
            return Err("the name before = is missing".to_owned());
        }
        let value = number(value)?;
        if value < 0.0 {
            return Err(format!("{value} is negative; a tolerance is zero or more"));
        }
        Ok(Allowance { name: name.to_owned(), value })
    }
}

/// The tolerance of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedTolerance {
    /// Its name.
    pub name: String,
    /// Finite, above zero.
    pub value: f64,
}

impl FromStr for NamedTolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = named(text, "tip=1e-3")?;
        Ok(NamedTolerance { name, value: as_tolerance(value)? })
    }
}

impl FromStr for GivenValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = named(text, "tip=0.8014")?;
        let written = text.split_once('=').map_or("", |(_, written)| written);
        Ok(GivenValue::written(name, value, written))
    }
}

/// NAME=NUMBER; names of quantities contain no equals sign.
fn named(text: &str, example: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or(format!("write NAME=X, for instance {example}"))?;
    if name.is_empty() {
        return Err("the name before = is missing".to_owned());
    }
    Ok((name.to_owned(), number(value)?))
}

fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("{text} is not finite")),
        Err(_) => Err(format!("\"{text}\" is not a number")),
    }
}

/// A finite number above zero.
pub(in crate::cli) fn positive(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > 0.0 { Ok(value) } else { Err(format!("{text} is not above zero")) }
}

/// A relative error: above zero, and at most one.
pub(in crate::cli) fn tolerance(text: &str) -> Result<f64, String> {
    as_tolerance(number(text)?)
}

/// A relative error that is a number already.
pub(in crate::cli) fn as_tolerance(value: f64) -> Result<f64, String> {
    if value <= 0.0 {
        return Err(format!("{value} is not above zero"));
    }
    if value > 1.0 {
        let [percent, meant] = [value * 100.0, value / 100.0].map(|number| significant(number, 6));
        return Err(format!("{value} would allow an error of {percent} %; write {meant} for {value} %"));
    }
    Ok(value)
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err("write a whole number, 1 or more".to_owned()),
    }
}
