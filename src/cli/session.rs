//! What the solving commands share: from the scene file to a bracket, and from a dossier to files and a verdict.

use std::path::Path;
use std::time::Instant;

use super::options::{Limits, Method, SolveOptions};
use super::progress::Progress;
use super::{CliError, Exit};
use crate::compare::Comparison;
use crate::dual::{ActiveSet, Clarabel, Condensed, DualError, DualMethod, Options, Uzawa};
use crate::problem::{Note, Problem};
use crate::report::{self, Dossier, HistoryRow, Status};
use crate::scene::{MeshSource, Scene};
use crate::study::{self, Adapted, Certified, Fields, Findings, Goal, StudyError, assemble};

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
    quiet: bool,
    threads: usize,
}

/// The dual side of a command.
pub struct DualRun {
    /// Problem, solution and bracket.
    pub certified: Certified,
    /// Mesh by mesh, where the mesh was refined adaptively.
    pub history: Vec<HistoryRow>,
    /// Why refinement stopped before the tolerance was reached.
    pub stopped: Option<String>,
}

/// What a command tells beside the dual run and its comparison.
#[derive(Default)]
pub struct Particulars {
    /// Remarks of its own.
    pub notes: Vec<Note>,
    /// Its phases.
    pub seconds: Vec<(&'static str, f64)>,
    /// What else took part, with versions.
    pub components: Vec<(String, String)>,
    /// Why the displacement model gave no answer.
    pub failure: Option<String>,
}

impl Session {
    /// Reads the scene.
    ///
    /// # Errors
    /// The scene is refused.
    pub fn open(command: &'static str, scene: &Path, solve: &SolveOptions, quiet: bool) -> Result<Self, CliError> {
        let start = Instant::now();
        let scene = Scene::read(scene)?;
        let threads = solve.threads as usize;
        // A second command in one process keeps the pool of the first.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        Ok(Session { scene, progress: Progress::new(quiet), start, command, quiet, threads })
    }

    /// Meshes the scene and solves the dual problem; a scene without equilibrium is reported into `folder`.
    ///
    /// # Errors
    /// Bad input, a solver that failed, or no equilibrium.
    pub fn solve(&self, solve: &SolveOptions, limits: &Limits, folder: &Path) -> Result<DualRun, CliError> {
        self.progress.phase("reading the mesh");
        let problem = self.problem(solve)?;
        let read = self.start.elapsed().as_secs_f64();
        let phase = |triangles: usize| self.progress.phase(format!("solving in stresses on {triangles} triangles"));
        phase(problem.mesh.triangles.len());
        let method = method(solve.method);
        let options = Options { threads: self.threads, ..Options::default() };
        let run = match solve.tolerance {
            None => study::certify(problem, method.as_ref(), &options).map(|certified| DualRun {
                certified,
                history: Vec::new(),
                stopped: None,
            }),
            Some(tolerance) => {
                let Limits { max_triangles, max_seconds } = *limits;
                let goal = Goal { max_triangles, max_seconds, ..Goal::new(tolerance) };
                let told = |row: &HistoryRow| {
                    let bound = 100.0 * row.relative_error_bound;
                    let text = format!("{} triangles: guaranteed error {bound:.3} %, refining", row.triangles);
                    self.progress.phase(text);
                };
                study::adapt(problem, method.as_ref(), &options, &goal, told)
                    .map(|Adapted { certified, history, stopped }| DualRun { certified, history, stopped })
            }
        };
        let mut run = run.map_err(|error| self.refuse(error, folder))?;
        run.certified.dual.seconds.read = read;
        Ok(run)
    }

