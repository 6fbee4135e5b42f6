//! Makes the runs of a chart, one after the other, and saves after each.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::data::{Chart, Cold, Plot, Run, SCHEMA_VERSION, SceneChart, Status};
use super::judge::judge;
use super::reference::{self, REFERENCE_ADAPTIVE, REFERENCE_PRIMAL, from_runs};
use super::store::{self, StoreError};
use crate::measure::{self, End, Ended, Limits, Machine, Measured, Method, Step};
use crate::primal::SolverCommand;
use crate::scene::Scene;

/// The methods, levels and limits of the runs of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The methods.
    pub methods: Vec<Method>,
    /// Uniform refinements 0 … levels − 1; adaptive methods divide their tolerance by five from one to the next.
    pub levels: usize,
    /// Runs of each kind.
    pub repeats: usize,
    /// Seconds that a run may take.
    pub budget: f64,
    /// Guaranteed relative error that the reference bracket is refined to.
    pub reference: f64,
    /// Threads.
    pub threads: usize,
    /// Quantities that every run bounds too.
    pub quantities: Vec<String>,
    /// Bytes that a run may take; if missing, four fifths of the memory available when it starts.
    pub memory: Option<u64>,
    /// A displacement solver to run in the place of FEniCSx.
    pub program: Option<SolverCommand>,
}

impl Default for Plan {
    fn default() -> Self {
        Plan {
            methods: Method::usual().collect(),
            levels: 4,
            repeats: 3,
            budget: 60.0,
            reference: REFERENCE_ADAPTIVE,
            threads: 1,
            quantities: Vec::new(),
            memory: None,
            program: None,
        }
    }
}

/// Tolerance of adaptive methods at level 0.
const FIRST_TOLERANCE: f64 = 0.05;
/// Triangles at which an adaptive run of a chart stops.
const MOST_TRIANGLES: usize = 400_000;
/// The reference may take this many budgets.
const REFERENCE_BUDGETS: f64 = 5.0;

/// The reason why a chart was not finished.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// The files.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The program could not start itself.
    #[error("a run could not be started: {0}")]
    Start(std::io::Error),
    /// A scene that disappeared.
    #[error("{path}: {source}")]
    Scene {
        /// Which.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
}

/// One run of the program.
#[derive(Clone, Copy)]
struct One<'a> {
    method: Method,
    refine: usize,
    tolerance: Option<f64>,
    quantities: &'a [String],
}

/// A chart in progress.
pub struct Campaign<'a> {
    /// The runs to make.
    pub plan: &'a Plan,
    /// This program.
    pub program: &'a Path,
    /// The folder for results.
    pub folder: &'a Path,
    /// The command that makes the chart again, for its readers.
    pub command: String,
    /// Called with each step that begins.
    pub progress: &'a dyn Fn(Step),
}

