//! Steps that the solving commands share: from the scene file to a bracket, and from a dossier to files and a verdict.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::commands::job::JobOptions;
use super::given::friction::refuse_ranges;
use super::given::memory::{COARSER, enough, too_fine};
use super::given::options::{Engine, EngineOptions, Limits, SolveOptions};
use super::given::threads;
use super::words::ci;
use super::words::progress::Progress;
use super::{CliError, Exit, program};
use crate::budget::Budget;
use crate::compare::name::OfRun;
use crate::compare::{Allowances, BLUNT, Comparison, SHARP};
use crate::dual::{DualError, DualMethod, Options, Petsc, Size};
use crate::element::{Elements, block};
use crate::mesh;
use crate::problem::{Problem, ProblemError, follows_coulomb};
use crate::process::{end_with_parent, limit};
use crate::report::{self, HistoryRow};
use crate::scene::{MeshSource, Normals, Scene};
use crate::study;
use crate::study::outlook;
use crate::study::{Adapted, Admission, Answer, Certified, Coulomb, Goal, OtherEnd, Sharpened, StudyError};

/// A scene on its way through a command.
pub struct Session {
    /// The scene.
    pub scene: Scene,
    /// Sign of life.
    pub progress: Progress,
    /// When the command started.
    pub start: Instant,
    /// Name of the command.
    pub command: &'static str,
    /// True if only errors are to be printed.
    pub(super) quiet: bool,
    /// Identifier of the run, where the job that it is part of gave it one.
    pub(super) run: Option<String>,
    /// Threads to use.
    pub(super) threads: usize,
    budget: Budget,
}

/// The dual side of a command.
pub struct DualRun {
    /// Problem, solution and bracket.
    pub certified: Certified,
    /// Mesh by mesh, where the mesh was refined adaptively.
    pub history: Vec<HistoryRow>,
    /// Why refinement stopped before the tolerance was reached.
    pub stopped: Option<String>,
    /// The remedy for that.
    pub advice: Option<&'static str>,
    /// The scene of the other ends of ranges of the data, solved.
    pub other_end: Option<OtherEnd>,
    /// How the bound of Coulomb friction was found, where there is any.
    pub coulomb: Option<Coulomb>,
}

impl Session {
    /// Reads the scene.
    ///
    /// # Errors
    /// The scene is refused.
    pub fn open(
        command: &'static str,
        scene: &Path,
        solve: &SolveOptions,
        quiet: bool,
        job: &JobOptions,
    ) -> Result<Self, CliError> {
        let start = Instant::now();
        if job.is_part() {
            end_with_parent();
        }
        if command != "verify" && solve.engine.ranks.is_some() && solve.engine.engine.is_none() {
            let what = "--ranks without --engine: nothing here runs over MPI";
            return Err(CliError::stopped(Exit::BadInput, what, "add --engine petsc, or leave --ranks out"));
        }
        let scene = Scene::read(scene)?;
        let threads = threads::start(solve.threads);
        let session = Session::new(command, scene, threads, solve, quiet)?;
        Ok(Session { start, run: job.part.clone(), ..session })
    }

    /// Begins with a scene that was read, for a caller that has `threads` threads of its own.
    ///
    /// # Errors
    /// Less memory may be taken than any run needs.
    pub fn new(
        command: &'static str,
        scene: Scene,
        threads: usize,
        solve: &SolveOptions,
        quiet: bool,
    ) -> Result<Self, CliError> {
        refuse_ranges(&scene)?;
        let budget = enough(solve.memory.budget(threads))?;
        let (start, progress) = (Instant::now(), Progress::new(quiet));
        Ok(Session { scene, progress, start, command, quiet, run: None, threads, budget })
    }

