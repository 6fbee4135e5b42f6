//! Runs the scenes of a plan, some at a time.

use std::ffi::OsString;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::plan::{Plan, Planned, Shard};
use super::record::{End, Record};
use super::{JobError, PARTS};
use crate::process::{Ended, Outcome, supervise};
use crate::report;
use crate::study::{hash, identifier};

/// How a plan is carried out.
#[derive(Debug)]
pub struct Runner<'a> {
    /// This program.
    pub program: &'a Path,
    /// The file with its code, the same where it is no script.
    pub code: &'a Path,
    /// Folder of the job.
    pub out: &'a Path,
    /// Processes at a time.
    pub processes: usize,
    /// The longest that a scene may take.
    pub limit: Duration,
    /// Bytes that each process may take; what it finds available where it is missing.
    pub memory: Option<u64>,
    /// Which of the scenes to run.
    pub shard: Shard,
    /// True if results of finished scenes are kept.
    pub resume: bool,
}

/// Hash of the settings that all scenes of a job share.
pub fn settings(command: &str, options: &[String], baseline: Option<&Path>) -> String {
    let mut parts = vec![command.to_string()];
    parts.extend(options.iter().cloned());
    // The content of the baseline counts, and not its name.
    parts.extend(baseline.and_then(|path| std::fs::read(path).ok()).map(|bytes| hash(&bytes)));
    hash(serde_json::Value::from(parts).to_string().as_bytes())
}

impl Runner<'_> {
    /// Runs the scenes of its shard that are not finished yet, and tells of each as it ends; gives the number of those that
    /// were finished before.
    ///
    /// # Errors
    /// A process cannot be started, or a record not be kept; scenes that fail are no errors but results.
    pub fn run(&self, plan: &Plan, told: &(dyn Fn(&Planned, &Record) + Sync)) -> Result<usize, JobError> {
        let failed = |source| JobError::Start { program: self.program.to_path_buf(), source };
        let program = hash(&std::fs::read(self.code).map_err(failed)?);
        let own: Vec<&Planned> =
            plan.scenes.iter().enumerate().filter(|(i, _)| self.shard.has(*i)).map(|(_, scene)| scene).collect();
        let open: Vec<&Planned> =
            own.iter().copied().filter(|scene| !(self.resume && self.is_finished(plan, scene, &program))).collect();
        std::fs::create_dir_all(self.out.join(PARTS))
            .map_err(|source| JobError::Write { path: self.out.join(PARTS), source })?;
        for scene in &open {
            Record::forget(self.out, &scene.name)?;
        }
        let next = AtomicUsize::new(0);
        let stopped: Mutex<Option<JobError>> = Mutex::new(None);
        let stop = |error| *stopped.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        let is_stopped = || stopped.lock().unwrap_or_else(PoisonError::into_inner).is_some();
        let work = || {
            while let Some(scene) = open.get(next.fetch_add(1, Ordering::Relaxed)).filter(|_| !is_stopped()) {
                match self.one(plan, scene, &program) {
                    Ok(record) => told(scene, &record),
                    Err(error) => stop(error),
                }
            }
        };
        thread::scope(|scope| {
            for _ in 1..self.processes.min(open.len()) {
                // Where the system has no more threads, fewer scenes run at a time.
                let _ = thread::Builder::new().spawn_scoped(scope, work);
            }
            work();
        });
        match stopped.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(error),
            None => Ok(own.len() - open.len()),
        }
    }

    /// True if the present program has given an answer to the present scene, and its report is there.
    fn is_finished(&self, plan: &Plan, scene: &Planned, program: &str) -> bool {
        let Some(record) = Record::read(self.out, plan, scene) else { return false };
        let answered = matches!(record.end, End::Exit(0 | 1 | 5)) && record.program == program;
        answered && report::run_of(&self.out.join(&scene.name)).is_ok_and(|run| run == record.run)
    }

    /// Runs one scene and keeps how it ended.
    fn one(&self, plan: &Plan, scene: &Planned, program: &str) -> Result<Record, JobError> {
        let run = identifier();
        let started = Instant::now();
        let ended = supervise(&mut self.command(plan, scene, &run), self.limit)
            .map_err(|source| JobError::Start { program: self.program.to_path_buf(), source })?;
        let (end, said) = told(ended);
        let record = Record {
            settings: plan.settings.clone(),
            content: scene.content.clone(),
            program: program.to_string(),
            run,
            end,
            seconds: started.elapsed().as_secs_f64(),
            said,
        };
        record.write(self.out, &scene.name)?;
        Ok(record)
    }

    fn command(&self, plan: &Plan, scene: &Planned, run: &str) -> Command {
        let mut command = Command::new(self.program);
        let out: PathBuf = self.out.join(&scene.name);
        command.arg(&plan.command).arg("--quiet").arg(option("--part=", run)).arg("--out").arg(out);
        command.arg(option("--part-name=", &scene.name));
        command.args(self.memory.map(|bytes| option("--max-memory=", &bytes.to_string())));
        // The job speaks for all of its scenes.
        command.env_remove("GITHUB_ACTIONS").env_remove("GITHUB_STEP_SUMMARY");
        command.args(&plan.options).args(&scene.options).arg("--").arg(&scene.scene);
        command
    }
}

fn option(name: &str, value: &str) -> OsString {
    format!("{name}{value}").into()
}

/// The end of a process, and what it said last.
fn told(ended: Ended) -> (End, Vec<String>) {
    let Ended { outcome, mut log } = ended;
    let end = match outcome {
        Outcome::TimedOut => End::TimedOut,
        Outcome::Exit(status) => match status.code().and_then(|code| u8::try_from(code).ok()) {
            Some(code) => End::Exit(code),
            None => End::Signal(status.signal()),
        },
        Outcome::Lost(error) => {
            log.push(lost(&error));
            End::Signal(None)
        }
    };
    (end, log)
}

fn lost(error: &io::Error) -> String {
    format!("the process could not be watched, and was ended: {error}")
}