impl Campaign<'_> {
    /// Makes the runs that `chart` does not have yet.
    ///
    /// # Errors
    /// [`CampaignError`]; runs that fail are no errors but results.
    pub fn run(&self, scenes: &[Scene], kept: Option<Chart>) -> Result<Chart, CampaignError> {
        let machine = Machine::here();
        let program = self.plan.program.as_ref().map(|program| program.line().to_string());
        let same =
            |chart: &Chart| (&chart.machine, chart.threads, &chart.program) == (&machine, self.plan.threads, &program);
        let mut kept = kept.filter(same);
        let mut chart = Chart {
            schema_version: SCHEMA_VERSION,
            machine,
            repeats: self.plan.repeats,
            budget: self.plan.budget,
            threads: self.plan.threads,
            program,
            command: self.command.clone(),
            scenes: Vec::new(),
        };
        let left = scenes.len() * self.plan.methods.len() * self.plan.levels;
        let mut step = Step { what: String::new(), done: 0, left };
        for scene in scenes {
            let sha256 = hash(&scene.path)?;
            let earlier = kept.as_mut().and_then(|chart| {
                let place = chart.scenes.iter().position(|s| s.name == scene.name && s.sha256 == sha256)?;
                Some(chart.scenes.swap_remove(place))
            });
            let own = match earlier {
                Some(earlier) => earlier,
                None => SceneChart {
                    name: scene.name.clone(),
                    title: scene.title.clone(),
                    reference: from_runs(&self.reference_runs(scene, &step)?),
                    sha256,
                    cold: Vec::new(),
                    runs: Vec::new(),
                },
            };
            chart.scenes.push(own);
            store::save(&chart, self.folder)?;
            self.scene(scene, &mut chart, &mut step)?;
        }
        Ok(chart)
    }

    /// The runs of the last scene of `chart`.
    fn scene(&self, scene: &Scene, chart: &mut Chart, step: &mut Step) -> Result<(), CampaignError> {
        for &method in &self.plan.methods {
            let mut stopped: Option<String> = None;
            for level in 0..self.plan.levels {
                let Some(own) = chart.scenes.last_mut() else { return Ok(()) };
                if method.is_primal()
                    && self.plan.program.is_none()
                    && level == 0
                    && own.cold.iter().all(|c| c.method != method)
                {
                    own.cold.extend(self.cold(scene, method, step)?);
                }
                let run = match (own.run(method, level), &stopped) {
                    (Some(run), _) if self.is_of_the_plan(run) => run.clone(),
                    (_, Some(reason)) => self.without_numbers(method, level, Status::Skipped(reason.clone())),
                    _ => {
                        self.tell(format!("{}: {}, level {level}", scene.name, method.name()), step);
                        step.done += 1;
                        self.repeat(scene, method, level, own)?
                    }
                };
                step.left -= 1;
                if let Status::OverBudget | Status::Failed(_) = run.status {
                    stopped = Some(format!("level {level} was over the budget or failed"));
                }
                own.runs.retain(|r| (r.method, r.level) != (method, level));
                own.runs.push(run);
                store::save(chart, self.folder)?;
            }
        }
        chart.scenes.last_mut().into_iter().for_each(SceneChart::sharpen);
        Ok(store::save(chart, self.folder)?)
    }

    fn tell(&self, what: String, step: &Step) {
        (self.progress)(Step { what, ..*step });
    }

    /// True if a run was not skipped and bounded the quantities of the plan.
    fn is_of_the_plan(&self, run: &Run) -> bool {
        let of = |plot: &Plot| plot.quantities.iter().map(|q| &q.name).eq(&self.plan.quantities);
        !matches!(run.status, Status::Skipped(_)) && run.plot.as_ref().is_none_or(of)
    }

    fn without_numbers(&self, method: Method, level: usize, status: Status) -> Run {
        let program = self.plan.program.as_ref().filter(|_| method.is_primal());
        Run {
            method,
            solver: program.map(SolverCommand::name),
            level,
            tolerance: tolerance(method, level),
            status,
            plot: None,
        }
    }

    fn repeat(&self, scene: &Scene, method: Method, level: usize, own: &SceneChart) -> Result<Run, CampaignError> {
        let mut repeats: Vec<Measured> = Vec::new();
        for _ in 0..self.plan.repeats.max(1) {
            let one =
                One { method, refine: level, tolerance: tolerance(method, level), quantities: &self.plan.quantities };
            let ended = self.once(scene, one, self.plan.budget, None)?;
            match ended {
                Ended::Told(results) => repeats.extend(results),
                Ended::OverBudget => return Ok(self.without_numbers(method, level, Status::OverBudget)),
                Ended::Crashed(text) => return Ok(self.without_numbers(method, level, Status::Failed(text))),
            }
        }
        let told = repeats.iter().find_map(|run| run.answer.as_ref()?.solver.clone());
        Ok(match judge(&repeats, own.reference.as_ref().ok()) {
            Err(reason) => self.without_numbers(method, level, Status::Failed(reason)),
            Ok(plot) => {
                let run = self.without_numbers(method, level, Status::Done);
                Run { plot: Some(plot), solver: told.or(run.solver), ..run }
            }
        })
    }

    fn once(
        &self,
        scene: &Scene,
        One { method, refine, tolerance, quantities }: One<'_>,
        budget: f64,
        cache: Option<&Path>,
    ) -> Result<Ended, CampaignError> {
        let mut arguments: Vec<OsString> = vec!["scene".into(), scene.path.clone().into()];
        let refine = if method.is_adaptive() { 0 } else { refine };
        let mut option = |name: &str, value: String| arguments.extend([name.into(), value.into()]);
        option("--method", method.name().to_string());
        option("--refine", refine.to_string());
        option("--threads", self.plan.threads.to_string());
        option("--seconds", budget.to_string());
        if let Some(program) = self.plan.program.as_ref().filter(|_| method.is_primal()) {
            option("--reference", program.line().to_string());
        }
        if let Some(memory) = self.plan.memory {
            option("--max-memory", memory.to_string());
        }
        if let Some(tolerance) = tolerance {
            option("--tolerance", tolerance.to_string());
            option("--max-triangles", MOST_TRIANGLES.to_string());
        }
        quantities.iter().for_each(|name| option("--quantity", name.clone()));
        let limits = Limits { budget: crate::process::limit(budget), cache };
        measure::run(self.program, &arguments, limits).map_err(CampaignError::Start)
    }

    /// Runs that give the reference bracket, each with its description and how it ended.
    fn reference_runs(&self, scene: &Scene, step: &Step) -> Result<Vec<(String, Ended)>, CampaignError> {
        self.tell(format!("{}: the bracket to measure errors against", scene.name), step);
        let budget = REFERENCE_BUDGETS * self.plan.budget;
        let mut runs = Vec::new();
        for method in reference::OF.into_iter().filter(|m| self.plan.methods.contains(m) || m.has_bracket()) {
            let (what, refine, tolerance) = if method.is_adaptive() {
                (format!("to {} %", 100.0 * self.plan.reference), 0, Some(self.plan.reference))
            } else {
                (format!("{REFERENCE_PRIMAL} refinements"), REFERENCE_PRIMAL, None)
            };
            let one = One { method, refine, tolerance, quantities: &[] };
            runs.push((what, self.once(scene, one, budget, None)?));
        }
        Ok(runs)
    }

    /// Times of imports and form compilation of one degree, with an empty cache and with a full one.
    fn cold(&self, scene: &Scene, method: Method, step: &Step) -> Result<Option<Cold>, CampaignError> {
        self.tell(format!("{}: first use of {}", scene.name, method.name()), step);
        let Ok(cache) = crate::process::Scratch::new() else { return Ok(None) };
        let phase = |name: &str| -> Result<Option<[f64; 2]>, CampaignError> {
            let one = One { method, refine: 0, tolerance: None, quantities: &[] };
            let ended = self.once(scene, one, REFERENCE_BUDGETS * self.plan.budget, Some(cache.path()))?;
            let Ended::Told(results) = ended else { return Ok(None) };
            let Some(run) = results.first().filter(|r| r.end == End::Solved) else { return Ok(None) };
            let of = |wanted: &str| run.seconds.phases.iter().find(|(n, _)| n == wanted).map_or(0.0, |(_, s)| *s);
            Ok(Some([of(name), of("import")]))
        };
        let (first, second) = (phase("compile")?, phase("compile")?);
        Ok(first.zip(second).map(|([compile, _], [compile_warm, import])| Cold {
            method,
            compile,
            compile_warm,
            import,
        }))
    }
}

/// Tolerance of a run at `level`.
fn tolerance(method: Method, level: usize) -> Option<f64> {
    method.is_adaptive().then(|| FIRST_TOLERANCE / 5_f64.powi(level as i32))
}

fn hash(path: &Path) -> Result<String, CampaignError> {
    let bytes = std::fs::read(path).map_err(|source| CampaignError::Scene { path: path.to_path_buf(), source })?;
    Ok(crate::study::hash(&bytes))
}
