//! Several scenes, or folders of them, given to one command.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::SystemTime;

use clap::value_parser;

use crate::budget::Budget;
use crate::cli::given::Given;
use crate::cli::given::options::{JudgeOptions, MemoryOptions, RunOptions, positive};
use crate::cli::words::progress::Progress;
use crate::cli::words::{ci, say};
use crate::cli::{CliError, Exit, this_program};
use crate::job::{self, Entry, Gathered, Job, JobError, Plan, Planned, Runner, Shard};
use crate::process::limit;
use crate::process::signals::LastWords;
use crate::report;
use crate::report::text::number::{at_most_percent, seconds};
use crate::scene::{Scene, counted};
use crate::study::{Accepted, Baseline, Signature};

/// Options whose values are not those of the single scenes.
const OF_THE_JOB: [&str; 12] = [
    "out",
    "quiet",
    "jobs",
    "scene-seconds",
    "resume",
    "shard",
    "part",
    "part-name",
    "max-memory",
    "reason",
    "accepted-by",
    "displacement",
];

/// How several scenes are run.
#[derive(Debug, Clone, clap::Args)]
pub struct JobOptions {
    /// Run N scenes at a time, each in a process of its own [default: one for each processor that --threads leaves]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024), help_heading = "Several scenes")]
    pub jobs: Option<u32>,
    /// End a scene after S seconds, and go on with the next
    #[arg(
        long,
        value_name = "S",
        value_parser = positive,
        help_heading = "Several scenes",
        help = "End a scene after S seconds, and go on with the next [default: 3600]"
    )]
    pub scene_seconds: Option<f64>,
    /// Keep what an interrupted job has finished; scenes that gave no answer are tried again
    #[arg(long, help_heading = "Several scenes")]
    pub resume: bool,
    /// Run the I-th of N parts of the job; `hypercircle gather` makes one page of all parts
    #[arg(long, value_name = "I/N", help_heading = "Several scenes")]
    pub shard: Option<Shard>,
    /// Identifier of the run, given by the job that this scene is part of
    #[arg(long, hide = true, requires = "part_name")]
    pub part: Option<String>,
    /// Name of the scene in that job
    #[arg(long, hide = true, requires = "part")]
    pub part_name: Option<String>,
}

impl JobOptions {
    /// True if `scenes` are a job, and not one scene.
    fn are_job(&self, scenes: &[PathBuf]) -> bool {
        self.part.is_none()
            && (scenes.len() > 1
                || self.resume
                || self.shard.is_some()
                || self.scene_seconds.is_some()
                || scenes.iter().any(|path| path.is_dir()))
    }

    /// True if this is one scene of a job.
    pub fn is_part(&self) -> bool {
        self.part.is_some()
    }
}

/// A job as a command has it.
pub struct Order<'a> {
    /// The command.
    pub command: &'static str,
    /// Scenes and folders.
    pub scenes: &'a [PathBuf],
    /// How they are run.
    pub job: &'a JobOptions,
    /// All options.
    pub given: &'a Given,
    /// Threads of each process.
    pub threads: u32,
    /// Memory of all processes.
    pub memory: &'a MemoryOptions,
    /// How each is judged, where it is.
    pub judge: Option<&'a JudgeOptions>,
    /// Where results go.
    pub run: &'a RunOptions,
    /// Returns the options, files and fields of a scene.
    pub own: &'a dyn Fn(&Path) -> Result<Own, CliError>,
}

/// Options, files and fields of one scene of a job.
pub struct Own {
    /// Options.
    pub options: Vec<String>,
    /// Files that its result depends on, beside the scene and its mesh.
    pub files: Vec<PathBuf>,
    /// Names of the displacement fields that its checks name; `None` where they name themselves later.
    pub fields: Option<Vec<String>>,
}

impl Default for Own {
    fn default() -> Self {
        Own { options: Vec::new(), files: Vec::new(), fields: Some(Vec::new()) }
    }
}

/// The command-line error of a job.
pub fn refused(error: JobError) -> CliError {
    let exit = match error {
        JobError::Report(error) => return error.into(),
        JobError::Write { .. } | JobError::Start { .. } => Exit::Failed,
        _ => Exit::BadInput,
    };
    CliError::stopped(exit, error.to_string(), "")
}

/// Does what was ordered: `one` where there is one scene, a job with one page where there are several.
///
/// # Errors
/// Those of `one`; a job cannot be begun, or its files not be written. A scene of a job that fails is a result.
pub fn run(order: &Order<'_>, one: impl FnOnce(&Path) -> Result<Exit, CliError>) -> Result<Exit, CliError> {
    match order.scenes {
        [scene] if !order.job.are_job(order.scenes) => {
            let begun = SystemTime::now();
            one(scene).inspect_err(|_| tell_of_an_earlier_report(order.run, scene, begun))
        }
        _ => several(order),
    }
}

