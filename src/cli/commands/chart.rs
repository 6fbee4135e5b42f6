//! `hypercircle chart`: accuracy against time, every method and refinement.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::{ValueEnum, value_parser};

use crate::chart::{self, Campaign, CampaignError, Chart, Of, Plan, SceneChart, Status, fastest};
use crate::cli::given::friction::refuse_chart;
use crate::cli::given::methods::MethodOptions;
use crate::cli::given::options::{MemoryOptions, NamedTolerance, RunOptions, positive, tolerance};
use crate::cli::session::refuse_unknown;
use crate::cli::words::progress::Progress;
use crate::cli::words::say;
use crate::cli::{CliError, Exit, this_program};
use crate::measure::Method;
use crate::primal::SolverCommand;
use crate::process::signals::LastWords;
use crate::report::folder;
use crate::scene::Scene;

const REFINE: u32 = 3;
const REPEATS: u32 = 3;
const THREADS: u32 = 1;

/// Options of `chart`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene files
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// Print the fastest choice for the relative error X, or bound the quantity NAME in every run and print the fastest choice for
    /// a half-width of X times its value; may be repeated
    #[arg(long = "for", value_name = "[NAME=]X")]
    pub wanted: Vec<Accuracy>,
    /// Mark a method that takes longer than SECONDS for one run, and go on
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub budget: Option<f64>,
    /// Keep the runs that an interrupted chart has saved
    #[arg(long)]
    pub resume: bool,
    /// Uniform refinements from 0 to N
    #[arg(long, value_name = "N", default_value_t = REFINE, value_parser = value_parser!(u32).range(0..=8))]
    pub refine: u32,
    /// Runs of each kind; the median counts
    #[arg(long, value_name = "N", default_value_t = REPEATS, value_parser = value_parser!(u32).range(1..=99))]
    pub repeats: u32,
    /// What is measured.
    #[command(flatten)]
    pub methods: MethodOptions,
    /// Run COMMAND in the place of FEniCSx, as `verify` does: {problem} stands for the file to read, {out} for the folder to write
    /// into, {degrees} for the degree that is wanted
    #[arg(long, value_name = "COMMAND")]
    pub reference: Option<SolverCommand>,
    /// Few refinements, one run each
    #[arg(long)]
    pub reduced: bool,
    /// Threads to use
    #[arg(long, value_name = "N", default_value_t = THREADS, value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// How much memory a run may take.
    #[command(flatten)]
    pub memory: MemoryOptions,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

/// How close a run is to come.
#[derive(Debug, Clone, PartialEq)]
pub enum Accuracy {
    /// Largest relative error in the energy norm.
    Energy(f64),
    /// Largest half-width of the interval of a quantity, relative to its value.
    Quantity(NamedTolerance),
}

impl Accuracy {
    /// The quantity that is asked for.
    fn name(&self) -> Option<&String> {
        match self {
            Accuracy::Energy(_) => None,
            Accuracy::Quantity(of) => Some(&of.name),
        }
    }
}

impl FromStr for Accuracy {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.contains('=') {
            true => text.parse().map(Accuracy::Quantity),
            false => tolerance(text).map(Accuracy::Energy),
        }
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Accuracy::Energy(error) => write!(f, "{error}"),
            Accuracy::Quantity(NamedTolerance { name, value }) => write!(f, "{name}={value}"),
        }
    }
}

impl Args {
    fn plan(&self) -> Plan {
        let mut plan = Plan {
            levels: self.refine as usize + 1,
            repeats: self.repeats as usize,
            threads: self.threads as usize,
            memory: self.memory.max_memory,
            quantities: self.quantities(),
            program: self.reference.clone(),
            methods: self.methods.chosen(),
            ..Plan::default()
        };
        if self.reduced {
            plan = Plan { levels: plan.levels.min(2), repeats: 1, budget: 10.0, reference: 0.01, ..plan };
        }
        if let Some(budget) = self.budget {
            plan.budget = budget;
        }
        plan
    }

