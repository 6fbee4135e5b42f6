//! `hypercircle certify`: somebody else's displacement field against the dual bound.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ArgGroup;

use super::job::{self, JobOptions, Order, Own};
use crate::cli::conclude::Particulars;
use crate::cli::given::Given;
use crate::cli::given::options::{JudgeOptions, Limits, ProofOptions, RunOptions, SolveOptions};
use crate::cli::given::revolved::{Claims, refuse_claims};
use crate::cli::given::values::ValueOptions;
use crate::cli::session::{DualRun, Session, refuse_unknown};
use crate::cli::{CliError, Exit};
use crate::compare::name::OfField;
use crate::compare::{Basis, Candidate, Comparison, compare};
use crate::problem::{Note, Problem};
use crate::process::limit;
use crate::study::{
    self, FieldError, ForeignField, GivenValue, quantity_checks, tolerance_check, value_checks, wanted_checks,
};

/// How contact of a field is claimed to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ContactClaim {
    /// In the mean over edges
    Weak,
}

/// Options of `certify`.
#[derive(Debug, clap::Args)]
#[command(group = ArgGroup::new("claim").required(true).multiple(true).args(["displacement", "value", "values"]))]
pub struct Args {
    /// Scene files, and folders for the scenes in them: every .toml file but those without a table of a scene; folders below are
    /// not searched. Several scenes get a folder each, and one page for all
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// The displacement field, in any format that meshio reads; may be repeated, for one file a body; for several scenes also a
    /// folder with one for each, of the same name but for the ending
    #[arg(long, value_name = "FILE")]
    pub displacement: Vec<PathBuf>,
    /// Values without a field.
    #[command(flatten)]
    pub values: ValueOptions,
    /// Name of the point data that is the displacement, where it is not displacement, u or disp, nor two arrays such as ux and uy
    #[arg(long, value_name = "NAME", requires = "displacement")]
    pub field: Option<String>,
    /// Claim that the field is the discrete solution of a displacement method on this mesh, and hold it to that
    #[arg(long, requires = "displacement")]
    pub solution: bool,
    /// Claim that contact holds in the mean over edges, as mortar and Nitsche methods have it: what nodes then penetrate is a
    /// remark
    #[arg(long, value_enum, value_name = "HOW", requires = "displacement")]
    pub contact: Option<ContactClaim>,
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
}

/// Measures the field against the bound.
///
/// # Errors
/// The scene or the field is refused, or no answer can be given.
pub fn run(args: &Args, given: &Given) -> Result<Exit, CliError> {
    args.solve.say_unheard(&args.limits, args.run.quiet);
    let order = Order {
        command: "certify",
        scenes: &args.scenes,
        job: &args.job,
        given,
        threads: args.solve.threads,
        memory: &args.solve.memory,
        judge: Some(&args.judge),
        run: &args.run,
        own: &|scene| own(args, scene),
    };
    job::run(&order, |scene| one(args, scene))
}

fn one(args: &Args, scene: &Path) -> Result<Exit, CliError> {
    let mut session = Session::open("certify", scene, &args.solve, args.run.quiet, &args.job)?;
    args.proof.refuse_early(&session)?;
    let given = args.values.all(&mut session.scene)?;
    let wanted = args.solve.tolerance_of.iter().map(|of| of.name.as_str());
    refuse_unknown(&session.scene, given.iter().map(|value| value.name.as_str()).chain(wanted))?;
    let has_field = !args.displacement.is_empty();
    if has_field {
        refuse_refinement(&args.solve)?;
    }
    let folder = args.run.report_folder(&session.scene)?;
    let start = Instant::now();
    let field = if has_field { Some(read(args, &session)?) } else { None };
    let reading = start.elapsed().as_secs_f64();
    args.judge.refuse_early(&session.scene, Some(field.iter().map(ForeignField::name).collect()), &args.job)?;
    let run = session.solve(&stress_side(args, has_field), &args.limits, Some(&folder))?;
    let (comparison, particulars) = judged(args, &session, &run, field.as_ref(), &given, reading)?;
    let exit = session.conclude(&run, &comparison, particulars, &folder)?;
    args.judge.say_accepted(args.run.quiet, &args.job);
    Ok(exit)
}

/// How the stress side is solved. A field belongs to the mesh as given: what is refined is the stress side alone, afterwards.
pub fn stress_side(args: &Args, has_field: bool) -> SolveOptions {
    match has_field {
        true => SolveOptions { tolerance: None, tolerance_of: Vec::new(), ..args.solve.clone() },
        false => args.solve.clone(),
    }
}

/// Holds `field`, which is a displacement on the mesh of `run`, and `given` values against the bounds of `run`. The field took
/// `reading` seconds.
///
/// # Errors
/// The field does not fit the mesh, an option names what is not there, or no answer can be given.
pub fn judged(
    args: &Args,
    session: &Session,
    run: &DualRun,
    field: Option<&ForeignField>,
    given: &[GivenValue],
    reading: f64,
) -> Result<(Comparison, Particulars), CliError> {
    match field {
        Some(field) => held(args, session, run, field, given, reading),
        None => values_held(args, session, run, given),
    }
}