/// Says, of a run that ended before it had a report, that the one in its folder is of an earlier run.
fn tell_of_an_earlier_report(run: &RunOptions, scene: &Path, begun: SystemTime) {
    let name = scene.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let report = run.folder_named(&name).join("report.json");
    if std::fs::metadata(&report).and_then(|file| file.modified()).is_ok_and(|written| written < begun) {
        say::complaint(&format!("{} is of an earlier run: this one has no report", report.display()));
    }
}

/// Runs the scenes, and makes one page of them.
fn several(order: &Order<'_>) -> Result<Exit, CliError> {
    let plan = plan(order)?;
    let out = order.run.out.clone().unwrap_or_else(|| PathBuf::from("out"));
    report::folder::refuse(&out, job::FILES).map_err(|e| refused(e.into()))?;
    let shard = order.job.shard.unwrap_or(Shard::WHOLE);
    let own = (0..plan.scenes.len()).filter(|i| shard.has(*i)).count();
    plan.write(&out).map_err(refused)?;
    let (program, code) = this_program()?;
    let processes = processes(order, own);
    let runner = Runner {
        program: &program,
        code: &code,
        out: &out,
        processes,
        limit: limit(order.job.scene_seconds.unwrap_or(SCENE_SECONDS)),
        memory: memory(order, processes),
        shard,
        resume: order.job.resume,
    };
    let progress = Progress::new(order.run.quiet);
    progress.phase(format!("{}, {processes} at a time", counted(own, "scene")));
    let ended = AtomicUsize::new(0);
    let kept = (!order.run.quiet).then(|| LastWords::kept_in(&out, ""));
    let finished = runner
        .run(&plan, &|planned, record| {
            let number = ended.fetch_add(1, Ordering::Relaxed) + 1;
            let entry = job::entry(&out, planned, record);
            progress.phase(format!("{number} of {} ended", counted(own, "scene")));
            progress.line(&line(&plan, &entry));
        })
        .map_err(refused)?;
    if finished > 0 {
        progress.line(&format!("  {finished} were finished before"));
    }
    drop((progress, kept));
    if shard != Shard::WHOLE {
        return part_of_job(&out, &plan, shard, order.run.quiet);
    }
    conclude(&out, &plan, order.judge.map(JudgeOptions::signature).as_ref(), order.run.quiet)
}

/// The end of a part: the rest of the job may be running still.
fn part_of_job(out: &Path, plan: &Plan, shard: Shard, quiet: bool) -> Result<Exit, CliError> {
    let part = job::gather(out, plan).map_err(refused)?.part(shard);
    ci::step_summary(&job::summary(&part, out), &part.job.sentence());
    ci::annotate(&complaints(&part));
    if !quiet {
        let Shard { number, of } = shard;
        say::line(&format!("{}.", part.job.sentence()));
        say::line(&format!("part {number} of {of}; with all parts there: hypercircle gather {}", out.display()));
    }
    Ok(Exit::of(part.job.exit))
}

/// Makes one page of what `out` has of `plan`, accepts what is to be accepted, and says how it ended.
///
/// # Errors
/// The files cannot be read or written.
pub fn conclude(out: &Path, plan: &Plan, signature: Option<&Signature>, quiet: bool) -> Result<Exit, CliError> {
    let gathered = job::gather(out, plan).map_err(refused)?;
    let summary = job::write(&gathered, out).map_err(refused)?;
    let accepted = match signature {
        Some(signature) => job::accept(plan, &gathered, signature).map_err(refused)?,
        None => false,
    };
    ci::step_summary(&summary, &gathered.job.sentence());
    ci::annotate(&complaints(&gathered));
    let Job { exit, .. } = gathered.job;
    if !quiet {
        say::line(&format!("{}.", gathered.job.sentence()));
        if accepted {
            say::line("the baseline has these numbers now");
        }
        if gathered.patch.is_some() {
            let patch = out.join("baseline.patch");
            say::line(&format!("numbers differ from the baseline; {} brings it up to date", patch.display()));
        }
        say::line(&format!("page: {}", out.join("index.html").display()));
    }
    Ok(Exit::of(exit))
}

/// Complaints about the scenes, the worst first.
fn complaints(gathered: &Gathered) -> Vec<ci::Complaint> {
    let job = &gathered.job;
    let bad = job.worst_first().into_iter().filter(|i| job.scenes[*i].exit != 0);
    let complaint = |i: usize| {
        let entry = &job.scenes[i];
        let first = gathered.reports[i].as_ref().and_then(|report| report.causes.first());
        ci::Complaint {
            file: Some(PathBuf::from(&entry.scene)),
            line: entry.line,
            title: format!("{}: {}", entry.name, job.word(entry.status)),
            message: first.map_or(entry.verdict.clone(), |cause| cause.sentence.clone()),
        }
    };
    bad.map(complaint).collect()
}