    /// The quantities that are asked for, each once.
    fn quantities(&self) -> Vec<String> {
        let mut names = Vec::new();
        for name in self.wanted.iter().filter_map(|wanted| wanted.name()) {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    }

    /// The command that makes the same runs.
    fn command(&self) -> String {
        let mut words: Vec<String> = vec!["hypercircle chart".to_string()];
        words.extend(self.scenes.iter().map(|path| quoted(&path.display().to_string())));
        words.extend(self.reduced.then(|| "--reduced".to_string()));
        words.extend(self.methods.words());
        words.extend(self.reference.iter().map(|program| format!("--reference {}", quoted(program.line()))));
        for (name, value, usual) in
            [("refine", self.refine, REFINE), ("repeats", self.repeats, REPEATS), ("threads", self.threads, THREADS)]
        {
            words.extend((value != usual).then(|| format!("--{name} {value}")));
        }
        words.extend(
            self.wanted.iter().filter(|w| w.name().is_some()).map(|w| format!("--for {}", quoted(&w.to_string()))),
        );
        words.extend(self.budget.map(|s| format!("--budget {s}")));
        words.extend(self.memory.max_memory.map(|bytes| format!("--max-memory {bytes}")));
        words.join(" ")
    }
}

/// A name as a shell wants it.
pub(in crate::cli) fn quoted(name: &str) -> String {
    if name.contains([' ', '\'', '"']) { format!("'{}'", name.replace('\'', "'\\''")) } else { name.to_string() }
}

/// Runs every method on every scene.
///
/// # Errors
/// The scene is refused, or no answer can be given.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    // All scenes are read before the first run, which may be hours before the last.
    let mut scenes: Vec<Scene> = Vec::new();
    for path in &args.scenes {
        let scene = Scene::read(path)?;
        refuse_chart(&scene)?;
        refuse_unknown(&scene, args.quantities().iter().map(String::as_str))?;
        if let Some(other) = scenes.iter().find(|s| s.name == scene.name) {
            let message = format!("{} and {} have the same name", other.path.display(), path.display());
            return Err(CliError::stopped(Exit::BadInput, message, "rename one of the files, or chart them apart"));
        }
        scenes.push(scene);
    }
    let folder = args.run.folder_named(scenes.first().filter(|_| scenes.len() == 1).map_or("chart", |s| &s.name));
    folder::refuse(&folder, [])?;
    let failed = |e: CampaignError| CliError::stopped(Exit::Failed, e.to_string(), "");
    let kept = if args.resume { chart::read(&folder).map_err(|e| failed(e.into()))? } else { None };
    let (program, _) = this_program()?;
    let progress = Progress::new(args.run.quiet);
    let plan = args.plan();
    let campaign = Campaign {
        plan: &plan,
        program: &program,
        folder: &folder,
        command: args.command(),
        progress: &|step| progress.step(step),
    };
    let _kept = (!args.run.quiet).then(|| LastWords::kept_in(&folder, ", on this machine"));
    let chart = campaign.run(&scenes, kept).map_err(failed)?;
    chart::write(&chart, &folder).map_err(|e| failed(e.into()))?;
    drop(progress);
    args.wanted.iter().for_each(|wanted| say::line(choices(&chart, wanted).trim_end()));
    if !args.run.quiet {
        say::line(&format!("chart: {}", Path::new(&folder).join("chart.html").display()));
    }
    Ok(Exit::Agree)
}

/// Refinement and tolerances that an adaptive run was given.
fn tolerances(scene: &SceneChart, method: Method, tolerance: f64) -> String {
    let adapt = match method {
        Method::Adaptive(adapt) => adapt.to_possible_value().map(|value| format!("--adapt {}", value.get_name())),
        Method::Stresses(..) | Method::Displacements(_) => None,
    };
    let tolerances = match scene.quantities().as_slice() {
        [] => vec![format!("--tolerance {tolerance}")],
        names => names.iter().map(|name| format!("--tolerance-of {name}={tolerance}")).collect(),
    };
    adapt.into_iter().chain(tolerances).collect::<Vec<_>>().join(" ")
}

/// The fastest runs for what is `wanted`, one line a scene and kind of error.
fn choices(chart: &Chart, wanted: &Accuracy) -> String {
    let mut text = String::new();
    let (of, error) = match wanted {
        Accuracy::Energy(error) => (Of::Energy, *error),
        Accuracy::Quantity(NamedTolerance { name, value }) => (Of::Quantity(name), *value),
    };
    for scene in &chart.scenes {
        for (guaranteed, kind) in [(true, "guaranteed"), (false, "true")] {
            let words = wanted.name().map_or(format!("{kind} error"), |name| format!("{kind} error of {name}"));
            let line = match fastest(scene, of, error, guaranteed) {
                Some(choice) => {
                    let how = match choice.run.tolerance {
                        Some(tolerance) => tolerances(scene, choice.run.method, tolerance),
                        None => format!("--refine {}", choice.run.level),
                    };
                    format!(
                        "{} {how}: {:.3} s, {words} {:.3} %, {} unknowns",
                        choice.run.name(),
                        choice.plot.whole.median,
                        100.0 * choice.error,
                        choice.plot.unknowns
                    )
                }
                None => format!("no run has a {words} of {} % or less", 100.0 * error),
            };
            text.push_str(&format!("{}: {line}\n", scene.name));
        }
        let marked = scene.runs.iter().filter(|r| r.status == Status::OverBudget);
        for run in marked {
            text.push_str(&format!("{}: {} was over the budget at level {}\n", scene.name, run.name(), run.level));
        }
    }
    text
}