/// A field, and values beside it.
fn held(
    args: &Args,
    session: &Session,
    run: &DualRun,
    field: &ForeignField,
    given: &[GivenValue],
    reading: f64,
) -> Result<(Comparison, Particulars), CliError> {
    let certified = &run.certified;
    if certified.problem.has_friction() && args.contact.is_some() {
        let what = "--contact weak: the law of contact in the mean is not told apart from friction";
        return Err(CliError::stopped(Exit::BadInput, what, "leave --contact weak out, or `friction` of the scene"));
    }
    let (candidate, rounded) = field.matched(&certified.problem, reading).map_err(refused)?;

    let before = if args.solution { before_contact(&certified.problem, &candidate, field)? } else { None };
    let is_of_calculix = args.solution && field.is_of_calculix();
    refuse_claims(
        &certified.problem,
        Claims { weak: args.contact.is_some(), is_cut: before.is_some(), is_of_calculix },
    )?;
    session.progress.phase("comparing");
    let allow = args.judge.allowances();
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, vec![candidate], &allow);
    let mut claimed = None;
    if let (true, Some(judged)) = (args.solution, comparison.judged.first()) {
        session.progress.phase("holding the field to its claim");
        let (problem, bracket) = (&certified.problem, &certified.bracket);
        let weak = args.contact.is_some();
        let claim = match &before {
            None => study::claim(problem, judged, bracket, weak, &allow),
            Some((before, own)) => study::claim_before_contact(problem, (before, own), judged, bracket, weak, &allow),
        };
        let claim = claim.map_err(|e| CliError::stopped(Exit::BadInput, e.to_string(), ""))?;
        // Supports and penetration have checks of their own, with the accuracy of a solver and their place.
        let admissible = OfField::Admissible.of(&judged.candidate.name);
        comparison.checks.retain(|check| check.name != admissible);
        comparison.checks.extend(claim.checks.iter().cloned());
        claimed = Some(claim);
    }
    let mut in_the_mean = Vec::new();
    if let (true, false, Some(judged)) = (args.contact.is_some(), args.solution, comparison.judged.first()) {
        let admissible = OfField::Admissible.of(&judged.candidate.name);
        let notes = study::weak_contact(&certified.problem, judged);
        let check = comparison.checks.iter_mut().find(|check| check.name == admissible);
        if let (Some(notes), Some(check)) = (notes, check.filter(|check| allow.given(&check.name).is_none())) {
            check.basis = Basis::Chosen;
            in_the_mean = notes;
        }
    }
    in_the_mean.extend(claimed.iter().flat_map(|claim| claim.notes.clone()));
    let (sharpened, enough) = session.sharpen(run, &mut comparison, &args.solve, &args.limits, &allow)?;
    if let Some(wanted) = args.solve.tolerance {
        let sharpest = sharpened.as_ref().map_or(certified, |finer| &finer.certified);
        comparison.checks.push(tolerance_check(sharpest, &comparison, wanted, &allow));
    }
    // The field has its values on its own mesh, intervals come from the finest one.
    let sharpest = sharpened.as_ref().map_or(certified, |finer| &finer.certified);
    if let (true, Some(judged)) = (args.solution, comparison.judged.first()) {
        let check = study::error_check(judged, &sharpest.bracket, &allow);
        comparison.checks.push(check);
    }
    let answers = session.sharpest_answers(run, sharpened.as_ref(), &args.solve);
    comparison.checks.extend(wanted_checks(certified, &answers, &args.solve.wanted(), &allow));
    comparison.checks.extend(quantity_checks(certified, &sharpest.bracket, &answers, &comparison, &allow));
    comparison.checks.extend(value_checks(certified, &answers, given, &allow));
    args.judge.refuse_unknown(&allow, &comparison.checks, comparison.judged.is_empty(), &args.job)?;
    let (against, baseline) = args.judge.against_baseline(certified, &comparison, &answers, &allow, &args.job)?;
    comparison.checks.extend(against);
    let particulars = Particulars {
        sharpened,
        enough: Some(enough),
        answers,
        notes: repairs(&comparison).into_iter().chain(rounded).chain(in_the_mean).collect(),
        seconds: vec![("reading the displacement", reading)],
        components: vec![(field.name(), format!("sha256:{}", field.sha256()))],
        diagnosis: claimed.iter().filter_map(|claim| claim.diagnosis.clone()).collect(),
        residual: claimed.map(|claim| claim.residual),
        failure: None,
        baseline,
        is_to_prove: args.proof.proof,
    };
    Ok((comparison, particulars))
}

/// The field in the files of the command line.
///
/// # Errors
/// One cannot be read.
pub fn read(args: &Args, session: &Session) -> Result<ForeignField, CliError> {
    session.progress.phase("reading the displacement");
    let read = |file: &PathBuf| {
        ForeignField::read(file, args.field.as_deref(), limit(args.solve.reading_seconds)).map_err(refused)
    };
    let mut parts = args.displacement.iter().map(read);
    let first = parts.next().ok_or_else(|| CliError::stopped(Exit::BadInput, "no --displacement was given", ""))??;
    parts.try_fold(first, |field, part| Ok(field.and(part?)))
}