/// One line for a scene that has ended.
fn line(plan: &Plan, entry: &Entry) -> String {
    let word = if plan.command == "solve" && entry.exit == 0 { "passed" } else { entry.status.words() };
    let bound = entry.energy.and_then(|energy| energy.relative_error_bound);
    let bound = bound.map_or(String::new(), |bound| format!(", error at most {}", at_most_percent(bound)));
    let why = match (entry.exit, entry.failing.first()) {
        (0, _) => String::new(),
        (_, Some(first)) => format!(": {first}"),
        (_, None) => format!(": {}", entry.verdict),
    };
    format!("  {} {}: {word}{bound} ({}){why}", entry.status.symbol(), entry.name, seconds(entry.seconds))
}

fn plan(order: &Order<'_>) -> Result<Plan, CliError> {
    let (files, left_out) = job::scenes_of(order.scenes).map_err(refused)?;
    let options = order.given.without(&OF_THE_JOB).map(unicode).collect::<Result<Vec<String>, CliError>>()?;
    if let Some(judge) = order.judge {
        judge.refuse_unheard(order.job.shard.is_some())?;
    }
    let baseline = order.judge.and_then(|judge| judge.baseline.clone());
    let accept = order.judge.is_some_and(|judge| judge.accept);
    if let Some(file) = &baseline {
        refuse_baseline(file, accept)?;
    }
    let mut scenes = Vec::new();
    let mut read = Vec::new();
    for (name, scene) in job::names(&files).into_iter().zip(&files) {
        let own = (order.own)(scene)?;
        let content = job::content(scene, &own.files);
        read.push(Scene::read(scene).ok().map(|scene| own.fields.map(|fields| (scene, fields))));
        scenes.push(Planned { name, scene: scene.clone(), content, options: own.options });
    }
    let known: Option<Vec<(Scene, Vec<String>)>> = read.into_iter().flatten().collect();
    if let Some((judge, known)) = order.judge.zip(known) {
        judge.refuse_foreign(&known)?;
    }
    let settings = {
        let memory = order.memory.max_memory.map(|bytes| format!("--max-memory={bytes}"));
        let all: Vec<String> = options.iter().cloned().chain(memory).collect();
        job::settings(order.command, &all, baseline.as_deref())
    };
    let left_out = left_out.iter().map(|path| path.display().to_string()).collect();
    let command = order.command.to_string();
    Ok(Plan { schema_version: job::SCHEMA_VERSION, command, options, settings, scenes, left_out, baseline, accept })
}

fn unicode(option: &OsString) -> Result<String, CliError> {
    option.to_str().map(str::to_string).ok_or_else(|| {
        let message = format!("{} is not Unicode, and a job writes its options down", option.to_string_lossy());
        CliError::stopped(Exit::BadInput, message, "rename the file")
    })
}

/// Seconds that a scene may take where nothing else is said.
const SCENE_SECONDS: f64 = 3600.0;

/// Refuses a baseline that a job cannot use.
fn refuse_baseline(file: &Path, accept: bool) -> Result<(), CliError> {
    if !Accepted::is_meant(file) {
        return Err(CliError::stopped(
            Exit::BadInput,
            format!("baseline {}: a job has one baseline for all its scenes, which is a TOML file", file.display()),
            "give it a name that ends with .toml, and write it first with --accept",
        ));
    }
    let refused = |e: crate::study::BaselineError| CliError::stopped(Exit::BadInput, e.to_string(), "");
    match accept {
        true => Baseline::refuse(file).and_then(|()| Accepted::read_if_there(file)).map(drop).map_err(refused),
        false => Accepted::read(file).map(drop).map_err(refused),
    }
}

/// Processes at a time.
fn processes(order: &Order<'_>, scenes: usize) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let usual = (processors / order.threads.max(1) as usize).max(1);
    order.job.jobs.map_or(usual, |jobs| jobs as usize).min(scenes).max(1)
}

/// Bytes for each process: an equal share of what all of them may take.
fn memory(order: &Order<'_>, processes: usize) -> Option<u64> {
    match order.memory.max_memory {
        Some(bytes) => Some((bytes / processes as u64).max(1)),
        None if processes == 1 => None,
        None => {
            let share = Budget::of_available(order.threads as usize).bytes() / processes as f64;
            share.is_finite().then_some(share as u64)
        }
    }
}
