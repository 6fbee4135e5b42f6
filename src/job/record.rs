//! Records of the scenes that were run, one file a scene, so that a job can be resumed and its parts be gathered.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::plan::{Plan, Planned};
use super::{JobError, PARTS, PLAN};
use crate::report::folder;

/// How the process of one scene ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// [`Plan::settings`] of the job.
    pub settings: String,
    /// [`Planned::content`] of the scene.
    pub content: String,
    /// SHA-256 of the program.
    pub program: String,
    /// Identifier that its report has.
    pub run: String,
    /// How it ended.
    pub end: End,
    /// Seconds of the process.
    pub seconds: f64,
    /// The last lines that it printed.
    pub said: Vec<String>,
}

/// The end of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// By itself, with this exit code.
    Exit(u8),
    /// By this signal, or in a way the system does not tell.
    Signal(Option<i32>),
    /// After the time it was allowed.
    TimedOut,
}

/// Where the record of a scene is.
fn path(out: &Path, name: &str) -> PathBuf {
    out.join(PARTS).join(format!("{name}.json"))
}

impl Record {
    /// The record of `planned`, if there is one for the present scene and options.
    pub fn read(out: &Path, plan: &Plan, planned: &Planned) -> Option<Record> {
        let text = std::fs::read(path(out, &planned.name)).ok()?;
        let record: Record = serde_json::from_slice(&text).ok()?;
        (record.settings == plan.settings && record.content == planned.content).then_some(record)
    }

    /// Keeps it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, out: &Path, name: &str) -> Result<(), JobError> {
        write(&path(out, name), self)
    }

    /// Forgets what is kept of the scene `name`.
    ///
    /// # Errors
    /// There is something, and it cannot be removed.
    pub fn forget(out: &Path, name: &str) -> Result<(), JobError> {
        let path = path(out, name);
        match std::fs::remove_file(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(JobError::Write { path, source }),
            _ => Ok(()),
        }
    }
}

impl Plan {
    /// The plan of the job in `out`.
    ///
    /// # Errors
    /// There is none, or it is another version's.
    pub fn read(out: &Path) -> Result<Plan, JobError> {
        let path = out.join(PLAN);
        let refused = |reason: String| JobError::NoPlan { path: path.clone(), reason };
        let text = std::fs::read(&path).map_err(|e| refused(e.to_string()))?;
        let plan: Plan = serde_json::from_slice(&text).map_err(|e| refused(e.to_string()))?;
        if plan.schema_version != super::SCHEMA_VERSION {
            return Err(refused(format!("its version is {}", plan.schema_version)));
        }
        Ok(plan)
    }

    /// Keeps it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, out: &Path) -> Result<(), JobError> {
        write(&out.join(PLAN), self)
    }
}

fn write(path: &Path, value: &impl Serialize) -> Result<(), JobError> {
    let failed = |source| JobError::Write { path: path.to_path_buf(), source };
    let mut text = serde_json::to_string_pretty(value).map_err(|e| failed(e.into()))?;
    text.push('\n');
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    folder::replace_file(path, text.into_bytes()).map_err(failed)
}