    /// Meshes the scene and solves the dual problem; a scene without equilibrium is reported into `folder`, where there is
    /// one.
    ///
    /// # Errors
    /// Bad input, a solver that failed, or no equilibrium.
    pub fn solve(&self, solve: &SolveOptions, limits: &Limits, folder: Option<&Path>) -> Result<DualRun, CliError> {
        refuse_unknown(&self.scene, solve.tolerance_of.iter().map(|of| of.name.as_str()))?;
        self.refuse_ranges()?;
        solve.refuse_degrees_of_uzawa()?;
        self.progress.phase("reading the mesh");
        // Quantities and finer meshes begin with what an upper bound in this process leaves.
        let alone = solve.is_adaptive() || !self.scene.quantities.is_empty();
        let method = dual_method(solve, if alone { None } else { program() });
        let admission = Admission::new(method.as_ref(), self.budget);
        let given = self.problem(solve, &admission)?;
        let problem = self.refined(&given, solve)?;
        let read = self.start.elapsed().as_secs_f64();
        let phase = |triangles: usize| self.progress.phase(format!("solving in stresses on {triangles} triangles"));
        phase(problem.mesh.triangles.len());
        let mut options = self.options(solve);
        if method.wants_guess() && solve.elements.is_none() {
            options.closed = study::guess_refined(&given, solve.refine as usize, &problem, &options);
        }
        drop(given);
        // A displacement that is handed in belongs to the mesh as given.
        let certify = if self.command == "certify" { study::certify } else { study::certify_divided };
        let adapt = |problem, options: &Options, max_seconds: Option<f64>| {
            let limits = &Limits { max_seconds, ..*limits };
            self.adapted(problem, (method.as_ref(), options), &admission, (solve, limits))
        };
        let (adapted, coulomb) = if follows_coulomb(&problem.scene) {
            let told = |text: &str| self.progress.phase(text.to_string());
            study::solve_coulomb_to(
                (solve.tolerance, limits.max_seconds),
                problem,
                (method.as_ref(), &options),
                certify,
                adapt,
                told,
            )
            .map(|(adapted, coulomb)| (adapted, Some(coulomb)))
        } else if solve.is_adaptive() {
            adapt(problem, &options, limits.max_seconds).map(|adapted| (adapted, None))
        } else {
            certify(problem, method.as_ref(), &options).map(|certified| (Adapted::only(certified), None))
        }
        .map_err(|error| self.refuse(error, folder))?;
        let Adapted { certified, history, stopped, advice } = adapted;
        let mut run = DualRun { certified, history, stopped, advice, other_end: None, coulomb };
        run.certified.dual.seconds.read = read;
        if let Some(scene) = self.scene.of_highest_energy() {
            self.progress.phase("solving for the other ends of the ranges");
            let progress = Progress::new(self.quiet);
            let other = Session { scene, progress, run: None, ..*self };
            // Quantities are bounded for the scene itself.
            run.other_end = Some(OtherEnd::of(&other.solve(solve, limits, folder)?.certified));
        }
        Ok(run)
    }

    /// Refines `problem` until what was asked for is reached.
    fn adapted(
        &self,
        problem: Problem,
        (method, options): (&dyn DualMethod, &Options),
        admission: &Admission,
        (solve, limits): (&SolveOptions, &Limits),
    ) -> Result<Adapted, StudyError> {
        let Limits { max_triangles, max_seconds } = *limits;
        let tolerance = solve.tolerance.unwrap_or(f64::INFINITY);
        let adapt = solve.adapt();
        let goal = Goal { max_triangles, max_seconds, adapt, wanted: solve.wanted(), ..Goal::new(tolerance) };
        let first = Size::of(&problem);
        let (mut rows, mut warned) = (Vec::new(), false);
        let told = |row: &HistoryRow| {
            let bound = 100.0 * row.relative_error_bound;
            let mut text = format!("{} triangles: guaranteed error {bound:.3} %, refining", row.triangles);
            rows.push(*row);
            if let Some(pace) = outlook(&rows, &goal, admission, first.grown(row.triangles as f64)) {
                if !std::mem::replace(&mut warned, true) {
                    self.progress.remark(&format!("{} triangles: {pace}", row.triangles));
                }
                text = format!("{text}; {pace}");
            }
            self.progress.phase(text);
        };
        study::adapt(problem, method, options, &goal, told)
    }

    /// Refuses a scene with ranges of data where one field is held against one scene.
    fn refuse_ranges(&self) -> Result<(), CliError> {
        let Some(range) = self.scene.ranges.first().filter(|_| self.command == "certify") else { return Ok(()) };
        let message = format!(
            "{}: {} is a range, and a field or a value from elsewhere belongs to one scene",
            self.scene.path.display(),
            self.scene.name_of(range)
        );
        let remedy = "write the number that it was computed with";
        Err(CliError::stopped(Exit::BadInput, message, remedy))
    }

    /// The intervals of the quantities of the scene, from a problem that was solved.
    pub fn answers(&self, certified: &Certified, solve: &SolveOptions) -> Vec<Answer> {
        if self.scene.quantities.is_empty() {
            return Vec::new();
        }
        self.progress.phase("bounding the quantities");
        study::answers(certified, &self.options(solve), |_| true)
    }

