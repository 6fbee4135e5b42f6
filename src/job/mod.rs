//! Many scenes, each in a process of its own: what one of them does hides nothing of another.
//!
//! A [`Plan`] names the scenes; a [`Runner`] gives them to this program once more, some at a time, and keeps a [`Record`] of
//! each as it ends; [`gather()`] puts plan, records and reports together, whoever made them and wherever; [`write()`] makes one
//! page of them. A job in one piece does these four one after the other; a job in parts leaves the last two to whoever has all
//! parts, and one that was interrupted finds the records of what was finished.
//!
//! Files in the folder of a scene count as this job's only if they name the run that the record names: each process
//! is told its identifier.

mod badge;
mod baseline;
mod data;
mod gather;
mod junit;
mod page;
mod plan;
mod record;
mod run;
mod summary;
mod write;

use std::path::PathBuf;

pub use baseline::accept;
pub use data::{Bracketed, Counts, Entry, Gathered, Job, SceneStatus, schema, severity};
pub use gather::{entry, gather};
pub use plan::{Plan, Planned, Shard, content, names, scenes_of};
pub use record::{End, Record};
pub use run::{Runner, settings};
pub use summary::summary;
pub use write::{FILES, write};

/// Version of `job.json` and of the files that a job keeps.
pub const SCHEMA_VERSION: u32 = 1;
/// The folder of the records.
const PARTS: &str = "parts";
/// The file of the plan.
const PLAN: &str = "plan.json";

/// Why there is no job.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// A folder of scenes cannot be read.
    #[error("{path} cannot be read: {source}; give scene files, or a folder of them")]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A folder has no scene in it.
    #[error(
        "{path} is a directory without a scene: {} ends with .toml and has a table of a scene, such as [model]; give the \
         folder that the scenes are in, folders below it are not searched",
        if *other == 0 { "no file in it" } else { "none of its files" }
    )]
    NoScenes {
        /// The folder.
        path: PathBuf,
        /// How many TOML files about something else are in it.
        other: usize,
    },
    /// A path that cannot be written down.
    #[error("the name of {path} is not Unicode, and a job writes the names of its scenes down; rename it")]
    NotUnicode {
        /// The file.
        path: PathBuf,
    },
    /// There is no job to gather.
    #[error("{path} cannot be used: {reason}; give the folder that `--out` named when the parts of the job were run")]
    NoPlan {
        /// The file of the plan.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file of the job cannot be written.
    #[error("{path} cannot be written: {source}; free the place, or choose another folder with --out")]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The files of the page cannot be written.
    #[error(transparent)]
    Report(#[from] crate::report::ReportError),
    /// The baseline.
    #[error(transparent)]
    Baseline(#[from] crate::study::BaselineError),
    /// A process could not be started.
    #[error("a scene could not be given to {program}: {source}")]
    Start {
        /// This program.
        program: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
}
