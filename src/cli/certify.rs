//! `hypercircle certify`: somebody else's displacement field against the dual bound.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::given::Given;
use super::job::{self, JobOptions, Order, Own};
use super::options::{JudgeOptions, Limits, RunOptions, SolveOptions};
use super::session::{Particulars, Session};
use super::{CliError, Exit};
use crate::compare::{Comparison, compare};
use crate::problem::Note;
use crate::process::limit;
use crate::study::ForeignField;

/// What rounding to single precision can do to a penetration relative to the largest displacement: a coefficient of the
/// jump is a combination of six rounded values with weights that add up to six.
const SINGLE: f64 = 6.0 * f32::EPSILON as f64;

/// Options of `certify`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene files, and folders for the scenes in them: every .toml file but those without a table of a scene; folders below are
    /// not searched. Several scenes get a folder each, and one page for all
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// The displacement field, in any format that meshio reads; for several scenes also a folder with one for each, of the
    /// same name but for the ending
    #[arg(long, value_name = "FILE")]
    pub displacement: PathBuf,
    /// Name of the point data that is the displacement, where it is not displacement, u or disp
    #[arg(long, value_name = "NAME")]
    pub field: Option<String>,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveOptions,
    /// How to judge.
    #[command(flatten)]
    pub judge: JudgeOptions,
    /// How several scenes are run.
    #[command(flatten)]
    pub job: JobOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// Measures the field against the bound.
///
/// # Errors
/// The scene or the field is refused, or no answer can be given.
pub fn run(args: &Args, given: &Given) -> Result<Exit, CliError> {
    match args.scenes.as_slice() {
        [scene] if !args.job.are_job(&args.scenes) => one(args, scene),
        _ => several(args, given),
    }
}

fn several(args: &Args, given: &Given) -> Result<Exit, CliError> {
    job::run(&Order {
        command: "certify",
        scenes: &args.scenes,
        job: &args.job,
        given,
        threads: args.solve.threads,
        memory: &args.solve.memory,
        judge: Some(&args.judge),
        run: &args.run,
        own: &|scene| own(args, scene),
    })
}

fn one(args: &Args, scene: &Path) -> Result<Exit, CliError> {
    let session = Session::open("certify", scene, &args.solve, args.run.quiet, &args.job)?;
    refuse_refinement(&args.solve)?;
    let folder = args.run.report_folder(&session.scene)?;
    let refused = |e: crate::study::FieldError| CliError::stopped(Exit::BadInput, e.to_string(), "");
    session.progress.phase("reading the displacement");
    let start = Instant::now();
    let field = ForeignField::read(&args.displacement, args.field.as_deref(), limit(args.solve.reading_seconds))
        .map_err(refused)?;
    args.judge.refuse_early(&session.scene, &[&field.name()], &args.job)?;
    let reading = start.elapsed().as_secs_f64();
    let limits = Limits { max_triangles: None, max_seconds: None };
    let run = session.solve(&args.solve, &limits, &folder)?;
    let certified = &run.certified;
    let candidate = field.candidate(&certified.problem, reading).map_err(refused)?;

    session.progress.phase("comparing");
    let rounding = field.is_single_precision().then(|| (format!("admissible/{}", candidate.name), SINGLE));
    let allow = args.judge.allowances().after(rounding);
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, vec![candidate], &allow);
    args.judge.refuse_unknown(&allow, &comparison.checks, comparison.judged.is_empty(), &args.job)?;
    let (against, baseline) = args.judge.against_baseline(certified, &comparison, &allow, &args.job)?;
    comparison.checks.extend(against);
    let (sharpened, enough) = session.sharpen(&run, &mut comparison, &args.solve, &limits, &allow)?;
    let particulars = Particulars {
        sharpened,
        enough: Some(enough),
        notes: repairs(&comparison),
        seconds: vec![("reading the displacement", reading)],
        components: vec![(field.name(), format!("sha256:{}", field.sha256()))],
        failure: None,
        baseline,
    };
    session.conclude(run, &comparison, particulars, &folder)
}

/// The displacement of one scene among several: the file that was given, or that of the scene's name in the folder.
fn own(args: &Args, scene: &Path) -> Result<Own, CliError> {
    let file =
        if args.displacement.is_dir() { of_scene(&args.displacement, scene)? } else { args.displacement.clone() };
    let option = file.to_str().map(|file| format!("--displacement={file}")).ok_or_else(|| {
        CliError::stopped(Exit::BadInput, format!("the name of {} is not Unicode", file.display()), "rename the file")
    })?;
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Own { options: vec![option], files: vec![file], fields: vec![name] })
}

/// The one file in `folder` that has the name of the scene.
fn of_scene(folder: &Path, scene: &Path) -> Result<PathBuf, CliError> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.is_file() && file.file_stem() == scene.file_stem());
    if let [file] = files.as_slice() {
        return Ok(file.clone());
    }
    let name = scene.file_stem().unwrap_or_default().to_string_lossy();
    let found = if files.is_empty() { "no file" } else { "more than one file" };
    Err(CliError::stopped(
        Exit::BadInput,
        format!("{} has {found} named {name} and an ending, for the scene {}", folder.display(), scene.display()),
        "give each scene one displacement of its name, or certify the scenes one by one",
    ))
}

/// A field lives on its own mesh, so there is nothing to refine.
fn refuse_refinement(solve: &SolveOptions) -> Result<(), CliError> {
    let option = match (solve.refine, solve.tolerance) {
        (0, None) => return Ok(()),
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
