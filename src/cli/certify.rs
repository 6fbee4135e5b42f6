//! `hypercircle certify`: somebody else's displacement field against the dual bound.

use std::path::PathBuf;
use std::time::Instant;

use clap::ArgGroup;

use super::options::{JudgeOptions, Limits, RunOptions, SolveOptions};
use super::session::{Particulars, Session};
use super::values::ValueOptions;
use super::{CliError, Exit};
use crate::compare::{Comparison, compare};
use crate::problem::Note;
use crate::process::limit;
use crate::study::{Claim, ForeignField, GivenValue, quantity_checks, value_checks, wanted_checks};

/// What rounding to single precision can do to a penetration relative to the largest displacement: a coefficient of the
/// jump is a combination of six rounded values with weights that add up to six.
const SINGLE: f64 = 6.0 * f32::EPSILON as f64;

/// Options of `certify`.
#[derive(Debug, clap::Args)]
#[command(group = ArgGroup::new("claim").required(true).multiple(true).args(["displacement", "value", "values"]))]
pub struct Args {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// The displacement field, in any format that meshio reads
    #[arg(long, value_name = "FILE")]
    pub displacement: Option<PathBuf>,
    /// Values without a field.
    #[command(flatten)]
    pub values: ValueOptions,
    /// Name of the point data that is the displacement, where it is not displacement, u or disp
    #[arg(long, value_name = "NAME")]
    pub field: Option<String>,
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
/// The scene or the field is refused, or no answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let session = Session::open("certify", &args.scene, &args.solve, args.run.quiet)?;
    let given = args.values.all()?;
    session.refuse_unknown_quantities(given.iter().map(|value| value.name.as_str()))?;
    let Some(displacement) = &args.displacement else { return values_alone(args, &session, &given) };
    refuse_refinement(&args.solve)?;
    let folder = args.run.report_folder(&session.scene)?;
    let refused = |e: crate::study::FieldError| CliError::stopped(Exit::BadInput, e.to_string(), "");
    session.progress.phase("reading the displacement");
    let start = Instant::now();
    let field =
        ForeignField::read(displacement, args.field.as_deref(), limit(args.solve.reading_seconds)).map_err(refused)?;
    args.judge.refuse_early(&session.scene, &[&field.name()])?;
    let reading = start.elapsed().as_secs_f64();
    let limits = Limits { max_triangles: None, max_seconds: None };
    let run = session.solve(&args.solve, &limits, &folder)?;
    let certified = &run.certified;
    let candidate = field.candidate(&certified.problem, reading).map_err(refused)?;

    session.progress.phase("comparing");
    let rounding = field.is_single_precision().then(|| (format!("admissible/{}", candidate.name), SINGLE));
    let allow = args.judge.allowances().after(rounding);
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, vec![candidate], &allow);
    let answers = session.answers(&run, &args.solve);
    comparison.checks.extend(quantity_checks(certified, &answers, &comparison, Claim::Exact, &allow));
    comparison.checks.extend(value_checks(&answers, &given, &allow));
    args.judge.refuse_unknown(&allow, &comparison.checks, comparison.judged.is_empty())?;
    let baseline = args.judge.against_baseline(certified, &comparison, &allow)?;
    comparison.checks.extend(baseline);
    let (sharpened, enough) = session.sharpen(&run, &mut comparison, &args.solve, &limits, &allow)?;
    let particulars = Particulars {
        sharpened,
        enough: Some(enough),
        answers,
        notes: repairs(&comparison),
        seconds: vec![("reading the displacement", reading)],
        components: vec![(field.name(), format!("sha256:{}", field.sha256()))],
        failure: None,
    };
    session.conclude(run, &comparison, particulars, &folder)
}

/// Holds values against the intervals where there is no field.
fn values_alone(args: &Args, session: &Session, given: &[GivenValue]) -> Result<Exit, CliError> {
    let folder = args.run.report_folder(&session.scene)?;
    args.judge.refuse_early(&session.scene, &[])?;
    let run = session.solve(&args.solve, &Limits { max_triangles: None, max_seconds: None }, &folder)?;
    let (certified, allow) = (&run.certified, args.judge.allowances());
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, Vec::new(), &allow);
    let answers = session.answers(&run, &args.solve);
    comparison.checks.extend(wanted_checks(&answers, &args.solve.wanted(), &allow));
    comparison.checks.extend(value_checks(&answers, given, &allow));
    args.judge.refuse_unknown(&allow, &comparison.checks, false)?;
    let baseline = args.judge.against_baseline(certified, &comparison, &allow)?;
    comparison.checks.extend(baseline);
    session.conclude(run, &comparison, Particulars { answers, ..Particulars::default() }, &folder)
}

/// A field lives on its own mesh, so there is nothing to refine.
fn refuse_refinement(solve: &SolveOptions) -> Result<(), CliError> {
    let option = match (solve.refine, solve.tolerance) {
        (0, None) if solve.tolerance_of.is_empty() => return Ok(()),
        (0, None) => "--tolerance-of",
        (0, Some(_)) => "--tolerance",
        _ => "--refine",
    };
    Err(CliError::stopped(
        Exit::BadInput,
        format!("{option} changes the mesh, and a displacement field is certified on the mesh it comes with"),
        format!("leave {option} out; refine in the program that makes the field, and certify what it then writes"),
    ))
}

/// What was done to fields that are not admissible.
fn repairs(comparison: &Comparison) -> Vec<Note> {
    let inadmissible = comparison.judged.iter().filter(|j| !j.is_admissible());
    inadmissible
        .map(|j| Note {
            weakens_guarantee: false,
            text: format!(
                "{} misses the supports by {:.2e} and penetrates by {:.2e}, relative to its largest displacement. Its own \
                 energy {:.8e} is no upper bound; the bound of this report belongs to the nearest admissible field, with \
                 the energy {:.8e}.",
                j.candidate.name,
                j.violation.support,
                j.violation.penetration,
                j.field.potential.total(),
                j.admissible.potential.total()
            ),
        })
        .collect()
}