fn refused(error: FieldError) -> CliError {
    CliError::stopped(Exit::BadInput, error.to_string(), "")
}

/// The displacements of one scene among several: the files that were given, or those of the scene's name in the folders.
fn own(args: &Args, scene: &Path) -> Result<Own, CliError> {
    let mut own = Own::default();
    for given in &args.displacement {
        let file = if given.is_dir() { of_scene(given, scene)? } else { given.clone() };
        let option = file.to_str().map(|file| format!("--displacement={file}")).ok_or_else(|| {
            let what = format!("the name of {} is not Unicode", file.display());
            CliError::stopped(Exit::BadInput, what, "rename the file")
        })?;
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned());
        own.fields.get_or_insert_default().push(name.unwrap_or_default());
        own.options.push(option);
        own.files.push(file);
    }
    own.files.extend(args.values.values.clone());
    Ok(own)
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

/// Values without a field.
fn values_held(
    args: &Args,
    session: &Session,
    run: &DualRun,
    given: &[GivenValue],
) -> Result<(Comparison, Particulars), CliError> {
    let (certified, allow) = (&run.certified, args.judge.allowances());
    let mut comparison = compare(&certified.problem, &certified.dual, &certified.bracket, Vec::new(), &allow);
    let answers = session.answers(certified, &args.solve);
    comparison.checks.extend(wanted_checks(certified, &answers, &args.solve.wanted(), &allow));
    comparison.checks.extend(value_checks(certified, &answers, given, &allow));
    args.judge.refuse_unknown(&allow, &comparison.checks, false, &args.job)?;
    let (against, baseline) = args.judge.against_baseline(certified, &comparison, &answers, &allow, &args.job)?;
    comparison.checks.extend(against);
    Ok((comparison, Particulars { answers, baseline, is_to_prove: args.proof.proof, ..Particulars::default() }))
}

/// The problem and the field on the triangles of its file, where contact cut some of these: a claim is held there. `None` where the
/// field is on the mesh of `problem`.
///
/// # Errors
/// The field is on triangles that are neither.
fn before_contact(
    problem: &Problem,
    candidate: &Candidate,
    field: &ForeignField,
) -> Result<Option<(Problem, Candidate)>, CliError> {
    if candidate.numbering.as_ref().is_some_and(|numbering| numbering.uncut) {
        if problem.has_friction() {
            let what = "--solution: contact with friction between sides of unlike meshes is not held to a claim";
            let help = "leave --solution out, or mesh both sides with the same points";
            return Err(CliError::stopped(Exit::BadInput, what, help));
        }
        let help = "along a bond of unlike meshes the claim to be a discrete solution cannot be held: leave out --solution, or mesh both \
                    sides with the same points";
        let help = if problem.scene.bonds.is_empty() { "" } else { help };
        let before = problem.before_contact().map_err(|e| CliError::stopped(Exit::BadInput, e.to_string(), help))?;
        let with_field = |before: Problem| field.candidate(&before, 0.0).map(|own| (before, own));
        return before.map(with_field).transpose().map_err(refused);
    }
    refuse_inserted(candidate, field)?;
    Ok(None)
}

/// On a mesh into whose edges contacts have put vertices a field on larger triangles is no discrete solution.
fn refuse_inserted(candidate: &Candidate, field: &ForeignField) -> Result<(), CliError> {
    let whole = !candidate.cells.is_empty() && candidate.cells.iter().all(|cell| !cell.nodes.is_empty());
    let inside = candidate.degree == 2 && !whole;
    let nodes = candidate.vertex.len() + if inside { candidate.middle.len() } else { 0 };
    let known = candidate.numbering.iter().flat_map(|n| &n.nodes).take(nodes).all(Option::is_some);
    if known {
        return Ok(());
    }
    Err(CliError::stopped(
        Exit::BadInput,
        format!(
            "--solution: vertices that contacts or gaps need are no points of {}, whose triangles are cut there; the field is no discrete \
             solution of the mesh that is left",
            field.name()
        ),
        "give both sides of every contact the same vertices, and kinks of the gap one, in the mesh that both programs use; or leave \
         --solution out",
    ))
}

/// A field lives on its own mesh: there is nothing to refine uniformly.
fn refuse_refinement(solve: &SolveOptions) -> Result<(), CliError> {
    if solve.refine == 0 {
        return Ok(());
    }
    Err(CliError::stopped(
        Exit::BadInput,
        "--refine changes the mesh, and a displacement field is certified on the mesh it comes with",
        "leave --refine out: --tolerance refines the stresses alone and keeps the field; to refine the field, do so in the program that \
         makes it, and certify what it then writes",
    ))
}

/// Notes on the repair of fields that are not admissible.
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