    fn problem(&self, solve: &SolveOptions) -> Result<Problem, CliError> {
        let refused = |e: crate::problem::ProblemError| {
            CliError::stopped(Exit::BadInput, format!("{}: {e}", self.scene.path.display()), "")
        };
        let mut scene = self.scene.clone();
        let mut coarsened = None;
        if let (Some(_), MeshSource::Geometry { size, .. }) = (solve.tolerance, &mut scene.mesh) {
            coarsened = size.take();
        }
        let problem = Problem::load(scene).map_err(refused)?;
        let mut problem = problem.refine_uniform(solve.refine as usize).map_err(refused)?;
        problem.notes.extend(coarsened.map(|size| Note {
            weakens_guarantee: false,
            text: format!(
                "geometry.size = {size} was not used: refinement to a tolerance starts from the coarsest mesh that \
                 represents the scene."
            ),
        }));
        Ok(problem)
    }

    fn refuse(&self, error: StudyError, folder: &Path) -> CliError {
        let message = format!("{}: {error}", self.scene.path.display());
        match error {
            StudyError::NoEquilibrium { sentence, motion, problem, .. } => {
                let dossier = study::infeasible(self.command, &problem, &sentence, motion, self.threads);
                if let Err(error) = report::write(&dossier, folder) {
                    return CliError::stopped(Exit::Failed, error.to_string(), "");
                }
                let remedy = format!("see {}, or hold the body with a support", folder.join("report.html").display());
                CliError::stopped(Exit::NoEquilibrium, message, remedy)
            }
            StudyError::BeyondMesh { .. } => {
                CliError::stopped(Exit::Failed, message, "refine the mesh, for instance with --refine or --tolerance")
            }
            StudyError::Dual(DualError::Infeasible { .. }) => {
                CliError::stopped(Exit::NoEquilibrium, message, "hold the body with a support, or change the load")
            }
            StudyError::Mesh(_) => CliError::stopped(Exit::BadInput, message, ""),
            StudyError::Statics(_) | StudyError::Dual(_) => CliError::stopped(Exit::Failed, message, ""),
        }
    }

    /// Assembles the dossier of a run with its comparison, writes the files and says the verdict.
    ///
    /// # Errors
    /// The files cannot be written.
    pub fn conclude(
        &self,
        run: DualRun,
        comparison: &Comparison,
        particulars: Particulars,
        folder: &Path,
    ) -> Result<Exit, CliError> {
        let DualRun { certified, history, stopped } = run;
        let Particulars { notes, mut seconds, components, failure } = particulars;
        seconds.push(("whole run", self.start.elapsed().as_secs_f64()));
        let stopped = stopped.map(|text| Note { weakens_guarantee: false, text });
        let fields = Fields::new(&certified, comparison);
        let dossier = assemble(
            Findings {
                command: self.command,
                certified: &certified,
                comparison,
                history,
                notes: stopped.into_iter().chain(notes).collect(),
                threads: self.threads,
                seconds,
                components,
                failure,
            },
            &fields,
        );
        self.close(&dossier, folder)
    }

    fn close(&self, dossier: &Dossier<'_>, folder: &Path) -> Result<Exit, CliError> {
        self.progress.phase("writing the report");
        report::write(dossier, folder).map_err(|e| CliError::stopped(Exit::Failed, e.to_string(), ""))?;
        if !self.quiet {
            let report = &dossier.report;
            println!("{}", report.verdict);
            for check in report.checks.iter().filter(|c| !c.passed) {
                println!("  failed: {}: {}", check.name, check.why);
            }
            println!("report: {}", folder.join("report.html").display());
        }
        Ok(match dossier.report.status {
            Status::Agree => Exit::Agree,
            Status::Disagree => Exit::Disagree,
            Status::Infeasible => Exit::NoEquilibrium,
            Status::Failed => Exit::Failed,
        })
    }
}

/// The solver of that name.
pub fn method(name: Method) -> Box<dyn DualMethod> {
    match name {
        Method::Condensed => Box::new(Condensed::default()),
        Method::ActiveSet => Box::new(ActiveSet::default()),
        Method::Clarabel => Box::new(Clarabel::default()),
        Method::Uzawa => Box::new(Uzawa::default()),
    }
}