    /// As [`Self::answers`], where the stress side was `sharpened` after it was solved: the interval of the mesh as given, and that of the
    /// finer one, hold the same value.
    pub fn sharpest_answers(&self, run: &DualRun, sharpened: Option<&Sharpened>, solve: &SolveOptions) -> Vec<Answer> {
        let own = self.answers(&run.certified, solve);
        match sharpened {
            Some(finer) => study::sharper(own, &self.answers(&finer.certified, solve)),
            None => own,
        }
    }

    fn options(&self, solve: &SolveOptions) -> Options {
        let degree = solve.degree.unwrap_or(1) as usize;
        let elements = solve.elements.clone().unwrap_or_else(|| Elements::Uniform(block(degree)));
        let keep_factor = !self.scene.quantities.is_empty();
        Options { elements, threads: self.threads, keep_factor, budget: self.budget, ..Options::default() }
    }

    fn problem(&self, solve: &SolveOptions, admission: &Admission<'_>) -> Result<Problem, CliError> {
        let load = |scene: Scene| {
            if let Some(triangles) = mesh::expected_triangles(&scene) {
                let size = Size { triangles, distinct: triangles, contact_ends: 0.0 };
                let cause = match &scene.mesh {
                    MeshSource::Geometry { size: Some(size), .. } => format!("geometry.size = {size:?}"),
                    _ => "geometry.polygons".to_string(),
                };
                admission.admit(size, None).map_err(|excess| too_fine(&scene, &cause, triangles, excess))?;
            }
            Problem::load_within(scene, limit(solve.reading_seconds)).map_err(|e| self.unreadable(&e))
        };
        let problem =
            if solve.is_adaptive() { Problem::to_refine(&self.scene, load) } else { load(self.scene.clone()) }?;
        study::refuse_quantities(&problem)
            .and_then(|()| study::refuse_wanted(&problem, &solve.wanted()))
            .map_err(|why| CliError::stopped(Exit::BadInput, format!("{}: {why}", self.scene.path.display()), ""))?;
        if solve.refine > 0 {
            let size = Size::of(&problem).refined(solve.refine);
            let cause = format!("--refine {}", solve.refine);
            admission.admit(size, None).map_err(|excess| too_fine(&self.scene, &cause, size.triangles, excess))?;
        }
        Ok(problem)
    }

    /// The problem to be solved: `given` with its mesh refined uniformly.
    fn refined(&self, given: &Problem, solve: &SolveOptions) -> Result<Problem, CliError> {
        let problem = given.refine_uniform(solve.refine as usize).map_err(|e| self.unreadable(&e))?;
        let triangles = problem.mesh.triangles.len();
        if let Some(Elements::Blocks(degrees)) = &solve.elements
            && degrees.len() != triangles
        {
            let what = format!("{} degrees for {triangles} triangles", degrees.len());
            return Err(CliError::stopped(
                Exit::BadInput,
                what,
                "give one degree for each triangle of the mesh that is solved on",
            ));
        }
        Ok(problem)
    }

    fn unreadable(&self, error: &ProblemError) -> CliError {
        // Where a mesh is made of the scene, its error names the scene already.
        let (path, text) = (self.scene.path.display().to_string(), error.to_string());
        let text = if text.starts_with(&path) { text } else { format!("{path}: {text}") };
        CliError::stopped(Exit::BadInput, text, "")
    }

    fn refuse(&self, error: StudyError, folder: Option<&Path>) -> CliError {
        /// What to do where nothing holds a body.
        const HOLD: &str = "hold the body with a support, or change the load";
        let message = format!("{}: {error}", self.scene.path.display());
        match error {
            StudyError::NoEquilibrium { sentence, motion, problem, .. } => {
                let Some(folder) = folder else { return CliError::stopped(Exit::NoEquilibrium, message, HOLD) };
                let mut dossier = study::infeasible(self.command, &problem, &sentence, motion, self.threads);
                self.sign(&mut dossier);
                ci::report(&dossier.report, &self.scene.path);
                if let Err(error) = report::write(&dossier, folder) {
                    return CliError::stopped(Exit::Failed, error.to_string(), "");
                }
                let remedy = format!("see {}, or hold the body with a support", folder.join("report.html").display());
                CliError::stopped(Exit::NoEquilibrium, message, remedy)
            }
            StudyError::BeyondMesh { .. } => {
                let finer = if self.command == "certify" {
                    "refine the mesh, and hand in a displacement of the finer one"
                } else {
                    "refine the mesh, for instance with --refine or --tolerance"
                };
                let facets = self.scene.contacts.iter().find(|contact| contact.normals == Normals::Facets);
                let remedy = facets.map_or(finer.to_string(), |contact| {
                    format!(
                        "{finer}; where the facets of {} keep two bodies from turning that a curve would let turn, write \
                         normals = \"smooth\" there",
                        contact.name()
                    )
                });
                CliError::stopped(Exit::Failed, message, remedy)
            }
            StudyError::Dual(DualError::Infeasible { .. }) => CliError::stopped(Exit::NoEquilibrium, message, HOLD),
            StudyError::Dual(DualError::NotInstalled(_)) => CliError::stopped(Exit::NotInstalled, message, ""),
            StudyError::Dual(DualError::TooLarge { .. }) => CliError::stopped(Exit::Failed, message, COARSER),
            StudyError::Mesh(_) | StudyError::Contradiction(_) | StudyError::Dual(DualError::NotExpressible { .. }) => {
                CliError::stopped(Exit::BadInput, message, "")
            }
            StudyError::Coulomb(_) | StudyError::Statics(_) | StudyError::Dual(_) => {
                CliError::stopped(Exit::Failed, message, "")
            }
        }
    }

    /// Refines the stress side until its bracket can tell the models of `comparison` apart, and holds them against it.
    ///
    /// # Errors
    /// None that solving on the first mesh did not have.
    pub fn sharpen(
        &self,
        run: &DualRun,
        comparison: &mut Comparison,
        solve: &SolveOptions,
        limits: &Limits,
        allow: &Allowances,
    ) -> Result<(Option<Sharpened>, f64), CliError> {
        let asked = allow.given(OfRun::Sharpness.name());
        // Where a field was handed in, refining the stresses is all that a tolerance can ask for, for as long as it takes.
        let wanted = solve.tolerance.filter(|_| self.command == "certify");
        let (aim, enough) = (wanted.or(asked).unwrap_or(SHARP), asked.unwrap_or(BLUNT));
        let Limits { max_triangles, max_seconds } = *limits;
        // A run without a field has refined towards its quantities before.
        let quantities = if self.command == "certify" { solve.wanted() } else { Vec::new() };
        let patient = wanted.is_some() || !quantities.is_empty();
        let max_seconds = max_seconds.or(patient.then_some(f64::INFINITY));
        let goal = Goal { max_triangles, max_seconds, wanted: quantities, ..Goal::new(aim) };
        let told = |row: &HistoryRow| {
            let bound = 100.0 * row.relative_error_bound;
            self.progress
                .phase(format!("{} triangles: guaranteed error {bound:.3} %, refining to tell", row.triangles));
        };
        let method = dual_method(solve, None);
        let options = match patient {
            true => self.options(&SolveOptions { tolerance: None, tolerance_of: Vec::new(), ..solve.clone() }),
            false => self.options(solve),
        };
        let sharpened = study::sharpen(&run.certified, comparison, method.as_ref(), &options, goal, told)
            .map_err(|error| CliError::stopped(Exit::Failed, format!("{}: {error}", self.scene.path.display()), ""))?;
        if let Some(finer) = &sharpened {
            comparison.against_finer(&finer.certified.bracket, allow);
        }
        Ok((sharpened, enough))
    }
}

/// Refuses names that no quantity of the scene has.
///
/// # Errors
/// The first of them.
pub fn refuse_unknown<'a>(scene: &Scene, names: impl Iterator<Item = &'a str>) -> Result<(), CliError> {
    let known: Vec<&str> = scene.quantities.iter().map(|quantity| quantity.name.as_str()).collect();
    for name in names {
        if !known.contains(&name) {
            let what = format!("{}: the scene has no quantity '{name}'", scene.path.display());
            let remedy = match known.as_slice() {
                [] => "give it one in a [[quantities]] table".to_string(),
                known => format!("use one of {}", known.join(", ")),
            };
            return Err(CliError::stopped(Exit::BadInput, what, remedy));
        }
    }
    Ok(())
}

/// The solver that was asked for; ranks may start `program`.
fn dual_method(solve: &SolveOptions, program: Option<PathBuf>) -> Box<dyn DualMethod> {
    let EngineOptions { engine, ranks, linear_solver, engine_seconds } = solve.engine;
    match engine {
        None => solve.method.method(),
        Some(Engine::Petsc) => Box::new(Petsc {
            ranks: ranks.unwrap_or(1) as usize,
            linear_solver,
            limit: limit(engine_seconds),
            interpreter: None,
            program,
        }),
    }
}
